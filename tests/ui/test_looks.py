"""How window and panels look: compared with accepted screenshots, loosely enough for another hinting of letters.

``--accept-images`` takes what is seen now: look at it first. Where another font or graphics device is in use than on
the machine of the screenshots (DejaVu Sans, llvmpipe), the test is skipped and says so.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QFontInfo, QImage
from qtpy.QtWidgets import QWidget
from scipy.ndimage import uniform_filter

from sfumato import Scene
from sfumato_ui.window import MainWindow

from .conftest import Hand, MakeWindow

LOOKS = Path(__file__).with_name("looks")
#: Pixels over which both are blurred, so that a letter may lie a pixel beside where it lay.
BLUR = 7
#: Most that the means, and single places, may differ then, in 8-bit counts.
MEAN, WORST = 1.5, 70.0

Check = Callable[[str, QWidget], None]

pytestmark = [pytest.mark.slow, pytest.mark.normal_quality]


def pixels(widget: QWidget) -> np.ndarray:
    """Return what a widget shows, shape (height, width, 3)."""
    image = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).copy()


@pytest.fixture
def check(request: pytest.FixtureRequest, tmp_path: Path) -> Check:
    """Compare a widget with the accepted screenshot of that name."""
    accept = bool(request.config.getoption("--accept-images"))

    def compare(name: str, widget: QWidget) -> None:
        from PIL import Image

        path, seen = LOOKS / f"{name}.png", pixels(widget)
        if accept:
            LOOKS.mkdir(exist_ok=True)
            Image.fromarray(seen).quantize(128).save(path, optimize=True)
            return
        assert path.exists(), f"no accepted screenshot {path.name}; look at it, then pytest --accept-images"
        with Image.open(path) as image:
            wanted = np.asarray(image.convert("RGB"))
        kept = tmp_path / f"{name}.png"
        Image.fromarray(seen).save(kept)
        assert seen.shape == wanted.shape, kept
        first, second = (uniform_filter(p.astype(float), (BLUR, BLUR, 0)) for p in (seen, wanted))
        away = np.abs(first - second)
        assert away.mean() <= MEAN, kept
        assert away.max() <= WORST, kept

    return compare


@pytest.fixture
def window(make_window: MakeWindow, ball_scene: Scene, qtbot: QtBot) -> MainWindow:
    """A window of the usual size at rest, with all its small pictures."""
    made = make_window(ball_scene.with_(technique="raycast-phong"), size=(1280, 720))
    made.status.hide()  # it tells times
    if QFontInfo(made.font()).family() != "DejaVu Sans":
        pytest.skip(f"the screenshots have DejaVu Sans; here it is {QFontInfo(made.font()).family()}")
    Hand(made, qtbot).wait_for_picture()
    if "llvmpipe" not in made.status.renderer.text():
        pytest.skip(f"the screenshots were drawn by llvmpipe; this is {made.status.renderer.text()}")
    made.viewport.clearFocus()
    return made


def settle(window: MainWindow, qtbot: QtBot) -> None:
    """Wait until nothing changes any more."""
    Hand(window, qtbot).wait_for_picture()
    qtbot.wait(900)  # panels ask for their small pictures only after a while
    qtbot.waitUntil(lambda: window.thumbnails.idle, timeout=60_000)


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_each_panel_looks_as_accepted(window: MainWindow, qtbot: QtBot, check: Check, theme: str) -> None:
    window.set_theme(theme)
    for page, name in (
        (window.light_page, "light"), (window.material_page, "material"), (window.view_page, "view"),
    ):  # fmt: skip
        window.panel.setCurrentWidget(page)
        settle(window, qtbot)
        check(f"panel-{name}-{theme}", window.panel)


def test_the_window_looks_as_accepted(window: MainWindow, qtbot: QtBot, check: Check) -> None:
    window.viewport.setFocus()
    qtbot.keyClick(window.viewport, Qt.Key.Key_O)
    settle(window, qtbot)
    check("window", window)
    qtbot.keyClick(window.viewport, Qt.Key.Key_M)
    qtbot.waitUntil(lambda: all(pane.made is not None for pane in window.slices.panel.panes), timeout=30_000)
    settle(window, qtbot)
    check("window-slices", window)
