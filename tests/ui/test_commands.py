"""The palette and the dialog *Keyboard*, by mouse and keys, in a window with nothing open (which is quick)."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QKeySequence
from qtpy.QtWidgets import QApplication

from sfumato_ui import bindings
from sfumato_ui.keyboard_dialog import KeyboardDialog
from sfumato_ui.palette import CommandPalette, matching
from sfumato_ui.theme import current_theme
from sfumato_ui.window import MainWindow

from .conftest import Hand, MakeWindow

LEFT = Qt.MouseButton.LeftButton
CTRL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def empty(make_window: MakeWindow, qtbot: QtBot) -> MainWindow:
    made = make_window()
    qtbot.waitUntil(made.isActiveWindow)
    made.viewport.setFocus()
    return made


def active(window: MainWindow, qtbot: QtBot) -> None:
    """Give a window the keys, as a window manager does when a dialog closes; Xvfb has none."""
    window.activateWindow()
    qtbot.waitUntil(window.isActiveWindow)
    window.viewport.setFocus()


def opened(window: MainWindow, qtbot: QtBot, kind: type) -> object:
    """Press the key of a dialog and return it."""
    active(window, qtbot)
    key = (Qt.Key.Key_K, CTRL if kind is CommandPalette else CTRL | SHIFT)
    qtbot.keyClick(window.viewport, *key)
    dialog = next(d for d in window.findChildren(kind) if d.isVisible())
    qtbot.waitUntil(dialog.isActiveWindow)
    return dialog


def rows(dialog: CommandPalette | KeyboardDialog) -> list[tuple[str, str]]:
    items = [dialog.list.topLevelItem(i) for i in range(dialog.list.topLevelItemCount())]
    return [(item.text(0), item.text(1)) for item in items]


# -- the palette -------------------------------------------------------------------------------------
def test_the_palette_finds_by_words_and_enter_runs(empty: MainWindow, qtbot: QtBot) -> None:
    palette = opened(empty, qtbot, CommandPalette)
    assert isinstance(palette, CommandPalette)
    titles = [title for title, _ in rows(palette)]
    assert "Open a folder" in titles
    assert "Export the picture" not in titles, "nothing is open"
    assert dict(rows(palette))["History"] == "H"
    qtbot.keyClicks(palette.search, "theme oth")
    assert [title for title, _ in rows(palette)] == ["Other theme (dark or light)"]
    qtbot.keyClick(palette.search, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: current_theme().name == "light")
    empty.set_theme("dark")


def test_arrow_keys_move_while_typing_and_esc_leaves_all_as_it_was(empty: MainWindow, qtbot: QtBot) -> None:
    palette = opened(empty, qtbot, CommandPalette)
    assert isinstance(palette, CommandPalette)
    qtbot.keyClicks(palette.search, "panel")
    assert len(rows(palette)) == 3
    qtbot.keyClick(palette.search, Qt.Key.Key_Down)
    assert palette.list.currentItem().text(0) == "Panel: Material"
    qtbot.keyClick(palette.search, Qt.Key.Key_Escape)
    assert empty.panel.currentIndex() == 0
    palette = opened(empty, qtbot, CommandPalette)
    assert isinstance(palette, CommandPalette)
    qtbot.keyClicks(palette.search, "panel view")
    item = palette.list.topLevelItem(0)
    qtbot.mouseClick(palette.list.viewport(), LEFT, pos=palette.list.visualItemRect(item).center())
    qtbot.waitUntil(lambda: empty.panel.currentIndex() == 2)


def test_the_palette_changes_the_technique(window: MainWindow, hand: Hand, qtbot: QtBot) -> None:
    palette = opened(window, qtbot, CommandPalette)
    assert isinstance(palette, CommandPalette)
    assert {"Undo", "Redo"}.isdisjoint(title for title, _ in rows(palette))
    qtbot.keyClicks(palette.search, "technique casting phong")
    qtbot.keyClick(palette.search, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: window.editor.scene.technique_id == "raycast-phong")
    active(window, qtbot)
    hand.press(Qt.Key.Key_Z, CTRL)
    assert window.editor.scene.technique_id != "raycast-phong"


def test_every_command_of_the_table_is_bound_and_no_key_twice(empty: MainWindow) -> None:
    assert set(empty.commands.actions) == set(bindings.commands())
    keys = [k for c in bindings.commands().values() for k in c.keys]
    assert len(keys) == len(set(keys))
    assert not set(keys) & set(bindings.RESERVED)
    for name, action in empty.commands.actions.items():
        assert action.shortcuts() == [QKeySequence(k) for k in bindings.keys_of(name)]


def test_words_in_any_order(own_settings: None) -> None:
    names = list(bindings.commands())
    assert matching(names, "picture export")[0] == "export"
    assert matching(names, "ctrl+e")[0] == "export"
    assert matching(names, "nothing like this") == []


# -- the keys ----------------------------------------------------------------------------------------
def choose(dialog: KeyboardDialog, qtbot: QtBot, title: str) -> None:
    """Click a command in the list."""
    items = dialog.list.findItems(title, Qt.MatchFlag.MatchExactly)
    dialog.list.scrollToItem(items[0])
    qtbot.mouseClick(dialog.list.viewport(), LEFT, pos=dialog.list.visualItemRect(items[0]).center())


def test_a_key_is_changed_told_where_it_is_taken_and_kept(empty: MainWindow, qtbot: QtBot) -> None:
    dialog = opened(empty, qtbot, KeyboardDialog)
    assert isinstance(dialog, KeyboardDialog)
    choose(dialog, qtbot, "History")
    assert not dialog.assign.isEnabled()
    qtbot.keyClick(dialog.edit, Qt.Key.Key_J)
    assert dialog.told.text() == "J is free."
    qtbot.mouseClick(dialog.assign, LEFT)
    assert dict(rows(dialog))["History"] == "J"
    assert bindings.keys_of("history") == ("J",)
    tip = empty.drawer.toggles["history"].toolTip()
    assert tip.endswith("(J)")
    # A key that another has is told, and taken from it only then.
    qtbot.keyClick(dialog.edit, Qt.Key.Key_L)
    assert "belongs to “Tool: Light”" in dialog.told.text()
    qtbot.mouseClick(dialog.assign, LEFT)
    assert dict(rows(dialog))["Tool: Light"] == ""
    assert empty.strip.tools["light"].toolTip() == "Light: drag moves the lamps"
    qtbot.mouseClick(dialog.reset_all, LEFT)
    assert bindings.keys_of("history") == ("H",)
    assert bindings.keys_of("tool-light") == ("L",)
    assert not dialog.reset_all.isEnabled()


def test_keys_of_the_picture_cannot_be_had(empty: MainWindow, qtbot: QtBot) -> None:
    dialog = opened(empty, qtbot, KeyboardDialog)
    assert isinstance(dialog, KeyboardDialog)
    for key in (Qt.Key.Key_B, Qt.Key.Key_Left):
        qtbot.keyClick(dialog.edit, key)
        assert "stays as it is" in dialog.told.text()
        assert not dialog.assign.isEnabled()


def test_changed_keys_act_at_once_and_in_the_next_window(
    empty: MainWindow, make_window: MakeWindow, qtbot: QtBot
) -> None:
    dialog = opened(empty, qtbot, KeyboardDialog)
    assert isinstance(dialog, KeyboardDialog)
    qtbot.keyClicks(dialog.search, "history")
    qtbot.keyClick(dialog.edit, Qt.Key.Key_J, CTRL)
    qtbot.mouseClick(dialog.assign, LEFT)
    qtbot.mouseClick(dialog.shut, LEFT)
    for window in (empty, None):
        used = window or make_window()
        active(used, qtbot)
        qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_H)
        assert not used.drawer.isVisible()
        qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_J, CTRL)
        assert used.drawer.isVisible()
    # And back, by the button that resets one command.
    dialog = opened(used, qtbot, KeyboardDialog)
    assert isinstance(dialog, KeyboardDialog)
    choose(dialog, qtbot, "History")
    qtbot.mouseClick(dialog.reset, LEFT)
    assert bindings.keys_of("history") == ("H",)
