"""Local occlusion in the window: its own section, light that comes by and by, a transfer function that is dragged."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint
from qtpy.QtGui import QImage

from sfumato import Renderer, Scene
from sfumato.techniques.local_occlusion.params import LocalOcclusionParams
from sfumato_ui.jobs import image_of
from sfumato_ui.sliders import Slider
from sfumato_ui.window import MainWindow


@pytest.fixture
def scene(ball_scene: Scene) -> Scene:
    return ball_scene.with_(technique=LocalOcclusionParams(directions=8, radius=8.0))


def pixels_of(image: QImage) -> np.ndarray:
    """Return an image's bytes, shape (height, width, 4), as a hand's `pixels`."""
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
    return flat.reshape(image.height(), image.width(), 4).astype(int)


def settle(window: MainWindow, hand: Any, qtbot: QtBot) -> np.ndarray:
    """Wait until no better picture of the scene will follow and return it."""
    hand.wait_for_picture()
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=120_000)
    return np.asarray(hand.pixels())


def test_its_sliders_change_the_picture(make_window: Any, hand_of: Any, scene: Scene, qtbot: QtBot) -> None:
    window = make_window(scene)
    hand, page = hand_of(window), window.light_page
    hand.wait_for_picture()
    assert page.technique.currentData() == "local-occlusion"
    page.own.set_open(True)
    sliders = {s.accessibleName(): s for s in page.own.findChildren(Slider)}
    assert {"Brightness", "Radius", "Least light"} <= set(sliders)
    for name, start, end in (("Brightness", 0.6, 0.3), ("Least light", 0.1, 0.9)):
        before = hand.pixels()
        window.panel.widget(0).ensureWidgetVisible(sliders[name])
        hand.drag_slider(sliders[name], start, end)
        hand.wait_for_picture()
        assert np.abs(hand.pixels() - before).mean() > 0.5, name


def test_a_dragged_transfer_function_ends_as_a_fresh_start(
    make_window: Any, hand_of: Any, scene: Scene, qtbot: QtBot
) -> None:
    window: MainWindow = make_window(scene, size=(760, 760))
    hand = hand_of(window)
    hand.wait_for_picture()
    seen: list[float] = []
    window.worker.picture.connect(lambda picture: seen.append(picture.light))
    window.panel.setCurrentIndex(1)
    plot = window.material_page.transfer.plot
    qtbot.waitUntil(lambda: window.isActiveWindow() and plot.isVisible())
    at = plot.scale.at(120, 0.9).toPoint()
    for end in (QPoint(20, 12), QPoint(-15, 20), QPoint(10, -6)):
        hand.drag(plot, at, at + end, steps=12)
        at = at + end
    shown = settle(window, hand, qtbot)
    assert seen[-1] == 1.0
    fresh = Renderer()
    try:
        picture = window.viewport.picture
        job = fresh.begin(picture.scene, picture.size)
        for _ in range(picture.frames):
            for _ in job.add_frame():
                pass
        expected = pixels_of(image_of(job))  # as the window has it: straight alpha is brighter
        job.release()
    finally:
        fresh.close()
    assert expected[..., :3].max() > 60
    assert np.abs(shown - expected).max() <= 1
