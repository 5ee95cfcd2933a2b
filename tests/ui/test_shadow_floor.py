"""The shadow floor in the window: a slider under More, a badge on the picture, a reason where it has no effect."""

from __future__ import annotations

from typing import Any

import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtWidgets import QApplication

from sfumato import Scene
from sfumato_ui import overlay
from sfumato_ui.window import MainWindow


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, hand_of: Any) -> MainWindow:
    window: MainWindow = make_window(ball_scene, size=(560, 460))
    hand_of(window).wait_for_picture()
    window.light_page.more.set_open(True)
    QApplication.processEvents()
    window.light_page.ensureWidgetVisible(window.light_page.floor)
    return window


def test_a_floor_lifts_the_shadows_and_is_never_silent(
    shown: MainWindow, hand_of: Any, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    user, row = hand_of(shown), shown.light_page.floor
    said: list[str] = []
    draw = overlay.draw_badge
    monkeypatch.setattr(
        overlay, "draw_badge", lambda painter, area, text: (said.append(text), draw(painter, area, text))
    )
    before = user.pixels()
    user.drag_slider(row.slider, 0.0, 0.5)
    floor = shown.editor.scene.shadow_floor
    assert 0.2 < floor < 0.4
    assert row.number.value() == pytest.approx(floor, abs=0.006)
    user.wait_for_picture()
    after = user.pixels()
    assert (after[..., :3] - before[..., :3]).min() > -3, "nothing gets darker"
    assert (after[..., :3] - before[..., :3]).max() > 10, "shadows get lighter"
    shown.viewport.repaint()
    assert f"Shadow floor {100 * floor:.0f} %" in said
    qtbot.keyClick(shown, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert shown.editor.scene.shadow_floor == 0, "one drag is one step"
    user.wait_for_picture()
    said.clear()
    shown.viewport.repaint()
    assert not said


def test_without_shadows_there_is_no_floor(shown: MainWindow) -> None:
    row = shown.light_page.floor
    assert row.isEnabled()
    shown.editor.change("Technique", technique="raycast-phong", shadow_floor=0.2)
    assert not row.isEnabled()
    assert "no shadows of lamps" in row.toolTip()
    shown.editor.undo()
    assert row.isEnabled()
