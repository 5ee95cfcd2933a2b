"""The transfer function by hand: points, the function as a whole, the view, typed numbers, keys."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QColor
from qtpy.QtWidgets import QApplication, QColorDialog

from sfumato import Region, Scene, TransferFunction, TransferPoint, Volume, VolumeInfo
from sfumato_ui.transfer_editor import histogram
from sfumato_ui.transfer_editor.painting import text_of
from sfumato_ui.transfer_editor.plot import TransferPlot
from sfumato_ui.transfer_editor.scale import nudge, ticks
from sfumato_ui.transfer_editor.tissue import tissue_at
from sfumato_ui.window import MainWindow

SHIFT, ALT, CONTROL = (
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ControlModifier,
)
START = (TransferPoint(20, (0.9, 0.85, 0.8), 0.0), TransferPoint(120, (0.9, 0.85, 0.8), 0.9))


@pytest.fixture
def plot(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> TransferPlot:
    """The plot in a window whose Material tab is in front."""
    window: MainWindow = make_window(ball_scene, size=(760, 760))
    window.panel.setCurrentIndex(1)
    plot = window.material_page.transfer.plot
    qtbot.waitUntil(lambda: window.isActiveWindow() and plot.isVisible())
    return plot


@pytest.fixture
def user(plot: TransferPlot, hand_of: Any) -> Any:
    return hand_of(plot.window())


def points(plot: TransferPlot) -> tuple[TransferPoint, ...]:
    transfer = plot.window().editor.scene.transfer
    assert transfer is not None
    return transfer.points


def place(plot: TransferPlot, value: float, opacity: float) -> QPoint:
    return plot.scale.at(value, opacity).toPoint()


def undo(plot: TransferPlot) -> None:
    plot.window().editor.undo()


def test_dragging_a_point_is_one_step_and_changes_the_picture(plot: TransferPlot, user: Any) -> None:
    user.wait_for_picture()
    before = user.pixels()
    user.drag(plot, place(plot, 120, 0.9), place(plot, 160, 0.04))
    assert points(plot)[0] == START[0]
    assert points(plot)[1].value == pytest.approx(160, abs=2)
    assert points(plot)[1].opacity == pytest.approx(0.04, abs=0.01)
    assert plot.selected == 1
    user.wait_for_picture()
    assert np.abs(user.pixels() - before).mean() > 0.5
    undo(plot)
    assert points(plot) == START, "one drag is one step"
    assert not plot.window().editor.document.undo_label


def test_a_point_is_hit_from_twelve_pixels_away_and_keeps_its_distance(plot: TransferPlot, user: Any) -> None:
    start = place(plot, 120, 0.9) + QPoint(8, 8)
    user.drag(plot, start, start + QPoint(0, 40))
    assert points(plot)[1].value == pytest.approx(120, abs=0.01)
    assert points(plot)[1].opacity < 0.6


def test_points_snap_to_the_histograms_peaks_unless_ctrl_is_held(plot: TransferPlot, user: Any) -> None:
    peak = plot.peaks[-1]
    assert peak > 150, "the ball's own value"
    beside = place(plot, peak, 0.5) - QPoint(4, 0)
    user.drag(plot, place(plot, 120, 0.9), beside)
    assert points(plot)[1].value == pytest.approx(peak, abs=1e-3)
    undo(plot)
    user.drag(plot, place(plot, 120, 0.9), beside, keys=CONTROL)
    assert points(plot)[1].value == pytest.approx(peak - 4 * plot.scale.per_pixel, abs=plot.scale.per_pixel)
    assert points(plot)[1].value != pytest.approx(peak, abs=0.5 * plot.scale.per_pixel)


def test_colours_of_a_map_and_the_mirror(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    page = plot.window().material_page
    page.more.set_open(True)
    row = page.maps
    page.ensureWidgetVisible(row)
    row.maps.setFocus()
    for key, title in ((Qt.Key.Key_Down, "Grey"), (Qt.Key.Key_Down, "Bone"), (Qt.Key.Key_Up, "Grey")):
        qtbot.keyClick(row.maps, key)
        assert plot.window().editor.document.undo_label == f"Colour by {title}"
        assert row.maps.currentText() == title
    colours = [point.color for point in points(plot)]
    assert all(r == pytest.approx(g) == pytest.approx(b) for r, g, b in colours)
    assert [p.opacity for p in (points(plot)[0], points(plot)[-1])] == [0.0, 0.9]
    while plot.window().editor.document.undo_label:
        undo(plot)
    assert points(plot) == START
    assert row.maps.currentIndex() == 0, "no map any more"
    qtbot.mouseClick(row.mirror, Qt.MouseButton.LeftButton)
    assert [(p.value, p.opacity) for p in points(plot)] == [(20, 0.9), (120, 0.0)]
    undo(plot)
    assert points(plot) == START


def test_a_point_stops_at_its_neighbour_and_at_the_edges(plot: TransferPlot, user: Any) -> None:
    user.drag(plot, place(plot, 120, 0.9), QPoint(-30, -60))
    assert points(plot)[1].value == 20
    assert points(plot)[1].opacity == 1
    low = plot._whole[0]
    user.drag(plot, place(plot, 20, 0), QPoint(-2000, 900), steps=20)
    assert points(plot)[0].opacity == 0
    assert points(plot)[0].value == low


def test_pressing_on_the_curve_adds_a_point_and_drags_it(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    opacity = 0.9 * (70 - 20) / 100
    user.drag(plot, place(plot, 70, opacity), place(plot, 90, 0.1))
    assert len(points(plot)) == 3
    assert points(plot)[1].value == pytest.approx(90, abs=2)
    assert points(plot)[1].opacity == pytest.approx(0.1, abs=0.02)
    assert points(plot)[1].color == pytest.approx((0.9, 0.85, 0.8))
    assert plot.selected == 1
    undo(plot)
    assert points(plot) == START


def test_a_double_click_adds_and_delete_removes(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    qtbot.mouseDClick(plot, Qt.MouseButton.LeftButton, pos=place(plot, 60, 0.9))
    assert len(points(plot)) == 3
    assert points(plot)[1].opacity == pytest.approx(0.9, abs=0.02)
    qtbot.mouseClick(plot, Qt.MouseButton.LeftButton, pos=place(plot, *_of(points(plot)[1])))
    user.press(Qt.Key.Key_Delete)
    assert points(plot) == START
    user.press(Qt.Key.Key_Delete)
    assert points(plot) == START, "the last two points stay"
    assert not plot.window().material_page.transfer.remove.isEnabled()


def _of(point: TransferPoint) -> tuple[float, float]:
    return point.value, point.opacity


def test_shift_drag_moves_and_widens_the_whole_function(plot: TransferPlot, user: Any) -> None:
    scale, start = plot.scale, QPoint(150, 60)
    user.drag(plot, start, start + QPoint(20, 0), keys=SHIFT)
    shift = 20 * scale.per_pixel
    assert [p.value for p in points(plot)] == pytest.approx([20 + shift, 120 + shift])
    undo(plot)
    user.drag(plot, start, start - QPoint(0, 48), keys=SHIFT)
    low, high = (p.value for p in points(plot))
    assert high - low == pytest.approx(100 * np.exp(0.5))
    assert (low + high) / 2 == pytest.approx(70)
    undo(plot)
    assert points(plot) == START


def test_arrow_keys(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    plot.setFocus()
    user.press(Qt.Key.Key_Right)
    assert plot.selected == 0
    assert points(plot) == START
    user.press(Qt.Key.Key_Right)
    user.press(Qt.Key.Key_Right, SHIFT)
    user.press(Qt.Key.Key_Up, SHIFT)
    step = 1.0 if plot.scale.per_pixel > 0.2 else plot.scale.per_pixel
    assert points(plot)[0].value == pytest.approx(20 + 11 * step)
    assert points(plot)[0].opacity == pytest.approx(0.01)
    user.press(Qt.Key.Key_Right, CONTROL)
    assert plot.selected == 1
    assert "Point 2 of 2" in plot.accessibleDescription()
    undo(plot)
    assert points(plot) == START, "quick nudges are one step"
    user.press(Qt.Key.Key_Insert)
    assert len(points(plot)) == 3
    assert points(plot)[1].value == 70
    undo(plot)
    user.press(Qt.Key.Key_Right, ALT)
    assert points(plot)[0].value == pytest.approx(20 + plot.scale.per_pixel)
    user.press(Qt.Key.Key_Up, ALT)
    assert points(plot)[1].value - points(plot)[0].value == pytest.approx(102)


def test_typed_numbers_and_colour(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    editor = plot.window().material_page.transfer
    qtbot.mouseClick(plot, Qt.MouseButton.LeftButton, pos=place(plot, 120, 0.9))
    for box, text in ((editor.value, "140"), (editor.opacity, "25")):
        box.setFocus()
        box.selectAll()
        qtbot.keyClicks(box, text)
        qtbot.keyClick(box, Qt.Key.Key_Return)
    assert _of(points(plot)[1]) == (140, 0.25)
    # A value beyond the neighbour: the point goes there and stays selected.
    editor.value.selectAll()
    qtbot.keyClicks(editor.value, "5")
    qtbot.keyClick(editor.value, Qt.Key.Key_Return)
    assert plot.selected == 0
    assert _of(points(plot)[0]) == (5, 0.25)


def test_a_point_glows_in_its_colour(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    page = plot.window().material_page
    page.more.set_open(True)
    qtbot.mouseClick(plot, Qt.MouseButton.LeftButton, pos=place(plot, 120, 0.9))
    page.transfer.glow.number.setValue(1.8)
    assert points(plot)[1].emission == pytest.approx((1.8, 1.7, 1.6))
    page.transfer.glow.number.setValue(0)
    assert points(plot)[1].emission == (0, 0, 0)


def test_holding_b_is_the_window_s_also_in_the_gallery(plot: TransferPlot, qtbot: QtBot) -> None:
    window = plot.window()
    before = window.editor.scene
    for widget in (window.material_page.presets, plot):
        widget.setFocus()
        qtbot.keyPress(widget, Qt.Key.Key_B)
        assert window.driver.shown_scene.technique_id == "raycast"
        qtbot.keyRelease(widget, Qt.Key.Key_B)
        assert window.driver.shown_scene == before


def test_the_colour_dialog_is_one_step(plot: TransferPlot, qtbot: QtBot) -> None:
    editor = plot.window().material_page.transfer
    qtbot.mouseClick(plot, Qt.MouseButton.LeftButton, pos=place(plot, 120, 0.9))

    qtbot.mouseClick(editor.color, Qt.MouseButton.LeftButton)
    dialog = editor.color.findChild(QColorDialog)
    for name in ("#ff0000", "#00ff00"):
        dialog.setCurrentColor(QColor(name))
    dialog.accept()
    assert points(plot)[1].color == pytest.approx((0, 1, 0))
    undo(plot)
    assert points(plot) == START


def test_the_wheel_zooms_only_when_focused(plot: TransferPlot, user: Any) -> None:
    plot.window().viewport.setFocus()
    first = plot.scale
    at = place(plot, 120, 0.5)
    user.wheel(plot, 3, at)
    assert plot.scale == first
    plot.setFocus()
    user.wheel(plot, 3, at)
    assert plot.scale.per_pixel == pytest.approx(first.per_pixel / 1.25**3)
    assert plot.scale.x(120) == pytest.approx(first.x(120), abs=1)
    ground = QPoint(round(plot.scale.rect.center().x()), round(plot.scale.rect.top()))
    low = plot.scale.low
    user.drag(plot, ground, ground + QPoint(15, 0))
    assert points(plot) == START, "the ground moves the view alone"
    assert plot.scale.low < low
    user.wheel(plot, -20, at)
    assert plot.scale.per_pixel == pytest.approx((plot._whole[1] - plot._whole[0]) / first.rect.width())
    user.press(Qt.Key.Key_Plus)
    assert plot.scale.per_pixel < first.per_pixel
    user.press(Qt.Key.Key_0)
    assert plot.scale == first


def test_reset_brings_the_preset_back(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    page = plot.window().material_page
    page.presets.setFocus()
    user.press(Qt.Key.Key_Right)
    chosen = plot.window().editor.scene.transfer
    assert chosen is not None
    assert chosen.name
    assert not page.transfer.reset.isVisible()
    plot.select(0)
    plot.change_point("Move the point", False, opacity=0.4)
    assert page.bar.origin.text() == f"{chosen.name}, edited"
    assert page.presets.selectedItems() == []
    qtbot.mouseClick(page.transfer.reset, Qt.MouseButton.LeftButton)
    assert plot.window().editor.scene.transfer == chosen
    undo(plot)
    assert points(plot)[0].opacity == 0.4


def test_shift_width_and_density_keep_the_form(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    page = plot.window().material_page
    page.more.set_open(True)
    page.presets.setFocus()
    user.press(Qt.Key.Key_Right)
    first = points(plot)
    page.level.number.setValue(10)
    assert points(plot)[0].value - first[0].value == pytest.approx(20)
    page.width_of_all.number.setValue(2)
    width = points(plot)[-1].value - points(plot)[0].value
    assert width == pytest.approx(2 * (first[-1].value - first[0].value))
    assert page.level.number.value() == pytest.approx(10)
    page.density.number.setValue(2)
    assert page.density.number.value() == 2
    assert page.width_of_all.number.value() == 2


def test_a_two_dimensional_function_has_no_points(plot: TransferPlot, user: Any, qtbot: QtBot) -> None:
    editor = plot.window().editor
    regions = (Region(value=(50, 150), gradient=(0, 100)),)
    editor.change("Regions", transfer=TransferFunction(regions=regions))
    qtbot.mouseClick(plot, Qt.MouseButton.LeftButton, pos=plot.rect().center())
    plot.setFocus()
    user.press(Qt.Key.Key_Delete)
    assert editor.scene.transfer.regions == regions
    assert not plot.grab().isNull()


def test_a_move_costs_little(plot: TransferPlot, qtbot: QtBot) -> None:
    plot.select(1)
    seconds = []
    for i in range(12):
        plot._hover = QPointF(120 + i, 60)
        started = time.thread_time()  # of this thread alone: the picture is drawn meanwhile
        plot.change_point("Move the point", value=120 + i)
        plot.repaint()
        seconds.append(time.thread_time() - started)
    print(f"a move and its painting: {1e3 * float(np.median(seconds)):.1f} ms")
    assert np.median(seconds) < 0.03


def test_hounsfield_values_are_named_also_when_stored_without_their_intercept(
    make_window: Any, qtbot: QtBot
) -> None:
    z, y, x = np.mgrid[0:24, 0:24, 0:24] - 12
    radius = np.sqrt(x * x + y * y + z * z)
    data = np.where(radius < 5, 1024 + 900, np.where(radius < 9, 1024 + 50, 24)).astype(np.uint16)
    window = make_window(Scene(volume=Volume(data, info=VolumeInfo(modality="CT"))), size=(760, 760))
    window.panel.setCurrentIndex(1)
    plot = window.material_page.transfer.plot
    assert plot.zero == 1024
    assert plot.told(1024 + 50, 0.25) == "50 HU   25 %   muscle"
    plot.select(0)
    box = window.material_page.transfer.value
    assert box.suffix() == " HU"
    assert box.value() == pytest.approx(window.editor.scene.transfer.points[0].value - 1024, abs=0.5)
    box.setValue(-100)
    assert window.editor.scene.transfer.points[plot.selected].value == 924


def test_ticks_numbers_and_tissues() -> None:
    assert ticks(-1050, 1450, 5) == [-1000, -500, 0, 500, 1000]
    assert ticks(0.0, 1.0, 4) == pytest.approx([0, 0.5, 1.0])
    assert text_of(-1000.0, 0) == "\N{MINUS SIGN}1000"
    assert text_of(0.250, 3) == "0.25"
    assert text_of(-0.0, 2) == "0"
    assert nudge(0.25, 10) == pytest.approx(0.36)
    assert nudge(0.001, -10) == 0
    assert (tissue_at(-100), tissue_at(0), tissue_at(700), tissue_at(-400)) == ("fat", "water", "bone", "")


@pytest.mark.parametrize("factor", [1, 0.37])
def test_the_histogram_of_few_whole_numbers_is_no_comb(factor: float) -> None:
    data = np.random.default_rng(1).integers(0, 300, (24, 24, 24)).astype(np.int16)
    if factor != 1:
        data = (data * factor).astype(np.float32)
    heights = histogram.log_histogram(Volume(data)).heights
    assert heights.min() > 0.7
    low, high = histogram.first_range(Volume(data), None, None)
    assert low < 1
    assert high > 298 * factor


def test_tab_leaves_a_focused_list_without_choosing(plot: TransferPlot, qtbot: QtBot) -> None:
    page = plot.window().material_page
    page.bar.unfold.setFocus()
    before = plot.window().editor.scene
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Tab)
    assert page.presets.hasFocus()
    assert plot.window().editor.scene == before
