"""A slice view as it is seen: asks for its slice, shows the newest one, draws all that lies over it."""

from __future__ import annotations

import math

import numpy as np
from qtpy.QtCore import QSize, Qt
from qtpy.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent, QShowEvent
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato.scene.vectors import vec3
from sfumato.slicing import Cut, Frame

from .. import overlay
from ..editing import Editor
from ..theme import PICTURE_GREY
from ..tools import PictureView
from . import painting
from .lamps import SliceLamps
from .slicer import SliceImage, Slicer, SliceRequest
from .state import SliceState

#: A slice has no more pixels than this, which takes about 60 ms; a larger view shows it enlarged.
MOST_PIXELS = 700_000
#: Free pixels beside the volume when the whole of it is seen.
MARGIN = 5
NOTHING = "No volume to slice"


class SliceCanvas(QWidget):
    """Shows one cut.

    Parameters
    ----------
    index : int
        Which of the state's cuts.
    """

    def __init__(self, editor: Editor, state: SliceState, slicer: Slicer, index: int) -> None:
        super().__init__()
        self._editor, self._state, self._slicer, self._index = editor, state, slicer, index
        self.lamps = SliceLamps(editor, state, index)
        self.made: SliceImage | None = None
        self._wanted: SliceRequest | None = None
        #: Whether it has the bar of true length; one view is enough, since all have the same scale.
        self.scale_bar = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(120, 100)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setMouseTracking(True)
        state.moved.connect(self.refresh)
        state.windowed.connect(self.want)
        state.replaced.connect(self._on_replaced)
        slicer.sliced.connect(self._on_sliced)
        editor.changed.connect(lambda old, new: self.update())
        editor.light_selected.connect(lambda index: self.update())

    def sizeHint(self) -> QSize:
        """Take what is there."""
        return QSize(300, 180)

    @property
    def cut(self) -> Cut:
        """What it shows."""
        return self._state.cuts[self._index]

    @property
    def view(self) -> PictureView:
        """From world to widget pixels and back."""
        frame = self._frame(1.0)
        return PictureView(frame.camera, frame.width, frame.height)

    @property
    def room(self) -> tuple[Cut, float, float]:
        """What it shows, and the width and height in pixels that a whole volume has."""
        return self.cut, self.width() - 2.0 * MARGIN, self.height() - 2.0 * MARGIN

    def _frame(self, ratio: float) -> Frame:
        """Return what is seen, with so many pixels to a pixel of the widget."""
        state = self._state
        width, height = max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio))
        scale = state.mm_per_pixel * self.height() / height
        return Frame(self.cut, vec3(state.middle_of(self.cut)), scale, width, height)

    # -- the slice --------------------------------------------------------------------------------
    def refresh(self) -> None:
        """Cross-hair or part are others."""
        self._describe()
        self.update()
        self.want()

    def want(self) -> None:
        """Ask for the slice, unless nobody sees it or it was asked for already."""
        state = self._state
        if state.volume is None or state.window is None or not self.isVisible():
            return
        most = math.sqrt(MOST_PIXELS / max(1, self.width() * self.height()))
        request = SliceRequest(state.volume, self._frame(min(self.devicePixelRatioF(), most)), state.window)
        before = self._wanted
        if before is None or (before.volume, before.frame, before.window) != (
            request.volume, request.frame, request.window,
        ):  # fmt: skip
            self._wanted = request
            self._slicer.want(request)

    def _on_sliced(self, made: SliceImage) -> None:
        request = made.request
        if request.frame.cut.id == self.cut.id and request.volume is self._state.volume:
            self.made = made
            self.update()

    def _on_replaced(self) -> None:
        """Forget what belongs to another volume."""
        self.made = self._wanted = None
        name = f"{self.cut.title} slice"
        self.setAccessibleName(name)
        self._describe()
        self.update()

    @property
    def place(self) -> str:
        """Where the slice lies, in words."""
        volume = self._state.volume
        return painting.slice_place(volume, self.cut, self._state.cross) if volume is not None else ""

    def _describe(self) -> None:
        self.setAccessibleDescription(self.place or NOTHING)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Ask for another size."""
        super().resizeEvent(event)
        self.want()

    def showEvent(self, event: QShowEvent) -> None:
        """Ask for what nobody has seen yet."""
        super().showEvent(event)
        self.want()

    def forget(self) -> None:
        """Ask anew when it is shown again."""
        self._wanted = None

    # -- looks ------------------------------------------------------------------------------------
    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the slice and all that lies over it."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(PICTURE_GREY))
        if self._state.volume is None:
            overlay.draw_centred(painter, self.rect(), NOTHING)
        else:
            self._paint_slice(painter)
        if self.hasFocus():
            painting.draw_focus(painter, self.rect())

    def _paint_slice(self, painter: QPainter) -> None:
        view, scene, cross = self.view, self._editor.scene, self._state.cross
        painter.setFont(painting.small(self.font()))
        if self.made is not None:
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painting.draw_slice(painter, view, self.made)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if scene.volume is not None:
            painting.draw_cuts(painter, view, scene, self.cut, np.asarray(cross))
        painting.draw_cross(painter, view, cross)
        self.lamps.paint(painter, view)
        painting.draw_names(painter, self.rect(), self.cut, self.place)
        if self.scale_bar:
            overlay.draw_scale_bar(painter, self.rect(), view.camera)


__all__ = ["SliceCanvas"]
