"""Clip planes and crop box: handles in the picture, controls in the View tab, both on one scene."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt

from sfumato import Scene, Volume, VolumeInfo
from sfumato.scene import MAX_CLIP_PLANES, ClipPlane
from sfumato_ui import camera_moves
from sfumato_ui.clip_planes import axes_of, unit
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier


@pytest.fixture(params=[False, True], ids=["perspective", "orthographic"])
def oblique(request: pytest.FixtureRequest, ball_scene: Scene) -> Scene:
    """The ball seen obliquely, so that no face looks at the eye."""
    camera = camera_moves.orbit(ball_scene.camera, 40, -30)  # type: ignore[arg-type]
    camera = camera_moves.zoom(camera, 0.7)
    return ball_scene.with_(camera=camera_moves.with_projection(camera, request.param))


def clipping(make_window: Any, qtbot: QtBot, scene: Scene) -> MainWindow:
    """Return a window with the Clip tool in hand."""
    window: MainWindow = make_window(scene, size=(900, 640))
    qtbot.waitExposed(window)
    window.panel.setCurrentIndex(2)
    window.strip.choose("clip")
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    return window


def handles(window: MainWindow) -> dict[str, Any]:
    view = window.viewport.view
    assert view is not None
    return {handle.key: handle for handle in window.viewport.tools["clip"].handles(view)}


def place(window: MainWindow, key: str) -> QPoint:
    return QPoint(*(round(v) for v in handles(window)[key].at))


def test_each_face_follows_the_pointer_along_its_normal(
    make_window: Any, qtbot: QtBot, hand_of: Any, oblique: Scene
) -> None:
    window = clipping(make_window, qtbot, oblique)
    user = hand_of(window)
    for axis in range(3):
        for high in (0, 1):
            key = f"crop.{axis}.{high}"
            start, along = place(window, key), handles(window)[key].along
            inwards = -40 if high else 40
            end = start + QPoint(round(inwards * along[0]), round(-inwards * along[1]))
            user.drag(window.viewport, start, end, steps=4)
            off = place(window, key) - end
            assert off.manhattanLength() <= 4, f"{key} is {off} from the pointer"
            crop = window.editor.scene.crop
            assert (crop.high if high else crop.low)[axis] not in (0.0, 1.0)
            assert window.editor.document.undo_label == "Move the crop box"
            user.press(Qt.Key.Key_Z, CTRL)
            assert window.editor.scene.crop == oblique.crop, "a drag is one step"
    assert window.editor.scene.camera == oblique.camera


def test_faces_that_look_at_the_eye_move_by_up_and_down(
    make_window: Any, qtbot: QtBot, hand_of: Any, ball_scene: Scene
) -> None:
    window = clipping(make_window, qtbot, ball_scene)
    near, far = place(window, "crop.1.0"), place(window, "crop.1.1")
    assert (near - far).manhattanLength() > 28, "the two do not hide each other"
    hand_of(window).drag(window.viewport, near, near - QPoint(0, 50))
    assert window.editor.scene.crop.low[1] > 0.05, "up is away from the eye"
    assert window.editor.scene.crop.high == (1.0, 1.0, 1.0)


def test_a_face_never_passes_the_other(
    make_window: Any, qtbot: QtBot, hand_of: Any, ball_scene: Scene
) -> None:
    window = clipping(make_window, qtbot, ball_scene)
    start = place(window, "crop.0.0")
    hand_of(window).drag(window.viewport, start, QPoint(window.viewport.width() - 2, start.y()))
    crop = window.editor.scene.crop
    assert 0.95 < crop.low[0] < crop.high[0] == 1.0


def test_beside_the_handles_a_drag_orbits(
    make_window: Any, qtbot: QtBot, hand_of: Any, ball_scene: Scene
) -> None:
    window = clipping(make_window, qtbot, ball_scene)
    hand_of(window).drag(window.viewport, QPoint(20, 60), QPoint(60, 90))
    assert window.editor.scene.camera != ball_scene.camera
    assert window.editor.scene.crop == ball_scene.crop


def with_plane(scene: Scene, normal: tuple[float, float, float]) -> Scene:
    return scene.with_(clip=(ClipPlane(scene.volume.center, normal),))  # type: ignore[union-attr]


def test_a_plane_moves_along_its_normal(make_window: Any, qtbot: QtBot, hand_of: Any, oblique: Scene) -> None:
    scene = with_plane(oblique, (1.0, 0.0, 0.0))
    window = clipping(make_window, qtbot, scene)
    user = hand_of(window)
    start, along = place(window, "plane.0.move"), handles(window)["plane.0.move"].along
    end = start + QPoint(round(40 * along[0]), round(-40 * along[1]))
    user.drag(window.viewport, start, end)
    plane = window.editor.scene.clip[0]
    assert plane.normal == (1.0, 0.0, 0.0)
    assert plane.point[0] > 21
    assert plane.point[1:] == pytest.approx(scene.clip[0].point[1:])
    assert (place(window, "plane.0.move") - end).manhattanLength() <= 4
    user.press(Qt.Key.Key_Z, CTRL)
    assert window.editor.scene == scene
    # Far beyond the volume it stops at its corner.
    user.drag(window.viewport, start, start + 100 * (end - start), steps=3)
    assert window.editor.scene.clip[0].point[0] == pytest.approx(40.0)


@pytest.mark.parametrize("normal", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.3, -0.8, 0.5)])
def test_a_plane_tilts_with_the_end_of_its_arm(
    make_window: Any, qtbot: QtBot, hand_of: Any, oblique: Scene, normal: tuple[float, float, float]
) -> None:
    scene = with_plane(oblique, normal)
    window = clipping(make_window, qtbot, scene)
    user = hand_of(window)
    start, middle = place(window, "plane.0.tilt"), place(window, "plane.0.move")
    way = middle - start
    end = start + QPoint(round(0.3 * way.x() - 0.3 * way.y()), round(0.3 * way.y() + 0.3 * way.x()))
    user.drag(window.viewport, start, end)
    plane = window.editor.scene.clip[0]
    turned = np.degrees(np.arccos(np.clip(unit(plane.normal) @ unit(normal), -1, 1)))
    assert 10 < turned < 90
    assert np.linalg.norm(plane.normal) == pytest.approx(1.0)
    assert plane.point == pytest.approx(scene.clip[0].point, abs=1e-6), "it turns about its middle"
    tip, wanted = handles(window)["plane.0.tilt"].at, (end.x(), end.y())
    if np.hypot(*(np.subtract(wanted, (middle.x(), middle.y())))) > 36:
        assert np.hypot(*np.subtract(tip, wanted)) < 4
    assert window.editor.document.undo_label == "Tilt the clip plane"
    user.press(Qt.Key.Key_Z, CTRL)
    assert window.editor.scene == scene


def test_keys_move_the_focused_handle(
    make_window: Any, qtbot: QtBot, hand_of: Any, ball_scene: Scene
) -> None:
    window = clipping(make_window, qtbot, with_plane(ball_scene, (1.0, 0.0, 0.0)))
    user, camera = hand_of(window), window.editor.scene.camera
    tool = window.viewport.tools["clip"]
    user.press(Qt.Key.Key_PageDown)
    assert tool.focused == "plane.0.move"
    x = window.editor.scene.clip[0].point[0]
    user.press(Qt.Key.Key_Right)
    assert window.editor.scene.clip[0].point[0] == pytest.approx(x + 1), "a voxel"
    user.press(Qt.Key.Key_Left, SHIFT)
    assert window.editor.scene.clip[0].point[0] == pytest.approx(x - 9)
    user.press(Qt.Key.Key_PageDown)
    user.press(Qt.Key.Key_Up)
    normal = np.asarray(window.editor.scene.clip[0].normal)
    assert np.degrees(np.arccos(normal[0])) == pytest.approx(1.0, abs=0.5) or normal[0] > 0.999
    assert window.editor.scene.clip[0].normal != (1.0, 0.0, 0.0) or tool.focused == "plane.0.tilt"
    for _ in range(6):
        user.press(Qt.Key.Key_PageDown)
        if tool.focused == "crop.0.0":
            break
    assert tool.focused == "crop.0.0"
    user.press(Qt.Key.Key_Right, SHIFT)
    assert window.editor.scene.crop.low[0] == pytest.approx(10 / 40)
    assert window.editor.scene.camera == camera


def test_no_handle_is_in_the_other_tools(make_window: Any, qtbot: QtBot, ball_scene: Scene) -> None:
    window = clipping(make_window, qtbot, with_plane(ball_scene, (1.0, 0.0, 0.0)))
    at = place(window, "crop.0.0")
    window.strip.choose("orbit")
    before = window.editor.scene.crop
    qtbot.mousePress(window.viewport, LEFT, pos=at)
    qtbot.mouseMove(window.viewport, at + QPoint(40, 0))
    qtbot.mouseRelease(window.viewport, LEFT, pos=at + QPoint(40, 0))
    assert window.editor.scene.crop == before


# -- the View tab ---------------------------------------------------------------------------------
def test_add_select_flip_switch_and_remove(
    make_window: Any, qtbot: QtBot, hand_of: Any, ball_scene: Scene
) -> None:
    window = clipping(make_window, qtbot, ball_scene)
    window.strip.choose("orbit")
    rows, editor = window.view_page.clip, window.editor
    qtbot.mouseClick(rows.add, LEFT)
    assert window.viewport.tool == "clip", "its handles are there at once"
    assert editor.scene.clip[0].normal == (0.0, 1.0, 0.0), "the front goes, as the eye sees it"
    assert editor.scene.clip[0].point == pytest.approx(editor.scene.volume.center)
    qtbot.mouseClick(rows.add, LEFT)
    qtbot.mouseClick(rows.flip, LEFT)
    assert editor.scene.clip[1].normal == (-1.0, 0.0, 0.0), "the second cuts across another axis"
    qtbot.mouseClick(rows.chips[0], LEFT)
    assert window.viewport.clips.selected == 0
    qtbot.mouseClick(rows.switch, LEFT)
    assert [plane.enabled for plane in editor.scene.clip] == [False, True]
    assert "plane.0.move" not in handles(window)
    assert "plane.1.move" in handles(window)
    qtbot.mouseClick(rows.switch, LEFT)
    assert editor.scene.clip[0].enabled
    qtbot.mouseClick(rows.remove, LEFT)
    assert len(editor.scene.clip) == 1
    while len(editor.scene.clip) < MAX_CLIP_PLANES:
        qtbot.mouseClick(rows.add, LEFT)
    assert not rows.add.isEnabled()
    assert str(MAX_CLIP_PLANES) in rows.add.toolTip()


def test_offset_in_mm_and_directions(make_window: Any, qtbot: QtBot, hand_of: Any, ball_scene: Scene) -> None:
    window = clipping(make_window, qtbot, ball_scene)
    rows, editor = window.view_page.clip, window.editor
    qtbot.mouseClick(rows.add, LEFT)
    rows.offset.number.setFocus()
    rows.offset.number.selectAll()
    qtbot.keyClicks(rows.offset.number, "-7.5")
    hand_of(window).press(Qt.Key.Key_Return)
    assert editor.scene.clip[0].point[1] == pytest.approx(20 - 7.5)
    hand_of(window).drag_slider(rows.offset.slider, 0.3, 1.0)
    assert editor.scene.clip[0].point[1] == pytest.approx(40, abs=0.1)
    names = {button.text(): button for button in rows.cuts}
    assert list(names) == ["Sagittal", "Coronal", "Axial", "View"]
    qtbot.mouseClick(names["Axial"], LEFT)
    assert np.abs(editor.scene.clip[0].normal) == pytest.approx((0, 0, 1))
    editor.change("look", camera=camera_moves.orbit(editor.scene.camera, 30, 10))
    qtbot.mouseClick(names["View"], LEFT)
    assert editor.scene.clip[0].normal == pytest.approx(editor.scene.camera.basis().forward)


def test_crop_in_mm_with_the_patients_names(make_window: Any, qtbot: QtBot, hand_of: Any) -> None:
    """Array x runs to the right of the patient, z is spaced by 2 mm: mm still run from right to left."""
    data = np.zeros((20, 30, 40), np.int16)
    data[5:15, 5:25, 5:35] = 100
    turn = ((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    volume = Volume(data, (1.0, 1.0, 2.0), (0.0, 0.0, 0.0), turn, VolumeInfo(orientation_known=True))
    window = clipping(make_window, qtbot, Scene(volume=volume))
    rows, editor = window.view_page.crop.ranges, window.editor
    assert [row.label.text() for row in rows] == ["Right – left", "Front – back", "Bottom – top"]
    assert [row.numbers[1].value() for row in rows] == [40.0, 30.0, 40.0]
    rows[0].numbers[0].setFocus()
    rows[0].numbers[0].selectAll()
    qtbot.keyClicks(rows[0].numbers[0], "10")
    hand_of(window).press(Qt.Key.Key_Return)
    assert editor.scene.crop.high[0] == pytest.approx(0.75), "10 mm from the right are gone"
    assert editor.scene.crop.low[0] == 0.0
    slider = rows[2].slider
    middle = slider.height() // 2
    start, end = QPoint(round(slider.place(40)), middle), QPoint(round(slider.place(30)), middle)
    hand_of(window).drag(slider, start, end)
    assert editor.scene.crop.high[2] == pytest.approx(0.75, abs=0.01)
    assert editor.document.undo_label == "Move the crop box"
    # Between the handles both move.
    hand_of(window).drag(
        slider, QPoint(round(slider.place(15)), middle), QPoint(round(slider.place(20)), middle)
    )
    assert editor.scene.crop.low[2] == pytest.approx(5 / 40, abs=0.01)
    assert editor.scene.crop.high[2] == pytest.approx(35 / 40, abs=0.01)
    slider.setFocus()
    hand_of(window).press(Qt.Key.Key_Right)
    high = rows[2].numbers[1].value()
    assert high == pytest.approx(37, abs=0.5), "a step is a voxel"
    hand_of(window).press(Qt.Key.Key_Space)
    hand_of(window).press(Qt.Key.Key_Left, SHIFT)
    assert rows[2].numbers[1].value() == high, "Space changed to the other handle"
    assert rows[2].numbers[0].value() == 0.0
    qtbot.mouseClick(rows[2].reset, LEFT)
    assert (editor.scene.crop.low[2], editor.scene.crop.high[2]) == (0.0, 1.0)
    assert not rows[2].reset.isVisible()


def test_axes_without_orientation_are_x_y_z() -> None:
    names = [axis.name for axis in axes_of(Volume(np.zeros((2, 3, 4))))]
    assert names == ["x", "y", "z"]


def test_what_is_cut_is_gone_from_the_picture(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    before = hand.pixels()
    window.panel.setCurrentIndex(2)
    qtbot.mouseClick(window.view_page.clip.add, LEFT)
    hand.wait_for_picture()
    assert np.abs(hand.pixels() - before).mean() > 1


def test_handles_stay_in_a_picture_that_shows_a_part(make_window: Any, qtbot: QtBot, oblique: Scene) -> None:
    """Zoomed in, each handle that has any place in the picture is in the picture."""
    closer = camera_moves.zoom(oblique.camera, 3.2)  # type: ignore[arg-type]
    window = clipping(make_window, qtbot, with_plane(oblique.with_(camera=closer), (0.0, 0.0, 1.0)))
    width, height = window.viewport.width(), window.viewport.height()
    inside = [k for k, h in handles(window).items() if 0 < h.at[0] < width and 0 < h.at[1] < height]
    assert "plane.0.move" in inside
    assert len([k for k in inside if k.startswith("crop")]) >= 3


def test_cut_faces_are_made_solid_by_a_click(
    make_window: Any, qtbot: QtBot, hand_of: Any, ball_scene: Scene
) -> None:
    through_the_ball = ClipPlane((0.0, 13.0, 0.0), (0.0, 1.0, 0.0))
    window = clipping(
        make_window, qtbot, ball_scene.with_(clip=(through_the_ball,), technique="raycast-phong")
    )
    user = hand_of(window)

    user.wait_for_picture()
    open_face = user.pixels()
    box = window.view_page.solid
    assert not box.isChecked()
    qtbot.mouseClick(box, LEFT, pos=QPoint(8, box.height() // 2))
    assert window.editor.scene.solid_cuts
    assert window.editor.document.undo_label == "Change the cut faces"
    user.wait_for_picture()
    assert np.abs(user.pixels() - open_face).max() > 20
    user.press(Qt.Key.Key_Z, CTRL)
    assert not window.editor.scene.solid_cuts
    assert not box.isChecked()
    user.wait_for_picture()
    assert np.abs(user.pixels() - open_face).max() < 10, "but for how far it is refined"
