"""The VTK view beside the lit view, in a real window: both live, one camera, picks, seeds, regions, failures.

Needs a screen with OpenGL for Qt (X or Xvfb, as ./run test has it).
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QGuiApplication
from qtpy.QtWidgets import QApplication

from sfumato import Camera, Geometry, Lines, Scene, Surface, TransferFunction
from sfumato_ui.tools.view import PictureView
from sfumato_ui.vtk_view.link import camera_of
from sfumato_ui.window import MainWindow

from .link_walk import places_in_vtk

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(autouse=True)
def screen(qapp: QApplication) -> None:
    if QGuiApplication.platformName() in ("offscreen", "minimal"):
        pytest.skip("VTK's view needs a screen with OpenGL: run under Xvfb")


def two_lines() -> Geometry:
    """A line along x above the middle of the ball's box, and a short one along z."""
    lines = Lines.of(
        [[[4, 10, 30], [36, 10, 30]], [[20, 10, 4], [20, 10, 16]]], [("fa", [[0.0, 1.0], [2.0, 2.0]])]
    )
    return Geometry(lines, name="two", radius=0.5, color=(1, 1, 1))


@pytest.fixture
def both(window: MainWindow, qtbot: Any) -> Iterator[MainWindow]:
    """The window on ball and lines, with the VTK view open beside the picture."""
    window.resize(1100, 640)
    window.editor.change("Add two", geometry=(two_lines(),))
    qtbot.mouseClick(window.strip.vtk, LEFT)
    wait_for_stage(window, qtbot)
    return window


def wait_for_stage(window: MainWindow, qtbot: Any) -> Any:
    def there() -> bool:
        panel = window.vtk.panel
        stage = panel.stage if panel is not None else None
        return stage is not None and stage.view.isValid() and not stage.busy

    qtbot.waitUntil(there, timeout=240_000)  # the first import of VTK
    qtbot.wait(60)
    return window.vtk.panel.stage  # type: ignore[union-attr]


def vtk_pixels(window: MainWindow) -> np.ndarray:
    image = window.vtk.panel.stage.view.grabFramebuffer()  # type: ignore[union-attr]
    image = image.convertToFormat(image.Format.Format_RGBA8888)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).astype(int)


def places_in_window(stage: Any, points: np.ndarray) -> np.ndarray:
    """Where VTK projects world points: the window's pixels from the upper left corner."""
    return np.asarray(places_in_vtk(stage, points) / stage.view.devicePixelRatioF())


# -- both views ------------------------------------------------------------------------------------
def test_both_views_live_together_and_apart(both: MainWindow, hand: Any, qtbot: Any) -> None:
    hand.wait_for_picture()
    seen = vtk_pixels(both)
    assert (seen[..., :3].min(axis=2) > 240).sum() > 50, "white lines"
    assert both.viewport.width() > 300
    both.look("left")
    hand.wait_for_picture()
    assert np.abs(vtk_pixels(both) - seen).max() > 100, "VTK follows"
    qtbot.mouseClick(both.vtk.panel.shut, LEFT)
    assert not both.vtk.is_open
    assert not both.strip.vtk.isChecked()
    both.look("front")
    hand.wait_for_picture()
    qtbot.mouseClick(both.strip.vtk, LEFT)
    wait_for_stage(both, qtbot)
    assert (vtk_pixels(both)[..., :3].min(axis=2) > 240).sum() > 50, "again, after it was closed"


def test_undock_and_dock(both: MainWindow, hand: Any, qtbot: Any) -> None:
    qtbot.mouseClick(both.vtk.panel.undock, LEFT)
    stage = wait_for_stage(both, qtbot)
    assert both.vtk.floating is not None
    assert stage.view.window() is both.vtk.floating
    assert (vtk_pixels(both)[..., :3].min(axis=2) > 240).sum() > 50
    hand.wait_for_picture()
    qtbot.mouseClick(both.vtk.panel.undock, LEFT)
    stage = wait_for_stage(both, qtbot)
    assert stage.view.window() is both
    qtbot.mouseClick(both.vtk.panel.undock, LEFT)
    wait_for_stage(both, qtbot)
    both.vtk.floating.close()
    assert not both.vtk.is_open


# -- the camera ------------------------------------------------------------------------------------
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("size", [(1100, 640), (820, 560)])
def test_a_point_lies_in_the_same_place_in_both(
    both: MainWindow, qtbot: Any, parallel: bool, size: tuple[int, int]
) -> None:
    stage = wait_for_stage(both, qtbot)
    both.resize(*size)
    camera = Camera(
        position=(90, -60, 70), focal_point=(18, 22, 17), view_up=(0.2, 0.1, 1), view_angle=34,
        parallel_projection=parallel, parallel_scale=30, window_center=(0.1, -0.2),
    )  # fmt: skip
    both.editor.change("Look", camera=camera)
    qtbot.wait(60)
    points = np.random.default_rng(0).uniform(0, 40, (20, 3))
    ours = PictureView(camera, stage.view.width(), stage.view.height()).places(points)
    assert np.abs(places_in_window(stage, points) - ours).max() < 1


@pytest.mark.parametrize(
    "scale", [1.5, pytest.param(1.0, marks=pytest.mark.slow), pytest.param(2.0, marks=pytest.mark.slow)]
)
def test_both_views_agree_within_a_pixel_at_each_pixel_ratio(scale: float, tmp_path: Any) -> None:
    """Projected points, and a ball found in both pictures; two sizes of the window, both projections."""
    env = {**os.environ, "QT_SCALE_FACTOR": str(scale), "SFUMATO_SETTINGS": str(tmp_path)}
    run = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("link_walk.py"))],
        env=env, capture_output=True, text=True, timeout=240, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout.splitlines()[-1])
    assert found["ratio"] == scale
    assert found["projected"] < 1
    assert found["seen"] < 1.5, "of pixels, in which edges of the ball are found"


def test_moves_in_the_vtk_view_move_the_lit_view(both: MainWindow, hand: Any, qtbot: Any) -> None:
    stage = wait_for_stage(both, qtbot)
    before = both.editor.scene.camera
    middle = stage.view.rect().center()
    hand.drag(stage.view, middle + QPoint(60, 60), middle + QPoint(140, 20))
    moved = both.editor.scene.camera
    assert moved is not None
    assert before is not None
    assert np.linalg.norm(np.subtract(moved.position, before.position)) > 5
    assert moved == camera_of(stage.view.renderer.GetActiveCamera())
    assert both.editor.document.undo_label == "Move the camera"
    hand.wait_for_picture()
    hand.wheel(stage.view, 2)
    qtbot.wait(60)
    assert both.editor.scene.camera.distance < moved.distance  # type: ignore[union-attr]
    both.editor.undo()
    both.editor.undo()
    assert both.editor.scene.camera == before, "a drag is one step, a turn of the wheel another"
    qtbot.wait(60)
    assert camera_of(stage.view.renderer.GetActiveCamera()).position == pytest.approx(before.position)


# -- picking and regions ---------------------------------------------------------------------------
def click_at(window: MainWindow, qtbot: Any, point: tuple[float, float, float]) -> None:
    stage = wait_for_stage(window, qtbot)
    x, y = places_in_window(stage, np.array([point]))[0]
    qtbot.mouseClick(stage.view, LEFT, Qt.KeyboardModifier.NoModifier, QPointF(x, y).toPoint())


def test_a_line_is_picked_and_its_neighbours_kept(both: MainWindow, qtbot: Any) -> None:
    panel = both.vtk.panel
    click_at(both, qtbot, (10, 10, 30))
    assert panel.told.text() == "Line 1: 32 mm"
    click_at(both, qtbot, (20, 10, 8))
    assert panel.told.text() == "Line 2: 12 mm"
    assert both.editor.scene.camera is not None
    qtbot.mouseClick(panel.keep, LEFT)
    (roi,) = both.editor.scene.geometry[0].rois
    assert np.linalg.norm(np.subtract(roi.center, (20, 10, 8))) < 2
    assert both.view_page.shapes.count.text() == "1 of 2 lines"
    click_at(both, qtbot, (10, 10, 30))
    assert panel.told.text() == "Click a line to pick it", "it is not there any more"
    qtbot.mouseClick(panel.all_lines, LEFT)
    assert both.editor.scene.geometry[0].rois == ()
    both.editor.change("Colour", **{"geometry.0.color_by": "scalar"})
    click_at(both, qtbot, (20, 10, 8))
    assert panel.told.text() == "Line 2: 12 mm, fa 2"


def test_what_is_picked_is_what_lies_under_the_pointer(both: MainWindow, qtbot: Any) -> None:
    """A line nearer to the eye that passes 4 pixels beside it is not taken for it, nor one that a surface hides."""
    stage, camera = wait_for_stage(both, qtbot), Camera(position=(20, -100, 20), focal_point=(20, 20, 20))
    both.editor.change("Look", camera=camera)
    mm = PictureView(camera, stage.view.width(), stage.view.height()).mm_per_pixel(np.array([20.0, 20, 20]))
    near, far = [[4, 19, 20 + 4 * mm], [36, 19, 20 + 4 * mm]], [[4, 20, 20], [36, 20, 20]]
    hidden = [[4, 30, 14], [36, 30, 14]]
    square = Surface(
        np.array([[0.0, 25, 10], [40, 25, 10], [40, 25, 17], [0, 25, 17]]), np.array([[0, 1, 2], [0, 2, 3]])
    )
    lines = Geometry(Lines.of([near, far, hidden]), radius=0.05)
    both.editor.change("Three", geometry=(lines, Geometry(square)))
    stage = wait_for_stage(both, qtbot)
    picks: list[Any] = []
    points: list[Any] = []
    stage.picked.connect(picks.append)
    stage.clicked.connect(points.append)
    for point in ([12, 20, 20], [12, 19, 20 + 4 * mm], [12, 30, 14]):
        at = places_in_window(stage, np.array([point], float))[0]
        stage.pick(QPointF(*at))
        assert np.abs(places_in_window(stage, np.array(points[-1:]))[0] - at).max() < 0.1
    assert [p and p.line for p in picks] == [1, 0, None]
    assert points[2][1] == pytest.approx(25, abs=0.01), "on the surface"
    both.editor.change("One", geometry=(lines,))
    stage = wait_for_stage(both, qtbot)
    stage.pick(QPointF(*at))
    assert picks[-1].line == 2


def choose(panel: Any, name: str) -> None:
    index = panel.tool.findData(name)
    assert index >= 0, f"{name} is not offered"
    panel.tool.setCurrentIndex(index)
    panel.tool.activated.emit(index)


def test_a_box_chooses_lines(both: MainWindow, hand: Any, qtbot: Any) -> None:
    panel = both.vtk.panel
    assert panel.tool.findData("sphere") < 0, "seeds need a vector field"
    choose(panel, "box")
    (roi,) = both.editor.scene.geometry[0].rois
    assert roi.kind == "box"
    assert roi.center == pytest.approx((20, 20, 20), abs=0.5)
    qtbot.wait(60)
    before = roi.center
    # The handle in the middle of the box moves it; from the front that of the front face would be before it.
    camera = Camera(position=(110, -70, 60), focal_point=(20, 20, 20), view_up=(0, 0, 1))
    both.editor.change("Look", camera=camera)
    qtbot.wait(60)
    x, y = places_in_window(panel.stage, np.array([before]))[0]
    place = QPointF(x, y).toPoint()
    hand.drag(panel.stage.view, place, place + QPoint(0, -60))
    (roi,) = both.editor.scene.geometry[0].rois
    assert roi.center[2] > before[2] + 2, "upwards, as the hand went"


# -- seeds -----------------------------------------------------------------------------------------
@pytest.fixture
def flow(tmp_path: Any) -> str:
    """A flow along x in a box of 40 mm, with a scalar."""
    import pyvista

    grid = pyvista.ImageData(dimensions=(21, 21, 21), spacing=(2, 2, 2))
    grid.point_data["speed of it"] = np.linspace(0, 100, grid.n_points)
    grid.point_data["flow"] = np.tile([1.0, 0.0, 0.0], (grid.n_points, 1))
    grid.save(tmp_path / "flow.vti")
    return str(tmp_path / "flow.vti")


def test_vectors_are_seen_without_a_click(make_window: Any, flow: str, qtbot: Any) -> None:
    window = make_window(size=(1000, 600))
    window.open(flow)
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=60_000)
    (lines,) = window.editor.scene.geometry
    assert lines.kind == "streamlines"
    assert lines.shape.count > 150
    assert not window.editor.document.modified, "nothing to save, nothing to undo"
    controls = window.view_page.shapes.tracing
    assert controls.direction.currentData() == "both"
    choose_in(controls.direction, "forward")
    controls.sliders["length"].number.setValue(10)
    qtbot.waitUntil(lambda: window.editor.scene.geometry[0] is not lines, timeout=60_000)
    (shorter,) = window.editor.scene.geometry
    assert shorter.tracing.direction == "forward"
    assert shorter.shape.lengths.max() < 12 < lines.shape.lengths.max()
    assert window.editor.document.undo_label == "Trace streamlines"


def choose_in(box: Any, data: str) -> None:
    box.setCurrentIndex(box.findData(data))
    box.activated.emit(box.currentIndex())


def test_single_seeds_and_seeds_on_a_surface(make_window: Any, flow: str, tmp_path: Any, qtbot: Any) -> None:
    import pyvista

    pyvista.Sphere(radius=6, center=(20, 20, 20)).save(tmp_path / "ball.stl")
    window = make_window(size=(1000, 600))
    window.files.open_all([flow, str(tmp_path / "ball.stl")])
    qtbot.waitUntil(lambda: len(window.editor.scene.geometry) == 2, timeout=60_000)
    window.strip.vtk.click()
    stage = wait_for_stage(window, qtbot)
    panel = window.vtk.panel

    def seeds() -> Any:
        return window.editor.scene.geometry[0].tracing.seeds

    choose(panel, "surface")
    qtbot.waitUntil(lambda: seeds().kind == "surface", timeout=60_000)
    assert window.editor.scene.geometry[0].shape.bounds[:, 1] == pytest.approx((14, 26), abs=0.5)
    wait_for_stage(window, qtbot)  # the lines that were there before lie in front of the ball
    choose(panel, "points")
    x, y = places_in_window(stage, np.array([[20, 20, 20]]))[0]
    on_ball = QPointF(x, y).toPoint()
    for place in (on_ball, on_ball + QPoint(90, 80)):
        qtbot.mouseClick(stage.view, LEFT, Qt.KeyboardModifier.NoModifier, place)
    qtbot.waitUntil(lambda: len(seeds().places) == 2, timeout=60_000)
    first = np.array(seeds().places[0])
    assert np.linalg.norm(first - 20) < 10, "on the ball, or on a line before it"
    seen = places_in_window(stage, first[None])[0]
    assert np.abs(seen - (on_ball.x(), on_ball.y())).max() < 1, "where the click was"


def test_seeds_are_placed_and_streamlines_follow(
    make_window: Any, hand_of: Any, flow: str, qtbot: Any
) -> None:
    window = make_window(size=(1000, 600))
    window.open(flow)
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=60_000)
    window.strip.vtk.click()
    stage = wait_for_stage(window, qtbot)
    panel = window.vtk.panel
    choose(panel, "sphere")
    qtbot.waitUntil(lambda: window.editor.scene.geometry[0].tracing.seeds.kind == "sphere", timeout=60_000)
    first = window.editor.scene.geometry[0]
    assert first.kind == "streamlines"
    assert first.shape.count == 200
    assert np.abs(np.diff(first.shape.points[:2], axis=0)[0][1:]).max() < 1e-4, "along x"
    window.editor.change("Colour", **{"geometry.0.colormap": "magma"})
    panel.count.setValue(50)
    qtbot.waitUntil(lambda: window.editor.scene.geometry[0].shape.count == 50, timeout=60_000)
    assert len(window.editor.scene.geometry) == 1, "new ones replace the old ones"
    assert window.editor.scene.geometry[0].colormap == "magma", "and look as they did"
    choose(panel, "line")
    qtbot.waitUntil(lambda: window.editor.scene.geometry[0].tracing.seeds.kind == "line", timeout=60_000)
    choose(panel, "plane")
    qtbot.waitUntil(lambda: window.editor.scene.geometry[0].tracing.seeds.kind == "plane", timeout=60_000)
    assert stage.view.isValid()


# -- failures --------------------------------------------------------------------------------------
def test_without_vtk_the_rest_lives_on(
    window: MainWindow, hand: Any, qtbot: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    import pyvistaqt

    class Broken:
        def __init__(self, *_: object, **__: object) -> None:
            raise RuntimeError("no OpenGL 3.2 here")

    monkeypatch.setattr(pyvistaqt, "QtInteractor", Broken)
    qtbot.mouseClick(window.strip.vtk, LEFT)
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=60_000)
    assert "no OpenGL 3.2 here" in window.messages.text
    assert not window.strip.vtk.isChecked()
    window.look("left")
    hand.wait_for_picture()


def test_a_scene_can_be_changed_while_vtk_starts_and_the_window_closed(
    make_window: Any, ball_scene: Scene, qtbot: Any
) -> None:
    window = make_window(ball_scene)
    window.strip.vtk.click()
    window.editor.change("Add two", geometry=(two_lines(),))
    window.editor.change(
        "Transfer", transfer=TransferFunction.from_points([(0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.5)])
    )
