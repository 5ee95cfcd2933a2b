"""Exporting the picture as a user does it: dialog, file, progress, cancel, clipboard, and what may go wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QApplication, QDialog, QDialogButtonBox, QFileDialog, QPushButton, QWidget

from sfumato.export.picture import PictureSpec
from sfumato.export.png import open_png
from sfumato_ui.export_dialog import ExportDialog
from sfumato_ui.export_size import PRESETS, ExportSize, duration_words, memory_words
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(autouse=True)
def qt_file_dialogs(qapp: QApplication) -> Any:
    """Use Qt's own file dialogs, into which a test can type."""
    qapp.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs, True)
    yield
    qapp.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs, False)


def shown(window: MainWindow, qtbot: QtBot, kind: type[QDialog]) -> Any:
    """Wait for a dialog of a kind and return it."""
    found: list[QDialog] = []

    def there() -> bool:
        found[:] = [d for d in window.findChildren(kind) if d.isVisible()]
        return bool(found)

    qtbot.waitUntil(there, timeout=20_000)
    return found[0]


def type_into(field: Any, qtbot: QtBot, text: str) -> None:
    """Type a number over what a field holds."""
    field.setFocus()
    field.selectAll()
    qtbot.keyClicks(field, text)


def choose(box: Any, qtbot: QtBot, text: str) -> None:
    """Choose an entry of a menu by the arrow keys."""
    box.setFocus()
    qtbot.keyClick(box, Qt.Key.Key_Home)
    while box.currentText() != text:
        before = box.currentText()
        qtbot.keyClick(box, Qt.Key.Key_Down)
        assert box.currentText() != before, f"there is no {text!r}"
    box.activated.emit(box.currentIndex())


def name_file(dialog: QFileDialog, qtbot: QtBot, path: Path) -> None:
    """Name a file in a file dialog and press Save."""
    dialog.selectFile(str(path))
    button = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Save)
    qtbot.mouseClick(button, LEFT)


def wait_for_end(window: MainWindow, qtbot: QtBot) -> str:
    """Wait until the bar tells how it ended; returns what it says."""
    qtbot.waitUntil(lambda: window.messages.kind in ("notice", "error"), timeout=90_000)
    return window.messages.text


def open_dialog(window: MainWindow, hand: Any, qtbot: QtBot) -> ExportDialog:
    hand.press(Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    return shown(window, qtbot, ExportDialog)  # type: ignore[no-any-return]


def test_pixels_to_png(window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path) -> None:
    dialog = open_dialog(window, hand, qtbot)
    assert dialog.wish.spec.size == window.viewport.pixel_size
    # The first picture reaches the viewport and the exporter by two events: the dialog may be open in between.
    qtbot.waitUntil(lambda: "about" in dialog.summary.text())
    qtbot.mouseClick(dialog.lock, LEFT, pos=QPoint(8, dialog.lock.height() // 2))
    type_into(dialog.pixels[0], qtbot, "320")
    type_into(dialog.pixels[1], qtbot, "200")
    assert dialog.preset.currentText() == "Own size"
    choose(dialog.quality, qtbot, "Draft")
    qtbot.keyClick(dialog, Qt.Key.Key_Return)
    target = tmp_path / "picture.png"
    name_file(shown(window, qtbot, QFileDialog), qtbot, target)
    assert wait_for_end(window, qtbot) == f"Saved {target}"
    with Image.open(target) as picture:
        assert picture.size == (320, 200)
        assert picture.info["dpi"] == pytest.approx((300, 300), abs=0.02)
        assert np.asarray(picture)[..., 3].min() == 255, "what is saved is what is seen, the grey too"
    assert open_png(target, volume=window.editor.scene.volume) == window.editor.scene


def test_millimetres_to_tiff_with_scale_bar(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    tifffile = pytest.importorskip("tifffile")
    window.editor.change("Orthographic", **{"camera.parallel_projection": True})
    hand.wait_for_picture()
    dialog = open_dialog(window, hand, qtbot)
    choose(dialog.preset, qtbot, "One column, 85 mm wide")
    type_into(dialog.dpi, qtbot, "100")
    assert dialog.pixels[0].value() == 335
    assert dialog.lengths[0].value() == 85
    type_into(dialog.lengths[0], qtbot, "50.8")
    assert dialog.pixels[0].value() == 200
    seen = window.viewport.pixel_size
    assert dialog.pixels[1].value() == pytest.approx(200 * seen[1] / seen[0], abs=1), "proportions stay"
    for box in (dialog.transparent, dialog.scale_bar):
        qtbot.mouseClick(box, LEFT, pos=QPoint(8, box.height() // 2))
    choose(dialog.format, qtbot, "TIFF")
    choose(dialog.bits, qtbot, "16 bits")
    choose(dialog.quality, qtbot, "Draft")
    width, height = dialog.wish.spec.size
    qtbot.mouseClick(dialog.go, LEFT)
    target = tmp_path / "picture.tif"
    name_file(shown(window, qtbot, QFileDialog), qtbot, target)
    assert wait_for_end(window, qtbot) == f"Saved {target}"
    with tifffile.TiffFile(target) as file:
        pixels = file.asarray()
        assert file.pages[0].tags["XResolution"].value == (100_000, 1000)
    assert pixels.shape == (height, width, 4)
    assert pixels.dtype == np.uint16
    assert pixels[:5, :5, 3].max() == 0, "nothing behind the subject"
    again = open_dialog(window, hand, qtbot)
    assert (again.format.currentText(), again.dpi.value()) == ("TIFF", 100), "remembered"
    qtbot.keyClick(again, Qt.Key.Key_Escape)


def test_scale_bar_needs_an_orthographic_view(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    dialog = open_dialog(window, hand, qtbot)
    assert not dialog.scale_bar.isEnabled()
    assert "orthographic" in dialog.scale_bar.toolTip()
    type_into(dialog.pixels[0], qtbot, "60000")
    assert not dialog.go.isEnabled()
    assert "Too large" in dialog.summary.text()
    qtbot.keyClick(dialog, Qt.Key.Key_Escape)


def test_the_dialog_by_tab_alone(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    dialog = open_dialog(window, hand, qtbot)
    wanted: list[QWidget] = [
        dialog.preset, *dialog.pixels, *dialog.lengths, dialog.lock, dialog.dpi, dialog.format, dialog.bits,
        dialog.quality, dialog.transparent,
    ]  # fmt: skip
    dialog.preset.setFocus()
    for control in wanted:
        assert dialog.focusWidget() is control
        named = control.accessibleName() or getattr(control, "text", str)()
        assert named
        assert control.toolTip()
        assert control.height() >= 24 or control in (dialog.lock, dialog.transparent)
        qtbot.keyClick(control, Qt.Key.Key_Tab)
    qtbot.keyClick(dialog, Qt.Key.Key_Escape)


def test_cancel_leaves_nothing_and_the_view_goes_on(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    window.exporter.export(str(tmp_path / "large.png"), PictureSpec((3000, 2500), frames=32))
    qtbot.waitUntil(lambda: window.messages.kind == "progress")
    assert "Exporting large.png" in window.messages.text
    window.editor.change_light("Move the light", tilt=55.0)
    hand.wait_for_picture()  # while the export goes on
    assert window.messages.kind == "progress"
    cancel = next(b for b in window.messages.findChildren(QPushButton) if b.text() == "Cancel")
    qtbot.mouseClick(cancel, LEFT)
    qtbot.waitUntil(lambda: not window.messages.isVisible(), timeout=20_000)
    qtbot.waitUntil(lambda: not [p for p in tmp_path.iterdir() if "large" in p.name], timeout=20_000)


def test_what_cannot_be_written_is_a_message(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    window.exporter.export(str(tmp_path / "missing" / "x.png"), PictureSpec((64, 64), frames=1))
    assert "missing" in wait_for_end(window, qtbot)
    assert window.messages.kind == "error"
    assert "choose another place" in window.messages.text
    window.editor.change_light("Move the light", tilt=50.0)
    hand.wait_for_picture()
    assert window.messages.kind == "error", "a good picture does not take the message away"


def test_a_narrow_picture_keeps_what_was_seen(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    width, height = window.viewport.pixel_size
    window.exporter.export(str(tmp_path / "n.png"), PictureSpec((width // 4, height), frames=1))
    wait_for_end(window, qtbot)
    camera = open_png(tmp_path / "n.png", window.editor.scene.volume).camera
    assert camera is not None
    seen = window.editor.scene.camera.half_extent(width / height)[0]
    assert camera.half_extent(width // 4 / height)[0] == pytest.approx(seen, rel=0.02)


def test_copying(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    hand.press(Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier)
    assert "Copied" in window.messages.text
    image = QApplication.clipboard().image()
    assert (image.width(), image.height()) == window.viewport.pixel_size
    place = QPoint(image.width() // 2, image.height() // 2)
    seen = hand.pixels()[place.y(), place.x()]
    got = image.pixelColor(place)
    assert [got.blue(), got.green(), got.red()] == pytest.approx(list(seen[:3]), abs=1)
    assert image.pixelColor(0, 0).name() == "#4e4e4e", "on the window's grey"


def test_sizes_follow_each_other() -> None:
    size = ExportSize((1600, 800), dpi=200, aspect=2.0)
    assert size.millimetres == pytest.approx((203.2, 101.6))
    assert size.with_side(0, 400).pixels == (400, 200)
    assert size.with_dpi(400).pixels == (1600, 800), "pixels were given"
    paper = size.with_length(1, 25.4)
    assert paper.pixels == (400, 200)
    assert paper.with_dpi(400).pixels == (800, 400), "millimetres were given"
    assert size.with_lock(False).with_side(0, 16).pixels == (16, 800)
    a4 = size.with_preset(next(p for p in PRESETS if p.title.startswith("A4,")), (300, 300))
    assert a4.millimetres == (210, 297)
    assert a4.with_side(0, 826).pixels[1] == pytest.approx(826 * 297 / 210, abs=1)
    assert not size.with_side(0, 40_000).possible
    assert (duration_words(0.2), duration_words(600), duration_words(9000)) == (
        "about 1 s", "about 10 min", "about 2.5 h",
    )  # fmt: skip
    assert (memory_words(10 << 20), memory_words(3 << 30)) == ("10 MiB", "3.0 GiB")
