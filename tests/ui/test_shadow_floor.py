"""The shadow floor and the shadow audit in the window: what they do, and that the picture says so."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QApplication

from sfumato import Scene
from sfumato_ui import overlay
from sfumato_ui.settings import settings
from sfumato_ui.shadow_audit import KEPT
from sfumato_ui.window import MainWindow


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, hand_of: Any) -> MainWindow:
    # A hard lamp: a soft one leaves more than a quarter of its light everywhere.
    hard = ball_scene.with_(**{"lights.0.aperture": 3.0, "lights.0.tilt": 50.0})
    window: MainWindow = make_window(hard, size=(560, 460))
    hand_of(window).wait_for_picture()
    window.light_page.more.set_open(True)
    QApplication.processEvents()
    window.light_page.ensureWidgetVisible(window.light_page.floor)
    return window


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What the picture's badge said, one entry each time that it was painted."""
    heard: list[str] = []
    draw = overlay.draw_badge
    monkeypatch.setattr(
        overlay, "draw_badge", lambda painter, area, text: (heard.append(text), draw(painter, area, text))
    )
    return heard


def test_an_audit_by_a_key_tells_what_is_dark(
    shown: MainWindow, hand_of: Any, qtbot: QtBot, said: list[str]
) -> None:
    user, audit = hand_of(shown), shown.light_page.audit
    scene, plain = shown.editor.scene, user.pixels()
    shown.viewport.setFocus()
    user.press(Qt.Key.Key_A)
    assert audit.on.isChecked()
    qtbot.waitUntil(lambda: audited(shown) is not None, timeout=60_000)
    share = audited(shown).share
    assert 0.01 < share < 0.6
    shown.viewport.repaint()
    assert said[-1] == f"Shadow audit: {100 * share:.1f} % has less than 25 % of its light"
    false = user.pixels()
    assert np.abs(false - plain).max() > 60, "dark places are marked"
    # A higher threshold, typed, finds more; it is remembered, and another technique is audited, too.
    audit.threshold.number.setFocus()
    audit.threshold.number.selectAll()
    qtbot.keyClicks(audit.threshold.number, "60")
    qtbot.keyClick(audit.threshold.number, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: audited(shown) is not None and audited(shown).threshold == 0.6, timeout=60_000)
    assert audited(shown).share > share
    assert float(settings().value(KEPT)) == 60
    shown.editor.change("Technique", technique="raycast-phong")
    user.wait_for_picture()
    shown.viewport.repaint()
    assert said[-1] == "Shadow audit: this technique casts no shadows"
    shown.editor.undo()
    qtbot.mouseClick(audit.on, Qt.MouseButton.LeftButton, pos=QPoint(10, audit.on.height() // 2))
    qtbot.waitUntil(lambda: audited(shown) is None and not shown.viewport.picture.interactive, timeout=60_000)
    assert shown.editor.scene == scene, "looking is no edit"


def audited(window: MainWindow) -> Any:
    """Return the audit of the full picture that is shown, if there is one."""
    picture = window.viewport.picture
    return None if picture is None or picture.interactive else picture.audit


def test_a_floor_lifts_the_shadows_and_is_never_silent(
    shown: MainWindow, hand_of: Any, qtbot: QtBot, said: list[str]
) -> None:
    user, row = hand_of(shown), shown.light_page.floor
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
    assert "casts no shadows" in row.toolTip()
    shown.editor.undo()
    assert row.isEnabled()
