"""Rigs of one's own under More: kept, chosen, renamed, exported, imported, deleted, by mouse and keys."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtWidgets import QApplication, QFileDialog

from sfumato import Scene
from sfumato.scene.rig_files import load_rig
from sfumato_ui.own_rigs import OwnRigs
from sfumato_ui.own_rigs_row import OwnRigsRow
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, hand_of: Any) -> MainWindow:
    window: MainWindow = make_window(ball_scene.with_(technique="raycast-phong"), size=(640, 560))
    hand_of(window).wait_for_picture()
    window.light_page.more.set_open(True)
    QApplication.processEvents()
    window.light_page.ensureWidgetVisible(window.light_page.own_rigs)
    return window


def name(own: OwnRigsRow, text: str, qtbot: QtBot) -> None:
    assert own.ask.isVisible()
    own.ask.text.selectAll()
    qtbot.keyClicks(own.ask.text, text)
    qtbot.keyClick(own.ask.text, Qt.Key.Key_Return)


def answer_file(path: Path, qtbot: QtBot) -> None:
    """Name a file in the dialog that is open, and accept it."""
    qtbot.waitUntil(
        lambda: any(isinstance(w, QFileDialog) and w.isVisible() for w in QApplication.topLevelWidgets())
    )
    dialog = next(w for w in QApplication.topLevelWidgets() if isinstance(w, QFileDialog) and w.isVisible())
    dialog.selectFile(str(path))
    dialog.accept()
    qtbot.waitUntil(lambda: not dialog.isVisible())


def test_the_life_of_an_own_rig(shown: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    own, editor = shown.light_page.own_rigs, shown.editor
    assert not own.share.isEnabled()
    assert "choose one first" in own.share.toolTip()
    editor.change_light("Move the light", tilt=55.0, rotation=20.0)
    lamps = editor.scene.lights
    # Kept: it is shown as a live picture, and is the scene's.
    qtbot.mouseClick(own.save, LEFT)
    name(own, "Low right", qtbot)
    button = own.row.buttons["Low right"]
    assert button.isChecked()
    qtbot.waitUntil(lambda: not button.image.isNull(), timeout=60_000)
    # Chosen again after something else.
    qtbot.mouseClick(shown.light_page.rig_buttons["headlamp"], LEFT)
    assert not button.isChecked()
    assert not own.rename.isEnabled()
    qtbot.mouseClick(button, LEFT)
    assert editor.scene.lights == lamps
    assert editor.document.undo_label == "Light with rig Low right"
    # Renamed, exported, deleted, imported.
    qtbot.mouseClick(own.rename, LEFT)
    name(own, "Raking light", qtbot)
    assert list(own.row.buttons) == ["Raking light"]
    qtbot.mouseClick(own.share, LEFT)
    answer_file(tmp_path / "shared.sfumato-rig", qtbot)
    assert load_rig(tmp_path / "shared.sfumato-rig").lights == lamps
    qtbot.mouseClick(own.delete, LEFT)
    assert "Its file goes, too" in own.ask.complaint
    qtbot.keyClick(own.ask.accept, Qt.Key.Key_Return)
    assert own.row.buttons == {}
    assert editor.scene.lights == lamps, "the scene keeps its lamps"
    qtbot.mouseClick(own.get, LEFT)
    answer_file(tmp_path / "shared.sfumato-rig", qtbot)
    assert own.row.buttons["Raking light"].isChecked()
    assert list(OwnRigs().kept) == ["Raking light"], "kept for the next window"


def test_a_file_that_is_no_rig_is_told(shown: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    own = shown.light_page.own_rigs
    (tmp_path / "bad.sfumato-rig").write_text("{}")
    qtbot.mouseClick(own.get, LEFT)
    answer_file(tmp_path / "bad.sfumato-rig", qtbot)
    assert "not a rig" in shown.messages.text
    assert own.row.buttons == {}
