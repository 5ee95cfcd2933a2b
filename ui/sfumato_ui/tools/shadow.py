"""The Shadow tool: press on what casts the shadow, drag to where it is to fall; the selected lamp follows.

The highlight is placed in the same way: with Alt, or as the tool's bar says. The surface under the pointer is
where it falls. What was placed stays in hand: its ends are handles, by mouse and keys, until the lamp is moved
otherwise. Where no lamp can do it, the nearest is taken and the bar says so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from qtpy.QtCore import QObject, Qt, Signal
from qtpy.QtGui import QPainter

from sfumato import Light, Scene, Volume
from sfumato.scene.aiming import LIT, Aimed, LitPlace, aimed, highlight_direction, shadow_ends
from sfumato.scene.picking import surface_under

from ..editing import Editor
from .handles import Handle, HandleTool, draw_line
from .view import PictureView, Place

SHADOW, HIGHLIGHT = "Place the shadow", "Place the highlight"
#: Part of the picture's height that an arrow key moves an end, and with Shift.
STEP, LARGE_STEP = 0.01, 0.05
#: Angle in degrees that counts as having reached what was wanted.
CLOSE = 0.5
TURNED_AWAY = "The surface here turns away from that light, and is dark by itself"


@dataclass
class _Placed:
    """What the tool has in hand: two points of the surface, world mm, and the lamp that it made."""

    caster: np.ndarray
    place: np.ndarray
    glossy: bool
    volume: Volume | None
    light: Light | None = None


class Told(QObject):
    """What the tool has to say."""

    changed = Signal(str)


class ShadowTool(HandleTool):
    """Solves the selected lamp for where its shadow, or its highlight, is to be."""

    cursor = Qt.CursorShape.CrossCursor
    own_alt = True

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._placed: _Placed | None = None
        #: Whether the highlight is placed, not the shadow; Alt does the other.
        self.glossy = False
        self.told = Told()

    # -- where its handles are --------------------------------------------------------------------
    def handles(self, view: PictureView) -> list[Handle]:
        """Return the ends of what was placed, as long as the lamp is as the tool left it."""
        placed = self._current
        if placed is None:
            return []
        made, seen = [], view.place(placed.place)
        if seen is not None:
            name = "Highlight" if placed.glossy else "Shadow"
            made.append(Handle("place", name, seen, None, "round"))
        seen = view.place(placed.caster)
        if seen is not None and not placed.glossy:
            made.append(Handle("caster", "What casts the shadow", seen, None, "diamond"))
        return made

    @property
    def _current(self) -> _Placed | None:
        """What is in hand, unless somebody else moved the lamp or other data are open."""
        placed = self._placed
        if placed is not None and (
            placed.volume is not self._editor.scene.volume or placed.light != self._editor.light
        ):
            self._placed = placed = None
        return placed

    # -- mouse ------------------------------------------------------------------------------------
    def press(self, view: PictureView, at: Place) -> str:
        """Take an end, or begin anew on the surface under the pointer; nothing there, or no lamp: nothing."""
        light = self._editor.light
        if light is None:
            return ""
        handle = self.hit(view, at)
        if handle is not None and not self.alternate:
            self.focused = self.taken = handle.key
            return self.begin(handle, view, at)
        surface = _surface(self._editor.scene, view, at)
        if surface is None:
            self.focused = self.taken = ""
            return ""
        self._placed = _Placed(
            surface, surface, self.glossy != self.alternate, self._editor.scene.volume, light
        )
        self.focused = self.taken = "place"
        return HIGHLIGHT if self._placed.glossy else SHADOW

    def begin(self, handle: Handle, view: PictureView, at: Place) -> str:
        """Take an end of what was placed."""
        return HIGHLIGHT if self._placed is not None and self._placed.glossy else SHADOW

    def drag(self, view: PictureView, at: Place) -> None:
        """Bring the end in the hand to the surface under the pointer, and the lamp after it."""
        surface = _surface(self._editor.scene, view, at)
        if surface is None or self._placed is None:
            self._tell("Nothing lies here on which it could fall" if self._placed is not None else "")
            return
        if self.taken == "caster":
            self._placed.caster = surface
        else:
            self._placed.place = surface
        self._solve(self._placed, view)

    def release(self) -> None:
        """Let go."""
        super().release()
        self.alternate = False

    def leave(self) -> None:
        """Forget what was placed: another tool is chosen."""
        super().leave()
        self._placed = None
        self._tell("")

    # -- keys -------------------------------------------------------------------------------------
    def focus_next(self, view: PictureView, step: int) -> None:
        """Focus the next end; with nothing in hand, take the surface in the picture's middle."""
        light, middle = self._editor.light, (view.width / 2, view.height / 2)
        if self._current is None and light is not None:
            surface = _surface(self._editor.scene, view, middle)
            if surface is not None:
                self._placed = _Placed(surface, surface, self.glossy, self._editor.scene.volume, light)
        super().focus_next(view, step)

    def nudge(self, view: PictureView, right: int, up: int, large: bool) -> bool:
        """Move the focused end by an arrow key over the surface."""
        placed = self._current
        if placed is None or not self.focused:
            return False
        seen = view.place(placed.caster if self.focused == "caster" else placed.place)
        if seen is None:
            return False
        way = (LARGE_STEP if large else STEP) * view.height
        self.taken = self.focused
        self.drag(view, (seen[0] + right * way, seen[1] - up * way))
        self.taken = ""
        return True

    # -- the lamp ---------------------------------------------------------------------------------
    def _solve(self, placed: _Placed, view: PictureView) -> None:
        """Change the lamp so that its shadow, or highlight, lies at the place, as nearly as it can."""
        scene, light = self._editor.scene, self._editor.light
        if light is None:
            return
        if placed.glossy:
            towards = highlight_direction(scene, placed.place)
            place, through, lit = placed.place, placed.place, True
        else:
            ends = _ends(scene, placed, view)
            towards, through = (ends[0] if ends else None), placed.caster
            place, lit = (ends[1].point, ends[1].share >= LIT) if ends else (placed.place, True)
        if towards is None:
            return
        found = aimed(scene, light, towards, place, through)
        if found.fields:
            label = HIGHLIGHT if placed.glossy else SHADOW
            self._editor.change_light(label, True, **found.fields)
            placed.light = self._editor.light
        self._tell(_complaint(light, found, placed.glossy) or ("" if lit else TURNED_AWAY))

    def _tell(self, words: str) -> None:
        self.told.changed.emit(words)

    # -- looks ------------------------------------------------------------------------------------
    def paint(self, painter: QPainter, view: PictureView) -> None:
        """Draw the way from what casts the shadow to where it falls."""
        placed = self._current
        if placed is None:
            return
        ends = view.place(placed.caster), view.place(placed.place)
        if not placed.glossy and ends[0] is not None and ends[1] is not None:
            draw_line(painter, ends[0], ends[1], dashed=True, strong=True)
        self.paint_handles(painter, view)


def _surface(scene: Scene, view: PictureView, at: Place) -> np.ndarray | None:
    point = surface_under(scene, *view.fractions(at), view.width / view.height)
    return None if point is None else np.asarray(point)


def _ends(scene: Scene, placed: _Placed, view: PictureView) -> tuple[np.ndarray, LitPlace] | None:
    """Return what makes the caster's shadow be seen where the place is."""
    at = view.place(placed.place)
    if at is None:
        return None
    x, y = view.fractions(at)
    return shadow_ends(scene, placed.caster, placed.place, (x, y), view.width / view.height)


def _complaint(light: Light, found: Aimed, glossy: bool) -> str:
    """Return what is to be said of a lamp that cannot do it, or nothing."""
    if found.off <= CLOSE:
        return ""
    what = "highlight" if glossy else "shadow"
    hint = " A harder lamp comes nearer." if not light.placed and light.aperture > 1.5 else ""
    return f"The lamp cannot put its {what} here; the nearest is {found.off:.0f}° off.{hint}"
