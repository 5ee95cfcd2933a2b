"""The rigs' pictures: of the user's own scene, the current one marked, a click or a key applies one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QImage
from qtpy.QtWidgets import QApplication

from sfumato import Scene
from sfumato.scene.rigs import rigs
from sfumato_ui.rigs_row import PICTURE, RigsRow
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


def marked(row: RigsRow) -> list[str]:
    return [name for name, button in row.buttons.items() if button.isChecked()]


def pixels(image: QImage) -> np.ndarray:
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat.astype(float)


def wait_for_pictures(row: RigsRow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: all(not b.image.isNull() for b in row.buttons.values()), timeout=120_000)


def test_they_show_the_users_scene(window: MainWindow, qtbot: QtBot) -> None:
    row = window.light_page.rigs
    wait_for_pictures(row, qtbot)
    images = {name: pixels(button.image) for name, button in row.buttons.items()}
    ratio = row.devicePixelRatioF()
    assert row.buttons["rim"].image.width() == round(PICTURE[0] * ratio)
    assert np.abs(images["top-left"] - images["rim"]).mean() > 1
    assert np.abs(images["top-left"] - images["raking"]).mean() > 1
    assert row.isEnabled()
    assert "Open a volume" not in row.buttons["rim"].toolTip()
    before = images["rim"]
    window.look("left")
    qtbot.waitUntil(lambda: np.abs(pixels(row.buttons["rim"].image) - before).mean() > 1, timeout=120_000)


def test_a_click_lights_the_scene_in_one_step(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    row, editor = window.light_page.rigs, window.editor
    assert marked(row) == ["top-left"]
    before = hand.pixels()
    qtbot.mouseClick(window.light_page.lamps.add, LEFT)
    assert marked(row) == []
    assert editor.selected == 1
    qtbot.mouseClick(row.buttons["rim"], LEFT)
    assert editor.scene.lights == rigs()["rim"].lights
    assert editor.selected == 0
    assert marked(row) == ["rim"]
    assert [chip.label for chip in window.light_page.lamps.chips] == ["left rim", "right rim", "fill"]
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - before).mean() > 1
    editor.undo()
    assert len(editor.scene.lights) == 2
    assert editor.light is not None


def test_a_lamp_that_moves_ends_the_mark(window: MainWindow, qtbot: QtBot) -> None:
    row = window.light_page.rigs
    window.editor.change_light("Move the light", tilt=20.0)
    assert marked(row) == []
    window.editor.undo()
    assert marked(row) == ["top-left"]
    qtbot.mouseClick(row.buttons["top-left"], LEFT)
    assert marked(row) == ["top-left"]
    assert not window.editor.document.undo_label, "the rig that is there already is no step"


def test_by_keys(window: MainWindow, qtbot: QtBot) -> None:
    row = window.light_page.rigs
    row.buttons["top-left"].setFocus()
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Right)
    assert QApplication.focusWidget() is row.buttons["headlamp"]
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Down)
    assert QApplication.focusWidget() is row.buttons["raking"]
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Space)
    assert marked(row) == ["raking"]
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Up)
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)
    assert marked(row) == ["headlamp"]


@pytest.mark.slow
def test_a_hidden_tab_draws_nothing(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    row = window.light_page.rigs
    wait_for_pictures(row, qtbot)
    told: list[str] = []
    window.thumbnails.ready.connect(lambda group, key, image: told.append(group))
    window.panel.setCurrentIndex(2)
    window.look("left")
    hand.wait_for_picture()
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=120_000)
    qtbot.wait(600)
    assert "rigs" not in told
    window.panel.setCurrentIndex(0)
    qtbot.waitUntil(lambda: told.count("rigs") >= len(row.buttons), timeout=120_000)


@pytest.mark.slow
def test_pictures_of_other_data_do_not_stay(window: MainWindow, ball_scene: Scene, qtbot: QtBot) -> None:
    row = window.light_page.rigs
    wait_for_pictures(row, qtbot)
    window.editor.reset(ball_scene)
    assert all(button.image.isNull() for button in row.buttons.values())
    wait_for_pictures(row, qtbot)


def test_with_nothing_open_they_say_why_they_wait(make_window: Any) -> None:
    row = make_window().light_page.rigs
    assert not row.isEnabled()
    assert all("Open a volume" in button.toolTip() for button in row.buttons.values())
