"""Presets as pictures, and those that the user keeps: saved, renamed, deleted, there after a restart."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtWidgets import QApplication

from sfumato import Scene, SfumatoError, TransferFunction
from sfumato_app.flags import transfer_of
from sfumato_ui.own_presets import OwnPresets
from sfumato_ui.panels.material import MaterialPage
from sfumato_ui.window import MainWindow

FUNCTION = TransferFunction.from_points([(20, (0.9, 0.2, 0.1), 0.0), (120, (0.9, 0.2, 0.1), 0.9)])


@pytest.fixture
def page(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> MaterialPage:
    window: MainWindow = make_window(ball_scene, size=(560, 620))
    window.panel.setCurrentIndex(1)
    qtbot.waitUntil(lambda: window.isActiveWindow() and window.material_page.presets.isVisible())
    return window.material_page


@pytest.fixture
def user(page: MaterialPage, hand_of: Any) -> Any:
    return hand_of(page.window())


def names(page: MaterialPage) -> list[str]:
    return [page.presets.item(i).text() for i in range(page.presets.count())]


def type_name(page: MaterialPage, qtbot: QtBot, text: str) -> None:
    assert QApplication.focusWidget() is page.ask.text
    page.ask.text.selectAll()
    qtbot.keyClicks(page.ask.text, text)
    qtbot.keyClick(page.ask.text, Qt.Key.Key_Return)


def save_as(page: MaterialPage, qtbot: QtBot, name: str) -> None:
    qtbot.mouseClick(page.bar.save, Qt.MouseButton.LeftButton)
    type_name(page, qtbot, name)


def files(page: MaterialPage) -> list[str]:
    return sorted(p.name for p in (Path(os.environ["SFUMATO_SETTINGS"]) / "presets").glob("*"))


def test_saving_and_finding_it_after_a_restart(
    page: MaterialPage, make_window: Any, ball_scene: Scene, qtbot: QtBot
) -> None:
    before = names(page)
    points = page.window().editor.scene.transfer.points
    save_as(page, qtbot, "Ball, best")
    assert names(page) == [*before, "Ball, best"]
    assert page.presets.currentItem().text() == "Ball, best"
    assert page.presets.hasFocus()
    assert files(page) == ["ball-best.json"]
    later = make_window(ball_scene).material_page
    assert names(later) == [*before, "Ball, best"]
    assert later.own.presets[0].transfer.points == points


def test_the_file_serves_the_command_line(page: MaterialPage, qtbot: QtBot) -> None:
    scene = page.window().editor.scene
    save_as(page, qtbot, "Ball")
    path = Path(os.environ["SFUMATO_SETTINGS"]) / "presets" / "ball.json"
    taken = transfer_of(scene, str(path))
    assert taken.points == scene.transfer.points
    assert taken.name == "Ball"


def test_choosing_by_mouse_and_keys_is_one_step_each(page: MaterialPage, user: Any, qtbot: QtBot) -> None:
    editor, start = page.window().editor, page.window().editor.scene
    item = page.presets.item(1)
    where = page.presets.visualItemRect(item).center()
    qtbot.mouseClick(page.presets.viewport(), Qt.MouseButton.LeftButton, pos=where)
    assert editor.scene.transfer.name == item.text()
    editor.undo()
    assert editor.scene == start
    page.presets.setFocus()
    user.press(Qt.Key.Key_Right)
    user.press(Qt.Key.Key_Down)
    assert editor.scene.transfer.name == page.presets.currentItem().text()
    editor.undo()
    assert editor.scene == start


def test_renaming_and_deleting(page: MaterialPage, user: Any, qtbot: QtBot) -> None:
    built_in = names(page)
    assert not page.bar.rename.isEnabled()
    save_as(page, qtbot, "One")
    assert page.bar.rename.isEnabled()
    user.press(Qt.Key.Key_F2)
    assert page.ask.text.text() == "One"
    type_name(page, qtbot, "Two")
    assert names(page) == [*built_in, "Two"]
    assert files(page) == ["two.json"]
    user.press(Qt.Key.Key_Delete)
    assert page.ask.accept.hasFocus()
    user.press(Qt.Key.Key_Escape)
    assert files(page) == ["two.json"], "Esc gives up"
    assert page.presets.hasFocus()
    user.press(Qt.Key.Key_Delete)
    user.press(Qt.Key.Key_Return)
    assert names(page) == built_in
    assert files(page) == []


def test_the_name_is_for_the_preset_that_was_asked_about(page: MaterialPage, user: Any, qtbot: QtBot) -> None:
    save_as(page, qtbot, "One")
    user.press(Qt.Key.Key_F2)
    where = page.presets.visualItemRect(page.presets.item(0)).center()
    qtbot.mouseClick(page.presets.viewport(), Qt.MouseButton.LeftButton, pos=where)
    chosen = page.window().editor.scene
    page.ask.text.setFocus()
    type_name(page, qtbot, "Two")
    assert files(page) == ["two.json"]
    assert page.window().editor.scene == chosen


def test_built_in_presets_are_neither_renamed_nor_deleted(page: MaterialPage, user: Any) -> None:
    page.presets.setFocus()
    user.press(Qt.Key.Key_Right)
    for key in (Qt.Key.Key_F2, Qt.Key.Key_Delete):
        user.press(key)
        assert not page.ask.isVisible()
    assert not page.bar.delete.isEnabled()


def test_a_name_that_cannot_be_taken_is_told_at_once(page: MaterialPage, qtbot: QtBot) -> None:
    save_as(page, qtbot, "One")
    qtbot.mouseClick(page.bar.save, Qt.MouseButton.LeftButton)
    assert not page.ask.accept.isEnabled()
    for name in ("one", names(page)[0]):
        page.ask.text.selectAll()
        qtbot.keyClicks(page.ask.text, name)
        assert not page.ask.accept.isEnabled()
        assert "name" in page.ask.complaint
    qtbot.keyClick(page.ask.text, Qt.Key.Key_Escape)
    assert not page.ask.isVisible()


def test_the_pictures_show_the_volume(page: MaterialPage, user: Any, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: len(page.presets.pictures) == page.presets.count(), timeout=60_000)
    image = page.presets.pictures[0]
    ratio = page.devicePixelRatioF()
    assert (image.width(), image.height()) == (round(84 * ratio), round(66 * ratio))
    shown = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
    assert shown.std() > 10


def test_bad_files_are_told_and_the_others_serve(
    make_window: Any, ball_scene: Scene, qtbot: QtBot, tmp_path: Path
) -> None:
    folder = tmp_path / "presets"
    OwnPresets(folder).save("Good", FUNCTION)
    (folder / "bad.json").write_text("{ not json", encoding="utf-8")
    (folder / "other.json").write_text(json.dumps({"points": [{"value": "x"}]}), encoding="utf-8")
    (folder / "deep.json").write_text("[" * 100_000, encoding="utf-8")
    (folder / "binary.json").write_bytes(b"\xff\xfe\x00")
    (folder / "dir.json").mkdir()
    window = make_window(ball_scene)
    assert [p.name for p in window.material_page.own.presets] == ["Good"]
    assert len(window.material_page.own.problems) == 5
    assert all(name in str(window.material_page.own.problems) for name in ("bad.json", "deep.json"))
    assert window.messages.text == ""
    window.panel.setCurrentIndex(1)
    qtbot.waitUntil(lambda: "cannot be read" in window.messages.text)


def test_another_window_s_presets_are_there_when_the_tab_comes_back(page: MaterialPage) -> None:
    window = page.window()
    OwnPresets().save("Elsewhere", FUNCTION)
    window.panel.setCurrentIndex(0)
    assert "Elsewhere" not in names(page)
    window.panel.setCurrentIndex(1)
    assert "Elsewhere" in names(page)


def test_a_folder_that_cannot_be_written_is_told(
    page: MaterialPage, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way", encoding="utf-8")
    monkeypatch.setenv("SFUMATO_SETTINGS", str(blocked))
    save_as(page, qtbot, "One")
    assert "preset" in page.window().messages.text.lower()
    assert "One" not in names(page)


def test_names_of_files(tmp_path: Path) -> None:
    own = OwnPresets(tmp_path)
    for name in ("A/../b", "a b", "骨", "..", "köstlich"):
        own.save(name, FUNCTION)
    assert sorted(p.name for p in own.presets) == sorted(("A/../b", "a b", "骨", "..", "köstlich"))
    assert all(p.parent == tmp_path for p in tmp_path.rglob("*"))
    with pytest.raises(SfumatoError, match="name"):
        own.save("A B", FUNCTION)
    with pytest.raises(SfumatoError, match="no own preset"):
        own.delete("nothing")
    own.rename("a b", "A B")
    assert "A B" in [p.name for p in own.presets]
