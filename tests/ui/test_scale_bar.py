"""The scale bar in the picture: of true length, in orthographic views only."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QImage

from sfumato import Camera, Scene
from sfumato_ui.overlay import scale_bar_length
from sfumato_ui.tools.view import PictureView

from .conftest import Hand, MakeWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.mark.parametrize(("scale", "size"), [(20.0, (400, 300)), (0.7, (900, 640)), (333.0, (300, 700))])
def test_its_length_is_true(scale: float, size: tuple[int, int]) -> None:
    camera = Camera(
        position=(5, -300, 8), focal_point=(5, 0, 8), parallel_projection=True, parallel_scale=scale
    )
    length, pixels = scale_bar_length(camera, *size)
    ends = np.array(
        [camera.focal_point, np.add(camera.focal_point, np.multiply(length, camera.basis().right))]
    )
    places = PictureView(camera, *size).places(ends)
    assert np.linalg.norm(places[1] - places[0]) == pytest.approx(pixels)
    assert 0.08 * size[0] < pixels <= 0.25 * size[0] + 1e-6


def longest_white_run(image: QImage) -> int:
    """Return the longest row of white pixels in a picture's lower right quarter."""
    image = image.convertToFormat(QImage.Format.Format_Grayscale8)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    quarter = flat[image.height() // 2 :, image.width() // 2 : image.width()] == 255
    best = 0
    for row in quarter:
        edges = np.flatnonzero(np.diff(np.concatenate([[0], row.astype(int), [0]])))
        best = max(best, int((edges[1::2] - edges[::2]).max(initial=0)))
    return best


def test_it_is_drawn_and_kept(make_window: MakeWindow, ball_scene: Scene, qtbot: QtBot) -> None:
    # The ball is seen from afar: nothing of it lies where the bar does.
    camera = Camera.standard(ball_scene.volume, fill=0.3)  # type: ignore[arg-type]
    window = make_window(ball_scene.with_(technique="raycast", camera=camera), size=(680, 560))
    hand = Hand(window, qtbot)
    window.viewport.set_hint("")
    hand.wait_for_picture()
    window.panel.setCurrentIndex(2)
    window.view_page.more.set_open(True)
    box = window.view_page.scale_bar
    assert not box.isEnabled()
    assert "orthographic" in box.toolTip()
    qtbot.mouseClick(window.view_page.parallel, LEFT, pos=window.view_page.parallel.rect().center())
    if not window.view_page.parallel.isChecked():  # a check box takes clicks on its mark and name alone
        window.view_page.parallel.setFocus()
        qtbot.keyClick(window.view_page.parallel, Qt.Key.Key_Space)
    assert box.isEnabled()
    hand.wait_for_picture()
    assert longest_white_run(window.viewport.grab().toImage()) < 20
    box.setFocus()
    qtbot.keyClick(box, Qt.Key.Key_Space)
    shown = window.editor.scene.camera
    assert shown is not None
    _, pixels = scale_bar_length(shown, window.viewport.width(), window.viewport.height())
    assert longest_white_run(window.viewport.grab().toImage()) == pytest.approx(pixels, abs=2)
    assert not window.editor.document.undo_label.startswith("Scale"), "the bar is the user's, not the scene's"
    assert make_window().viewport.scale_bar, "kept for the next window"
