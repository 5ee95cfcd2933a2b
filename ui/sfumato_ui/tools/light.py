"""The Light tool: every lamp in the picture; drag one, or drag beside them the selected one.

Parallel lamps lie on a hemisphere before the picture: the inner circle is its edge, lamps in the ring around
it shine from behind. Lamps with a place are where they stand (`lamps`).
"""

from __future__ import annotations

import math
from typing import Any

from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen

from sfumato import Light, Scene

from .. import light_moves, overlay
from ..color_button import to_srgb
from ..dial import MOVE
from ..editing import Editor
from ..lamp_place import AIM
from ..lamp_places import diagonal_of, moved, place_words, placed, seen_angles
from ..theme import DARK
from . import lamps
from .handles import Handle, HandleTool, draw_handle, draw_label, draw_line
from .view import PictureView, Place

#: Part of the hemisphere's radius that an arrow key moves a lamp, and with Shift.
STEP, LARGE_STEP = 0.02, 0.1
#: The same for a lamp with a place, in parts of the picture's height, and for its direction, in degrees.
SHIFT, LARGE_SHIFT = 0.01, 0.05
TURN, LARGE_TURN = 1.0, 10.0

_Grip = lamps.PlaceGrip | lamps.DepthGrip | lamps.AimGrip


class LightTool(HandleTool):
    """One handle a lamp; the selected one has more if it stands somewhere."""

    cursor = Qt.CursorShape.CrossCursor

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._slip = (0.0, 0.0)
        self._grip: _Grip | None = None

    def handles(self, view: PictureView) -> list[Handle]:
        """Return the lamps, the selected one before the others."""
        scene, made = self._editor.scene, []
        for i, light in enumerate(scene.lights):
            name, selected = light.name or str(i + 1), i == self._editor.selected
            if light.placed:
                made += lamps.handles(scene, view, light, i, selected, name)
                continue
            tilt, rotation = seen_angles(scene, light)
            words = f"{name}: tilt {tilt:.0f}°, rotation {rotation % 360:.0f}°"
            at = _place(view, *light_moves.to_disc(tilt, rotation))
            made.append(Handle(f"lamp.{i}", words, at, None, "round"))
        made.sort(key=lambda handle: not handle.key.endswith(f".{self._editor.selected}"))
        return made

    @property
    def _selected(self) -> str:
        return f"lamp.{self._editor.selected}"

    @property
    def _focus(self) -> str:
        """The focused handle, if it is the selected lamp's still."""
        return self.focused if self.focused.endswith(f".{self._editor.selected}") else self._selected

    # -- mouse ------------------------------------------------------------------------------------
    def begin(self, handle: Handle, view: PictureView, at: Place) -> str:
        """Select a lamp and take it, or what moves it along the view or aims it."""
        part, index = handle.key.split(".")
        self._editor.select_light(int(index))
        light, scene = self._editor.light, self._editor.scene
        self._grip = None
        self._slip = handle.at[0] - at[0], handle.at[1] - at[1]
        if light is None or not light.placed:
            return MOVE
        if part == "depth":
            self._grip = lamps.DepthGrip(view, light, at)
        elif part == "aim":
            self._grip = lamps.AimGrip(scene, view, light, at)
        else:
            self._grip = lamps.PlaceGrip(scene, view, light, at)
        return AIM if part == "aim" else MOVE

    def take(self, view: PictureView, at: Place) -> bool:
        """Take the selected lamp from beside it; returns whether it has a place."""
        light = self._editor.light
        if light is None or not light.placed:
            return False
        self._grip = lamps.PlaceGrip(self._editor.scene, view, light, at)
        return True

    def drag(self, view: PictureView, at: Place) -> None:
        """Bring the lamp under the pointer."""
        light, scene = self._editor.light, self._editor.scene
        if light is None:
            return
        if self._grip is not None:
            label = AIM if isinstance(self._grip, lamps.AimGrip) else MOVE
            self._editor.change_light(label, True, **self._grip.moved(scene, view, light, at))
        else:
            x, y = _disc(view, (at[0] + self._slip[0], at[1] + self._slip[1]))
            self._editor.change_light(MOVE, True, **placed(scene, light, x, y))

    def release(self) -> None:
        """Let go."""
        super().release()
        self._grip = None

    def wheel(self, view: PictureView, at: Place, notches: float) -> bool:
        """Move the lamp in the hand, or under the pointer, along the view; returns whether there is one."""
        light, scene = self._editor.light, self._editor.scene
        if light is None or not light.placed:
            return False
        if isinstance(self._grip, lamps.PlaceGrip):
            way = notches * lamps.NOTCH * diagonal_of(scene)
            return self._editor.change_light(MOVE, True, **self._grip.deeper(scene, view, light, way))
        under = self.hit(view, at)
        if self._grip is not None or under is None or under.key != self._selected:
            return False
        return self._editor.change_light(MOVE, True, **lamps.farther(scene, view, light, notches))

    # -- keys -------------------------------------------------------------------------------------
    def nudge(self, view: PictureView, right: int, up: int, large: bool) -> bool:
        """Move the selected lamp, or what is focused of it, by an arrow key."""
        light, scene = self._editor.light, self._editor.scene
        if light is None:
            return False
        part = self._focus.split(".")[0] if light.placed else ""
        if part == "depth":
            fields = lamps.farther(scene, view, light, (up or right) * (5.0 if large else 1.0))
        elif part == "aim":
            turn = LARGE_TURN if large else TURN
            return self._editor.change_light(
                AIM, True, **lamps.aimed_by(view, light, turn * right, turn * up)
            )
        else:
            fields = self.shifted(view, light, right, up, large)
        return self._editor.change_light(MOVE, True, **fields)

    def shifted(self, view: PictureView, light: Light, right: int, up: int, large: bool) -> dict[str, Any]:
        """Return a lamp's fields after an arrow key."""
        if light.placed:
            step = LARGE_SHIFT if large else SHIFT
            return lamps.nudged(view, light, step * right, step * up)
        step = LARGE_STEP if large else STEP
        return moved(self._editor.scene, light, step * right, step * up)

    def focus_next(self, view: PictureView, step: int) -> None:
        """Select the next or previous lamp; between them come the further handles of the selected one."""
        own = [h.key for h in self.handles(view) if h.key.endswith(f".{self._editor.selected}")]
        count = len(self._editor.scene.lights)
        if not count:
            return
        at = own.index(self._focus) if self._focus in own else 0
        if 0 <= at + step < len(own):
            self.focused = own[at + step]
        else:
            self._editor.select_light((self._editor.selected + step) % count)
            own = [h.key for h in self.handles(view) if h.key.endswith(f".{self._editor.selected}")]
            self.focused = own[-1] if step < 0 else own[0]

    # -- looks ------------------------------------------------------------------------------------
    def paint(self, painter: QPainter, view: PictureView) -> None:
        """Draw hemisphere and ring if a lamp lies there, and the lamps."""
        scene = self._editor.scene
        if any(not light.placed for light in scene.lights):
            draw_guide(painter, view)
        shown = {handle.key: handle for handle in self.handles(view)}
        for i, light in reversed(list(enumerate(scene.lights))):
            handle, selected = shown[f"lamp.{i}"], i == self._editor.selected
            hot = handle.key in (self.hovered, self.taken)
            if light.placed:
                lamps.draw(painter, scene, view, light, selected)
            on = light in scene.active_lights
            draw_lamp(painter, view, handle.at, light, on=on, selected=selected, hot=hot)
        for handle in shown.values():
            if not handle.key.startswith("lamp."):
                hot = handle.key in (self.hovered, self.taken)
                draw_handle(painter, handle, hot, handle.key == self._focus)
        wanted = self.taken or self.hovered or self._focus
        named = shown.get(wanted) or shown.get(self._selected)
        if named is not None:
            draw_label(painter, view, named)


def paint_one(painter: QPainter, view: PictureView, scene: Scene, light: Light) -> None:
    """Draw one lamp, where it stands or on the hemisphere, while it is moved with another tool."""
    on = light in scene.active_lights
    if light.placed:
        lamps.draw(painter, scene, view, light, True)
        at, words = lamps.place_of(view, light), place_words(scene, light.position)
    else:
        draw_guide(painter, view)
        tilt, rotation = seen_angles(scene, light)
        at = _place(view, *light_moves.to_disc(tilt, rotation))
        words = f"tilt {tilt:.0f}°, rotation {rotation % 360:.0f}°"
    draw_lamp(painter, view, at, light, on=on, selected=True, hot=True)
    draw_label(painter, view, Handle("lamp", words, at))


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
    painter: QPainter, view: PictureView, at: Place, light: Light, *, on: bool, selected: bool, hot: bool,
    spoke: bool = True,
) -> None:  # fmt: skip
    """Draw a lamp in its colour, crossed out if it does not shine, with a spoke and a ring if it is selected."""
    size = 11.0 if hot else 9.0
    if selected:
        if spoke and not light.placed:
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
