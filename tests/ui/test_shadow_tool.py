"""The Shadow tool by hand: the lamp's shadow, or its highlight, follows the pointer over the surface."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QApplication

from sfumato import Light, Scene
from sfumato.scene.aiming import direction_in_effect, highlight_direction, shadow_ends
from sfumato.scene.picking import surface_under
from sfumato_ui.window import MainWindow

LEFT, ALT = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.AltModifier
CTRL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> MainWindow:
    """A window on ball and plate with the Shadow tool; its picture is not waited for."""
    window: MainWindow = make_window(
        ball_scene.with_(lights=(Light(aperture=5.0), Light(name="fill")), technique="raycast-phong"),
        size=(560, 460),
    )
    qtbot.waitExposed(window)
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    qtbot.keyClick(window.viewport, Qt.Key.Key_S)
    assert window.viewport.tool == "shadow"
    assert window.strip.tools["shadow"].isChecked()
    return window


@pytest.fixture
def user(shown: MainWindow, hand_of: Any) -> Any:
    return hand_of(shown)


def surface(window: MainWindow, at: QPoint) -> np.ndarray:
    view = window.viewport.view
    assert view is not None
    point = surface_under(window.editor.scene, *view.fractions((at.x(), at.y())), window.viewport.aspect)
    assert point is not None
    return np.asarray(point)


def ends(window: MainWindow) -> tuple[QPoint, QPoint]:
    """Return the picture's middle, which is on the ball, and a place on the plate beside it."""
    middle = window.viewport.rect().center()
    return middle, middle + QPoint(round(0.3 * window.viewport.height()), 60)


def towards(window: MainWindow, place: np.ndarray) -> np.ndarray:
    scene = window.editor.scene
    return direction_in_effect(scene, scene.lights[window.editor.selected], place)


def wanted(window: MainWindow, caster: QPoint, place: QPoint) -> np.ndarray:
    """Return the direction by which the surface at one place shadows what is seen at another."""
    view, p, q = window.viewport.view, surface(window, caster), surface(window, place)
    assert view is not None
    at = view.fractions((place.x(), place.y()))
    found = shadow_ends(window.editor.scene, p, q, at, window.viewport.aspect)
    assert found is not None
    assert float(found[0] @ (p - q)) > 0.995 * float(np.linalg.norm(p - q)), "nearly the surfaces' own"
    return found[0]


def test_the_shadow_follows_the_pointer_in_one_step(shown: MainWindow, user: Any) -> None:
    start, (caster, place) = shown.editor.scene, ends(shown)
    way, q = wanted(shown, caster, place), surface(shown, place)
    user.drag(shown.viewport, caster, place)
    np.testing.assert_allclose(towards(shown, q), way, atol=1e-6)
    assert shown.editor.scene.camera == start.camera
    assert shown.editor.scene.lights[1] == start.lights[1]
    assert shown.editor.document.undo_label == "Place the shadow"
    user.press(Qt.Key.Key_Z, CTRL)
    assert shown.editor.scene == start, "one drag is one step"


def test_its_ends_are_handles_until_the_lamp_is_moved_otherwise(shown: MainWindow, user: Any) -> None:
    caster, place = ends(shown)
    user.drag(shown.viewport, caster, place)
    tool, view = shown.viewport.tools["shadow"], shown.viewport.view
    assert view is not None
    assert [h.key for h in tool.handles(view)] == ["place", "caster"]
    other = place + QPoint(30, -50)
    user.drag(shown.viewport, place, other)
    np.testing.assert_allclose(towards(shown, surface(shown, other)), wanted(shown, caster, other), atol=1e-6)
    before = shown.editor.scene.lights[0]
    user.press(Qt.Key.Key_Right)
    assert shown.editor.scene.lights[0] != before
    moved = QPoint(round(other.x() + 0.01 * view.height), other.y())
    np.testing.assert_allclose(towards(shown, surface(shown, moved)), wanted(shown, caster, moved), atol=0.02)
    shown.editor.change_light("Move the light", tilt=10.0)
    assert tool.handles(view) == []


def test_by_keys_alone(shown: MainWindow, user: Any) -> None:
    start = shown.editor.scene
    user.press(Qt.Key.Key_PageDown)
    for _ in range(7):
        user.press(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert shown.editor.scene.camera == start.camera
    assert shown.editor.scene.lights[0] != start.lights[0]


@pytest.mark.parametrize("by_switch", [False, True])
def test_the_highlight_sits_where_it_is_dragged(
    shown: MainWindow, user: Any, qtbot: QtBot, by_switch: bool
) -> None:
    middle = shown.viewport.rect().center()
    bar = shown.viewport.shadow_bar
    assert bar.isVisible()
    if by_switch:
        shown.editor.change("Dull", **{"technique.specular": 0.0})
        qtbot.mouseClick(bar.highlight, LEFT)
        assert "Highlights are off" in bar.words.text()
    end = middle + QPoint(-15, -20)
    q = surface(shown, end)
    wanted = highlight_direction(shown.editor.scene, q)
    assert wanted is not None
    camera = shown.editor.scene.camera
    user.drag(shown.viewport, middle, end, keys=Qt.KeyboardModifier.NoModifier if by_switch else ALT)
    np.testing.assert_allclose(towards(shown, q), wanted, atol=1e-6)
    assert shown.editor.document.undo_label == "Place the highlight"
    assert shown.editor.scene.camera == camera


def test_where_no_lamp_can_do_it_the_nearest_shines_and_the_bar_says_so(shown: MainWindow, user: Any) -> None:
    bar, middle = shown.viewport.shadow_bar, shown.viewport.rect().center()
    assert "Drag from" in bar.words.text()
    # From the ball's one side to its other: light from beside the subject.
    user.drag(shown.viewport, middle - QPoint(40, 0), middle + QPoint(40, 0))
    assert "nearest" in bar.words.text()
    assert "off" in bar.words.text()
    lamp = shown.editor.scene.lights[0]
    assert lamp.tilt == pytest.approx(84) or lamp.tilt == pytest.approx(96)
    user.drag(shown.viewport, *ends(shown))
    assert "Drag from" in bar.words.text()


def test_beside_the_subject_a_drag_turns_it(shown: MainWindow, user: Any) -> None:
    shown.editor.change("Crop", **{"crop.high": (1.0, 0.8, 1.0)})
    start = shown.editor.scene
    user.drag(shown.viewport, QPoint(12, 12), QPoint(60, 12))
    assert shown.editor.scene.lights == start.lights
    assert shown.editor.scene.camera != start.camera


def test_the_bar_says_why_nothing_would_be_seen(shown: MainWindow, qtbot: QtBot) -> None:
    bar = shown.viewport.shadow_bar
    shown.editor.change("Mute", **{"lights.0.enabled": False})
    assert "does not shine" in bar.words.text()
    shown.editor.change("Technique", technique="raycast")
    assert "without light" in bar.words.text()
    for theme in ("light", "dark"):
        shown.set_theme(theme)
        QApplication.processEvents()
        assert bar.geometry().right() < shown.viewport.width()
        assert bar.words.height() >= bar.words.heightForWidth(bar.words.width())
    qtbot.keyClick(shown.viewport, Qt.Key.Key_Escape)
    assert not bar.isVisible()
