"""Tracts and meshes in the window: opened, dropped, listed, changed, saved; with the scan or alone."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
from nibabel.streamlines import Tractogram, TrkFile
from qtpy.QtCore import QMimeData, QPoint, Qt, QUrl
from qtpy.QtGui import QDragEnterEvent, QDropEvent
from qtpy.QtWidgets import QApplication

from sfumato import Geometry, Lines, Scene
from sfumato.geometry import color_bars, meshing
from sfumato.techniques import technique_with_geometry

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def tracts(tmp_path):
    """Twenty lines within the ball's box, with values, and one of one point."""
    rng = np.random.default_rng(0)
    lines = [np.float32(rng.uniform(-38, -2, (8, 3)) * [1, 1, -1]) for _ in range(20)] + [
        np.float32([[0, 0, 0]])
    ]
    values = {"fa": [np.linspace(0, 1, len(line), dtype=np.float32)[:, None] for line in lines]}
    TrkFile(Tractogram(lines, data_per_point=values, affine_to_rasmm=np.eye(4))).save(
        str(tmp_path / "bundle.trk")
    )
    return str(tmp_path / "bundle.trk")


def drop(window, *paths):
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(p)) for p in paths])
    at, actions = window.rect().center(), Qt.DropAction.CopyAction
    for kind in (QDragEnterEvent, QDropEvent):
        place = QPoint(at) if kind is QDragEnterEvent else at.toPointF()
        QApplication.sendEvent(window, kind(place, actions, data, LEFT, Qt.KeyboardModifier.NoModifier))


def test_dropped_tracts_join_the_volume(window, tracts, qtbot):
    volume = window.editor.scene.volume
    drop(window, tracts)
    qtbot.waitUntil(lambda: len(window.editor.scene.geometry) == 1, timeout=20_000)
    scene = window.editor.scene
    assert scene.volume is volume
    assert scene.geometry[0].shape.count == 20
    assert "1 line of one point left out" in window.messages.text
    assert window.editor.document.undo_label == "Add bundle"
    if technique_with_geometry():
        assert scene.technique_id == technique_with_geometry()
    window.editor.undo()
    assert window.editor.scene.geometry == ()
    assert not window.view_page.shapes.isVisibleTo(window.view_page)


def test_bad_tracts_leave_the_scene_alone(window, tmp_path, qtbot):
    (tmp_path / "bad.trk").write_bytes(b"no")
    before = window.editor.scene
    drop(window, tmp_path / "bad.trk")
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=20_000)
    assert "bad.trk" in window.messages.text
    assert window.editor.scene is before


def test_scan_and_tracts_dropped_together(make_window, tmp_path, tracts, qtbot):
    np.save(tmp_path / "v.npy", np.zeros((8, 8, 8), np.uint8) + np.arange(8, dtype=np.uint8) * 30)
    window = make_window()
    drop(window, tracts, tmp_path / "v.npy")
    qtbot.waitUntil(lambda: bool(window.editor.scene.geometry), timeout=20_000)
    assert window.editor.scene.volume is not None


def test_tracts_alone_are_a_scene(make_window, tracts, tmp_path, qtbot):
    window = make_window()
    window.open(tracts)
    qtbot.waitUntil(lambda: bool(window.editor.scene.geometry), timeout=20_000)
    scene = window.editor.scene
    assert scene.volume is None
    assert scene.camera is not None
    assert window.files.name == "bundle"
    assert window.top.save.isEnabled()
    window.look("left")
    assert window.editor.scene.camera != scene.camera
    assert window.files.save_scene_as(str(tmp_path / "s.sfumato"))
    assert Scene.open(tmp_path / "s.sfumato").geometry[0].shape == scene.geometry[0].shape


@pytest.fixture
def shapes(window, tracts, qtbot):
    """The Geometry section, with tracts."""
    window.panel.setCurrentWidget(window.view_page)
    drop(window, tracts)
    qtbot.waitUntil(lambda: bool(window.editor.scene.geometry), timeout=20_000)
    qtbot.wait(20)
    return window.view_page.shapes


def shown(window):
    return window.editor.scene.geometry[0]


def choose(box, data):
    index = box.findData(data)
    assert index >= 0
    box.setCurrentIndex(index)
    box.activated.emit(index)


def test_section_shows_and_changes_the_tracts(window, shapes, hand, qtbot):
    assert shapes.isVisible()
    assert shapes.header.isChecked(), "opens with the first tracts"
    assert shapes.count.text() == "20 lines"
    before = shown(window).radius
    hand.drag_slider(shapes.sliders["radius"].slider, 0.5, 0.9)
    assert shown(window).radius > 2 * before
    assert window.editor.document.undo_label == "Change radius"
    hand.drag_slider(shapes.sliders["fraction"].slider, 1.0, 0.4)
    assert shapes.count.text().endswith("of 20 lines")
    qtbot.mouseClick(shapes.visible, LEFT)
    assert not shown(window).visible
    qtbot.mouseClick(shapes.visible, LEFT)
    assert shown(window).visible


def test_colouring_by_values_has_a_bar_in_the_picture(window, shapes, hand):
    assert shapes.rows["color_by"].isVisible()
    assert not shapes.rows["scalar"].isVisible()
    plain = window.viewport.grab().toImage()
    choose(shapes.coloring, "scalar")
    assert shapes.rows["scalar"].isVisible()
    choose(shapes.colormap, "magma")
    (bar,) = color_bars(window.editor.scene)
    assert bar.title == "fa"
    image = window.viewport.grab().toImage()
    strip = [image.pixelColor(20, y) for y in range(image.height() - 240, image.height() - 40)]
    bright = [c.lightness() for c in strip if c != plain.pixelColor(20, 0)]
    assert max(bright) - min(bright) > 150, "from magma's dark end to its light one"
    choose(shapes.coloring, "color")
    assert shapes.rows["color"].isVisible()


def test_several_are_listed_and_removed(window, shapes, qtbot):
    more = Geometry(Lines.of([[[5, 5, 5], [30, 30, 30]]]), name="second")
    window.editor.change("Add second", geometry=(*window.editor.scene.geometry, more))
    assert [shapes.choice.itemText(i) for i in range(2)] == ["bundle", "second"]
    assert shapes.choice.currentIndex() == 1, "the new one is selected"
    assert shapes.coloring.findData("scalar") < 0, "it has no values"
    qtbot.mouseClick(shapes.remove, LEFT)
    assert [g.name for g in window.editor.scene.geometry] == ["bundle"]
    assert shapes.coloring.findData("scalar") >= 0
    qtbot.mouseClick(shapes.remove, LEFT)
    assert not shapes.isVisible()
    window.editor.undo()
    assert shapes.isVisible()


def test_changed_tubes_are_built_beside_the_picture(window, shapes, hand, qtbot, monkeypatch):
    """Neither the window's nor the render thread builds them; till then the old ones are shown."""
    hand.wait_for_picture()
    built, whole = [], meshing.build

    def build(geometry):
        built.append(threading.current_thread().name)
        return whole(geometry)

    monkeypatch.setattr(meshing, "build", build)
    before = shown(window)
    window.editor.change("Thicker", **{"geometry.0.radius": 2 * before.radius})
    stand_in = window.driver.builder.buildable(window.editor.scene).geometry[0]
    assert stand_in.radius in (before.radius, 2 * before.radius)
    hand.wait_for_picture()
    assert built == ["sfumato-meshes"]
    assert window.viewport.picture.scene.geometry[0].radius == 2 * before.radius


def test_a_change_that_takes_long_can_be_given_up(window, shapes, hand, qtbot, monkeypatch):
    hand.wait_for_picture()

    def slow(geometry):
        for k in range(2000):
            time.sleep(0.01)
            yield k / 2000
        raise AssertionError("not given up")

    monkeypatch.setattr(meshing, "build", slow)
    before = shown(window).radius
    window.editor.change("Thicker", **{"geometry.0.radius": 3 * before})
    qtbot.waitUntil(lambda: window.messages.kind == "progress", timeout=20_000)
    assert window.messages.text.startswith("Building tubes")
    assert window.viewport.picture.scene.geometry[0].radius == before
    window.messages.cancelled.emit()
    qtbot.waitUntil(lambda: not window.driver.builder.alive, timeout=20_000)
    assert shown(window).radius == before
    qtbot.waitUntil(lambda: window.messages.kind == "", timeout=20_000)


# -- bad input, told with counts -------------------------------------------------------------------
def trk(path, lines):
    from nibabel.streamlines import save

    save(Tractogram([np.asarray(line, np.float32) for line in lines], affine_to_rasmm=np.eye(4)), str(path))
    return path


def bare(path, lines):
    """Write a TRK as old programs did: 64 bytes of its header, the affine, are zero."""
    data = bytearray(trk(path.with_suffix(".trk"), lines).read_bytes())
    data[440:504] = bytes(64)
    path.with_suffix(".trk").write_bytes(data)
    return path.with_suffix(".trk")


def vtp(path, lines):
    import pyvista

    points = np.concatenate([np.asarray(line, float) for line in lines])
    cells, start = [], 0
    for line in lines:
        cells += [len(line), *range(start, start + len(line))]
        start += len(line)
    pyvista.PolyData(points, lines=cells).save(path)
    return path


GOOD = [[-4, -4, 4], [-30, -30, 30]]


@pytest.mark.parametrize(
    ("make", "lines", "told"),
    [
        (trk, [GOOD, [[500, 0, 0], [510, 0, 0]]], "1 line of 2 leave the volume, 1 of them lie outside"),
        (trk, [[[500, 0, 0], [510, 0, 0]]], "they may belong to another scan"),
        (trk, [GOOD, [[-5, -5, 5]]], "1 line of one point left out"),
        (
            trk,
            [GOOD, [[-5, -5, 5], [np.nan] * 3, [-6, -6, 6], [-7, -7, 7]]],
            "1 line with 1 point that are NaN",
        ),
        (vtp, [GOOD], "does not name its space"),
        (bare, [GOOD], "has no affine"),
    ],
    ids=["outside", "another scan", "one point", "NaN", "no space", "no affine"],
)
def test_what_is_wrong_is_counted_and_the_rest_shown(window, tmp_path, qtbot, make, lines, told):
    path = make(tmp_path / f"odd.{make.__name__}", lines)
    drop(window, path)
    qtbot.waitUntil(lambda: bool(window.editor.scene.geometry), timeout=60_000)
    assert told in window.messages.text
    assert shown(window).shape.count >= 1


def test_tracts_without_a_line_are_refused(window, tmp_path, qtbot):
    drop(window, trk(tmp_path / "empty.trk", []))
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=60_000)
    assert "empty.trk: there is nothing to show (it holds no lines)" in window.messages.text
    assert window.editor.scene.geometry == ()


def test_masked_cells_of_a_field_are_counted(make_window, tmp_path, qtbot):
    import pyvista

    grid = pyvista.ImageData(dimensions=(9, 9, 9), spacing=(2, 2, 2))
    grid.point_data["speed of it"] = np.linspace(0, 100, grid.n_points)
    vectors = np.tile([1.0, 0.0, 0.0], (grid.n_points, 1))
    vectors[:10] = np.nan
    grid.point_data["flow"] = vectors
    grid.save(tmp_path / "flow.vti")
    window = make_window()
    window.open(str(tmp_path / "flow.vti"))
    qtbot.waitUntil(lambda: bool(window.editor.scene.geometry), timeout=60_000)
    assert "10 vectors of 729 are masked or NaN" in window.messages.text


def test_a_field_at_rest_opens_without_streamlines(make_window, tmp_path, qtbot):
    import pyvista

    grid = pyvista.ImageData(dimensions=(9, 9, 9))
    grid.point_data["value"] = np.linspace(0, 100, grid.n_points)
    grid.point_data["flow"] = np.zeros((grid.n_points, 3))
    grid.save(tmp_path / "rest.vti")
    window = make_window()
    window.open(str(tmp_path / "rest.vti"))
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=60_000)
    assert window.editor.scene.geometry == ()
    assert "No streamlines" in window.messages.text
