"""The history's drawer: steps with their pictures, returned to by mouse and keys."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QApplication

from sfumato import Scene
from sfumato.scene.document import Step
from sfumato_ui.history import MOST_PICTURES, StepPictures
from sfumato_ui.window import MainWindow

from .conftest import Hand

LEFT = Qt.MouseButton.LeftButton
pytestmark = pytest.mark.usefixtures("qapp")


def words(window: MainWindow) -> list[str]:
    return [window.history.item(i).text() for i in range(window.history.count())]


def three_steps(window: MainWindow, hand: Hand) -> None:
    """Turn the subject, move the lamp and look from the left, by real events."""
    window.viewport.setFocus()
    middle = window.viewport.rect().center()
    hand.drag(window.viewport, middle, middle + QPoint(60, 10))
    hand.drag(window.viewport, middle, middle + QPoint(40, 0), keys=Qt.KeyboardModifier.ShiftModifier)
    hand.press(Qt.Key.Key_3)
    hand.wait_for_picture()


def test_the_drawer_is_closed_at_start_and_opens_by_button_and_key(
    window: MainWindow, hand: Hand, qtbot: QtBot
) -> None:
    height = window.viewport.height()
    assert not window.drawer.isVisible()
    qtbot.mouseClick(window.drawer.toggles["history"], LEFT)
    assert window.history.isVisible()
    assert window.viewport.height() < height
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_H)
    assert not window.drawer.isVisible()
    qtbot.waitUntil(lambda: window.viewport.height() == height)


def test_every_step_is_returned_to_by_a_click(window: MainWindow, hand: Hand, qtbot: QtBot) -> None:
    first = window.editor.scene
    three_steps(window, hand)
    last = window.editor.scene
    hand.press(Qt.Key.Key_H)
    assert words(window) == ["Beginning", "Orbit", "Move the light", "View from the left"]
    row = window.history
    qtbot.mouseClick(row.viewport(), LEFT, pos=row.visualItemRect(row.item(0)).center())
    assert window.editor.scene is first
    assert row.position == 0
    assert len(words(window)) == 4, "what was undone stays"
    qtbot.mouseClick(row.viewport(), LEFT, pos=row.visualItemRect(row.item(3)).center())
    assert window.editor.scene is last


def test_arrow_keys_and_enter_return_and_undo_moves_the_mark(
    window: MainWindow, hand: Hand, qtbot: QtBot
) -> None:
    three_steps(window, hand)
    hand.press(Qt.Key.Key_H)
    row = window.history
    row.setFocus(Qt.FocusReason.TabFocusReason)
    seen: list[Scene] = []
    window.editor.changed.connect(lambda old, new: seen.append(new))
    hand.press(Qt.Key.Key_Left)
    hand.press(Qt.Key.Key_Left)
    assert not seen, "choosing alone changes nothing"
    hand.press(Qt.Key.Key_Return)
    assert row.position == 1
    assert len(seen) == 1, "the steps between are not shown"
    hand.press(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert (row.position, row.currentRow()) == (0, 0)
    hand.press(Qt.Key.Key_Y, Qt.KeyboardModifier.ControlModifier)
    assert (row.position, row.currentRow()) == (1, 1)
    assert QApplication.focusWidget() is row
    # Another edit drops what was undone.
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_Right)
    assert words(window)[-1] == "Orbit"
    assert len(words(window)) <= 3


def test_steps_get_their_pictures(window: MainWindow, hand: Hand, qtbot: QtBot) -> None:
    three_steps(window, hand)
    row = window.history
    assert row.pictures.of(row.steps[-1].scene) is not None, "from what was shown, the drawer being closed"
    hand.press(Qt.Key.Key_H)
    qtbot.waitUntil(lambda: all(row.pictures.of(s.scene) is not None for s in row.steps), timeout=60_000)
    one, other = (row.pictures.of(row.steps[i].scene) for i in (0, 3))
    assert one is not None
    assert other is not None
    assert one.size() == other.size()
    assert one != other


def test_pictures_are_bounded_and_the_nearest_stay() -> None:
    from qtpy.QtGui import QImage

    kept = StepPictures()
    steps = tuple(Step("Brighter", Scene(exposure=i / 100)) for i in range(MOST_PICTURES + 60))
    for step in steps:
        kept.keep(step.scene, QImage(2, 2, QImage.Format.Format_ARGB32))
    kept.tidy(steps, len(steps) - 1)
    assert len(kept) == MOST_PICTURES
    assert kept.of(steps[-1].scene) is not None
    assert kept.of(steps[0].scene) is None
    kept.tidy(steps[:1], 0)
    assert len(kept) == 0
