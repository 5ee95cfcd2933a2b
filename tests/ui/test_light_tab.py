"""The Light tab by hand: every control changes the document and the picture, in one step of the history."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt

from sfumato_ui.window import MainWindow


@pytest.mark.parametrize(
    ("name", "field"),
    [("tilt", "tilt"), ("rotation", "rotation"), ("aperture", "aperture")],
)
def test_dragging_a_slider(window: MainWindow, hand: Any, qtbot: QtBot, name: str, field: str) -> None:
    row = getattr(window.light_page, name)
    before, start = hand.pixels(), getattr(window.editor.scene.lights[0], field)
    hand.drag_slider(row.slider, 0.2, 0.45)
    after = getattr(window.editor.scene.lights[0], field)
    assert after != start
    assert row.number.value() == pytest.approx(after, abs=0.06)
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - before).mean() > 0.2
    qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert getattr(window.editor.scene.lights[0], field) == start, "one drag is one step"
    assert not window.editor.document.undo_label
    qtbot.keyClick(
        window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    )
    assert getattr(window.editor.scene.lights[0], field) == after


def test_the_tilt_slider_skips_what_the_aperture_forbids(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    slider, editor = window.light_page.tilt.slider, window.editor
    tilts = []
    editor.changed.connect(lambda old, new: tilts.append(new.lights[0].tilt))
    hand.drag_slider(slider, 0.0, 1.0, steps=60)
    assert tilts[-1] == pytest.approx(180, abs=0.1)
    assert any(t <= 69 for t in tilts)
    assert all(t <= 69 or t >= 111 for t in tilts)


def test_softness_stops_where_the_tilt_says(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    hand.drag_slider(window.light_page.aperture.slider, 0.2, 1.0)
    light = window.editor.scene.lights[0]
    assert light.aperture == pytest.approx(89 - light.tilt)


def test_typing_a_number_and_resetting_it(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    row = window.light_page.tilt
    qtbot.mouseDClick(row.number, Qt.MouseButton.LeftButton)
    row.number.selectAll()
    qtbot.keyClicks(row.number, "52")
    qtbot.keyClick(row.number, Qt.Key.Key_Return)
    assert window.editor.scene.lights[0].tilt == 52
    qtbot.keyClick(row.number, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert window.editor.scene.lights[0].tilt == 37, "Ctrl+Z is the document's, even in a number"
    window.editor.redo()
    assert row.reset.isVisible()
    qtbot.mouseClick(row.reset, Qt.MouseButton.LeftButton)
    assert window.editor.scene.lights[0].tilt == 37
    qtbot.keyClick(row.slider, Qt.Key.Key_Right)
    assert window.editor.scene.lights[0].tilt == pytest.approx(38, abs=0.05)
    qtbot.mouseDClick(row.label, Qt.MouseButton.LeftButton)
    assert window.editor.scene.lights[0].tilt == 37


def test_the_wheel_changes_only_the_focused_control(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    start = window.editor.scene
    page = window.light_page
    window.viewport.setFocus()
    for widget in (page.dial, page.tilt.slider, page.tilt.number, page.technique):
        hand.wheel(widget)
    assert window.editor.scene == start
    page.tilt.slider.setFocus()
    hand.wheel(page.tilt.slider)
    assert window.editor.scene.lights[0].tilt == pytest.approx(38, abs=0.05)
    page.dial.setFocus()
    hand.wheel(page.dial)
    assert window.editor.scene.lights[0].intensity == pytest.approx(1.05)


def test_dragging_the_lamp_on_the_dial(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    dial = window.light_page.dial
    before = hand.pixels()
    start = dial.lamp_point(window.editor.scene.lights[0]).toPoint()
    hand.drag(dial, start, start + QPoint(50, 45))
    light = window.editor.scene.lights[0]
    assert light.rotation > 270
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - before).mean() > 0.5
    assert window.editor.document.undo_label == "Move the light"
    window.editor.undo()
    assert window.editor.scene.lights[0].rotation == 135
    assert not window.editor.document.undo_label


def test_the_ring_holds_lights_behind_the_subject(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    dial = window.light_page.dial
    start = dial.lamp_point(window.editor.scene.lights[0]).toPoint()
    edge = dial.rect().center() + QPoint(round(dial.radius * 1.2), 0)
    hand.drag(dial, start, edge)
    light = window.editor.scene.lights[0]
    assert light.tilt > 111
    assert light.rotation % 360 == pytest.approx(0, abs=3) or light.rotation % 360 > 357


def test_the_handle_of_the_cone_is_the_softness(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    dial = window.light_page.dial
    light = window.editor.scene.lights[0]
    handle, lamp = dial.handle_point(light), dial.lamp_point(light)
    outwards = handle + (handle - lamp) * 0.8
    hand.drag(dial, handle.toPoint(), outwards.toPoint())
    assert window.editor.scene.lights[0].aperture > 25
    assert window.editor.scene.lights[0].tilt == light.tilt


def test_arrow_keys_nudge_the_lamp(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    dial = window.light_page.dial
    dial.setFocus()
    qtbot.keyClick(dial, Qt.Key.Key_Up)
    qtbot.keyClick(dial, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
    light = window.editor.scene.lights[0]
    assert (light.tilt, light.rotation) == (38, 145)
    assert "tilt 38°" in dial.accessibleDescription()
    for _ in range(60):
        qtbot.keyClick(dial, Qt.Key.Key_Up)
    assert window.editor.scene.lights[0].tilt > 111, "the keys step over the forbidden band"


def test_choosing_a_technique_opens_its_section(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    page = window.light_page
    assert not page.own.body.isVisible()
    page.technique.setFocus()
    while window.editor.scene.technique_id != "raycast-phong":
        qtbot.keyClick(page.technique, Qt.Key.Key_Down)
    assert page.own.header.text() == "Ray casting, Phong"
    assert page.own.body.isVisible()
    names = {control.name: control for control in page.controls}
    assert {"Ambient", "Diffuse", "Specular", "Shininess"} <= set(names)
    window.panel.widget(0).ensureWidgetVisible(names["Ambient"])
    hand.drag_slider(names["Ambient"].control.slider, 0.15, 0.6)
    assert window.editor.scene.technique.ambient == pytest.approx(0.6, abs=0.05)
    hand.wait_for_picture()


def test_generated_controls_tell_range_and_go_back_to_the_default(window: MainWindow, qtbot: QtBot) -> None:
    page, editor = window.light_page, window.editor
    editor.change("Choose the technique", technique="multidirectional")
    page.more.set_open(True)
    page.own.set_open(True)
    names = {control.name: control for control in page.controls}
    assert "From 0 to 1" in names["Ambient"].control.toolTip()
    assert "texel/voxel" in next(c for c in page.controls if c.field.name == "resolution").control.toolTip()
    falloff = next(c for c in page.controls if c.field.name == "falloff")
    assert not falloff.reset.isVisible()
    start = editor.scene.technique.falloff
    editor.change("Falloff", **{"technique.falloff": "gaussian" if start == "linear" else "linear"})
    assert falloff.reset.isVisible()
    window.panel.widget(0).ensureWidgetVisible(falloff)
    qtbot.mouseClick(falloff.reset, Qt.MouseButton.LeftButton)
    assert editor.scene.technique.falloff == start
    assert not falloff.reset.isVisible()
