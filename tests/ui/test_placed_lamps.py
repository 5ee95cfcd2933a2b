"""Lamps that stand somewhere, by hand: made, dragged over the subject, aimed, typed, turned; each one step back."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QApplication

from sfumato import Light, Scene
from sfumato.scene.picking import surface_under
from sfumato_ui.lamp_places import KINDS, as_kind, diagonal_of, kind_of, middle_of, rotation_between
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier
#: Before the ball, beside it as the eye sees it.
POINT = Light(kind="point", position=(12.0, 2.0, 28.0), radius=1.0, name="bulb")
SPOT = Light(kind="spot", position=(12.0, 2.0, 28.0), direction=(1.0, 1.0, -1.0), name="beam")


@pytest.fixture
def shown(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> MainWindow:
    """A window with a point lamp; its picture is not waited for."""
    window: MainWindow = make_window(ball_scene.with_(lights=(POINT, Light(name="key"))))
    qtbot.waitExposed(window)
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    return window


@pytest.fixture
def user(shown: MainWindow, hand_of: Any) -> Any:
    return hand_of(shown)


def handle_at(window: MainWindow, key: str) -> QPoint:
    view = window.viewport.view
    assert view is not None
    place = next(h.at for h in window.viewport.tools["light"].handles(view) if h.key == key)
    return QPoint(round(place[0]), round(place[1]))


def lamp(window: MainWindow) -> Light:
    return window.editor.scene.lights[0]


def surface_at(window: MainWindow, at: QPoint) -> np.ndarray | None:
    view = window.viewport.view
    assert view is not None
    point = surface_under(window.editor.scene, *view.fractions((at.x(), at.y())), window.viewport.aspect)
    return None if point is None else np.asarray(point)


def test_a_dragged_lamp_floats_before_what_is_under_the_pointer(shown: MainWindow, user: Any) -> None:
    shown.strip.choose("light")
    middle = shown.viewport.rect().center()
    camera = shown.editor.scene.camera
    user.drag(shown.viewport, handle_at(shown, "lamp.0"), middle)
    surface, place = surface_at(shown, middle), np.asarray(lamp(shown).position)
    assert surface is not None
    view = shown.viewport.view
    assert view is not None
    off = place - surface
    assert 1.0 < np.linalg.norm(off) < 1.0 + 0.02 * diagonal_of(shown.editor.scene), "its radius and a little"
    assert off @ view.ray((middle.x(), middle.y()))[1] < 0, "towards the viewer"
    assert (handle_at(shown, "lamp.0") - middle).manhattanLength() <= 2
    assert shown.editor.scene.camera == camera
    assert shown.editor.document.undo_label == "Move the light"
    user.press(Qt.Key.Key_Z, CTRL)
    assert lamp(shown) == POINT, "one drag is one step"


def test_beside_the_subject_a_lamp_keeps_its_depth(shown: MainWindow, user: Any) -> None:
    clip = shown.editor.scene.crop
    # Nothing but the ball: the plate behind it is cut away.
    shown.editor.change("Crop", crop=type(clip)(clip.low, (1.0, 0.8, 1.0)))
    shown.strip.choose("light")
    view = shown.viewport.view
    assert view is not None
    depth = view.depth(np.asarray(POINT.position))
    corner = QPoint(30, 40)
    assert surface_at(shown, corner) is None
    user.drag(shown.viewport, handle_at(shown, "lamp.0"), corner)
    assert view.depth(np.asarray(lamp(shown).position)) == pytest.approx(depth)
    assert (handle_at(shown, "lamp.0") - corner).manhattanLength() <= 2


def test_a_lamp_inside_stays_as_deep_inside(shown: MainWindow, user: Any) -> None:
    inside = (19.5, 14.0, 19.5)
    shown.editor.change("Place", **{"lights.0.position": inside})
    shown.strip.choose("light")
    start = handle_at(shown, "lamp.0")
    before = surface_at(shown, start)
    assert before is not None
    user.drag(shown.viewport, start, start + QPoint(20, 10))
    after = surface_at(shown, start + QPoint(20, 10))
    assert after is not None
    deep = [np.linalg.norm(np.subtract(p, s)) for p, s in ((inside, before), (lamp(shown).position, after))]
    assert deep[1] == pytest.approx(deep[0], rel=0.05)


def test_the_wheel_moves_the_lamp_along_the_view(shown: MainWindow, user: Any) -> None:
    shown.strip.choose("light")
    view, camera = shown.viewport.view, shown.editor.scene.camera
    assert view is not None
    at = handle_at(shown, "lamp.0")
    before = view.depth(np.asarray(lamp(shown).position))
    user.wheel(shown.viewport, 2, at)
    assert view.depth(np.asarray(lamp(shown).position)) > before + 1
    assert (handle_at(shown, "lamp.0") - at).manhattanLength() <= 2, "it stays under the pointer"
    assert shown.editor.scene.camera == camera
    user.wheel(shown.viewport, 1, QPoint(20, 20))
    assert shown.editor.scene.camera != camera, "elsewhere the wheel zooms"


def test_the_handle_beside_it_moves_it_away_and_nearer(shown: MainWindow, user: Any) -> None:
    shown.strip.choose("light")
    view, start = shown.viewport.view, handle_at(shown, "depth.0")
    assert view is not None
    depth = view.depth(np.asarray(POINT.position))
    user.drag(shown.viewport, start, start - QPoint(0, 60))
    assert view.depth(np.asarray(lamp(shown).position)) > depth + 2
    user.press(Qt.Key.Key_Z, CTRL)
    assert lamp(shown) == POINT
    start = handle_at(shown, "depth.0")
    user.drag(shown.viewport, start, start + QPoint(0, 60))
    assert view.depth(np.asarray(lamp(shown).position)) < depth - 2


def test_shift_drag_moves_it_in_every_tool(shown: MainWindow, user: Any) -> None:
    for tool in ("orbit", "light", "clip"):
        shown.strip.choose(tool)
        start = handle_at(shown, "lamp.0")
        camera, scene = shown.editor.scene.camera, shown.editor.scene
        user.drag(shown.viewport, start + QPoint(60, 60), start + QPoint(90, 40), keys=SHIFT)
        assert (handle_at(shown, "lamp.0") - (start + QPoint(30, -20))).manhattanLength() <= 2, tool
        assert shown.editor.scene.camera == camera
        shown.editor.undo()
        assert shown.editor.scene == scene, "one step"


def test_keys_nudge_it_across_and_along_the_view(shown: MainWindow, user: Any) -> None:
    shown.strip.choose("light")
    shown.viewport.setFocus()
    view, start = shown.viewport.view, handle_at(shown, "lamp.0")
    assert view is not None
    user.press(Qt.Key.Key_Right)
    user.press(Qt.Key.Key_Up, SHIFT)
    moved = handle_at(shown, "lamp.0") - start
    assert moved.x() == pytest.approx(0.01 * view.height, abs=1.5)
    assert moved.y() == pytest.approx(-0.05 * view.height, abs=1.5)
    depth = view.depth(np.asarray(lamp(shown).position))
    user.press(Qt.Key.Key_PageDown)
    user.press(Qt.Key.Key_Up)
    assert view.depth(np.asarray(lamp(shown).position)) > depth
    user.press(Qt.Key.Key_PageDown)
    assert shown.editor.selected == 1, "after its handles comes the next lamp"
    user.press(Qt.Key.Key_PageUp)
    assert shown.editor.selected == 0
    shown.strip.choose("orbit")
    shown.viewport.setFocus()
    before = lamp(shown).position
    user.press(Qt.Key.Key_Left, SHIFT)
    assert lamp(shown).position != before


def test_a_spot_is_aimed_at_what_is_under_the_pointer(shown: MainWindow, user: Any) -> None:
    shown.editor.change("Light", lights=(SPOT,))
    shown.strip.choose("light")
    middle = shown.viewport.rect().center()
    user.drag(shown.viewport, handle_at(shown, "aim.0"), middle)
    surface = surface_at(shown, middle)
    assert surface is not None
    wanted = surface - np.asarray(SPOT.position)
    np.testing.assert_allclose(lamp(shown).direction, wanted / np.linalg.norm(wanted), atol=0.02)
    assert lamp(shown).position == SPOT.position
    assert shown.editor.document.undo_label == "Aim the lamp"
    before = lamp(shown).direction
    user.press(Qt.Key.Key_Left)
    assert lamp(shown).direction != before, "what was taken last is what the arrows move"
    shown.editor.undo()
    shown.editor.undo()
    assert lamp(shown) == SPOT


def test_a_lamp_outside_the_picture_can_be_taken_at_its_edge(shown: MainWindow, user: Any) -> None:
    for place in ((500.0, 0.0, 20.0), (20.0, -500.0, 25.0)):
        shown.editor.change("Place", **{"lights.0.position": place})
        shown.strip.choose("light")
        at = handle_at(shown, "lamp.0")
        assert shown.viewport.rect().contains(at)
        middle = shown.viewport.rect().center()
        user.drag(shown.viewport, at, middle)
        assert (handle_at(shown, "lamp.0") - middle).manhattanLength() <= 2


# -- the panel ----------------------------------------------------------------------------------------
def test_a_place_is_typed_in_patient_millimetres(shown: MainWindow, qtbot: QtBot) -> None:
    page = shown.light_page
    row = page.place.place
    assert row.isVisible()
    assert not page.tilt.isVisible()
    assert [label.text() for label in row.labels] == ["Left, mm", "Back, mm", "Top, mm"]
    assert row.values == POINT.position
    box = row.numbers[1]
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "-12.5")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert lamp(shown).position == (12.0, -12.5, 28.0)
    qtbot.keyClick(box, Qt.Key.Key_Up)
    assert lamp(shown).position == (12.0, -11.5, 28.0)
    shown.editor.undo()
    assert row.values == POINT.position
    qtbot.mouseClick(page.lamps.chips[1], LEFT)
    assert page.tilt.isVisible()
    assert not row.isVisible()


def test_the_dial_turns_it_about_the_subject(shown: MainWindow, user: Any) -> None:
    dial, scene = shown.light_page.dial, shown.editor.scene
    middle = middle_of(scene)
    start = dial.lamp_point(lamp(shown)).toPoint()
    user.drag(dial, start, start + QPoint(25, 20))
    arms = [np.linalg.norm(np.asarray(p) - middle) for p in (POINT.position, lamp(shown).position)]
    assert lamp(shown).position != POINT.position
    assert arms[1] == pytest.approx(arms[0])
    assert (dial.lamp_point(lamp(shown)).toPoint() - (start + QPoint(25, 20))).manhattanLength() <= 3
    shown.editor.undo()
    assert lamp(shown) == POINT
    dial.setFocus()
    user.press(Qt.Key.Key_Left)
    assert np.linalg.norm(np.asarray(lamp(shown).position) - middle) == pytest.approx(arms[0])


def test_kinds_become_each_other_and_back(shown: MainWindow, qtbot: QtBot) -> None:
    tools = shown.light_page.tools
    assert tools.kind.isVisible()
    offered = [tools.kind.itemData(i) for i in range(tools.kind.count())]
    assert "directional" in offered
    assert "point" in offered
    dial = shown.light_page.dial
    seen = dial.place(dial.lamp_point(lamp(shown)))
    tools.kind.setFocus()
    qtbot.keyClick(tools.kind, Qt.Key.Key_Up)
    assert lamp(shown).kind == "directional"
    assert math.dist(dial.place(dial.lamp_point(lamp(shown))), seen) < 1e-6, "it shines from where it stood"
    shown.editor.undo()
    assert lamp(shown) == POINT


def test_every_kind_from_every_other(ball_scene: Scene) -> None:
    """A new lamp with a place stands just outside the box, towards the old direction, and shines to the middle."""
    scene = ball_scene
    assert scene.camera is not None
    for start in KINDS:
        first = Light(**as_kind(scene, Light(), start) or {})
        for wanted in KINDS:
            fields = as_kind(scene, first, wanted)
            made = scene.with_({f"lights.0.{n}": getattr(first, n) for n in fields} | {})
            made = scene.with_(lights=(first,)).with_({f"lights.0.{n}": v for n, v in fields.items()})
            assert kind_of(made.lights[0]) == wanted
            if first.placed and wanted.kind != "directional":
                assert made.lights[0].position == first.position
    for kind in KINDS[1:]:
        made = scene.with_({f"lights.0.{n}": v for n, v in as_kind(scene, Light(tilt=60), kind).items()})
        place, new = np.asarray(made.lights[0].position), made.lights[0]
        towards = Light(tilt=60).towards(scene.camera.basis(), tuple(middle_of(scene)))
        away = place - middle_of(scene)
        np.testing.assert_allclose(away / np.linalg.norm(away), towards, atol=1e-9)
        outside = np.maximum(place - 40, 0 - place).max()
        assert 0 < outside < 0.2 * diagonal_of(scene)
        if new.needs_direction:
            np.testing.assert_allclose(new.direction, -towards, atol=1e-9)


def test_rotations_turn_one_vector_into_another() -> None:
    rng = np.random.default_rng(1)
    for a, b in [*rng.normal(size=(20, 2, 3)), np.array([[0, 0, 1], [0, 0, -1]]), np.array([[1, 0, 0]] * 2)]:
        a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
        m = rotation_between(a, b)
        np.testing.assert_allclose(m @ a, b, atol=1e-9)
        np.testing.assert_allclose(m @ m.T, np.eye(3), atol=1e-9)


def test_reach_is_everywhere_until_it_is_set(shown: MainWindow, user: Any, qtbot: QtBot) -> None:
    page = shown.light_page
    page.more.set_open(True)
    QApplication.processEvents()
    reach = page.lamp_more.reach
    page.ensureWidgetVisible(reach)
    assert reach.label.text() == "Reach · everywhere"
    assert reach.number.text().startswith("–")
    assert not reach.reset.isVisible()
    user.drag_slider(reach.slider, 0.2, 0.5)
    value = lamp(shown).reach
    assert value is not None
    assert value > 0
    assert reach.label.text() == "Reach"
    assert reach.number.value() == pytest.approx(value, abs=0.06)
    qtbot.mouseClick(reach.reset, LEFT)
    assert lamp(shown).reach is None
    shown.editor.undo()
    assert lamp(shown).reach == value
    shown.editor.undo()
    assert lamp(shown).reach is None


def test_what_each_kind_has_is_shown(shown: MainWindow) -> None:
    page = shown.light_page
    page.more.set_open(True)
    shape = {
        "point": (False, False, False, False, False),
        "spot": (True, False, False, True, False),
        "rectangle": (False, True, False, True, True),
        "sphere": (False, False, False, False, False),
        "tube": (False, False, True, False, True),
    }
    for kind in KINDS[1:]:
        shown.editor.change_light("Kind", **as_kind(shown.editor.scene, lamp(shown), kind))
        QApplication.processEvents()
        rows = (page.form.beam, page.form.sides, page.form.length, page.lamp_more.aim, page.lamp_more.axis)
        assert tuple(row.isVisible() for row in rows) == shape[kind.id], kind.id
        assert not page.attached.isEnabled(), "it stays where it is"


def test_a_rectangle_is_sized_and_a_direction_of_no_length_refused(shown: MainWindow, qtbot: QtBot) -> None:
    shown.editor.change_light("Kind", **as_kind(shown.editor.scene, lamp(shown), KINDS[3]))
    page = shown.light_page
    page.more.set_open(True)
    width = page.form.sides.numbers[0]
    width.setFocus()
    width.selectAll()
    qtbot.keyClicks(width, "7.5")
    qtbot.keyClick(width, Qt.Key.Key_Return)
    assert lamp(shown).size[0] == 7.5
    shown.editor.change_light("Aim", direction=(1.0, 0.0, 0.0))
    aim = page.lamp_more.aim.numbers[0]
    aim.setFocus()
    aim.selectAll()
    qtbot.keyClicks(aim, "0")
    qtbot.keyClick(aim, Qt.Key.Key_Return)
    assert lamp(shown).direction == (1.0, 0.0, 0.0)
    assert aim.value() == 1.0


def test_many_lamps_stand_in_rows_and_change_places(
    make_window: Any, ball_scene: Scene, hand_of: Any
) -> None:
    lights = tuple(Light(name=f"lamp {i}") for i in range(10))
    window = make_window(ball_scene.with_(lights=lights))
    QApplication.processEvents()
    row = window.light_page.lamps
    tops = [chip.geometry().top() for chip in row.chips]
    assert [tops.count(top) for top in sorted(set(tops))] == [4, 4, 2]
    assert max(chip.geometry().right() for chip in row.chips) < row.width()
    hand_of(window).drag(
        row.chips[9], row.chips[9].rect().center(), row.chips[9].mapFrom(row, row.chips[1].pos())
    )
    names = [light.name for light in window.editor.scene.lights]
    assert names == ["lamp 0", "lamp 9", *(f"lamp {i}" for i in range(1, 9))]
    window.editor.undo()
    assert window.editor.scene.lights == lights
    assert not row.add.isEnabled()
    assert "4 of 10" in window.light_page.note.text()


def test_placed_lamps_survive_file_undo_and_rigs(shown: MainWindow, qtbot: QtBot) -> None:
    scene = shown.editor.scene
    assert Scene.from_json(json.loads(json.dumps(scene.to_json())), scene.volume) == scene
    assert "parallel light" in shown.light_page.note.text(), "cone knows parallel light alone"
    shown.light_page.rigs.buttons["three-point"].click()
    assert all(not light.placed for light in shown.editor.scene.lights)
    shown.editor.undo()
    assert shown.editor.scene.lights == scene.lights
