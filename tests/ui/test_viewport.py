"""The picture by hand: orbit, pan, zoom, the lamp, views by key, unlit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt

from sfumato_ui import camera_moves
from sfumato_ui.settings import settings
from sfumato_ui.window import HINT, MainWindow

SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier


def test_the_picture_has_its_share_of_the_window(window: MainWindow) -> None:
    window.resize(1280, 720)
    picture = window.viewport
    assert picture.width() * picture.height() >= 0.62 * 1280 * 720


def test_orbit_is_one_step_and_changes_the_picture(window: MainWindow, hand: Any) -> None:
    before, start = hand.pixels(), window.editor.scene.camera
    middle = window.viewport.rect().center()
    hand.drag(window.viewport, middle, middle + QPoint(90, 40))
    turned = window.editor.scene.camera
    assert turned != start
    assert turned.distance == pytest.approx(start.distance)
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - before).mean() > 1
    hand.press(Qt.Key.Key_Z, CTRL)
    assert window.editor.scene.camera == start
    assert not window.editor.document.undo_label
    hand.press(Qt.Key.Key_Z, CTRL, SHIFT)
    assert window.editor.scene.camera == turned


@pytest.mark.parametrize(
    ("button", "keys"), [(Qt.MouseButton.MiddleButton, None), (Qt.MouseButton.LeftButton, CTRL)]
)
def test_pan(window: MainWindow, hand: Any, button: Qt.MouseButton, keys: Qt.KeyboardModifier | None) -> None:
    start = window.editor.scene.camera
    middle = window.viewport.rect().center()
    none = Qt.KeyboardModifier.NoModifier
    hand.drag(window.viewport, middle, middle + QPoint(60, 0), button=button, keys=keys or none)
    moved = window.editor.scene.camera
    right = np.asarray(start.basis().right)
    expected = -60 / window.viewport.height() * 2 * camera_moves.picture_half_height(start)
    assert np.subtract(moved.focal_point, start.focal_point) @ right == pytest.approx(expected, rel=0.02)


def test_zoom_by_wheel_keys_and_drag(window: MainWindow, hand: Any) -> None:
    view = window.viewport
    sizes = [camera_moves.picture_half_height(window.editor.scene.camera)]

    def closer() -> bool:
        sizes.append(camera_moves.picture_half_height(window.editor.scene.camera))
        return sizes[-1] < sizes[-2]

    hand.wheel(view, at=QPoint(30, 30))
    assert closer()
    view.setFocus()
    hand.press(Qt.Key.Key_Plus)
    assert closer()
    middle = view.rect().center()
    hand.drag(view, middle, middle - QPoint(0, 40), button=Qt.MouseButton.RightButton)
    assert closer()
    hand.drag(view, middle, middle - QPoint(0, 40), keys=CTRL | SHIFT)
    assert closer()
    hand.press(Qt.Key.Key_Minus)
    assert not closer()


def test_shift_drag_moves_the_lamp_in_every_tool_and_the_hint_goes(
    window: MainWindow, hand: Any, make_window: Any
) -> None:
    assert window.viewport.hint == HINT
    before, camera = hand.pixels(), window.editor.scene.camera
    middle = window.viewport.rect().center()
    hand.drag(window.viewport, middle, middle + QPoint(150, 60), keys=SHIFT)
    light = window.editor.scene.lights[0]
    assert (light.tilt, light.rotation) != (37, 135)
    assert window.editor.scene.camera == camera
    assert window.editor.document.undo_label == "Move the light"
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - before).mean() > 0.2
    assert not window.viewport.hint
    assert settings().value("hint/light_seen", type=bool)
    assert not make_window().viewport.hint, "it stays away in the next window"


def test_the_light_tool_needs_the_left_button_alone(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    qtbot.mouseClick(window.strip.tools["light"], Qt.MouseButton.LeftButton)
    camera, light = window.editor.scene.camera, window.editor.scene.lights[0]
    middle = window.viewport.rect().center()
    hand.drag(window.viewport, middle, middle + QPoint(0, 50))
    assert window.editor.scene.lights[0] != light
    assert window.editor.scene.camera == camera
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_Escape)
    hand.drag(window.viewport, middle, middle + QPoint(0, 50))
    assert window.editor.scene.camera != camera


def test_arrow_keys_orbit_and_quick_ones_are_one_step(window: MainWindow, hand: Any) -> None:
    start = window.editor.scene.camera
    window.viewport.setFocus()
    for _ in range(4):
        hand.press(Qt.Key.Key_Right)
    turned = np.subtract(window.editor.scene.camera.position, start.focal_point)
    arm = np.subtract(start.position, start.focal_point)
    assert np.degrees(np.arccos(turned @ arm / (arm @ arm))) == pytest.approx(20, abs=0.1)
    hand.press(Qt.Key.Key_Z, CTRL)
    assert window.editor.scene.camera == start


@pytest.mark.parametrize(("key", "axis"), [(Qt.Key.Key_3, (1, 0, 0)), (Qt.Key.Key_5, (0, 0, 1))])
def test_standard_views_by_key(
    window: MainWindow, hand: Any, key: Qt.Key, axis: tuple[int, int, int]
) -> None:
    window.viewport.setFocus()
    hand.press(key)
    camera = window.editor.scene.camera
    assert np.asarray(camera.basis().back) == pytest.approx(axis, abs=1e-6)
    assert window.editor.document.undo_label.startswith("View from the")


def test_holding_b_shows_the_unlit_picture(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    lit = hand.pixels()
    window.viewport.setFocus()
    qtbot.keyPress(window.viewport, Qt.Key.Key_B)
    assert window.top.before.isDown()
    hand.wait_for_picture()
    assert window.viewport.picture.scene.technique_id == "raycast"
    assert np.abs(hand.pixels() - lit).mean() > 1
    qtbot.keyRelease(window.viewport, Qt.Key.Key_B)
    hand.wait_for_picture()
    assert not window.top.before.isDown()
    assert window.viewport.picture.scene.technique_id == window.editor.scene.technique_id != "raycast"
    assert not window.editor.document.modified, "looking is no edit"


def test_the_picture_follows_the_windows_size(window: MainWindow, hand: Any) -> None:
    window.resize(700, 520)
    hand.wait_for_picture()
    image = window.viewport.picture.image
    assert (image.width(), image.height()) == window.viewport.pixel_size
