"""The tools of the picture by hand: lamps on their hemisphere, double-click, cursors, keys."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QEvent, QPoint, QPointF, Qt
from qtpy.QtGui import QMouseEvent
from qtpy.QtWidgets import QApplication, QWidget

from sfumato import Light, Scene
from sfumato.scene.picking import surface_under
from sfumato_ui import camera_moves
from sfumato_ui.lamp_places import moved, seen_angles
from sfumato_ui.tools import PictureView
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier
TWO = (Light(), Light(name="fill", tilt=45.0, rotation=350.0, aperture=35.0))


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> MainWindow:
    """A window on the ball with two lamps; its picture is not waited for."""
    window: MainWindow = make_window(ball_scene.with_(lights=TWO))
    qtbot.waitExposed(window)
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    return window


@pytest.fixture
def user(shown: MainWindow, hand_of: Any) -> Any:
    return hand_of(shown)


def handle_at(window: MainWindow, key: str) -> QPoint:
    """Return where a handle of the active tool is."""
    view = window.viewport.view
    assert view is not None
    place = next(h.at for h in window.viewport.tools[window.viewport.tool].handles(view) if h.key == key)
    return QPoint(round(place[0]), round(place[1]))


def hover(widget: QWidget, at: QPoint) -> None:
    """Move the pointer with no button down."""
    none = Qt.MouseButton.NoButton
    where = QPointF(at), QPointF(widget.mapToGlobal(at))
    event = QMouseEvent(QEvent.Type.MouseMove, *where, none, none, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(widget, event)


def test_exactly_one_tool_is_active(shown: MainWindow, user: Any, qtbot: QtBot) -> None:
    for name, button in shown.strip.tools.items():
        qtbot.mouseClick(button, LEFT)
        assert shown.viewport.tool == name
        assert [n for n, b in shown.strip.tools.items() if b.isChecked()] == [name]
    shown.viewport.setFocus()
    for key, name in ((Qt.Key.Key_L, "light"), (Qt.Key.Key_C, "clip"), (Qt.Key.Key_Escape, "orbit")):
        user.press(key)
        assert shown.viewport.tool == name


def test_a_lamp_is_selected_and_follows_the_pointer(shown: MainWindow, user: Any) -> None:
    shown.strip.choose("light")
    start, camera = handle_at(shown, "lamp.1"), shown.editor.scene.camera
    user.drag(shown.viewport, start, start + QPoint(-40, 30))
    assert shown.editor.selected == 1
    at = handle_at(shown, "lamp.1") - (start + QPoint(-40, 30))
    assert at.manhattanLength() <= 2, "the lamp is where the pointer let it go"
    assert shown.editor.scene.lights[0] == TWO[0]
    assert shown.editor.scene.camera == camera
    assert shown.editor.document.undo_label == "Move the light"
    user.press(Qt.Key.Key_Z, CTRL)
    assert shown.editor.scene.lights == TWO, "one step"


def test_a_lamp_far_outside_shines_from_behind(shown: MainWindow, user: Any) -> None:
    shown.strip.choose("light")
    view, start = shown.viewport, handle_at(shown, "lamp.0")
    user.drag(view, start, QPoint(view.width() // 2, 4))
    assert shown.editor.scene.lights[0].tilt > 110
    assert shown.editor.scene.lights[0].rotation == pytest.approx(90, abs=2)


def test_keys_move_and_change_the_lamp(shown: MainWindow, user: Any) -> None:
    shown.strip.choose("light")
    shown.viewport.setFocus()
    before = handle_at(shown, "lamp.0")
    user.press(Qt.Key.Key_Right)
    user.press(Qt.Key.Key_Right, SHIFT)
    assert handle_at(shown, "lamp.0").x() > before.x() + 10
    user.press(Qt.Key.Key_PageDown)
    assert shown.editor.selected == 1
    user.press(Qt.Key.Key_PageUp)
    assert shown.editor.selected == 0


def test_cursors_say_what_can_be_done(shown: MainWindow) -> None:
    view = shown.viewport
    assert view.cursor().shape() == Qt.CursorShape.OpenHandCursor
    shown.strip.choose("light")
    hover(view, QPoint(20, 20))
    assert view.cursor().shape() == Qt.CursorShape.CrossCursor
    at = handle_at(shown, "lamp.0")
    for offset, hit in ((QPoint(12, 0), True), (QPoint(0, -12), True), (QPoint(40, -40), False)):
        hover(view, at + offset)
        assert (view.tools["light"].hovered == "lamp.0") == hit, "the hit radius is at least 12 pixels"
    hover(view, at)
    assert view.cursor().shape() == Qt.CursorShape.SizeAllCursor


def test_a_patients_lamp_moves_as_it_is_seen(ball_scene: Scene) -> None:
    camera = camera_moves.from_side(ball_scene.camera, "left")  # type: ignore[arg-type]
    lamp = Light(attached="patient", tilt=130.0, rotation=10.0, aperture=5.0)
    scene = ball_scene.with_(camera=camera, lights=(lamp,))
    for dx, dy in ((0.1, 0.0), (0.0, -0.1)):
        tilt, rotation = (math.radians(a) for a in seen_angles(scene, lamp))
        changed = scene.with_(**{f"lights.0.{k}": v for k, v in moved(scene, lamp, dx, dy).items()})
        after = [math.radians(a) for a in seen_angles(changed, changed.lights[0])]
        step = [math.sin(after[0]) * f(after[1]) - math.sin(tilt) * f(rotation) for f in (math.cos, math.sin)]
        assert step == pytest.approx((dx, dy), abs=0.02)


def test_a_point_lamp_keeps_its_distance(ball_scene: Scene) -> None:
    target = np.asarray(ball_scene.volume.center)  # type: ignore[union-attr]
    lamp = Light(kind="point", position=tuple(target + np.array([0.0, -100.0, 0.0])), radius=2.0)
    scene = ball_scene.with_(lights=(lamp,))
    fields = moved(scene, lamp, 0.5, 0.0)
    away = np.asarray(fields["position"]) - target
    assert np.linalg.norm(away) == pytest.approx(100)
    assert away @ np.asarray(scene.camera.basis().right) == pytest.approx(50)  # type: ignore[union-attr]


@pytest.mark.parametrize("tool", ["orbit", "light", "clip"])
def test_double_click_centres_the_surface_under_the_cursor(
    shown: MainWindow, user: Any, qtbot: QtBot, tool: str
) -> None:
    shown.strip.choose(tool)
    view = shown.viewport
    at = QPoint(view.width() // 2 + 37, view.height() // 2 - 41)
    aspect = view.width() / view.height()
    start = shown.editor.scene
    expected = surface_under(start, 2 * at.x() / view.width() - 1, 1 - 2 * at.y() / view.height(), aspect)
    assert expected is not None
    qtbot.mousePress(view, LEFT, pos=at)
    qtbot.mouseRelease(view, LEFT, pos=at)
    qtbot.mouseDClick(view, LEFT, pos=at)
    camera = shown.editor.scene.camera
    assert camera.focal_point == pytest.approx(expected)
    assert camera.distance == pytest.approx(start.camera.distance)
    assert camera.basis() == start.camera.basis()
    centre = PictureView(camera, view.width(), view.height()).place(np.array(expected))
    assert centre == pytest.approx((view.width() / 2, view.height() / 2))
    user.press(Qt.Key.Key_Z, CTRL)
    assert shown.editor.scene == start, "one step, and nothing but that"


def test_double_click_on_nothing_changes_nothing(shown: MainWindow, qtbot: QtBot) -> None:
    start = shown.editor.scene
    shown.look("left")
    aside = shown.editor.scene
    assert aside != start
    qtbot.mouseDClick(shown.viewport, LEFT, pos=QPoint(3, 3))
    assert shown.editor.scene == aside


def test_ctrl_and_arrows_pan(shown: MainWindow, user: Any) -> None:
    start = shown.editor.scene.camera
    user.press(Qt.Key.Key_Right, CTRL)
    camera = shown.editor.scene.camera
    shift = np.subtract(camera.focal_point, start.focal_point)
    assert shift @ np.asarray(start.basis().right) < 0, "the subject goes to the right"
    assert shown.editor.document.undo_label == "Pan"


def test_places_and_rays_belong_together(ball_scene: Scene) -> None:
    camera = camera_moves.orbit(ball_scene.camera, 25, 15)  # type: ignore[arg-type]
    for parallel in (False, True):
        view = PictureView(camera_moves.with_projection(camera, parallel), 700, 400)
        for point in (np.array([3.0, 10.0, 33.0]), np.array([30.0, 2.0, 7.0])):
            place = view.place(point)
            assert place is not None
            start, along = view.ray(place)
            assert np.linalg.norm(np.cross(point - start, along)) < 1e-6


def test_what_is_behind_the_eye_has_no_place(ball_scene: Scene) -> None:
    view = PictureView(ball_scene.camera, 700, 400)  # type: ignore[arg-type]
    basis = view.camera.basis()
    behind = np.asarray(view.camera.position) + 10 * np.asarray(basis.back)
    assert view.place(behind) is None
    segment = view.segment(behind, np.asarray(view.camera.focal_point))
    assert segment is not None
    assert np.isfinite(segment).all()
    assert view.segment(behind, behind + np.asarray(basis.right)) is None
