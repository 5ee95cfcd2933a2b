"""The Pick tool: press on a material, or drag over several; the Material tab shows where it lies in the function."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QObject, Qt, Signal
from qtpy.QtGui import QPainter

from sfumato import Volume
from sfumato.scene.picking import Found, material_under

from ..editing import Editor
from .handles import Handle, HandleTool
from .view import PictureView, Place

PICK = "Pick a material"
#: Part of the picture's height that an arrow key moves the place, and with Shift.
STEP, LARGE_STEP = 0.01, 0.05


class Picked(QObject):
    """What the tool found."""

    changed = Signal(object)


class PickTool(HandleTool):
    """Finds the material that is seen at a place of the picture."""

    cursor = Qt.CursorShape.CrossCursor

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._found: Found | None = None
        self._volume: Volume | None = None
        self.picked = Picked()
        #: Value and opacity in words; the window lets the function's plot say them, so that both say the same.
        self.words: Callable[[float, float], str] = lambda value, opacity: f"{value:g}"

    def handles(self, view: PictureView) -> list[Handle]:
        """Return the place at which a material was found, with what is known of it."""
        found = self._current
        at = view.place(np.asarray(found.point)) if found is not None else None
        if found is None or at is None:
            return []
        # The function may be another by now: what is said is what it says today.
        transfer = self._editor.scene.transfer
        opacity = transfer.opacity_of(found.value, found.gradient) if transfer is not None else found.opacity
        return [Handle("material", self.words(found.value, opacity), at, None, "round")]

    @property
    def _current(self) -> Found | None:
        """What was found, unless other data are open."""
        if self._volume is not self._editor.scene.volume:
            self._found = None
        return self._found

    def press(self, view: PictureView, at: Place) -> str:
        """Find the material under the pointer; where there is none the subject is turned."""
        self._find(view, at)
        self.focused = self.taken = "material" if self._found is not None else ""
        return PICK if self._found is not None else ""

    def begin(self, handle: Handle, view: PictureView, at: Place) -> str:
        """Take the place."""
        return PICK

    def drag(self, view: PictureView, at: Place) -> None:
        """Find what is under the pointer now; over nothing, what was found last stays."""
        kept = self._found
        self._find(view, at)
        if self._found is None:
            self._found = kept

    def _find(self, view: PictureView, at: Place) -> None:
        scene = self._editor.scene
        self._volume = scene.volume
        self._found = material_under(scene, *view.fractions(at), view.width / view.height)
        if self._found is not None:
            self.picked.changed.emit(self._found)

    def focus_next(self, view: PictureView, step: int) -> None:
        """Look at the picture's middle if nothing was found yet."""
        if self._current is None:
            self._find(view, (view.width / 2, view.height / 2))
        super().focus_next(view, step)

    def nudge(self, view: PictureView, right: int, up: int, large: bool) -> bool:
        """Move the place by an arrow key."""
        found = self._current
        at = view.place(np.asarray(found.point)) if found is not None and self.focused else None
        if at is None:
            return False
        way = (LARGE_STEP if large else STEP) * view.height
        self.drag(view, (at[0] + right * way, at[1] - up * way))
        return True

    def leave(self) -> None:
        """Forget what was found: another tool is chosen."""
        super().leave()
        self._found = None

    def paint(self, painter: QPainter, view: PictureView) -> None:
        """Draw the place, and what lies there."""
        self.paint_handles(painter, view)
