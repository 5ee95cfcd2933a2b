"""The lamps in a slice view: where they are, what a hand does to them, how they look.

Lamps that stand somewhere are where they stand, moved parallel to the slice. Parallel ones lie, as in the Light
tool, on a disc before the view: its middle is a lamp that shines at right angles to the slice, its rim one that
shines along it; an arrow leads from where the light comes. A drag keeps the side of the slice on which a lamp is.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from qtpy.QtCore import QPointF, Qt
from qtpy.QtGui import QColor, QPainter, QPen, QPolygonF

from sfumato import Light
from sfumato.scene.vectors import vec3
from sfumato.slicing import Cut

from ..dial import MOVE
from ..editing import Editor
from ..lamp_places import middle_of, place_words, pointed, seen_angles, within_reach
from ..theme import DARK
from ..tools import HandleTool, PictureView
from ..tools import lamps as placed_lamps
from ..tools.handles import Handle, draw_label
from ..tools.light import LARGE_STEP, STEP, draw_lamp, radius_of
from ..tools.view import Place
from .state import SliceState

#: Opacity of a lamp that stands beside the slice.
BESIDE = 0.6
#: Length in pixels of the arrow behind which a parallel lamp lies, and of its head.
ARROW, HEAD = 26.0, 7.0


class SliceLamps(HandleTool):
    """One handle a lamp, in one view."""

    cursor = Qt.CursorShape.CrossCursor

    def __init__(self, editor: Editor, state: SliceState, index: int) -> None:
        super().__init__()
        self._editor, self._state, self._index = editor, state, index
        self._slip = (0.0, 0.0)
        #: Whether they are shown, and can be taken.
        self.shown = True

    @property
    def _cut(self) -> Cut:
        return self._state.cuts[self._index]

    # -- where they are ---------------------------------------------------------------------------
    def handles(self, view: PictureView) -> list[Handle]:
        """Return the lamps, the selected one before the others."""
        scene = self._editor.scene
        if not self.shown or scene.camera is None or scene.volume is None:
            return []
        made = [self._handle(view, i, light) for i, light in enumerate(scene.lights)]
        return sorted(made, key=lambda handle: handle.key != f"lamp.{self._editor.selected}")

    def _handle(self, view: PictureView, index: int, light: Light) -> Handle:
        scene, name = self._editor.scene, light.name or str(index + 1)
        if light.placed:
            words = f"{name}: {place_words(scene, light.position)}{self._beside(light)}"
            return Handle(f"lamp.{index}", words, placed_lamps.place_of(view, light), None, "round")
        tilt, rotation = seen_angles(scene, light)
        right, up, _ = self._towards(light)
        at = view.width / 2 + right * radius_of(view), view.height / 2 - up * radius_of(view)
        return Handle(
            f"lamp.{index}", f"{name}: tilt {tilt:.0f}°, rotation {rotation % 360:.0f}°", at, None, "round"
        )

    def _towards(self, light: Light) -> np.ndarray:
        """Return the unit vector towards a parallel lamp in the view's axes right, up, back."""
        scene = self._editor.scene
        assert scene.camera is not None
        return np.asarray(self._cut.axes @ light.towards(scene.camera.basis(), vec3(middle_of(scene))))

    def _before(self, light: Light) -> float:
        """Return how far before the slice a lamp stands, in mm."""
        return float(self._cut.back @ (np.asarray(light.position) - self._state.cross))

    def _beside(self, light: Light) -> str:
        away = self._before(light)
        if abs(away) < 0.05:
            return ""
        return f", {abs(away):.1f} mm {'before' if away > 0 else 'behind'} the slice"

    # -- what a hand does -------------------------------------------------------------------------
    def begin(self, handle: Handle, view: PictureView, at: Place) -> str:
        """Select a lamp and take it."""
        self._editor.select_light(int(handle.key.split(".")[1]))
        self._slip = handle.at[0] - at[0], handle.at[1] - at[1]
        return MOVE

    def take(self, view: PictureView, at: Place) -> str:
        """Take the selected lamp from beside it; returns what the drag does, or nothing."""
        light = self._editor.light
        if light is None or self._editor.scene.camera is None or self._state.volume is None:
            return ""
        self.taken = f"lamp.{self._editor.selected}"
        handle = self._handle(view, self._editor.selected, light)
        # One that stands out of sight comes to the pointer.
        seen = not light.placed or placed_lamps.is_seen(view, light)
        self._slip = (handle.at[0] - at[0], handle.at[1] - at[1]) if seen else (0.0, 0.0)
        return MOVE

    def drag(self, view: PictureView, at: Place) -> None:
        """Bring the lamp under the pointer."""
        self._bring(view, (at[0] + self._slip[0], at[1] + self._slip[1]))

    def _bring(self, view: PictureView, spot: Place) -> None:
        light = self._editor.light
        if light is not None:
            fields = self._placed(view, light, spot) if light.placed else self._turned(view, light, spot)
            self._editor.change_light(MOVE, True, **fields)

    def _placed(self, view: PictureView, light: Light, spot: Place) -> dict[str, Any]:
        """Return the fields of a lamp under a place of the view, as far from the slice as it was."""
        start, back = view.ray(spot)[0], self._cut.back
        return {"position": within_reach(start - back * float(back @ (start - np.asarray(light.position))))}

    def _turned(self, view: PictureView, light: Light, spot: Place) -> dict[str, Any]:
        """Return the fields of a parallel lamp under a place of the disc, on the side of the slice where it was."""
        x, y = (spot[0] - view.width / 2) / radius_of(view), (view.height / 2 - spot[1]) / radius_of(view)
        length = math.hypot(x, y)
        if length > 1:
            x, y = x / length, y / length
        side = 1.0 if self._towards(light)[2] >= 0 else -1.0
        inward = side * math.sqrt(max(0.0, 1 - x * x - y * y))
        return pointed(self._editor.scene, light, self._cut.axes.T @ np.array([x, y, inward]))

    def nudge(self, view: PictureView, right: int, up: int, large: bool) -> bool:
        """Move the selected lamp by an arrow key."""
        light = self._editor.light
        if light is None or self._editor.scene.camera is None or self._state.volume is None:
            return False
        handle = self._handle(view, self._editor.selected, light)
        way = (LARGE_STEP if large else STEP) * radius_of(view)
        self._bring(view, (handle.at[0] + right * way, handle.at[1] - up * way))
        return True

    # -- how they look ----------------------------------------------------------------------------
    def paint(self, painter: QPainter, view: PictureView) -> None:
        """Draw the lamps, and beside the one in the hand or under the pointer what it is."""
        scene, handles = self._editor.scene, self.handles(view)
        for handle in reversed(handles):
            index = int(handle.key.split(".")[1])
            light, selected = scene.lights[index], index == self._editor.selected
            on, hot = light in scene.active_lights, handle.key in (self.hovered, self.taken)
            beside = light.placed and abs(self._before(light)) > max(light.radius, self._state.mm_per_pixel)
            painter.setOpacity(BESIDE if (beside or not on) and not hot else 1.0)
            if light.placed:
                placed_lamps.draw(painter, scene, view, light, selected)
            else:
                _draw_arrow(painter, view, handle.at, selected)
            # Without its spoke: the arrow says whence it shines.
            draw_lamp(painter, view, handle.at, light, on=on, selected=selected, hot=hot, spoke=False)
        painter.setOpacity(1.0)
        for handle in handles:
            if handle.key == (self.taken or self.hovered):
                draw_label(painter, view, handle)


def _draw_arrow(painter: QPainter, view: PictureView, at: Place, selected: bool) -> None:
    """Draw an arrow from a parallel lamp the way it shines, light within dark; none if that is into the view."""
    x, y = view.width / 2 - at[0], view.height / 2 - at[1]
    length = math.hypot(x, y)
    if length < HEAD + 9:
        return
    x, y, reach = x / length, y / length, min(length, 9 + ARROW)
    tip = QPointF(at[0] + reach * x, at[1] + reach * y)
    neck = QPointF(tip.x() - HEAD * x, tip.y() - HEAD * y)
    side = QPointF(-0.6 * HEAD * y, 0.6 * HEAD * x)
    ink = QColor(DARK.accent) if selected else QColor(255, 255, 255, 220)
    for colour, width in ((QColor(0, 0, 0, 150), 4.0), (ink, 1.8)):
        painter.setPen(QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.setBrush(colour)
        painter.drawLine(QPointF(*at), neck)
        painter.drawPolygon(QPolygonF([tip, neck + side, neck - side]))


__all__ = ["SliceLamps"]
