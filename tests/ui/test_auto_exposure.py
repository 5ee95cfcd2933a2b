"""Exposure by itself: with rigs, by a key, on opening, never while a lamp is moved; temperatures; with real events."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt

from sfumato import Scene
from sfumato.scene.white import lamp_color
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, hand_of: Any) -> MainWindow:
    window: MainWindow = make_window(ball_scene.with_(technique="directional"), size=(640, 520))
    hand_of(window).wait_for_picture()
    return window


def test_a_rig_brings_its_exposure_in_one_step(shown: MainWindow, hand_of: Any, qtbot: QtBot) -> None:
    start, user = shown.editor.scene, hand_of(shown)
    button = shown.light_page.rig_buttons["raking"]
    qtbot.waitUntil(lambda: button.exposure is not None, timeout=60_000)
    stops = button.exposure
    qtbot.mouseClick(button, LEFT)
    assert shown.editor.scene.exposure == stops
    assert button.exposure == stops, "it does not depend on the lamps that shine"
    assert shown.editor.scene.lights == button.rig.lights
    shown.viewport.setFocus()
    user.press(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert shown.editor.scene == start, "one step"
    # Without it, the exposure is the user's.
    shown.panel.setCurrentIndex(2)
    shown.view_page.more.set_open(True)
    box = shown.view_page.automatic
    shown.view_page.ensureWidgetVisible(box)
    qtbot.mouseClick(box, LEFT, pos=QPoint(10, box.height() // 2))
    assert not shown.exposure.on
    shown.panel.setCurrentIndex(0)
    qtbot.mouseClick(button, LEFT)
    assert shown.editor.scene.exposure == 0


def test_a_dark_scene_is_exposed_by_a_key_but_not_by_a_drag(
    shown: MainWindow, hand_of: Any, qtbot: QtBot
) -> None:
    user = hand_of(shown)
    shown.editor.change_light("Dim the lamp", intensity=0.2)
    user.wait_for_picture()
    dark = user.pixels()[..., :3].mean()
    shown.viewport.setFocus()
    middle = shown.viewport.rect().center()
    user.drag(shown.viewport, middle, middle + QPoint(20, 10), keys=Qt.KeyboardModifier.ShiftModifier)
    user.wait_for_picture()
    qtbot.wait(600)
    assert shown.editor.scene.exposure == 0, "never while a lamp is moved"
    user.press(Qt.Key.Key_X)
    qtbot.waitUntil(lambda: shown.editor.scene.exposure > 1.5, timeout=60_000)
    assert shown.editor.document.undo_label == "Automatic exposure"
    user.wait_for_picture()
    assert user.pixels()[..., :3].mean() > 1.5 * dark
    shown.panel.setCurrentIndex(2)
    assert shown.view_page.exposure.number.value() == pytest.approx(shown.editor.scene.exposure, abs=0.01)


def test_lamp_temperature_and_white_balance(shown: MainWindow, hand_of: Any, qtbot: QtBot) -> None:
    user, page = hand_of(shown), shown.light_page
    page.more.set_open(True)
    page.ensureWidgetVisible(page.temperature)
    row = page.temperature
    assert row.number.value() == 6504
    row.number.setFocus()
    row.number.selectAll()
    qtbot.keyClicks(row.number, "2700")
    qtbot.keyClick(row.number, Qt.Key.Key_Return)
    assert shown.editor.scene.lights[0].color == pytest.approx(lamp_color(2700))
    assert row.number.value() == pytest.approx(2700, abs=20)
    shown.editor.change_light("Colour the lamp", color=(0.2, 1.0, 0.3))
    assert "own colour" in row.label.text()
    shown.editor.undo()
    user.wait_for_picture()
    warm = user.pixels()[..., :3]
    shown.panel.setCurrentIndex(2)
    shown.view_page.more.set_open(True)
    white = shown.view_page.white.control
    shown.view_page.ensureWidgetVisible(white)
    white.number.setFocus()
    white.number.selectAll()
    qtbot.keyClicks(white.number, "2700")
    qtbot.keyClick(white.number, Qt.Key.Key_Return)
    assert shown.editor.scene.white_balance == 2700
    user.wait_for_picture()
    balanced = user.pixels()[..., :3]
    lit = warm.max(axis=-1) > 40
    # Blue over red: under the warm lamp far less than in the tissue's own colour, then as there.
    assert np.median(balanced[lit, 0] / balanced[lit, 2]) > 1.6 * np.median(warm[lit, 0] / warm[lit, 2])


def test_a_volume_is_exposed_when_it_is_opened(
    make_window: Any, ball_scene: Scene, hand_of: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    window: MainWindow = make_window(size=(640, 520))
    np.save(tmp_path / "ball.npy", ball_scene.volume.data)  # type: ignore[union-attr]
    window.open(str(tmp_path / "ball.npy"))
    hand_of(window).wait_for_picture()
    qtbot.waitUntil(lambda: window.exposure._asked is None, timeout=60_000)
    assert not window.editor.document.modified
    assert len(window.editor.document.steps) == 1, "it is no step of the history"
    # A scene's own exposure is left alone.
    dark = window.editor.scene.with_(exposure=-3.0)
    dark.save(tmp_path / "dark.sfumato")
    window.open(str(tmp_path / "dark.sfumato"))
    hand_of(window).wait_for_picture()
    qtbot.wait(500)
    assert window.editor.scene.exposure == -3
