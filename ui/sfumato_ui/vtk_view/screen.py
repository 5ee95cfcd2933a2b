"""VTK's widget, and when it draws: never more often than the window can bear, with less in it while something moves.

VTK draws on the window's thread. By itself it would do so at each move of the mouse, and once more when the
widget is painted. Here nothing draws but the widget's own paint, which is asked for once for all that changed,
and not before the window has had as much time for itself as the last paint took.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from qtpy.QtCore import QObject, Qt, QTimer, Signal
from qtpy.QtWidgets import QWidget

#: Quiet time in milliseconds after which the view is drawn in full again.
STILL_MS = 300
#: Shortest time between two paints, in seconds.
FRAME_SECONDS = 1 / 60
#: A still paint quicker than this, in seconds, is worth smooth edges; one slower than that goes without them.
SMOOTH_SECONDS, ROUGH_SECONDS = 0.01, 0.05
#: Samples a pixel for smooth edges.
SAMPLES = 4


class VtkScreen(QObject):
    """Owns the widget; lives on the window's thread.

    Raises
    ------
    Exception
        Whatever pyvistaqt or VTK raise where there is no OpenGL for them.
    """

    #: It begins to move, or is still (whether it moves): who shows things may show fewer.
    moving_changed = Signal(bool)

    def __init__(self, parent: QWidget, before_paint: Callable[[], None]) -> None:
        super().__init__(parent)
        self._before_paint = before_paint
        self._seconds = 0.0
        self._ended = 0.0
        self.moving = self._painting = False
        self.view = _make_view(parent, self._paint)
        # pyvista's own keys (q, e, w, …) would close or change the view behind the document's back.
        self.view.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.view.enable_trackball_style()
        self.interactor.AddObserver("RenderEvent", lambda *_: self._on_render())
        self.interactor.EnableRenderOff()
        self._soon = _single_shot(self, self.view.update)
        self._still = _single_shot(self, self._be_still)
        self._still.setInterval(STILL_MS)

    @property
    def interactor(self) -> Any:
        """VTK's interactor."""
        return self.view.iren.interactor

    @property
    def seconds(self) -> float:
        """What the last paint took."""
        return self._seconds

    def _on_render(self) -> None:
        """VTK wanted to draw: it is its turn in the widget's paint."""
        if not self._painting:
            self.redraw()

    def redraw(self) -> None:
        """Draw soon, once for all that changed."""
        if not self._soon.isActive():
            pause = max(self._seconds, FRAME_SECONDS) - (time.perf_counter() - self._ended)
            self._soon.start(max(0, round(1000 * pause)))

    def move(self) -> None:
        """Draw soon, and what can be drawn quickly, until nothing moves any more."""
        self._still.start()
        if not self.moving:
            self.moving = True
            self.view.render_window.SetMultiSamples(0)
            self.moving_changed.emit(True)
        self.redraw()

    def _be_still(self) -> None:
        self.moving = False
        self.moving_changed.emit(False)
        self.redraw()

    def _paint(self, draw: Callable[[], None]) -> None:
        """Draw within the widget's paint event."""
        self._before_paint()
        began = time.perf_counter()
        self._painting = True
        self.interactor.EnableRenderOn()
        try:
            draw()
        finally:
            self.interactor.EnableRenderOff()
            self._painting = False
        self.view.render_window.WaitForCompletion()
        self._ended = time.perf_counter()
        self._seconds = self._ended - began
        if not self.moving:
            self._choose_samples()

    def _choose_samples(self) -> None:
        """Smooth edges where they cost nothing that is felt: a software renderer has none."""
        window = self.view.render_window
        smooth = window.GetMultiSamples() > 0
        if smooth and self._seconds > ROUGH_SECONDS:
            window.SetMultiSamples(0)
        elif not smooth and self._seconds < SMOOTH_SECONDS:
            window.SetMultiSamples(SAMPLES)
            self.redraw()

    def close(self) -> None:
        """Give VTK's context back, on this thread, while the widget is still there."""
        self._soon.stop()
        self._still.stop()
        self.view.close()


def _single_shot(owner: QObject, act: Callable[[], object]) -> QTimer:
    timer = QTimer(owner)
    timer.setSingleShot(True)
    timer.timeout.connect(act)
    return timer


def _make_view(parent: QWidget, paint: Callable[[Callable[[], None]], None]) -> Any:
    """Return a QtInteractor whose paint event is in our hand."""
    from pyvistaqt import QtInteractor

    base: Any = QtInteractor

    class View(base):  # type: ignore[misc]
        def paintGL(self) -> None:
            paint(super().paintGL)

    return View(parent, auto_update=False, multi_samples=0)
