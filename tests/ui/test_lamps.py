"""The lamps by hand: select, add, remove, mute, solo, rename, order, colour, intensity; each is undone in one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt
from qtpy.QtGui import QColor
from qtpy.QtWidgets import QApplication, QColorDialog, QWidget

from sfumato import Light, Scene
from sfumato.scene.rigs import rigs
from sfumato_ui.dial import ball_image
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
CTRL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def lit(make_window: Any, ball_scene: Scene) -> MainWindow:
    """A window with three lamps; nothing here waits for its picture."""
    made: MainWindow = make_window(ball_scene.with_(lights=rigs()["three-point"].lights))
    return made


def names(window: MainWindow) -> list[str]:
    return [light.name for light in window.editor.scene.lights]


def test_lamps_are_added_selected_muted_and_removed(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    page, editor = window.light_page, window.editor
    row, tools = page.lamps, page.tools
    for count in (2, 3, 4):
        qtbot.mouseClick(row.add, LEFT)
        assert len(editor.scene.lights) == count
    assert not row.add.isEnabled()
    assert editor.selected == 3
    qtbot.mouseClick(row.chips[1], LEFT)
    assert editor.selected == 1
    assert [chip.isChecked() for chip in row.chips] == [False, True, False, False]
    assert page.tilt.number.value() == editor.scene.lights[1].tilt
    qtbot.mouseClick(tools.mute, LEFT)
    assert [light.enabled for light in editor.scene.lights] == [True, False, True, True]
    gone = editor.scene.lights[1].name
    qtbot.mouseClick(tools.remove, LEFT)
    assert gone not in names(window)
    hand.wait_for_picture()
    editor.undo()
    assert len(row.chips) == 4
    assert gone in names(window)


def test_the_last_lamp_stays(window: MainWindow) -> None:
    assert not window.light_page.tools.remove.isEnabled()
    assert "last lamp" in window.light_page.tools.remove.toolTip()


def test_solo_is_one_lamp_alone(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    editor, page = window.editor, window.light_page
    editor.change("Light", lights=rigs()["three-point"].lights)
    hand.wait_for_picture()
    before = hand.pixels()
    page.lamps.chips[1].setFocus()
    qtbot.keyClick(page.lamps.chips[1], Qt.Key.Key_Space)
    qtbot.mouseClick(page.tools.solo, LEFT)
    assert [light.name for light in editor.scene.active_lights] == ["fill"]
    assert page.lamps.chips[0].accessibleDescription() == "dark"
    assert page.lamps.chips[1].accessibleDescription() == "solo"
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - before).mean() > 1
    qtbot.mouseClick(page.lamps.chips[2], LEFT)
    qtbot.mouseClick(page.tools.solo, LEFT)
    assert [light.solo for light in editor.scene.lights] == [False, False, True]
    qtbot.mouseClick(page.tools.solo, LEFT)
    assert len(editor.scene.active_lights) == 3
    for _ in range(3):
        editor.undo()
    assert not any(light.solo for light in editor.scene.lights)


def test_renaming_by_double_click_and_f2(lit: MainWindow, qtbot: QtBot) -> None:
    row = lit.light_page.lamps
    qtbot.mouseDClick(row.chips[1], LEFT)
    assert row.name_line is not None
    qtbot.keyClicks(row.name_line, "Bulb L1")
    assert lit.editor.scene.lights[1].name == "fill", "nothing happens while it is typed"
    qtbot.keyClick(row.name_line, Qt.Key.Key_Return)
    assert names(lit) == ["key", "Bulb L1", "rim"]
    assert row.chips[1].label == "Bulb L1"
    assert lit.viewport.tool == "orbit", "L and 1 are letters here"
    lit.editor.undo()
    assert names(lit) == ["key", "fill", "rim"]
    qtbot.mouseClick(row.chips[2], LEFT)
    qtbot.keyClick(row.chips[2], Qt.Key.Key_F2)
    assert row.name_line is not None
    qtbot.keyClicks(row.name_line, "gone")
    qtbot.keyClick(row.name_line, Qt.Key.Key_Escape)
    assert row.name_line is None
    assert names(lit) == ["key", "fill", "rim"]
    qtbot.waitUntil(lambda: QApplication.focusWidget() is row.chips[2])
    assert not lit.editor.document.undo_label


def test_leaving_the_line_takes_the_name(lit: MainWindow, qtbot: QtBot) -> None:
    row = lit.light_page.lamps
    qtbot.mouseDClick(row.chips[0], LEFT)
    qtbot.keyClicks(row.name_line, "window")
    lit.viewport.setFocus()
    qtbot.waitUntil(lambda: row.name_line is None)
    assert names(lit)[0] == "window"


def test_back_from_another_window_the_lamp_has_the_keys(lit: MainWindow, qtbot: QtBot) -> None:
    row = lit.light_page.lamps
    qtbot.mouseDClick(row.chips[1], LEFT)
    qtbot.keyClicks(row.name_line, "window")
    other = QWidget()
    qtbot.addWidget(other)
    other.show()
    other.activateWindow()
    qtbot.waitUntil(lambda: row.name_line is None)
    assert names(lit)[1] == "window"
    other.close()
    lit.activateWindow()
    qtbot.waitUntil(lambda: QApplication.focusWidget() is row.chips[1])


def test_lamps_change_places_by_drag_and_keys(lit: MainWindow, hand_of: Any, qtbot: QtBot) -> None:
    row = lit.light_page.lamps
    first, last = row.chips[0], row.chips[2]
    start = first.rect().center()
    hand_of(lit).drag(first, start, start + QPoint(last.geometry().right() - first.x(), 0), steps=16)
    assert names(lit) == ["fill", "rim", "key"]
    assert lit.editor.selected == 2
    lit.editor.undo()
    assert names(lit) == ["key", "fill", "rim"], "one drag is one step"
    row.chips[1].setFocus()
    qtbot.keyClick(row.chips[1], Qt.Key.Key_Left, CTRL)
    assert names(lit) == ["fill", "key", "rim"]
    assert lit.editor.selected == 0
    assert QApplication.focusWidget() is row.chips[0]
    qtbot.keyClick(row.chips[0], Qt.Key.Key_Left, CTRL)
    assert names(lit) == ["fill", "key", "rim"], "there is no further"


def test_typing_and_turning_the_intensity(lit: MainWindow, hand_of: Any, qtbot: QtBot) -> None:
    box = lit.light_page.tools.intensity
    lit.viewport.setFocus()
    before = lit.editor.scene.lights[0].intensity
    hand_of(lit).wheel(box)
    assert lit.editor.scene.lights[0].intensity == before
    box.setFocus()
    hand_of(lit).wheel(box)
    assert lit.editor.scene.lights[0].intensity == pytest.approx(before + 0.05)
    box.selectAll()
    qtbot.keyClicks(box, "1.5")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert lit.editor.scene.lights[0].intensity == 1.5
    qtbot.mouseClick(lit.light_page.lamps.chips[1], LEFT)
    assert box.value() == lit.editor.scene.lights[1].intensity


def test_colouring_a_lamp(lit: MainWindow, qtbot: QtBot) -> None:
    tools = lit.light_page.tools

    qtbot.mouseClick(tools.color, LEFT)
    dialog = QApplication.activeModalWidget()
    assert isinstance(dialog, QColorDialog)
    corner = lit.mapToGlobal(lit.rect().bottomRight())
    assert 0 < corner.x() - dialog.geometry().right() < 20, "over the panel, not the picture"
    dialog.setCurrentColor(QColor(255, 0, 0))
    dialog.accept()
    assert lit.editor.scene.lights[0].color == pytest.approx((1, 0, 0), abs=1e-3)
    lit.editor.undo()
    assert lit.editor.scene.lights[0].color == (1, 1, 1)


def test_a_lamp_is_fixed_to_the_patient(lit: MainWindow, qtbot: QtBot) -> None:
    page = lit.light_page
    page.more.set_open(True)
    page.attached.setFocus()
    qtbot.keyClick(page.attached, Qt.Key.Key_Down)
    assert lit.editor.scene.lights[0].attached == "patient"
    qtbot.mouseClick(page.lamps.chips[1], LEFT)
    assert page.attached.currentData() == "viewer"


def test_long_names_stay_inside_the_panel(lit: MainWindow) -> None:
    lights = tuple(Light(name=f"a very long name {i}") for i in range(4))
    lit.editor.change("Light", lights=lights)
    QApplication.processEvents()
    row = lit.light_page.lamps
    assert row.add.geometry().right() <= row.width()
    assert all(chip.width() >= 40 for chip in row.chips)
    assert lit.light_page.widget().width() <= lit.light_page.viewport().width()


def test_what_a_technique_leaves_out_is_said(lit: MainWindow) -> None:
    page = lit.light_page
    assert not page.note.isVisible()
    lit.editor.change("Technique", technique="half-angle")
    assert page.note.isVisible()
    assert "1 of 3" in page.note.text()
    assert page.rigs.isEnabled()
    lit.editor.change("Technique", technique="raycast")
    assert "without light" in page.note.text()
    assert not page.rigs.isEnabled()
    assert "without light" in page.rigs.toolTip()


def test_the_dial_shows_who_shines(lit: MainWindow) -> None:
    def ball() -> np.ndarray:
        image = ball_image(lit.editor.scene.lights, 60)
        return np.frombuffer(image.constBits(), np.uint8).astype(float)

    before = ball()
    lit.editor.change("Solo", **{"lights.2.solo": True})
    assert ball().mean() < before.mean() - 5, "a rim alone leaves the ball's front dark"


def test_a_lamp_is_duplicated(lit: MainWindow, qtbot: QtBot) -> None:
    editor, tools = lit.editor, lit.light_page.tools
    qtbot.mouseClick(lit.light_page.lamps.chips[1], LEFT)
    before = editor.scene.lights
    qtbot.mouseClick(tools.duplicate, LEFT)
    assert names(lit) == ["key", "fill", "fill 2", "rim"]
    assert editor.selected == 2
    assert editor.scene.lights[2] == replace(before[1], name="fill 2")
    assert not tools.duplicate.isEnabled(), "four are the most that the technique uses"
    assert "At most 4" in tools.duplicate.toolTip()
    editor.undo()
    assert editor.scene.lights == before


def test_further_rigs_wait_under_more(lit: MainWindow, qtbot: QtBot) -> None:
    page = lit.light_page
    assert list(page.more_rigs.buttons) == ["under-light", "soft-box"]
    page.more.set_open(True)
    QApplication.processEvents()
    page.ensureWidgetVisible(page.more_rigs)
    qtbot.mouseClick(page.more_rigs.buttons["under-light"], LEFT)
    assert lit.editor.scene.lights == rigs()["under-light"].lights
    assert page.more_rigs.buttons["under-light"].isChecked()
    assert not any(button.isChecked() for button in page.rigs.buttons.values())
