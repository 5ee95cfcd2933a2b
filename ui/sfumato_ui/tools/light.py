"""The Light tool: every lamp on a hemisphere before the picture; drag one, or drag beside them the selected one.

The inner circle is the edge of the hemisphere; lamps in the ring around it shine from behind.
"""

from __future__ import annotations

import math

from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen

from sfumato import Light, Scene

from .. import light_moves, overlay
from ..color_button import to_srgb
from ..dial import MOVE
from ..editing import Editor
from ..lamp_places import moved, placed, seen_angles
from ..theme import DARK
from .handles import Handle, HandleTool, draw_label, draw_line
from .view import PictureView, Place

#: Part of the hemisphere's radius that an arrow key moves a lamp, and with Shift.
STEP, LARGE_STEP = 0.02, 0.1


class LightTool(HandleTool):
    """One handle a lamp."""

    cursor = Qt.CursorShape.CrossCursor

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._slip = (0.0, 0.0)

    def handles(self, view: PictureView) -> list[Handle]:
        """Return the lamps, the selected one before the others."""
        scene = self._editor.scene
        made = []
        for i, light in enumerate(scene.lights):
            tilt, rotation = seen_angles(scene, light)
            words = f"{light.name or i + 1}: tilt {tilt:.0f}°, rotation {rotation % 360:.0f}°"
            at = _place(view, *light_moves.to_disc(tilt, rotation))
            made.append(Handle(f"lamp.{i}", words, at, None, "round"))
        made.sort(key=lambda handle: handle.key != self._selected)
        return made

    @property
    def _selected(self) -> str:
        return f"lamp.{self._editor.selected}"

    def begin(self, handle: Handle, view: PictureView, at: Place) -> str:
        """Select a lamp and take it."""
        self._editor.select_light(int(handle.key.split(".")[1]))
        self._slip = handle.at[0] - at[0], handle.at[1] - at[1]
        return MOVE

    def drag(self, view: PictureView, at: Place) -> None:
        """Bring the lamp under the pointer."""
        light = self._editor.light
        if light is not None:
            x, y = _disc(view, (at[0] + self._slip[0], at[1] + self._slip[1]))
            self._editor.change_light(MOVE, True, **placed(self._editor.scene, light, x, y))

    def nudge(self, view: PictureView, right: int, up: int, large: bool) -> bool:
        """Move the selected lamp by an arrow key."""
        light, step = self._editor.light, LARGE_STEP if large else STEP
        if light is None:
            return False
        fields = moved(self._editor.scene, light, step * right, step * up)
        return self._editor.change_light(MOVE, True, **fields)

    def focus_next(self, view: PictureView, step: int) -> None:
        """Select the next or previous lamp."""
        count = len(self._editor.scene.lights)
        if count:
            self._editor.select_light((self._editor.selected + step) % count)

    def paint(self, painter: QPainter, view: PictureView) -> None:
        """Draw hemisphere, ring and lamps."""
        draw_guide(painter, view)
        handles = {handle.key: handle for handle in self.handles(view)}
        for i, light in reversed(list(enumerate(self._editor.scene.lights))):
            handle = handles[f"lamp.{i}"]
            hot = handle.key in (self.hovered, self.taken)
            on = light in self._editor.scene.active_lights
            draw_lamp(painter, view, handle.at, light, on=on, selected=handle.key == self._selected, hot=hot)
        shown = handles.get(self.hovered) or handles.get(self._selected)
        if shown is not None:
            draw_label(painter, view, shown)


def paint_one(painter: QPainter, view: PictureView, scene: Scene, light: Light) -> None:
    """Draw the hemisphere and one lamp on it, while it is moved with another tool."""
    draw_guide(painter, view)
    tilt, rotation = seen_angles(scene, light)
    at = _place(view, *light_moves.to_disc(tilt, rotation))
    draw_lamp(painter, view, at, light, on=light in scene.active_lights, selected=True, hot=True)
    draw_label(painter, view, Handle("lamp", f"tilt {tilt:.0f}°, rotation {rotation % 360:.0f}°", at))


def radius_of(view: PictureView) -> float:
    """Return the hemisphere's radius in pixels."""
    return overlay.LIGHT_RADIUS * min(view.width, view.height)


def _place(view: PictureView, x: float, y: float) -> Place:
    return view.width / 2 + x * radius_of(view), view.height / 2 - y * radius_of(view)


def _disc(view: PictureView, at: Place) -> Place:
    return (at[0] - view.width / 2) / radius_of(view), (view.height / 2 - at[1]) / radius_of(view)


def draw_guide(painter: QPainter, view: PictureView) -> None:
    """Draw the edge of the hemisphere and, dashed, that of the ring."""
    middle, radius = QPointF(view.width / 2, view.height / 2), radius_of(view)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for colour, width in ((QColor(0, 0, 0, 130), 3.0), (QColor(255, 255, 255, 190), 1.0)):
        painter.setPen(QPen(colour, width))
        painter.drawEllipse(middle, radius, radius)
    painter.setPen(QPen(QColor(255, 255, 255, 110), 1.0, Qt.PenStyle.DashLine))
    painter.drawEllipse(middle, radius * light_moves.RING, radius * light_moves.RING)


def draw_lamp(
    painter: QPainter, view: PictureView, at: Place, light: Light, *, on: bool, selected: bool, hot: bool
) -> None:
    """Draw a lamp in its colour, crossed out if it does not shine, with a spoke and a ring if it is selected."""
    size = 11.0 if hot else 9.0
    if selected:
        draw_line(painter, (view.width / 2, view.height / 2), at)
        painter.setBrush(QColor(0, 0, 0, 110))
        painter.setPen(QPen(QColor(DARK.accent), 2.5))
        painter.drawEllipse(QPointF(*at), size + 5, size + 5)
    painter.setPen(QPen(QColor("#1b1b1b"), 2))
    painter.setBrush(to_srgb(_full(light.color)) if on else QColor(60, 60, 60))
    painter.drawEllipse(QPointF(*at), size, size)
    if not on:
        reach = size * math.sqrt(0.5)
        painter.setPen(QPen(QColor("#f4f4f4"), 2))
        box = QRectF(at[0] - reach, at[1] - reach, 2 * reach, 2 * reach)
        painter.drawLine(box.topRight(), box.bottomLeft())


def _full(color: tuple[float, float, float]) -> tuple[float, float, float]:
    """Return a lamp's hue at full brightness: how bright it is, its intensity says."""
    top = max(max(color), 1e-6)
    return color[0] / top, color[1] / top, color[2] / top
