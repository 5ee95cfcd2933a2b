"""A real window on a small volume, settings in a temporary folder, and no widget left behind."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from qtpy.QtCore import QCoreApplication, QEvent
from qtpy.QtWidgets import QApplication

from sfumato import Document, Scene, TransferFunction, Volume, VolumeInfo
from sfumato_ui.theme import apply_theme
from sfumato_ui.window import MainWindow


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
def own_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SFUMATO_SETTINGS", str(tmp_path))


@pytest.fixture(autouse=True)
def no_leaked_widgets(qapp: QApplication) -> Iterator[None]:
    """Fail if a test leaves a top-level widget behind."""
    apply_theme(qapp, "dark")
    before = set(map(id, qapp.topLevelWidgets()))
    yield
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    left = [w for w in qapp.topLevelWidgets() if id(w) not in before]
    assert not left, f"widgets left behind: {left}"


MakeWindow = Callable[..., MainWindow]


@pytest.fixture
def make_window(qapp: QApplication) -> Iterator[MakeWindow]:
    """Return a maker of windows that are shown, active and closed after the test."""
    made: list[MainWindow] = []

    def make(scene: Scene | None = None, size: tuple[int, int] = (900, 700)) -> MainWindow:
        window = MainWindow(Document(scene) if scene is not None else None)
        made.append(window)
        window.resize(*size)
        window.show()
        window.activateWindow()
        return window

    yield make
    for window in made:
        window.editor.document.mark_saved()
        window.close()
        assert not window.worker.alive, "the render thread went on after the window"
        window.deleteLater()


@pytest.fixture
def window(make_window: MakeWindow, qtbot: object) -> MainWindow:
    """A window on the ball, with its first picture."""
    made = make_window(Scene(volume=ball(), transfer=solid()))
    wait_for_picture(made, qtbot)
    return made


def wait_for_picture(window: MainWindow, qtbot: object, timeout: int = 60_000) -> None:
    """Wait until a full picture of the scene that the window now wants is shown."""

    def there() -> bool:
        picture = window.viewport.picture
        return (
            picture is not None
            and not picture.interactive
            and picture.scene == window.driver.shown_scene
            and picture.size == window.viewport.pixel_size
        )

    qtbot.waitUntil(there, timeout=timeout)  # type: ignore[attr-defined]


def pixels(window: MainWindow) -> np.ndarray:
    """Return the picture that is shown as numbers, shape (height, width, 4)."""
    picture = window.viewport.picture
    assert picture is not None
    image = picture.image
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).astype(int)
