"""The two-dimensional function by hand: the switch, shapes, handles, keys, typed numbers, presets, pick."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtWidgets import QApplication, QFileDialog, QMenu, QWidget

from sfumato import Region, Scene, TransferFunction, Volume
from sfumato_ui.preset_gallery import FEW
from sfumato_ui.transfer_editor import region_painting
from sfumato_ui.transfer_editor.canvas import HIT
from sfumato_ui.transfer_editor.region_editor import RegionEditor
from sfumato_ui.transfer_editor.region_plot import RegionPlot
from sfumato_ui.transfer_preview import visible_range
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
SHIFT, ALT, CONTROL = (
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ControlModifier,
)
BOX = Region("rectangle", (60, 140), (8, 40), color=(1, 0.1, 0.1))
ROUND = Region("ellipse", (20, 50), (4, 30), color=(0.1, 0.1, 1))


@pytest.fixture
def window(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> MainWindow:
    """A window whose Material tab is in front; its picture is not waited for."""
    window: MainWindow = make_window(ball_scene.with_(technique="raycast"), size=(760, 760))
    window.panel.setCurrentIndex(1)
    qtbot.waitUntil(lambda: window.isActiveWindow() and window.material_page.transfer.plot.isVisible())
    return window


@pytest.fixture
def shapes(window: MainWindow, qtbot: QtBot) -> RegionEditor:
    """Its editor of shapes, on a rectangle and an ellipse, with all voxels counted."""
    editor = window.editor
    assert editor.scene.transfer is not None
    editor.change("Shapes", transfer=replace(editor.scene.transfer, regions=(BOX, ROUND)))
    window.editor.document.reset(editor.scene)
    shapes = window.material_page.transfer.shapes
    window.material_page.ensureWidgetVisible(shapes)
    voxels = editor.scene.volume.data.size
    qtbot.waitUntil(lambda: shapes.plot.isVisible() and shapes.plot.joint.counts.sum() == voxels)
    return shapes


@pytest.fixture
def plot(shapes: RegionEditor) -> RegionPlot:
    return shapes.plot


@pytest.fixture
def user(window: MainWindow, hand_of: Any) -> Any:
    return hand_of(window)


def place(plot: RegionPlot, value: float, gradient: float) -> QPoint:
    return plot.plane.at(value, gradient).toPoint()


def click(qtbot: QtBot, widget: Any, at: QPoint | None = None) -> None:
    qtbot.mouseClick(widget, LEFT, pos=at or widget.rect().center())


def undo_all(plot: RegionPlot) -> int:
    """Undo everything, and return how many steps that took."""
    steps, editor = 0, plot.window().editor
    while editor.document.undo_label:
        editor.undo()
        steps += 1
    return steps


# -- the switch -------------------------------------------------------------------------------------
def test_the_switch_keeps_the_picture_and_loses_nothing(window: MainWindow, user: Any, qtbot: QtBot) -> None:
    transfer, first = window.material_page.transfer, window.editor.scene.transfer
    user.wait_for_picture()
    before = user.pixels()
    click(qtbot, transfer.dimensions.buttons[1])
    two = window.editor.scene.transfer
    assert [r.shape for r in two.regions] == ["curve"]
    assert two.points == first.points
    assert transfer.shapes.isVisible()
    assert not transfer.plot.isVisible()
    user.wait_for_picture()
    assert np.abs(user.pixels() - before).mean() < 1, "the same picture"
    click(qtbot, transfer.shapes.duplicate)
    click(qtbot, transfer.dimensions.buttons[0])
    assert window.editor.scene.transfer == first
    assert transfer.plot.isVisible()
    click(qtbot, transfer.dimensions.buttons[1])
    assert len(window.editor.scene.transfer.regions) == 2, "the shapes come back"
    for _ in range(4):
        window.editor.undo()
    assert window.editor.scene.transfer == first
    assert transfer.dimensions.buttons[0].isChecked()
    click(qtbot, transfer.dimensions.buttons[1])
    click(qtbot, transfer.shapes.duplicate)
    click(qtbot, transfer.dimensions.buttons[0])
    window.material_page.presets.setCurrentRow(1)
    click(qtbot, transfer.dimensions.buttons[1])
    assert len(window.editor.scene.transfer.regions) == 1, "another function begins anew"


def test_shapes_of_another_volume_do_not_come_back(window: MainWindow, qtbot: QtBot) -> None:
    transfer = window.material_page.transfer
    click(qtbot, transfer.dimensions.buttons[1])
    click(qtbot, transfer.shapes.duplicate)
    other = Volume(np.arange(60).reshape(3, 4, 5).astype(np.float32))
    window.editor.reset(Scene(volume=other, transfer=TransferFunction()))
    window._show_document()
    click(qtbot, transfer.dimensions.buttons[1])
    assert len(window.editor.scene.transfer.regions) == 1


# -- mouse ------------------------------------------------------------------------------------------
def test_dragging_a_shape_is_one_step(plot: RegionPlot, user: Any) -> None:
    user.drag(plot, place(plot, 80, 30), place(plot, 110, 50))
    moved = plot.regions[0]
    assert plot.selected == 0
    assert moved.value == pytest.approx((90, 170), abs=1.5)
    assert moved.gradient == pytest.approx((28, 60), abs=1)
    assert undo_all(plot) == 1
    assert plot.regions == (BOX, ROUND)


def test_the_viewport_follows_at_drag_quality(plot: RegionPlot, user: Any, qtbot: QtBot) -> None:
    window = plot.window()
    user.wait_for_picture()
    start, drawn = place(plot, 80, 30), []
    window.worker.picture.connect(drawn.append)
    qtbot.mousePress(plot, LEFT, pos=start)
    qtbot.mouseMove(plot, start - QPoint(0, 60))
    assert window.editor.document.dragging
    wanted = window.editor.scene.transfer

    def followed() -> bool:  # a frame of the still picture may yet come in between
        return any(picture.scene.transfer == wanted for picture in drawn)

    qtbot.waitUntil(followed, timeout=30_000)
    qtbot.mouseRelease(plot, LEFT, pos=start - QPoint(0, 60))
    assert next(picture for picture in drawn if picture.scene.transfer == wanted).interactive


def test_handles_stretch_and_are_hit_from_twelve_pixels_away(
    plot: RegionPlot, user: Any, qtbot: QtBot
) -> None:
    click(qtbot, plot, place(plot, 80, 30))
    assert HIT >= 12
    corner = plot.handle_places()["upper right"].toPoint()
    user.drag(plot, corner + QPoint(8, -8), corner + QPoint(8 + 30, -8 - 20))
    stretched = plot.regions[0]
    across, up = plot.plane.per_pixel
    assert stretched.value == pytest.approx((60, 140 + 30 * across), abs=across)
    assert stretched.gradient == pytest.approx((8, 40 + 20 * up), abs=up)
    user.drag(plot, plot.handle_places()["lower"].toPoint(), QPoint(-500, 2000))
    assert plot.regions[0].gradient[0] == 0, "nothing lies below gradient 0"
    assert plot.regions[0].value == stretched.value
    assert undo_all(plot) == 2


def test_a_shape_of_a_few_pixels_is_taken_by_its_middle(plot: RegionPlot, user: Any) -> None:
    across, up = plot.plane.per_pixel
    plot.select(0)
    plot.put_region("Tiny", replace(BOX, value=(150, 150 + 2 * across), gradient=(70, 70 + 2 * up)))
    plot.select(1)
    start = place(plot, 150, 70) + QPoint(-7, 7)
    user.drag(plot, start, start + QPoint(40, 0))
    assert plot.selected == 0, "its edge is near enough"
    assert plot.region.value == pytest.approx((150 + 40 * across, 150 + 42 * across), abs=across / 2)
    middle = plot.handle_places()["middle"].toPoint()
    user.drag(plot, middle, middle - QPoint(40, 0))
    assert np.ptp(plot.region.value) == pytest.approx(2 * across), "moved, not stretched"


def test_an_outline_is_drawn_and_escape_ends_drawing(
    plot: RegionPlot, shapes: RegionEditor, user: Any, qtbot: QtBot
) -> None:
    window = plot.window()
    shapes.add.menu().actions()[3].trigger()
    assert plot.drawing
    qtbot.waitUntil(plot.hasFocus)
    user.press(Qt.Key.Key_Escape)
    assert not plot.drawing
    assert not window.editor.document.undo_label
    shapes.add.menu().actions()[3].trigger()
    middle, corners = place(plot, 150, 60), [(40, 0), (0, 40), (-40, 0), (0, -40)]
    qtbot.mousePress(plot, LEFT, pos=middle + QPoint(40, 0))
    for x, y in [*corners[1:], corners[0]]:
        for part in np.linspace(0, 1, 9):
            before = corners[(corners.index((x, y)) - 1) % 4]
            at = QPointF(before[0] * (1 - part) + x * part, before[1] * (1 - part) + y * part)
            qtbot.mouseMove(plot, middle + at.toPoint())
    qtbot.mouseRelease(plot, LEFT, pos=middle + QPoint(40, 0))
    drawn = plot.regions[-1]
    assert drawn.shape == "polygon"
    assert 4 <= len(drawn.points) <= 6
    assert plot.selected == 2
    across, _up = plot.plane.per_pixel
    assert np.ptp([v for v, _ in drawn.points]) == pytest.approx(80 * across, abs=3 * across)
    user.drag(plot, plot.handle_places()["corner 1"].toPoint(), middle + QPoint(60, 0))
    assert plot.regions[-1].points[1:] == drawn.points[1:]
    assert undo_all(plot) == 2


def test_a_double_click_adds_and_the_ground_moves_the_view_when_zoomed(
    plot: RegionPlot, user: Any, qtbot: QtBot
) -> None:
    ground = place(plot, 170, 70)
    qtbot.mouseDClick(plot, LEFT, pos=ground)
    added = plot.regions[2]
    assert added.shape == "rectangle"
    assert added.value[0] < 170 < added.value[1]
    assert undo_all(plot) == 1
    plot.setFocus()
    seen, under = plot.plane, place(plot, 100, 60)
    user.wheel(plot, 3, under)
    assert plot.plane.per_pixel[0] < 0.6 * seen.per_pixel[0]
    assert (place(plot, 100, 60) - under).manhattanLength() <= 2
    low = plot.plane.gradients[0]
    corner = plot.plane.rect.topRight().toPoint() + QPoint(-15, 15)
    user.drag(plot, corner, corner + QPoint(0, 20))
    assert plot.plane.gradients[0] > low
    user.press(Qt.Key.Key_0)
    assert plot.plane == seen
    assert undo_all(plot) == 0, "looking is no step"


# -- keys and fields --------------------------------------------------------------------------------
def test_all_of_it_by_keys(plot: RegionPlot, user: Any) -> None:
    plot.setFocus()
    plot.select(0)
    across, up = plot.plane.per_pixel
    user.press(Qt.Key.Key_Right)
    user.press(Qt.Key.Key_Up, SHIFT)
    assert plot.region.value[0] == pytest.approx(60 + across)
    assert plot.region.gradient[0] == pytest.approx(8 + 10 * up)
    user.press(Qt.Key.Key_Right, ALT)
    assert np.ptp(plot.region.value) == pytest.approx(80 + across)
    user.press(Qt.Key.Key_Right, CONTROL)
    assert plot.selected == 1
    user.press(Qt.Key.Key_PageDown)
    assert [r.shape for r in plot.regions] == ["ellipse", "rectangle"]
    assert plot.selected == 0
    user.press(Qt.Key.Key_D, CONTROL)
    assert [r.shape for r in plot.regions] == ["ellipse", "ellipse", "rectangle"]
    assert plot.selected == 1
    user.press(Qt.Key.Key_Insert)
    assert plot.region.shape == "rectangle"
    for _ in range(5):
        user.press(Qt.Key.Key_Delete)
    assert len(plot.regions) == 1, "the last one stays"
    assert "1 of 1" in plot.accessibleDescription()
    undo_all(plot)
    assert plot.regions == (BOX, ROUND)


def test_the_list_and_the_fields(shapes: RegionEditor, window: MainWindow, qtbot: QtBot) -> None:
    plot = shapes.plot
    assert [shapes.shape.itemText(i) for i in range(2)] == ["1  Rectangle", "2  Ellipse"]
    shapes.shape.setFocus()
    qtbot.keyClick(shapes.shape, Qt.Key.Key_Up)
    assert plot.selected == 0
    shapes.opacity.setValue(25)
    shapes.soft.setValue(60)
    shapes.color.picked.emit((0.2, 0.3, 0.4))
    shapes.glow.number.setValue(2)
    region = plot.regions[0]
    assert (region.opacity, region.feather, region.color) == (0.25, 0.6, (0.2, 0.3, 0.4))
    assert max(region.emission) == pytest.approx(2)
    extents = shapes.extents
    extents.values[0].setValue(100)
    assert plot.regions[0].value == (100, 140)
    extents.values[0].setValue(150)
    assert plot.regions[0].value == (150, 190), "the other end gives way"
    extents.gradients[1].setValue(16)
    assert plot.regions[0].gradient == (8, 16)
    extents.gradients[1].setValue(0)
    assert plot.regions[0].gradient[0] >= 0
    assert extents.gradients[0].suffix() == " /mm"
    click(qtbot, shapes.over)
    assert plot.selected == 1
    assert not shapes.over.isEnabled()
    click(qtbot, shapes.remove)
    assert plot.regions == (ROUND,)
    assert not shapes.remove.isEnabled()


def test_the_menu_adds_each_shape_aside_of_the_last(shapes: RegionEditor) -> None:
    menu: QMenu = shapes.add.menu()
    for action in [menu.actions()[i] for i in (0, 0, 1, 2, 4)]:
        action.trigger()
    added = shapes.plot.regions[2:]
    assert [r.shape for r in added] == ["rectangle", "rectangle", "ellipse", "trapezoid", "curve"]
    assert len({r.extent for r in added}) == 5
    assert not shapes.color.isEnabled(), "a curve has the points' colours"


# -- presets, pick ----------------------------------------------------------------------------------
def test_an_own_preset_keeps_the_shapes(window: MainWindow, shapes: RegionEditor, qtbot: QtBot) -> None:
    page = window.material_page
    click(qtbot, page.bar.save)
    qtbot.keyClicks(page.ask.text, "Two shapes")
    qtbot.keyClick(page.ask.text, Qt.Key.Key_Return)
    (path,) = (Path(os.environ["SFUMATO_SETTINGS"]) / "presets").glob("*.json")
    assert path.name == "two-shapes.json"
    page.presets.setCurrentRow(0)
    assert not window.editor.scene.transfer.regions
    page.presets.setCurrentRow(page.presets.count() - 1)
    assert window.editor.scene.transfer.regions == (BOX, ROUND)
    assert not shapes.window().material_page.transfer.reset.isVisible()
    assert visible_range(window.editor.scene.transfer) == (20, 140)


def test_presets_are_found_exported_and_imported(
    window: MainWindow, shapes: RegionEditor, qtbot: QtBot, tmp_path: Path
) -> None:
    page = window.material_page
    page.more.set_open(True)
    page.ensureWidgetVisible(page.files)

    def answer(button: QWidget, path: Path) -> None:
        click(qtbot, button)
        (dialog,) = (d for d in window.findChildren(QFileDialog) if d.isVisible())
        dialog.fileSelected.emit(str(path))
        dialog.reject()
        qtbot.wait(1)

    shared = tmp_path / "shared.json"
    answer(page.files.share, shared)
    window.editor.change("Other", transfer=TransferFunction())
    answer(page.files.get, shared)
    assert window.editor.scene.transfer.regions == (BOX, ROUND)
    assert page.presets.currentItem().text() == "shared"
    built_in = page.presets.item(0).text()
    page.own.write(shared, built_in, TransferFunction())
    page.files.take(str(shared))
    assert window.editor.scene.transfer.name == f"{built_in} 2", "names stay unique"
    page.files.words.setFocus()
    rows, height = page.presets.count(), page.presets.height()
    qtbot.keyClicks(page.files.words, "SHAR")
    assert [page.presets.item(i).text() for i in range(rows) if not page.presets.isRowHidden(i)] == ["shared"]
    assert page.presets.height() < height
    page.files.words.clear()
    assert page.presets.height() == height
    shared.write_text("{nonsense")
    refused = []
    window.editor.rejected.connect(refused.append)
    answer(page.files.get, shared)
    assert "cannot be imported" in refused[0]


def test_the_gallery_shows_the_first_presets_until_it_is_unfolded(
    window: MainWindow, hand: Any, qtbot: QtBot
) -> None:
    window.panel.setCurrentWidget(window.material_page)
    page, gallery = window.material_page, window.material_page.presets

    def shown() -> int:
        return sum(not gallery.isRowHidden(row) for row in range(gallery.count()))

    assert gallery.count() > FEW
    assert shown() == FEW
    folded = gallery.height()
    click(qtbot, page.bar.unfold)
    assert shown() == gallery.count()
    assert gallery.height() > folded
    click(qtbot, page.bar.unfold)
    assert (shown(), gallery.height()) == (FEW, folded)
    last = page._presets[-1]
    window.editor.change("Other", transfer=last.transfer)
    assert shown() == gallery.count(), "the scene's preset is shown"
    assert gallery.currentItem().text() == last.name
    click(qtbot, page.bar.unfold)
    page.more.set_open(True)
    page.files.words.setFocus()
    qtbot.keyClicks(page.files.words, last.name)
    assert not gallery.isRowHidden(gallery.count() - 1), "a search finds all"


def test_shift_moves_the_shapes_too(window: MainWindow, shapes: RegionEditor) -> None:
    page = window.material_page
    page.presets.setCurrentRow(0)
    window.editor.change("Shapes", transfer=replace(window.editor.scene.transfer, regions=(BOX,)))
    page.level.edited.emit(10)
    assert shapes.plot.regions[0].value == pytest.approx((80, 160)), "a tenth of the volume's range"


def test_a_picked_material_is_marked_and_its_shape_selected(
    window: MainWindow, shapes: RegionEditor, qtbot: QtBot
) -> None:
    plot = shapes.plot
    plot.select(1)
    window.viewport.setFocus()
    qtbot.keyClick(window.viewport, Qt.Key.Key_P)
    click(qtbot, window.viewport)
    assert plot.picked is not None
    value, gradient = plot.picked
    assert 8 < gradient < 13, "the ball's slope"
    under = BOX if plot.selected == 0 else ROUND
    assert under.value[0] <= value <= under.value[1]
    assert under.gradient[0] <= gradient <= under.gradient[1]
    plot.add_shape("ellipse")
    (low, high), (flat, steep) = plot.region.extent
    assert low < value < high
    assert flat < gradient < steep, "a new shape comes where one looked"


# -- odd things -------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    "data", [np.full((3, 3, 3), 5, np.uint8), np.zeros((1, 1, 1), np.float32)], ids=["constant", "one voxel"]
)
def test_odd_volumes_have_a_plot(make_window: Any, data: np.ndarray, qtbot: QtBot) -> None:
    window = make_window(Scene(volume=Volume(data), transfer=TransferFunction()), size=(760, 760))
    window.panel.setCurrentIndex(1)
    transfer = window.material_page.transfer
    qtbot.waitUntil(transfer.plot.isVisible)
    click(qtbot, transfer.dimensions.buttons[1])
    transfer.shapes.plot.add_shape("trapezoid")
    assert not transfer.shapes.plot.grab().isNull()
    away = Region("ellipse", (1e6, 2e6), (500, 900))
    transfer.shapes.plot.put_region("Away", away)
    assert not transfer.shapes.plot.grab().isNull(), "a shape outside of all values"
    assert transfer.shapes.plot.handle_places()


def test_the_histogram_is_quiet_and_even_in_both_themes(shapes: RegionEditor) -> None:
    from sfumato_ui.theme import THEMES

    for theme in THEMES.values():
        image = region_painting.histogram_image(shapes.plot.joint, theme)
        bits = image.constBits()
        pixels = np.frombuffer(bits, np.uint8).reshape(image.height(), image.width(), 4)
        assert (pixels[..., 0] == pixels[..., 1]).all(), "no colour of its own"
        assert pixels[..., 3].max() > 180


def test_a_move_costs_little(plot: RegionPlot) -> None:
    import time

    seconds = []
    for i in range(8):
        started = time.thread_time()
        plot.put_region("Move the shape", replace(ROUND, value=(20 + i, 50 + i)), True)
        plot.repaint()
        seconds.append(time.thread_time() - started)
    print(f"a move and its painting: {1e3 * float(np.median(seconds)):.1f} ms")
    assert np.median(seconds) < 0.04
    assert QApplication.instance() is not None
