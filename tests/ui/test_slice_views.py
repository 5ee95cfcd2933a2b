"""The slice views by real mouse and key events: cross-hair, window and level, zoom, lamps; and whatever is opened."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QWheelEvent
from qtpy.QtWidgets import QApplication

from sfumato import Document, Geometry, Light, Lines, Scene, TransferFunction, Volume, VolumeInfo
from sfumato.scene import ClipPlane, CropBox
from sfumato.scene.vectors import vec3
from sfumato.slicing import ValueWindow
from sfumato_ui.editing import Editor
from sfumato_ui.slice_views.pane import SlicePane
from sfumato_ui.slice_views.panel import SlicePanel
from sfumato_ui.window import MainWindow

from .conftest import MakeWindow, ball, solid

LEFT, RIGHT, MIDDLE = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton, Qt.MouseButton.MiddleButton
NONE, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
CTRL, ALT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.AltModifier
SLOPE = np.array([1.0, 2.0, 4.0])


def ramp() -> Volume:
    """48 x 40 x 30 mm of anisotropic voxels, mirrored in the array; the value is a linear function of the place."""
    spacing, origin, direction = (
        np.array([1.0, 2.0, 3.0]),
        np.array([-20.0, 19.0, 100.0]),
        np.diag([1.0, -1.0, 1.0]),
    )
    z, y, x = np.mgrid[0:10, 0:20, 0:48]
    places = origin + np.stack([x, y, z], axis=-1) @ (direction * spacing).T
    info = VolumeInfo(path="ramp.npy", orientation_known=True, name="ramp")
    data = (places @ SLOPE).astype(np.float32)
    return Volume(data, vec3(spacing), vec3(origin), tuple(vec3(row) for row in direction), info)


def scene_of(volume: Volume, **fields: Any) -> Scene:
    low, high = volume.value_range
    transfer = TransferFunction.from_points([(low, (0.8, 0.8, 0.8), 0.0), (high + 1, (0.8, 0.8, 0.8), 0.5)])
    return Scene(volume=volume, transfer=transfer, technique="raycast", **fields)


@pytest.fixture
def shown(make_window: MakeWindow, qtbot: QtBot) -> MainWindow:
    """A window on the ramp with the views open; its picture is not waited for."""
    window = make_window(scene_of(ramp()), size=(920, 560))
    open_slices(window, qtbot)
    return window


def open_slices(window: MainWindow, qtbot: QtBot) -> SlicePanel:
    qtbot.waitExposed(window)
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    qtbot.keyClick(window.viewport, Qt.Key.Key_M)
    return settled(window, qtbot)


def settled(window: MainWindow, qtbot: QtBot) -> SlicePanel:
    """Wait until every pane that is seen shows its newest slice."""
    panel = window.slices.panel
    assert panel is not None

    def there() -> bool:
        seen = [pane for pane in panel.panes if pane.isVisible()]
        return bool(seen) and panel.slicer.idle and all(
            pane.made is not None and pane.made.request == pane._wanted for pane in seen
        )  # fmt: skip

    qtbot.waitUntil(there, timeout=20_000)
    return panel


def at(pane: SlicePane, point: Any) -> QPoint:
    """Return where a world point lies in a pane."""
    place = pane.view.place(np.asarray(point, dtype=float))
    assert place is not None
    return QPointF(*place).toPoint()


def wheel(
    pane: SlicePane, notches: int, keys: Qt.KeyboardModifier = NONE, place: QPoint | None = None
) -> None:
    spot = QPointF(place if place is not None else pane.rect().center())
    event = QWheelEvent(
        spot, QPointF(pane.mapToGlobal(spot)), QPoint(), QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton, keys, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(pane, event)


def grey_at(pane: SlicePane, place: QPoint) -> int:
    """Return the grey level of the slice at a place; -1 outside of the volume."""
    assert pane.made is not None
    assert (pane.made.image.width(), pane.made.image.height()) == (pane.width(), pane.height())
    colour = pane.made.image.pixelColor(place)
    return colour.red() if colour.alpha() else -1


# -- the layout --------------------------------------------------------------------------------------
def test_the_views_open_beside_the_picture_and_are_there_again(
    shown: MainWindow, make_window: MakeWindow, qtbot: QtBot, hand_of: Any
) -> None:
    panel = shown.slices.panel
    assert panel is not None
    assert shown.strip.slices.isChecked()
    assert shown.viewport._mark is not None
    shown.resize(1280, 720)
    qtbot.mouseClick(panel.shut, LEFT)
    assert not panel.isVisible()
    assert not shown.strip.slices.isChecked()
    assert shown.viewport._mark is None
    qtbot.mouseClick(shown.strip.slices, LEFT)
    assert panel.isVisible()
    assert shown.viewport.width() > 1.9 * panel.width(), "the picture keeps the larger part"
    heights = [pane.height() for pane in panel.panes]
    assert 0.7 * heights[0] < heights[1] < 0.8 * heights[0], "as high as what they show: 40 and 30 mm"
    assert abs(heights[1] - heights[2]) <= 1
    # A double-click gives one the whole place; Enter gives it back.
    qtbot.mouseDClick(panel.panes[1], LEFT, NONE, QPoint(60, 60))
    assert [pane.isVisible() for pane in panel.panes] == [False, True, False]
    settled(shown, qtbot)
    grip = shown.views.handle(1)
    hand_of(shown).drag(grip, grip.rect().center(), grip.rect().center() - QPoint(100, 0))
    assert panel.width() > 380
    part = panel.width() / (panel.width() + shown.viewport.width())
    qtbot.mouseClick(panel.shut, LEFT)
    qtbot.mouseClick(shown.strip.slices, LEFT)
    again = make_window(scene_of(ramp()), size=(1280, 720))
    qtbot.waitUntil(lambda: again.slices.panel is not None and again.slices.panel.isVisible())
    other = again.slices.panel
    assert other is not None
    assert [pane.isVisible() for pane in other.panes] == [False, True, False]
    qtbot.waitUntil(lambda: abs(other.width() / (other.width() + again.viewport.width()) - part) < 0.03)
    other.panes[1].setFocus()
    qtbot.keyClick(other.panes[1], Qt.Key.Key_Return)
    assert all(pane.isVisible() for pane in other.panes)
    qtbot.mouseClick(other.panes[2].enlarge, LEFT)
    assert [pane.isVisible() for pane in other.panes] == [False, False, True]


# -- the cross-hair ----------------------------------------------------------------------------------
def test_a_click_moves_the_cross_hair_in_all_views(shown: MainWindow, qtbot: QtBot, hand_of: Any) -> None:
    panel, start = settled(shown, qtbot), shown.editor.scene
    axial, coronal, sagittal = panel.panes
    state = panel.state
    before = state.cross.copy()
    qtbot.mouseClick(axial, LEFT, NONE, at(axial, (-10.0, 5.0, before[2])))
    assert state.cross == pytest.approx((-10, 5, before[2]), abs=state.mm_per_pixel)
    assert panel.place.text().split()[1].startswith("R"), "x below zero is the patient's right"
    assert "P" in panel.place.text()
    assert "S" in panel.place.text()
    value = float(panel.value.text().split()[1].replace("\N{MINUS SIGN}", "-"))
    assert value == pytest.approx(state.cross @ SLOPE, abs=0.1)
    settled(shown, qtbot)
    for pane in (coronal, sagittal):
        assert pane.made is not None
        assert np.asarray(pane.made.request.frame.middle) @ pane.cut.back == pytest.approx(
            state.cross @ pane.cut.back
        )
    hand_of(shown).drag(coronal, at(coronal, state.cross), at(coronal, (15.0, 0.0, 110.0)))
    assert state.cross[[0, 2]] == pytest.approx((15, 110), abs=state.mm_per_pixel)
    assert state.cross[1] == pytest.approx(5, abs=state.mm_per_pixel), (
        "a drag in the coronal slice stays in it"
    )
    qtbot.mouseClick(axial, LEFT, NONE, QPoint(3, 3))
    low, high = ramp().corners().min(axis=0), ramp().corners().max(axis=0)
    assert (state.cross >= low - 1e-6).all()
    assert (state.cross <= high + 1e-6).all()
    # It is the window's, not the scene's.
    assert shown.editor.scene is start
    assert not shown.editor.document.undo_label


def test_slices_show_values_where_they_lie(shown: MainWindow, qtbot: QtBot) -> None:
    panel = settled(shown, qtbot)
    window = panel.state.window
    assert window is not None
    for pane in panel.panes:
        for part in (0.2, 0.5, 0.8):
            corners = ramp().corners()
            point = corners.min(axis=0) + part * np.ptp(corners, axis=0)
            point = point + pane.cut.back * (pane.cut.back @ (panel.state.cross - point))
            # The middle of the pixel that is looked at.
            place = at(pane, point)
            seen = pane._frame(1.0).point(place.x() + 0.5, place.y() + 0.5)
            expected = int(window.grey(np.array([seen @ SLOPE]))[0])
            assert grey_at(pane, place) == pytest.approx(expected, abs=1)
        assert grey_at(pane, QPoint(1, pane.height() // 2)) == -1 or grey_at(pane, QPoint(1, 1)) == -1


def test_wheel_and_keys_go_from_slice_to_slice(shown: MainWindow, qtbot: QtBot) -> None:
    panel = settled(shown, qtbot)
    axial, coronal, sagittal = panel.panes
    state = panel.state
    start = state.cross.copy()
    wheel(axial, 2)
    assert state.cross - start == pytest.approx((0, 0, 6)), "two slices of 3 mm away from the feet"
    wheel(coronal, -1)
    assert state.cross - start == pytest.approx((0, -2, 6))
    sagittal.setFocus()
    qtbot.keyClick(sagittal, Qt.Key.Key_PageUp)
    assert state.cross - start == pytest.approx((-1, -2, 6)), "away from the viewer, who is on the left"
    qtbot.keyClick(sagittal, Qt.Key.Key_PageDown)
    qtbot.keyClick(sagittal, Qt.Key.Key_Left)
    assert state.cross - start == pytest.approx((0, -4, 6)), "to the front by a voxel"
    qtbot.keyClick(sagittal, Qt.Key.Key_Down)
    assert state.cross - start == pytest.approx((0, -4, 3))


def test_zoom_and_pan_are_common_and_end_by_0(shown: MainWindow, qtbot: QtBot, hand_of: Any) -> None:
    panel = settled(shown, qtbot)
    axial, coronal, _ = panel.panes
    state = panel.state
    whole = state.mm_per_pixel
    assert not panel.whole.isEnabled()
    spot = QPoint(axial.width() // 3, axial.height() // 3)
    under = axial._frame(1.0).point(spot.x(), spot.y())
    wheel(axial, 5, CTRL, spot)
    assert state.mm_per_pixel < 0.7 * whole
    assert axial._frame(1.0).point(spot.x(), spot.y()) == pytest.approx(under, abs=1e-6), (
        "it stays under the pointer"
    )
    assert coronal._frame(1.0).mm_per_pixel == axial._frame(1.0).mm_per_pixel
    for start, button, keys in (((90, 90), MIDDLE, NONE), ((80, 80), LEFT, CTRL)):
        under = axial._frame(1.0).point(*start)
        hand_of(shown).drag(
            axial, QPoint(*start), QPoint(start[0] + 12, start[1] + 9), button=button, keys=keys
        )
        assert axial._frame(1.0).point(start[0] + 12, start[1] + 9) == pytest.approx(under, abs=1e-6)
    assert panel.whole.isEnabled()
    axial.setFocus()
    qtbot.keyClick(axial, Qt.Key.Key_0)
    assert state.mm_per_pixel == whole
    qtbot.keyClick(axial, Qt.Key.Key_Plus)
    qtbot.keyClick(axial, Qt.Key.Key_Right, CTRL)
    assert not state.is_whole
    qtbot.mouseClick(panel.whole, LEFT)
    assert state.is_whole
    settled(shown, qtbot)


# -- window and level --------------------------------------------------------------------------------
def ct() -> Volume:
    """Air, soft tissue and a bone in Hounsfield units."""
    data = np.full((20, 24, 24), -1000, np.int16)
    data[2:18, 4:20, 4:20] = 45
    data[8:12, 10:14, 4:20] = 1200
    return Volume(data, info=VolumeInfo(path="ct.npy", modality="CT", orientation_known=True, name="ct"))


def test_window_and_level_by_menu_numbers_and_drags(
    make_window: MakeWindow, qtbot: QtBot, hand_of: Any
) -> None:
    window = make_window(scene_of(ct()), size=(920, 560))
    panel = open_slices(window, qtbot)
    axial, row, state = panel.panes[0], panel.window_row, panel.state
    assert row.choice.currentText() == "Soft tissue"
    assert (row.level.text(), row.width_box.text()) == ("40 HU", "400 HU")
    assert panel.value.text().endswith("1200 HU, bone")
    soft = at(axial, (6.0, 6.0, state.cross[2]))
    assert grey_at(axial, soft) == int(ValueWindow(40, 400).grey(np.array([45]))[0])
    row.choice.setFocus()
    qtbot.keyClick(row.choice, Qt.Key.Key_Down)
    assert state.window == ValueWindow(-600, 1500)
    settled(window, qtbot)
    assert grey_at(axial, soft) > 200, "soft tissue is bright in the lung's window"
    hand = hand_of(window)
    for button, keys in ((RIGHT, NONE), (LEFT, ALT), (LEFT, CTRL | SHIFT)):
        before, cross = state.window, state.cross.copy()
        hand.drag(axial, QPoint(60, 100), QPoint(80, 60), button=button, keys=keys)
        assert state.window.width == pytest.approx(before.width * np.exp(0.1))
        assert state.window.level == pytest.approx(before.level + 0.2 * before.width)
        assert np.array_equal(state.cross, cross)
    assert row.choice.currentText() == "Own window"
    row.level.setFocus()
    row.level.selectAll()
    qtbot.keyClicks(row.level, "300")
    qtbot.keyClick(row.level, Qt.Key.Key_Return)
    assert state.window.level == 300
    assert row.reset.isVisible()
    qtbot.mouseClick(row.reset, LEFT)
    assert row.choice.currentText() == "Soft tissue"
    assert not row.reset.isVisible()
    axial.setFocus()
    qtbot.keyClick(axial, Qt.Key.Key_Right, ALT)
    assert state.window.width > 400


# -- the light ---------------------------------------------------------------------------------------
def test_lamps_are_moved_within_the_slice(make_window: MakeWindow, qtbot: QtBot, hand_of: Any) -> None:
    lamps = (
        Light(name="key", attached="patient"),
        Light(kind="point", position=(-10.0, 8.0, 120.0), name="bulb"),
    )
    window = make_window(scene_of(ramp(), lights=lamps), size=(920, 560))
    panel = open_slices(window, qtbot)
    axial, coronal, _ = panel.panes
    editor, hand = window.editor, hand_of(window)
    cross = panel.state.cross.copy()
    bulb = at(axial, lamps[1].position)
    hand.drag(axial, bulb, bulb + QPoint(30, -12))
    moved = editor.scene.lights[1].position
    mm = panel.state.mm_per_pixel
    assert moved == pytest.approx((-10 + 30 * mm, 8 - 12 * mm, 120.0)), "parallel to the slice"
    assert editor.selected == 1
    assert np.array_equal(panel.state.cross, cross)
    qtbot.mouseClick(window.top.undo, LEFT)
    assert editor.scene.lights == lamps
    assert not editor.document.undo_label, "one step"
    # With Shift from anywhere, and by keys.
    hand.drag(coronal, QPoint(20, 40), QPoint(20, 60), keys=SHIFT)
    assert editor.scene.lights[1].position == pytest.approx((-10.0, 8.0, 120.0 - 20 * mm))
    axial.setFocus()
    before = editor.scene.lights[1].position
    qtbot.keyClick(axial, Qt.Key.Key_Right, SHIFT)
    assert editor.scene.lights[1].position[0] > before[0]
    # A parallel lamp turns: it shines from where its handle is let go.
    editor.select_light(0)
    handle = next(h for h in axial.lamps.handles(axial.view) if h.key == "lamp.0")
    start = QPointF(*handle.at).toPoint()
    depth = axial.lamps._towards(editor.scene.lights[0])[2]
    hand.drag(axial, start, start + QPoint(25, 10))
    after = axial.lamps._towards(editor.scene.lights[0])
    radius = 0.36 * min(axial.width(), axial.height())
    middle = QPointF(axial.width() / 2, axial.height() / 2)
    assert middle.x() + radius * after[0] == pytest.approx(start.x() + 25, abs=2)
    assert middle.y() - radius * after[1] == pytest.approx(start.y() + 10, abs=2)
    assert after[2] * depth > 0, "on the same side of the slice"
    # Hidden, they cannot be taken.
    qtbot.mouseClick(panel.lamps, LEFT)
    lights = editor.scene.lights
    spot = at(axial, lights[1].position)
    qtbot.mouseClick(axial, LEFT, NONE, spot)
    assert editor.scene.lights == lights
    assert panel.state.cross[:2] == pytest.approx(np.asarray(lights[1].position)[:2], abs=mm)


def test_the_light_falls_on_the_slices(make_window: MakeWindow, qtbot: QtBot) -> None:
    """A wall before the eye casts its shadow backwards; a move of the lamp, or of the slice, brings other light."""
    data = np.full((40, 40, 40), 50, np.uint8)
    data[:, 10:13, 12:28] = 250
    volume = Volume(data, info=VolumeInfo(path="wall.npy", orientation_known=True))
    transfer = TransferFunction.from_points([(100, (1, 1, 1), 0.0), (200, (1, 1, 1), 0.9999)])
    scene = Scene(volume=volume, transfer=transfer, technique="raycast", lights=(Light(tilt=0, aperture=2),))
    window = make_window(scene, size=(920, 560))
    panel = open_slices(window, qtbot)
    axial, coronal, _ = panel.panes
    dark, bright = at(axial, (17.0, 30.0, 20.5)), at(axial, (4.0, 30.0, 20.5))

    def seen(pane: SlicePane, place: QPoint) -> int:
        return pane.grab().toImage().pixelColor(place).red()

    def lit() -> bool:
        panes = [pane for pane in panel.panes if pane.isVisible()]
        return panel.lighter.idle and all(
            pane.light is not None and not pane._light_timer.isActive() for pane in panes
        )  # fmt: skip

    panel.state.set_window(ValueWindow(60, 200))
    settled(window, qtbot)
    plain = seen(axial, bright)
    assert plain > 100
    assert seen(axial, dark) == pytest.approx(plain, abs=2)
    qtbot.mouseClick(panel.lamps, LEFT)
    qtbot.mouseClick(panel.light, LEFT)
    qtbot.waitUntil(lit, timeout=20_000)
    assert seen(axial, dark) < 0.45 * seen(axial, bright)
    assert seen(axial, bright) >= plain
    # From the left the shadow falls to the other side.
    window.editor.change_light("Move the light", attached="patient", tilt=105.0, rotation=0.0)
    qtbot.waitUntil(lambda: lit() and axial.light.request.scene is window.editor.scene, timeout=20_000)
    assert seen(axial, at(axial, (4.0, 9.3, 20.5))) < 0.6 * seen(axial, at(axial, (4.0, 30.0, 20.5)))
    assert seen(axial, dark) > 0.7 * plain
    # Another slice has no light until its own is known; off, all is as before.
    qtbot.mouseClick(coronal, LEFT, NONE, at(coronal, (20.0, 20.0, 30.0)))
    qtbot.waitUntil(lit, timeout=20_000)
    qtbot.mouseClick(panel.light, LEFT)
    settled(window, qtbot)
    assert seen(axial, dark) == pytest.approx(plain, abs=2)


def test_the_mark_lies_over_the_picture_alone_and_pick_moves_it(
    make_window: MakeWindow, hand_of: Any, qtbot: QtBot
) -> None:
    window = make_window(Scene(volume=ball(), transfer=solid(), technique="raycast"), size=(920, 520))
    panel, hand = open_slices(window, qtbot), hand_of(window)
    hand.wait_for_picture()
    viewport = window.viewport
    assert viewport.view is not None
    qtbot.keyClick(viewport, Qt.Key.Key_P)
    spot = viewport.rect().center() + QPoint(8, -6)
    before = panel.state.cross.copy()
    qtbot.mouseClick(viewport, LEFT, NONE, spot)
    assert not np.array_equal(panel.state.cross, before)
    place = viewport.view.place(panel.state.cross)
    assert place == pytest.approx((spot.x(), spot.y()), abs=2)
    qtbot.keyClick(viewport, Qt.Key.Key_Escape)
    arm = QPoint(spot.x() + 12, spot.y())
    seen = viewport.grab().toImage().pixelColor(arm)
    assert seen.red() > seen.blue() + 60, "the accent's colour"
    drawn = hand.pixels()[arm.y(), arm.x()]
    assert drawn[0] < drawn[2] + 60, "no part of the picture"


# -- whatever is opened ------------------------------------------------------------------------------
def plain(shape: tuple[int, ...], value: float = 3, dtype: type = np.uint8, **known: Any) -> Volume:
    return Volume(np.full(shape, value, dtype), (0.5, 2, 1), info=VolumeInfo(path="plain.npy", **known))


def test_anything_may_be_opened_while_they_are_shown(shown: MainWindow, qtbot: QtBot) -> None:
    panel, editor = settled(shown, qtbot), shown.editor
    qtbot.mouseClick(panel.light, LEFT)
    panel.state.go_to((-5, 2, 108))
    kept = panel.state.cross.copy()
    step = Volume(ramp().data * 0.5, ramp().spacing, ramp().origin, ramp().direction, ramp().info)
    editor.reset(scene_of(step))
    settled(shown, qtbot)
    assert np.array_equal(panel.state.cross, kept), "the next time step keeps the place"
    with_holes = np.where(np.random.default_rng(0).random((6, 7, 8)) < 0.3, np.nan, 1e-4).astype(np.float32)
    for volume in (
        plain((1, 9, 12), orientation_known=True), plain((9, 1, 12)), plain((1, 1, 1), 7.5, np.float32),
        Volume(with_holes), Volume(np.zeros((4, 4, 4), np.float32)), ramp(),
    ):  # fmt: skip
        editor.reset(scene_of(volume, clip=(ClipPlane(volume.center, (1, 1, 0)),), crop=CropBox((0.1, 0, 0))))
        settled(shown, qtbot)
        for pane in panel.panes:
            pane.grab()
            wheel(pane, 1)
            qtbot.mouseClick(pane, LEFT, NONE, QPoint(50, 50))
        assert panel.value.text()
        assert ("R" in panel.panes[0].cut.letters.values()) == volume.info.orientation_known
    editor.reset(Scene(geometry=(Geometry(Lines.of([[[0, 0, 0], [9, 9, 9]]])),)))
    assert panel.value.text() == ""
    for pane in panel.panes:
        pane.grab()
        wheel(pane, 1)
        qtbot.mouseClick(pane, LEFT, NONE, QPoint(50, 50))
        qtbot.mouseClick(pane, LEFT, SHIFT, QPoint(50, 50))
        qtbot.keyClick(pane, Qt.Key.Key_Left)
    assert shown.viewport._mark is None


@pytest.mark.measured
def test_the_window_does_not_wait_for_slices(qapp: QApplication, qtbot: QtBot) -> None:
    """256^3 voxels, askew: a move of the cross-hair costs the window's thread little, and slices follow."""
    c, s = np.cos(0.4), np.sin(0.4)
    data = np.random.default_rng(0).integers(0, 2000, (256, 256, 256)).astype(np.int16)
    known = VolumeInfo(orientation_known=True)
    volume = Volume(data, direction=((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)), info=known)
    panel = SlicePanel(Editor(Document(scene_of(volume))))
    qtbot.addWidget(panel)
    panel.resize(305, 650)
    panel.show()
    qtbot.waitUntil(lambda: all(pane.made is not None for pane in panel.panes))
    axial, times, made = panel.panes[0], [], []
    panel.slicer.sliced.connect(made.append)
    qtbot.mousePress(axial, LEFT, NONE, QPoint(100, 60))
    for i in range(60):
        began = time.perf_counter()
        qtbot.mouseMove(axial, QPoint(100 + i, 60 + i // 2))
        times.append(time.perf_counter() - began)
        qtbot.wait(16)
    qtbot.mouseRelease(axial, LEFT, NONE, QPoint(160, 90))
    qtbot.waitUntil(lambda: panel.slicer.idle)
    assert np.median(times) < 0.012, "of a frame of 16 ms"
    assert len(made) >= 30, f"{len(made)} slices in 60 moves"
