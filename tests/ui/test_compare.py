"""Comparing by wipe and by differences, with real mouse and key events."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt
from qtpy.QtGui import QColor, QImage
from qtpy.QtWidgets import QApplication

from sfumato import Scene
from sfumato.techniques import techniques
from sfumato_ui.difference import color_difference, difference_picture
from sfumato_ui.quality import QUALITIES, remember_quality
from sfumato_ui.window import MainWindow

from .conftest import Hand, MakeWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def window(make_window: MakeWindow, ball_scene: Scene, qtbot: QtBot) -> MainWindow:
    """A window on the ball, lit by a technique that is quick, in two frames, with its first picture."""
    remember_quality(QUALITIES[0])
    made = make_window(ball_scene.with_(technique="raycast-phong"), size=(640, 400))
    Hand(made, qtbot).wait_for_picture()
    return made


def pick(window: MainWindow, name: str, qtbot: QtBot) -> None:
    """Choose by keys what to compare with."""
    box = window.compare.against
    box.setFocus()
    for _ in range(box.count()):
        qtbot.keyClick(box, Qt.Key.Key_Up)
    for _ in range(box.findData(name)):
        qtbot.keyClick(box, Qt.Key.Key_Down)


def is_settled(window: MainWindow) -> bool:
    picture = window.viewport.picture
    return picture is not None and picture.settled


def drawn(window: MainWindow, qtbot: QtBot) -> QImage:
    """Wait for the other picture."""
    qtbot.waitUntil(lambda: window.compare.layer.image is not None, timeout=90_000)
    assert window.compare.layer.image is not None
    return window.compare.layer.image


def column(window: MainWindow, part: float) -> np.ndarray:
    """Return what is seen in a column of the picture."""
    image = window.viewport.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    rows = flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3)
    return rows[60:-40, round(part * image.width())].astype(int)


def test_wipe_against_another_technique(window: MainWindow, hand: Hand, qtbot: QtBot) -> None:
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_K)
    assert window.compare.against.currentData() == "raycast"
    pick(window, "slices", qtbot)
    qtbot.mouseClick(window.compare.wipe, LEFT)
    assert window.compare.handle.isVisible()
    drawn(window, qtbot)
    qtbot.waitUntil(lambda: is_settled(window), timeout=90_000)
    height = window.viewport.height()
    qtbot.waitUntil(lambda: window.compare.handle.height() == height)
    # The handle goes to the left by the mouse: what was the present picture there is the other now.
    handle = window.compare.handle
    middle = handle.rect().center()
    present = column(window, 0.35)
    qtbot.mousePress(handle, LEFT, pos=middle)
    for part in (0.45, 0.4, 0.35, 0.3, 0.25):
        there = QPoint(round(part * window.viewport.width()), middle.y())
        qtbot.mouseMove(handle, handle.mapFrom(window.viewport, there))  # the handle has moved with the hand
    qtbot.mouseRelease(handle, LEFT)
    assert handle.fraction == pytest.approx(0.25, abs=0.02)
    assert np.abs(column(window, 0.35) - present).max() > 8
    # And by keys all the way to the right, where only the present picture is left.
    handle.setFocus(Qt.FocusReason.TabFocusReason)
    for _ in range(8):
        hand.press(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert handle.fraction == 1.0
    assert np.array_equal(column(window, 0.35), present)
    scene = window.editor.scene
    hand.press(Qt.Key.Key_Escape)
    assert not window.compare.layer.isVisible()
    assert not handle.isVisible()
    assert window.editor.scene is scene, "nothing of it is an edit"


def test_a_drag_sees_the_present_picture_alone(window: MainWindow, hand: Hand, qtbot: QtBot) -> None:
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_K)
    qtbot.mouseClick(window.compare.wipe, LEFT)
    first = drawn(window, qtbot)
    corner = QPoint(60, 60)
    qtbot.mousePress(window.viewport, LEFT, pos=corner)
    qtbot.mouseMove(window.viewport, corner + QPoint(30, 10))
    qtbot.waitUntil(lambda: window.compare.layer.image is None)
    assert "being drawn" in window.compare.layer.told
    qtbot.mouseRelease(window.viewport, LEFT, pos=corner + QPoint(30, 10))
    second = drawn(window, qtbot)
    assert second != first
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_K)
    assert not window.compare.layer.isVisible(), "a closed drawer ends it"


def test_difference_against_a_step_of_the_history(window: MainWindow, hand: Hand, qtbot: QtBot) -> None:
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    for _ in range(12):
        hand.press(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    hand.press(Qt.Key.Key_K)
    assert window.compare.against.itemText(0) == "History: Beginning"
    pick(window, "step", qtbot)
    qtbot.mouseClick(window.compare.differ, LEFT)
    image = drawn(window, qtbot)
    (bar,) = window.compare.layer.bars
    assert bar.low == 0
    assert bar.high in (5, 10, 20, 50, 100)
    assert "ΔE" in window.compare.told.text()
    assert QApplication.focusWidget() is window.compare.differ
    corner = QColor(image.pixel(3, 3))
    darkest = QColor("#440154")  # viridis at 0: where both are the background
    assert abs(corner.red() - darkest.red()) + abs(corner.blue() - darkest.blue()) < 6


def test_a_grid_of_rigs_with_times_and_a_click_takes_one(
    window: MainWindow, hand: Hand, qtbot: QtBot
) -> None:
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_K)
    grid = window.compare.grids["rigs"]
    with qtbot.waitSignal(grid.finished, timeout=120_000):
        qtbot.mouseClick(window.compare.rigs, LEFT)
    assert grid.isVisible()
    assert grid.size() == window.viewport.size()
    cells = grid.cells
    assert [c.present for c in cells.values()].count(True) == 1
    assert all(c.time_words.split()[0].replace(".", "").isdigit() for c in cells.values())
    assert cells["rim"].image != cells["headlamp"].image
    qtbot.mouseClick(cells["rim"], LEFT)
    assert window.editor.document.undo_label == "Light with rig Rim"
    assert cells["rim"].present
    cells["rim"].setFocus()
    hand.press(Qt.Key.Key_Escape)
    assert not grid.isVisible()
    assert not window.compare.rigs.isChecked()


def test_the_grid_of_techniques_names_all_but_the_slowest(
    window: MainWindow, hand: Hand, qtbot: QtBot
) -> None:
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_K)
    qtbot.mouseClick(window.compare.techniques, LEFT)
    cells = window.compare.grids["techniques"].cells
    assert set(cells) == set(techniques()) - {"reference"}
    assert cells[window.editor.scene.technique_id].present
    cell = cells["raycast"]
    cell.setFocus(Qt.FocusReason.TabFocusReason)
    hand.press(Qt.Key.Key_Space)
    assert window.editor.scene.technique_id == "raycast"
    assert cell.present


# -- the measure -------------------------------------------------------------------------------------
def test_the_difference_is_that_of_the_cie() -> None:
    pixels = np.array([[[255, 255, 255], [0, 0, 0], [255, 0, 0], [119, 119, 119]]], dtype=np.uint8)
    black = np.zeros_like(pixels)
    found = color_difference(pixels, black)[0]
    # L* of white is 100; CIE 1976 distance of sRGB's red (L 53.24, a 80.09, b 67.20) from black; grey 119 has L* 50.03.
    assert found == pytest.approx([100, 0, 117.3, 50.03], abs=0.1)


def test_its_scale_holds_nearly_all_of_it() -> None:
    one, other = (QImage(40, 30, QImage.Format.Format_ARGB32_Premultiplied) for _ in range(2))
    one.fill(QColor(120, 120, 120))
    other.fill(QColor(120, 120, 120))
    assert difference_picture(one, other)[2] == 0
    other.fill(QColor(150, 120, 120))
    image, bar, mean = difference_picture(one, other)
    assert bar.high / 2.5 <= mean <= bar.high
    assert image.size() == one.size()
