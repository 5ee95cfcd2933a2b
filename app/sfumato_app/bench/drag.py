"""The whole step of a drag: from the event at a slider to the picture that the window shows.

A real window of 960 x 720 pixels shows the benchmark's chest. The rotation slider of its Light tab is moved,
as a hand does, by one event after another, each when the picture of the one before it has been painted; so
what is measured is event, document, render thread, picture and painting, at drag quality.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from typing import Any

from sfumato import SfumatoError

from . import machine
from .measure import Spread
from .setting import Setting

#: The window's size in pixels.
SIZE = (960, 720)
#: Steps of a drag, and those before that do not count: shaders are compiled, the drag quality settles.
STEPS, FIRST = 25, 8
#: Pixels by which the hand moves from event to event, and within which it goes to and fro.
STRIDE, SWING = 3, 60
#: A picture that has not come after so many seconds does not come.
LIMIT = 120.0
FORMAT_VERSION = 1


@dataclass(frozen=True)
class Drag:
    """The steps of a drag.

    Attributes
    ----------
    picture : (int, int)
        Pixels of the picture's place in the window.
    drawn : (int, int)
        Pixels drawn at drag quality.
    steps, render : list of float
        Milliseconds: event to shown picture, and of these the render thread's.
    """

    machine: dict[str, Any]
    setting: Setting
    technique: str
    picture: tuple[int, int]
    drawn: tuple[int, int]
    steps: list[float]
    render: list[float]

    def to_json(self) -> dict[str, Any]:
        """Return everything as JSON data."""
        return {
            "sfumato_drag": FORMAT_VERSION,
            **asdict(self),
            "setting": self.setting.to_json(),
            "median_ms": Spread.of(self.steps).median,
        }

    def text(self) -> str:
        """Return the figures for people."""
        m, size = self.machine, self.setting.size
        step, render = Spread.of(self.steps), Spread.of(self.render)
        return "\n".join(
            [
                f"sfumato bench --drag, {m['date']}",
                f"machine   {m['cpu']}, {m['cores']} cores, load {' '.join(map(str, m['load_average'] or []))}",
                f"graphics  {m['gl_renderer']}, OpenGL {m['gl_version']}",
                f"task      {self.technique}, {size}^3 uint8, window {SIZE[0]} x {SIZE[1]}, "
                f"picture {self.picture[0]} x {self.picture[1]}, drawn {self.drawn[0]} x {self.drawn[1]}",
                f"steps     {len(self.steps)} moves of the rotation slider; wall ms, median [quartiles]",
                f"slider event to shown picture   {step.median:7.1f} [{step.q1:.1f} {step.q3:.1f}]",
                f"of these, rendering             {render.median:7.1f} [{render.q1:.1f} {render.q3:.1f}]",
            ]
        )


def has_display() -> bool:
    """Tell whether a window can be shown."""
    return not sys.platform.startswith("linux") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


@contextmanager
def bench_window(what: str, flag: str) -> Iterator[Any]:
    """Make a window with settings of its own for a benchmark, and close it.

    Raises
    ------
    SfumatoError
        If there is no display or Qt is missing.
    """
    if not has_display():
        raise SfumatoError(f"{what} needs a display (with none: xvfb-run sfumato bench {flag})")
    try:
        from sfumato_app.first_minute import own_settings
        from sfumato_ui.app import make_application
        from sfumato_ui.window import MainWindow
    except ImportError as error:
        raise SfumatoError(f"{what} needs the window: {error}") from None
    make_application()
    with own_settings():
        window = MainWindow()
        try:
            yield window
        finally:
            window.editor.document.mark_saved()
            window.close()


def measure_drag(
    setting: Setting,
    technique: str,
    steps: int = STEPS,
    first: int = FIRST,
    tell: Callable[[str], None] = lambda text: None,
) -> Drag:
    """Show a window, drag its rotation slider, and tell how long each step took.

    Raises
    ------
    SfumatoError
        If there is no display, Qt is missing, or no picture comes.
    """
    with bench_window("a drag", "--drag") as window:
        return _drag(window, setting, technique, steps, first, tell)


def _drag(
    window: Any, setting: Setting, technique: str, steps: int, first: int, tell: Callable[[str], None]
) -> Drag:
    window.resize(*SIZE)
    window.show()
    window.editor.reset(setting.scene(technique))
    painted = _Painted(window.viewport)
    _run_until(lambda: painted.picture is not None, "the first picture")
    renderer = window.worker._renderer
    found = machine.describe(renderer.name, renderer.version)
    slider = window.light_page.rotation.slider
    _mouse(slider, "MouseButtonPress", 0)
    times, render = [], []
    for number in range(first + steps):
        tell(f"step {number + 1} of {first + steps}")
        began = time.perf_counter()
        _mouse(slider, "MouseMove", STRIDE * (number + 1) % SWING)
        painted.wait_for(window.editor.scene)
        times.append((time.perf_counter() - began) * 1000)
        render.append(painted.picture.seconds * 1000)
    picture = painted.picture
    _mouse(slider, "MouseButtonRelease", 0)
    tell("")
    drawn = picture.image.width(), picture.image.height()
    return Drag(found, setting, technique, picture.size, drawn, times[first:], render[first:])


def _mouse(slider: Any, kind: str, along: int) -> None:
    """Send the left button's event at so many pixels along a slider from its middle."""
    from qtpy.QtCore import QEvent, QPointF, Qt
    from qtpy.QtGui import QMouseEvent
    from qtpy.QtWidgets import QApplication

    at = QPointF(slider.rect().center()) + QPointF(along, 0)
    button, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    place = QPointF(slider.mapToGlobal(at.toPoint()))
    event = QMouseEvent(getattr(QEvent.Type, kind), at, place, button, button, keys)
    QApplication.sendEvent(slider, event)


class _Painted:
    """Knows the picture that a viewport has painted last."""

    def __init__(self, viewport: Any) -> None:
        from qtpy.QtCore import QEvent, QObject, QTimer

        note = self._note

        class Filter(QObject):
            def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's own name)
                if event.type() == QEvent.Type.Paint:
                    # The painting is done when the event loop goes on.
                    QTimer.singleShot(0, lambda picture=viewport.picture: note(picture))
                return False

        self.picture: Any = None
        self._filter = Filter(viewport)
        viewport.installEventFilter(self._filter)

    def _note(self, picture: Any) -> None:
        self.picture = picture

    def shows(self, scene: Any) -> bool:
        """Tell whether the last picture is that of a scene."""
        return self.picture is not None and self.picture.scene is scene

    def wait_for(self, scene: Any) -> None:
        """Let the window work until it has painted a scene that it did not show before."""
        if self.shows(scene):
            raise SfumatoError("the slider did not move")
        _run_until(lambda: self.shows(scene), "the picture of a drag")


def _run_until(done: Callable[[], bool], what: str) -> None:
    from qtpy.QtWidgets import QApplication

    until = time.perf_counter() + LIMIT
    while not done():
        if time.perf_counter() > until:
            raise SfumatoError(f"{what} did not come within {LIMIT:.0f} seconds")
        QApplication.processEvents()
        time.sleep(0.001)
