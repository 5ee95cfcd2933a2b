"""A real window on a small volume, settings in a temporary folder, and no widget left behind."""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QCoreApplication, QEvent, QPoint, QPointF, Qt
from qtpy.QtGui import QMouseEvent, QWheelEvent
from qtpy.QtWidgets import QApplication, QWidget

from sfumato import Document, Scene, TransferFunction, Volume, VolumeInfo
from sfumato.renderer import Accumulation
from sfumato_ui.quality import DRAFT, remember_quality
from sfumato_ui.sliders import Slider
from sfumato_ui.theme import apply_theme
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


#: Least time in milliseconds for which a test waits for what is to come: a machine with other work may stand still for
#: seconds, and the tests' own timeouts end what hangs.
PATIENCE = 60_000


def pytest_configure(config: pytest.Config) -> None:
    """Wait with patience, and on a screen of one's own: on one screen two processes would take each other's focus."""
    for name in ("waitUntil", "waitSignal"):
        setattr(QtBot, name, _patient(getattr(QtBot, name)))
    second = os.environ.get("PYTEST_XDIST_WORKER", "gw0") != "gw0"
    if second and os.environ.get("DISPLAY") and shutil.which("Xvfb"):
        command = ["Xvfb", "-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"]
        screen = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert screen.stdout is not None
        os.environ["DISPLAY"] = f":{screen.stdout.readline().strip()}"
        os.environ.pop("XAUTHORITY", None)
        config.add_cleanup(lambda: _end(screen))


def _patient(wait: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(wait)
    def patient(*args: Any, timeout: int = 0, **options: Any) -> Any:
        return wait(*args, timeout=max(timeout, PATIENCE), **options)

    return patient


def _end(screen: subprocess.Popen[str]) -> None:
    screen.terminate()
    screen.communicate()  # closes its output, too


def ball(n: int = 40) -> Volume:
    """Return a ball before a plate, whose lighting leaves no doubt."""
    z, y, x = np.mgrid[0:n, 0:n, 0:n] * (2 / (n - 1)) - 1
    data = np.clip((0.45 - np.sqrt(x * x + (y + 0.35) ** 2 + z * z)) * n * 6, 0, 200).astype(np.int16)
    data[:, int(0.85 * n) :, :] = 200
    return Volume(data, info=VolumeInfo(path="ball.npy", orientation_known=True, name="ball"))


def solid() -> TransferFunction:
    """Return a function that makes the ball and the plate opaque and light."""
    return TransferFunction.from_points([(20, (0.9, 0.85, 0.8), 0.0), (120, (0.9, 0.85, 0.8), 0.9)])


@pytest.fixture(autouse=True)
def own_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    """Keep settings apart, and stop at two frames: six more behind each test's back took an eighth of the time."""
    monkeypatch.setenv("SFUMATO_SETTINGS", str(tmp_path))
    if request.node.get_closest_marker("normal_quality") is None:
        remember_quality(DRAFT)


@pytest.fixture(autouse=True)
def no_leaked_widgets(qapp: QApplication) -> Iterator[None]:
    """Fail if a test leaves a top-level widget behind."""
    apply_theme(qapp, "dark")
    # The widgets themselves are kept: Python's names of those that nobody holds change from one look to the next,
    # and what one test left behind would be held against all that follow.
    before = set(qapp.topLevelWidgets())
    yield
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    left = [w for w in qapp.topLevelWidgets() if w not in before]
    assert not left, f"widgets left behind: {left}"


def _activate(window: QWidget) -> None:
    """Make a window the active one, as it is for a user: on a busy machine the screen takes a while to say so."""
    until = time.monotonic() + 30
    window.activateWindow()
    asked = time.monotonic()
    while not window.isActiveWindow() and time.monotonic() < until:
        QApplication.processEvents()
        time.sleep(0.002)
        if time.monotonic() - asked > 1:
            window.activateWindow()
            asked = time.monotonic()
    assert window.isActiveWindow(), "the screen did not make the window the active one"


MakeWindow = Callable[..., MainWindow]


@pytest.fixture
def make_window(qapp: QApplication) -> Iterator[MakeWindow]:
    """Return a maker of windows that are shown, active and closed after the test."""
    made: list[MainWindow] = []

    def make(scene: Scene | None = None, size: tuple[int, int] = (760, 600)) -> MainWindow:
        window = MainWindow(Document(scene) if scene is not None else None)
        made.append(window)
        window.resize(*size)
        window.show()
        _activate(window)
        return window

    yield make
    for window in made:
        window.editor.document.mark_saved()
        window.close()
    # On a machine with other work a frame takes longer than the window waits for it.
    until = time.monotonic() + 60
    while any(window.worker.alive for window in made) and time.monotonic() < until:
        QApplication.processEvents()
        time.sleep(0.01)
    went_on = [window for window in made if window.worker.alive]
    for window in made:
        if window not in went_on:
            window.deleteLater()
    assert not went_on, "the render thread went on after the window"


class Hand:
    """What a user does and sees: real mouse and key events on a window, and its picture as numbers."""

    def __init__(self, window: MainWindow, qtbot: QtBot) -> None:
        self.window, self.qtbot = window, qtbot

    def wait_for_picture(self, timeout: int = 90_000) -> None:
        """Wait until a full picture of the scene that the window now wants is shown."""

        def there() -> bool:
            picture = self.window.viewport.picture
            return (
                picture is not None
                and not picture.interactive
                and picture.scene == self.window.driver.shown_scene
                and picture.size == self.window.viewport.pixel_size
            )

        self.qtbot.waitUntil(there, timeout=timeout)

    def pixels(self) -> np.ndarray:
        """Return the picture that is shown, shape (height, width, 4)."""
        picture = self.window.viewport.picture
        assert picture is not None
        image = picture.image
        flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
        return flat[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).astype(int)

    def drag(
        self,
        widget: QWidget,
        start: QPoint,
        end: QPoint,
        *,
        steps: int = 8,
        button: Qt.MouseButton = LEFT,
        keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
    ) -> None:
        """Press at one place, move in steps, release at another."""
        self.qtbot.mousePress(widget, button, keys, start)
        for i in range(1, steps + 1):
            at = start + (end - start) * (i / steps)
            # QTest's mouseMove knows no modifiers: the event itself does.
            event = QMouseEvent(
                QEvent.Type.MouseMove,
                QPointF(at),
                QPointF(widget.mapToGlobal(at)),
                Qt.MouseButton.NoButton,
                button,
                keys,
            )
            QApplication.sendEvent(widget, event)
            self.qtbot.wait(5)
        self.qtbot.mouseRelease(widget, button, keys, end)

    def drag_slider(self, slider: Slider, start: float, end: float, steps: int = 8) -> None:
        """Drag a slider from one fraction of its length to another."""
        left, length, y = 10, slider.width() - 20, slider.height() // 2
        places = [QPoint(round(left + length * f), y) for f in (start, end)]
        self.drag(slider, *places, steps=steps)

    def wheel(self, widget: QWidget, notches: int = 1, at: QPoint | None = None) -> None:
        """Turn the wheel over a widget, in its middle if no place is given."""
        place = at if at is not None else widget.rect().center()
        event = QWheelEvent(
            QPointF(place), QPointF(widget.mapToGlobal(place)), QPoint(), QPoint(0, 120 * notches),
            Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(widget, event)

    def press(self, key: Qt.Key, *keys: Qt.KeyboardModifier) -> None:
        """Press and release a key on what has the focus."""
        modifiers = Qt.KeyboardModifier.NoModifier
        for one in keys:
            modifiers |= one
        self.qtbot.keyClick(QApplication.focusWidget() or self.window, key, modifiers)


@pytest.fixture
def window(make_window: MakeWindow, qtbot: QtBot) -> MainWindow:
    """A window on the ball, with its first picture."""
    made = make_window(Scene(volume=ball(), transfer=solid()))
    Hand(made, qtbot).wait_for_picture()
    return made


@pytest.fixture
def hand(window: MainWindow, qtbot: QtBot) -> Hand:
    """The user of that window."""
    return Hand(window, qtbot)


@pytest.fixture
def hand_of(qtbot: QtBot) -> Callable[[MainWindow], Hand]:
    """Return a maker of users, for windows of a test's own."""
    return lambda window: Hand(window, qtbot)


class Count:
    """How many frames are drawn at the size of the window."""

    def __init__(self, window: MainWindow) -> None:
        self.window, self.frames = window, 0


@pytest.fixture
def count(window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> Count:
    """Count the frames of a settled picture's window from now on; thumbnails are not its frames."""
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=90_000)
    counted, original = Count(window), Accumulation.add_frame

    def add_frame(self: Accumulation) -> Iterator[float]:
        wide = self.size[0] / self.quality.scale >= 0.9 * window.viewport.pixel_size[0]
        counted.frames += wide
        return original(self)

    monkeypatch.setattr(Accumulation, "add_frame", add_frame)
    return counted


@pytest.fixture
def ball_scene() -> Scene:
    """The scene of `window`."""
    return Scene(volume=ball(), transfer=solid())
