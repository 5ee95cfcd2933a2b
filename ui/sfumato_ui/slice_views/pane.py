"""A slice view in the hand.

Left drag moves the cross-hair, or a lamp that is taken; with Shift, from anywhere, the selected lamp. The wheel goes
from slice to slice. Right drag (or Alt, or Ctrl and Shift with the left button) changes window and level: to the right
it widens, upwards the level rises. Middle drag (or Ctrl) pans, the wheel with Ctrl zooms about the pointer; a
double-click enlarges the view. Keys do the same: see `KEYS`.
"""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QEvent, QPointF, QSize, Qt, Signal
from qtpy.QtGui import QKeyEvent, QMouseEvent, QResizeEvent, QWheelEvent
from qtpy.QtWidgets import QToolButton, QWidget

from sfumato.slicing import ValueWindow

from ..editing import Editor
from ..icons import icon
from ..theme import DARK
from ..tools.view import Place
from .canvas import SliceCanvas
from .lighter import Lighter
from .slicer import Slicer
from .state import SliceState

_MODIFIER, _KEY, _BUTTON = Qt.KeyboardModifier, Qt.Key, Qt.MouseButton
_ARROWS = {_KEY.Key_Left: (-1, 0), _KEY.Key_Right: (1, 0), _KEY.Key_Up: (0, 1), _KEY.Key_Down: (0, -1)}
#: Pixels of a drag over which window and level change by as much as is felt as one.
WINDOW_PIXELS = 200.0
#: The same of an arrow key, and how far, in parts of the view's height, it pans.
WINDOW_STEP, PAN_STEP = 0.05, 0.05
ZOOM_STEP = 1.12
KEYS = (
    "<p>Drag or click: the cross-hair. Wheel, or page keys: from slice to slice. Right drag, or Alt-drag: window and "
    "level. Middle drag, or Ctrl-drag: pan. Ctrl+wheel: zoom. Double-click: enlarge. Shift-drag: the lamp.</p>"
    "<p>Keys: arrows move the cross-hair by a voxel (Shift: the lamp, Ctrl: pan, Alt: window and level), + and "
    "\N{MINUS SIGN} zoom, 0 shows the whole slice, Enter enlarges.</p>"
)


class SlicePane(SliceCanvas):
    """One view, and what mouse and keys do there."""

    #: It is to fill the place of all three, or to give it back.
    enlarge_wanted = Signal()

    def __init__(
        self, editor: Editor, state: SliceState, slicer: Slicer, lighter: Lighter, index: int
    ) -> None:
        super().__init__(editor, state, slicer, lighter, index)
        self._mode = ""
        self._notches = 0.0
        self._start = self._last = QPointF()
        self._window = ValueWindow(0.0, 1.0)
        self.enlarge = QToolButton(self)
        self.enlarge.setObjectName("OverPicture")
        self.enlarge.setIconSize(QSize(16, 16))
        self.enlarge.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.enlarge.setCursor(Qt.CursorShape.ArrowCursor)
        self.enlarge.clicked.connect(self.enlarge_wanted)
        #: Tab reaches them after the view.
        self.controls_over: list[QWidget] = [self.enlarge]
        self.setCursor(Qt.CursorShape.CrossCursor)
        self.show_enlarged(False)
        self._on_replaced()

    def show_enlarged(self, enlarged: bool) -> None:
        """Let the button say what it does."""
        words = "Show all three slices" if enlarged else f"Enlarge the {self.cut.title.lower()} slice"
        self.enlarge.setIcon(icon("reduce" if enlarged else "enlarge", DARK))
        self.enlarge.setAccessibleName(words)
        self.enlarge.setToolTip(f"{words} (Enter, or double-click the slice)")

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the button in its corner."""
        super().resizeEvent(event)
        self.enlarge.adjustSize()
        self.enlarge.move(self.width() - self.enlarge.width() - 6, 6)

    # -- mouse ------------------------------------------------------------------------------------
    def _mode_for(self, event: QMouseEvent) -> str:
        button, keys = event.button(), event.modifiers()
        shift, ctrl = bool(keys & _MODIFIER.ShiftModifier), bool(keys & _MODIFIER.ControlModifier)
        if button == _BUTTON.MiddleButton:
            return "pan"
        if button == _BUTTON.RightButton or (button == _BUTTON.LeftButton and keys & _MODIFIER.AltModifier):
            return "window"
        if button != _BUTTON.LeftButton:
            return ""
        if ctrl:
            return "window" if shift else "pan"
        return "lamp" if shift else "cross"

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a drag."""
        if self._mode or self._state.volume is None:
            return
        self._mode = self._mode_for(event)
        self._start = self._last = event.position()
        if self._mode in ("cross", "lamp"):
            self._take_lamp(_place(event))
        if self._mode == "cross":
            self._state.go_to(self._point(event.position()))
        elif self._mode == "window":
            self._window = self._state.window or self._window
        elif self._mode == "pan":
            self.setCursor(Qt.CursorShape.ClosedHandCursor)

    def _take_lamp(self, at: Place) -> None:
        """Take the lamp under the pointer, with Shift the selected one."""
        label = self.lamps.take(self.view, at) if self._mode == "lamp" else self.lamps.press(self.view, at)
        if label:
            self._mode = "lamp"
            self._editor.begin(label)
            self.update()
        elif self._mode == "lamp":
            self._mode = ""

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow the pointer."""
        at, step = event.position(), event.position() - self._last
        self._last = at
        if not self._mode:
            self._hover(at)
        elif self._mode == "cross":
            self._state.go_to(self._point(at))
        elif self._mode == "lamp":
            self.lamps.drag(self.view, _place(event))
        elif self._mode == "pan":
            self._state.pan(self._shift(step.x(), step.y()))
        else:
            way = at - self._start
            self._state.drag_window(self._window, way.x() / WINDOW_PIXELS, -way.y() / WINDOW_PIXELS)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag."""
        if self._mode and not event.buttons():
            if self._mode == "lamp":
                self._editor.end()
                self.lamps.release()
            self._mode = ""
            self._hover(event.position())

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Enlarge the view; on a lamp, a double-click is a click."""
        plain = event.button() == _BUTTON.LeftButton and not event.modifiers()
        if plain and self.lamps.hit(self.view, _place(event)) is None:
            self.enlarge_wanted.emit()
        else:
            self.mousePressEvent(event)

    def _hover(self, at: QPointF | None) -> None:
        """Mark the lamp under the pointer."""
        before = self.lamps.hovered
        self.setCursor(self.lamps.hover(self.view, (at.x(), at.y()) if at is not None else None))
        if self.lamps.hovered != before:
            self.update()

    def leaveEvent(self, event: QEvent) -> None:
        """Mark no lamp any more."""
        self._hover(None)
        super().leaveEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Go from slice to slice, forwards into the picture; with Ctrl zoom about the pointer."""
        notches = event.angleDelta().y() / 120
        if self._state.volume is None or not notches:
            event.ignore()
        elif event.modifiers() & _MODIFIER.ControlModifier:
            self._state.zoom_about(self._point(event.position()), ZOOM_STEP**notches)
        else:
            self._state.step(self.cut, 0, 0, self._whole_steps(notches))

    def _whole_steps(self, notches: float) -> float:
        """Return slices for notches of the wheel: a trackpad tells of parts, which are kept until they are whole."""
        self._notches += notches
        steps = float(int(self._notches))
        self._notches -= steps
        return steps

    # -- keys -------------------------------------------------------------------------------------
    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Do by keys what the mouse does."""
        key = Qt.Key(event.key())
        page = {_KEY.Key_PageUp: 1, _KEY.Key_PageDown: -1}.get(key)
        zoom = {_KEY.Key_Plus: ZOOM_STEP, _KEY.Key_Equal: ZOOM_STEP, _KEY.Key_Minus: 1 / ZOOM_STEP}.get(key)
        if self._state.volume is None:
            event.ignore()
        elif key in _ARROWS:
            self._arrow(*_ARROWS[key], event.modifiers())
        elif page:
            self._state.step(self.cut, 0, 0, page)
        elif zoom:
            self._state.zoom_about(self._state.cross, zoom)
        elif key == _KEY.Key_0:
            self._state.show_whole()
        elif key in (_KEY.Key_Return, _KEY.Key_Enter):
            self.enlarge_wanted.emit()
        else:
            event.ignore()

    def _arrow(self, right: int, up: int, keys: Qt.KeyboardModifier) -> None:
        if keys & _MODIFIER.ControlModifier:
            step = PAN_STEP * self.height()
            self._state.pan(self._shift(step * right, -step * up))
        elif keys & _MODIFIER.AltModifier and self._state.window is not None:
            self._state.drag_window(self._state.window, WINDOW_STEP * right, WINDOW_STEP * up)
        elif keys & _MODIFIER.ShiftModifier:
            self.lamps.nudge(self.view, right, up, False)
        else:
            self._state.step(self.cut, right, up, 0)

    # -- places -----------------------------------------------------------------------------------
    def _point(self, at: QPointF) -> np.ndarray:
        """Return the point of the slice, world mm, at a place in the view."""
        return self._frame(1.0).point(at.x(), at.y())

    def _shift(self, dx: float, dy: float) -> np.ndarray:
        """Return a way in pixels, y down, as a vector of the world in mm."""
        right, up, _ = self.cut.axes
        return np.asarray(self._state.mm_per_pixel * (dx * right - dy * up))


def _place(event: QMouseEvent) -> Place:
    return event.position().x(), event.position().y()


__all__ = ["KEYS", "SlicePane"]
