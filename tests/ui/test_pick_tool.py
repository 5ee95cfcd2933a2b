"""The Pick tool by hand: what lies under the pointer is told, and found in the transfer function."""

from __future__ import annotations

from typing import Any

import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt

from sfumato import Scene
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> MainWindow:
    """A window with the Pick tool; its picture is not waited for."""
    window: MainWindow = make_window(ball_scene.with_(technique="raycast"), size=(560, 460))
    qtbot.waitExposed(window)
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    qtbot.keyClick(window.viewport, Qt.Key.Key_P)
    assert window.viewport.tool == "pick"
    return window


def test_a_material_is_found_in_the_function(shown: MainWindow, qtbot: QtBot, hand_of: Any) -> None:
    plot, start = shown.material_page.transfer.plot, shown.editor.scene
    middle = shown.viewport.rect().center()
    qtbot.mouseClick(shown.viewport, LEFT, pos=middle)
    assert shown.panel.currentWidget() is shown.material_page
    assert plot.picked is not None
    assert 20 < plot.picked < 120, "the skin of the ball, between the function's two points"
    assert plot.selected == 0, "the nearest"
    tool, view = shown.viewport.tools["pick"], shown.viewport.view
    assert view is not None
    (handle,) = tool.handles(view)
    assert "%" in handle.name
    assert abs(handle.at[0] - middle.x()) < 2
    # By keys it goes on; what it does is no step of the history.
    shown.viewport.setFocus()
    qtbot.keyClick(shown.viewport, Qt.Key.Key_Left)
    assert tool.handles(view)[0].at[0] < middle.x()
    assert shown.editor.scene is start
    assert not shown.editor.document.undo_label
    # What it says follows the function.
    said = tool.handles(view)[0].name
    shown.editor.change("Fade", **{"transfer.points.1.opacity": 0.1})
    assert tool.handles(view)[0].name != said
    shown.editor.undo()
    assert tool.handles(view)[0].name == said
    # Over nothing a drag turns the subject, as with other tools.
    hand_of(shown).drag(shown.viewport, QPoint(6, 6), QPoint(40, 6))
    assert shown.editor.scene.camera != start.camera
    qtbot.keyClick(shown.viewport, Qt.Key.Key_Escape)
    assert shown.viewport.tool == "orbit"
