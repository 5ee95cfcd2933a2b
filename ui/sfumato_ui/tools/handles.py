"""Handles in the picture: where they are, which one is meant, how they look."""

from __future__ import annotations

import math
from dataclasses import dataclass

from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen

from .. import overlay
from ..theme import DARK
from .view import PictureView, Place

#: Distance in pixels within which a handle is hit.
HIT = 14.0
#: Radius of a handle in pixels.
SIZE = 7.0
_CURSORS = (
    Qt.CursorShape.SizeHorCursor,
    Qt.CursorShape.SizeBDiagCursor,
    Qt.CursorShape.SizeVerCursor,
    Qt.CursorShape.SizeFDiagCursor,
)


@dataclass(frozen=True)
class Handle:
    """One thing to take hold of.

    Parameters
    ----------
    key : str
        Which it is, however it moves.
    name : str
        What it moves and its value, for people.
    at : (float, float)
        Place in the picture, widget pixels.
    along : (float, float), optional
        Direction in the picture, y up, in which it moves; none if it moves freely.
    shape : str
        ``square``, ``round`` or ``diamond``.
    """

    key: str
    name: str
    at: Place
    along: Place | None = None
    shape: str = "square"

    def distance(self, place: Place) -> float:
        """Return the distance to a place in pixels."""
        return math.dist(self.at, place)

    @property
    def cursor(self) -> Qt.CursorShape:
        """The cursor that says how it can be moved."""
        if self.along is None:
            return Qt.CursorShape.SizeAllCursor
        eighth = round(math.atan2(self.along[1], self.along[0]) / (math.pi / 4))
        return _CURSORS[eighth % 4]


class HandleTool:
    """A tool with handles; which one is under the pointer, taken, or focused for the keys."""

    cursor = Qt.CursorShape.ArrowCursor
    #: Whether a drag with Alt is the tool's own, not a pan.
    own_alt = False

    def __init__(self) -> None:
        #: Whether the drag began with Alt.
        self.alternate = False
        self.hovered = ""
        self.focused = ""
        self.taken = ""

    # -- for the tools ----------------------------------------------------------------------------
    def handles(self, view: PictureView) -> list[Handle]:
        """Return the handles from front to back."""
        raise NotImplementedError

    def begin(self, handle: Handle, view: PictureView, at: Place) -> str:
        """Take a handle; returns what the drag does, for the history."""
        raise NotImplementedError

    def drag(self, view: PictureView, at: Place) -> None:
        """Follow the pointer."""
        raise NotImplementedError

    def nudge(self, view: PictureView, right: int, up: int, large: bool) -> bool:
        """Move the focused handle by an arrow key; returns whether there was one."""
        raise NotImplementedError

    def paint(self, painter: QPainter, view: PictureView) -> None:
        """Draw what the tool shows."""
        raise NotImplementedError

    # -- for the viewport -------------------------------------------------------------------------
    def hit(self, view: PictureView, at: Place) -> Handle | None:
        """Return the handle at a place."""
        near = [handle for handle in self.handles(view) if handle.distance(at) <= HIT]
        return min(near, key=lambda handle: handle.distance(at), default=None)

    def hover(self, view: PictureView, at: Place | None) -> Qt.CursorShape:
        """Mark the handle under the pointer; returns the cursor to show."""
        handle = self.hit(view, at) if at is not None else None
        self.hovered = handle.key if handle else ""
        return handle.cursor if handle else self.cursor

    def press(self, view: PictureView, at: Place) -> str:
        """Take the handle at a place and focus it; returns the drag's name, or nothing."""
        handle = self.hit(view, at)
        self.focused = self.taken = handle.key if handle else ""
        return self.begin(handle, view, at) if handle else ""

    def release(self) -> None:
        """Let go."""
        self.taken = ""

    def focus_next(self, view: PictureView, step: int) -> None:
        """Focus the next or previous handle for the arrow keys."""
        keys = [handle.key for handle in self.handles(view)]
        if keys:
            at = keys.index(self.focused) + step if self.focused in keys else min(step, 0)
            self.focused = keys[at % len(keys)]

    def leave(self) -> None:
        """Forget pointer and focus: another tool is chosen."""
        self.hovered = self.focused = self.taken = ""

    def paint_handles(self, painter: QPainter, view: PictureView) -> None:
        """Draw all handles, and beside the one in question what it does."""
        handles = self.handles(view)
        for handle in reversed(handles):
            draw_handle(painter, handle, handle.key in (self.hovered, self.taken), handle.key == self.focused)
        wanted = self.taken or self.hovered or self.focused
        for handle in handles:
            if handle.key == wanted:
                draw_label(painter, view, handle)


def draw_handle(painter: QPainter, handle: Handle, hot: bool, focused: bool) -> None:
    """Draw a handle that is seen on any picture: a light body in a dark rim, in the accent's colour if hot."""
    middle, size = QPointF(*handle.at), SIZE + (1.5 if hot else 0)
    if focused:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for colour, width in ((QColor(0, 0, 0, 180), 4.0), (QColor(DARK.accent), 2.0)):
            painter.setPen(QPen(colour, width))
            painter.drawEllipse(middle, size + 5, size + 5)
    painter.setPen(QPen(QColor("#1b1b1b"), 2))
    painter.setBrush(QColor(DARK.accent) if hot or focused else QColor("#f4f4f4"))
    if handle.shape == "round":
        painter.drawEllipse(middle, size, size)
        return
    painter.save()
    painter.translate(middle)
    if handle.shape == "diamond":
        painter.rotate(45)
    painter.drawRoundedRect(QRectF(-size + 1, -size + 1, 2 * size - 2, 2 * size - 2), 2, 2)
    painter.restore()


def draw_label(painter: QPainter, view: PictureView, handle: Handle) -> None:
    """Draw a handle's name below it, within the picture."""
    metrics = painter.fontMetrics()
    wide, tall = metrics.horizontalAdvance(handle.name) + 20, metrics.height() + 8
    left = min(max(4.0, handle.at[0] - wide / 2), view.width - wide - 4)
    below = handle.at[1] + SIZE + 10
    top = below if below + tall < view.height - 4 else handle.at[1] - SIZE - 10 - tall
    overlay.draw_text(painter, QRectF(left, top, wide, tall), handle.name)


def draw_line(painter: QPainter, a: Place, b: Place, *, dashed: bool = False, strong: bool = False) -> None:
    """Draw a line that is seen on any picture: light within dark."""
    style = Qt.PenStyle.DashLine if dashed else Qt.PenStyle.SolidLine
    light = QColor(DARK.accent) if strong else QColor(255, 255, 255, 200)
    for colour, width in ((QColor(0, 0, 0, 120), 3.0), (light, 1.6 if strong else 1.2)):
        painter.setPen(QPen(colour, width, Qt.PenStyle.SolidLine if width == 3.0 and not dashed else style))
        painter.drawLine(QPointF(*a), QPointF(*b))
