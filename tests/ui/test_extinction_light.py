"""The section of `extinction` by hand: shells and cone angle change the picture; the cone goes back to the lamp's."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt

from sfumato import Light, Scene
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def lit(make_window: Any, ball_scene: Scene, hand_of: Any) -> MainWindow:
    """A window on the ball, lit by extinction."""
    scene = ball_scene.with_(technique="extinction", lights=(Light(tilt=45, aperture=8, rotation=135),))
    window: MainWindow = make_window(scene)
    window.light_page.own.set_open(True)
    hand_of(window).wait_for_picture()
    return window


def row(window: MainWindow, name: str) -> Any:
    """Return a control of the technique's section, scrolled to."""
    control = next(c for c in window.light_page.controls if c.name == name)
    window.panel.widget(0).ensureWidgetVisible(control)
    return control.control


def test_the_section_holds_what_matters(lit: MainWindow) -> None:
    page = lit.light_page
    assert page.own.header.text() == "Extinction-based light"
    shown = [c.name for c in page.controls if c.isVisible()]
    assert shown == ["Shells", "Cone angle", "Ambient", "Colour bleeding", "Highlights"]
    page.more.set_open(True)
    names = {c.name for c in page.controls if c.isVisible()}
    assert {"Shell radius", "Shadow strength", "Cone samples", "Section growth", "Narrow cones"} <= names


def test_shells_and_cone_angle_change_the_picture(lit: MainWindow, hand_of: Any, qtbot: QtBot) -> None:
    hand, editor = hand_of(lit), lit.editor
    before = hand.pixels()

    shells = row(lit, "Shells")
    hand.drag_slider(shells.slider, 5 / 12, 0.0)
    assert editor.scene.technique.shells == 0
    hand.wait_for_picture()
    bare = hand.pixels()
    assert (bare - before)[..., :3].mean() > 0.2, "without shells light from all around is not dimmed"
    shells.slider.setFocus()
    qtbot.keyClick(shells.slider, Qt.Key.Key_Right)
    assert editor.scene.technique.shells == 1
    editor.undo()

    cone = row(lit, "Cone angle")
    assert "from lamp" in cone.label.text()
    assert not cone.reset.isVisible()
    hand.drag_slider(cone.slider, 0.1, 0.7)
    assert editor.scene.technique.cone_angle > 30
    assert "from lamp" not in cone.label.text()
    hand.wait_for_picture()
    wide = hand.pixels()
    assert np.abs(wide - bare).mean() > 0.2, "a wide cone's shadow is soft"

    qtbot.mouseClick(cone.reset, LEFT)
    assert editor.scene.technique.cone_angle is None
    assert "from lamp" in cone.label.text()
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - bare).max() <= 1
