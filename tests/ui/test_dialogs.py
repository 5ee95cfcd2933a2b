"""The dialogs that opening may need: which series, and how raw voxels are stored."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.uid import ExplicitVRLittleEndian, MRImageStorage, generate_uid
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtWidgets import QApplication, QDialog, QDialogButtonBox, QSpinBox

from sfumato import Scene
from sfumato.io import RawGuess, guess_raw
from sfumato_ui.raw_dialog import RawDialog, middle_slice
from sfumato_ui.recent import recent_files
from sfumato_ui.series_dialog import SeriesDialog, largest_volume
from sfumato_ui.slices import slice_image
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
OPEN = QDialogButtonBox.StandardButton.Open


def write_series(folder: Path, name: str, count: int, size: int, value: int = 300) -> None:
    """Write a small MR series: a bright square on black."""
    folder.mkdir(exist_ok=True)
    series, study = generate_uid(), generate_uid()
    pixels = np.zeros((size, size), "<u2")
    pixels[size // 4 : size // 2, size // 4 : size // 2] = value
    for i in range(count):
        meta = FileMetaDataset()
        meta.TransferSyntaxUID = ExplicitVRLittleEndian
        meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = MRImageStorage, generate_uid()
        image = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
        image.SOPClassUID, image.SOPInstanceUID = MRImageStorage, meta.MediaStorageSOPInstanceUID
        image.StudyInstanceUID, image.SeriesInstanceUID, image.FrameOfReferenceUID = study, series, study
        image.Modality, image.SeriesDescription, image.InstanceNumber = "MR", name, i + 1
        image.ImagePositionPatient, image.ImageOrientationPatient = [0, 0, i * 2.0], [1, 0, 0, 0, 1, 0]
        image.PixelSpacing, image.SliceThickness = [1.0, 1.0], 2.0
        image.Rows = image.Columns = size
        image.SamplesPerPixel, image.PhotometricInterpretation = 1, "MONOCHROME2"
        image.BitsAllocated, image.BitsStored, image.HighBit, image.PixelRepresentation = 16, 16, 15, 0
        image.PixelData = pixels.tobytes()
        image.save_as(folder / f"{name}-{i:03d}.dcm", enforce_file_format=True)


def dialog_of(window: MainWindow, qtbot: QtBot, kind: type[QDialog]) -> Any:
    """Wait for a dialog of a kind and return it."""
    found: list[QDialog] = []

    def there() -> bool:
        found[:] = [d for d in window.findChildren(kind) if d.isVisible()]
        return bool(found)

    qtbot.waitUntil(there, timeout=20_000)
    return found[0]


def retype(box: QSpinBox, qtbot: QtBot, text: str) -> None:
    """Replace a box's number by typing."""
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, text)
    qtbot.keyClick(box, Qt.Key.Key_Tab)


# -- series ----------------------------------------------------------------------------------------
@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A folder with a large single image, a survey of three large slices, and a volume."""
    folder = tmp_path / "study"
    write_series(folder, "report", 1, 200)
    write_series(folder, "survey", 3, 120)
    write_series(folder, "brain", 12, 40)
    return folder


def test_series_have_pictures_and_the_largest_volume_is_proposed(
    make_window: Any, qtbot: QtBot, study: Path
) -> None:
    window = make_window()
    window.open(str(study))
    dialog = dialog_of(window, qtbot, SeriesDialog)
    rows = {
        dialog.list.topLevelItem(i).text(0).split("\n")[0]: dialog.list.topLevelItem(i)
        for i in range(dialog.list.topLevelItemCount())
    }
    assert set(rows) == {"MR brain", "MR survey", "MR report"}
    assert dialog.list.currentItem() is rows["MR brain"]
    assert "single image" in rows["MR report"].text(0)
    assert [rows["MR brain"].text(i) for i in (1, 2, 3)] == ["12", "40 × 40", "1 × 1 × 2"]

    def bright(name: str) -> bool:
        icon = rows[name].icon(0).pixmap(dialog.list.iconSize()).toImage()
        inside, outside = (icon.pixelColor(icon.width() * n // 8, icon.height() * n // 8) for n in (3, 6))
        return bool(inside.lightness() > 240 and outside.lightness() < 15)

    qtbot.waitUntil(lambda: all(bright(name) for name in rows), timeout=20_000)
    qtbot.keyClick(dialog.list, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=20_000)
    assert window.editor.scene.volume.dims == (40, 40, 12)
    assert recent_files()[0] == str(study)


def test_a_single_image_cannot_be_opened_as_a_volume(make_window: Any, qtbot: QtBot, study: Path) -> None:
    window = make_window()
    window.open(str(study))
    dialog = dialog_of(window, qtbot, SeriesDialog)
    single = next(i for i, s in enumerate(dialog._series) if s.count == 1)
    dialog.list.setCurrentItem(dialog.list.topLevelItem(single))
    assert not dialog.buttons.button(OPEN).isEnabled()
    qtbot.keyClick(dialog.list, Qt.Key.Key_Return)
    assert dialog.isVisible()
    qtbot.keyClick(dialog, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: not window.messages.isVisible())
    assert window.editor.scene.volume is None


def test_a_scene_on_the_second_series_opens_again(
    make_window: Any, qtbot: QtBot, study: Path, tmp_path: Path
) -> None:
    window = make_window()
    window.open(str(study))
    dialog = dialog_of(window, qtbot, SeriesDialog)
    survey = next(i for i, s in enumerate(dialog._series) if s.count == 3)
    dialog.list.setCurrentItem(dialog.list.topLevelItem(survey))
    qtbot.mouseClick(dialog.buttons.button(OPEN), LEFT)
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=20_000)
    scene = window.editor.scene
    assert window.files.save_scene_as(str(tmp_path / "kept.sfumato"))
    assert Scene.open(tmp_path / "kept.sfumato").volume.key == scene.volume.key


def test_the_largest_volume(qapp: QApplication) -> None:
    from sfumato.io import SeriesInfo

    def series(*dims: int) -> SeriesInfo:
        return SeriesInfo("k", "CT", "CT", dims[2], (dims[0], dims[1], dims[2]), (1.0, 1.0, 1.0))

    assert largest_volume([series(900, 900, 1), series(64, 64, 9), series(64, 64, 30)]) == 2
    assert largest_volume([series(900, 900, 3), series(64, 64, 9)]) == 1
    assert largest_volume([series(900, 900, 1), series(64, 64, 2)]) == 1


# -- raw voxels ------------------------------------------------------------------------------------
@pytest.fixture
def raw(tmp_path: Path) -> Path:
    """40 x 30 x 20 big-endian shorts after 64 bytes: a bright box; the name tells nothing."""
    data = np.zeros((20, 30, 40), ">i2")
    data[5:15, 8:22, 10:20] = 900
    path = tmp_path / "scan.raw"
    path.write_bytes(b"\0" * 64 + data.tobytes())
    return path


def test_raw_voxels_are_asked_about_and_opened(
    make_window: Any, hand_of: Any, qtbot: QtBot, raw: Path
) -> None:
    window = make_window()
    window.open(str(raw))
    dialog: RawDialog = dialog_of(window, qtbot, RawDialog)
    for box, text in zip((*dialog.dims, dialog.offset), ("40", "30", "20", "64"), strict=True):
        retype(box, qtbot, text)
    dialog.type.setFocus()
    while dialog.type.currentText() != "int16":
        qtbot.keyClick(dialog.type, Qt.Key.Key_Down if dialog.type.currentIndex() < 3 else Qt.Key.Key_Up)
    dialog.big.setFocus()
    qtbot.keyClick(dialog.big, Qt.Key.Key_Space)
    retype(dialog.spacing[2], qtbot, "2.5")
    assert dialog.form == RawGuess((40, 30, 20), ">i2", (1.0, 1.0, 2.5), 64)
    assert dialog.verdict.text() == "The file's size agrees."

    def shown() -> bool:
        image = dialog.preview.pixmap().toImage()
        wide, tall = image.width(), image.height()
        inside = image.pixelColor(wide * 15 // 40, tall // 2) if wide else None
        return inside is not None and inside.lightness() > 240 and wide * 3 == tall * 4

    qtbot.waitUntil(shown, timeout=5000)
    qtbot.keyClick(dialog, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=20_000)
    volume = window.editor.scene.volume
    assert volume.dims == (40, 30, 20)
    assert volume.spacing == (1.0, 1.0, 2.5)
    assert volume.data.max() == 900
    kept = json.loads(raw.with_name("scan.raw.json").read_text())
    assert kept == {"dims": [40, 30, 20], "dtype": ">i2", "spacing": [1.0, 1.0, 2.5], "offset": 64}
    with qtbot.waitSignal(window.files.opened, timeout=20_000):  # without a question now
        window.open(str(raw))


def test_what_does_not_fit_is_told_where_it_is_typed(make_window: Any, qtbot: QtBot, raw: Path) -> None:
    window = make_window()
    window.open(str(raw))
    dialog: RawDialog = dialog_of(window, qtbot, RawDialog)
    retype(dialog.dims[2], qtbot, "4000")
    assert "too short" in dialog.verdict.text()
    assert not dialog.buttons.button(OPEN).isEnabled()
    qtbot.waitUntil(lambda: dialog.preview.text() == "Does not fit the file", timeout=5000)
    retype(dialog.dims[2], qtbot, "1")
    assert "at least 2" in dialog.verdict.text()
    assert not dialog.buttons.button(OPEN).isEnabled()
    retype(dialog.dims[2], qtbot, "2")
    assert "would not be read" in dialog.verdict.text()
    assert dialog.buttons.button(OPEN).isEnabled()
    qtbot.mouseClick(dialog.buttons.button(QDialogButtonBox.StandardButton.Cancel), LEFT)
    assert window.editor.scene.volume is None
    assert not raw.with_name("scan.raw.json").exists()


def test_proposals_come_from_the_size(make_window: Any, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "cube.raw"
    path.write_bytes(np.arange(64**3, dtype=np.uint16).tobytes())
    window = make_window()
    window.open(str(path))
    dialog: RawDialog = dialog_of(window, qtbot, RawDialog)
    assert dialog.proposals.currentText().startswith("64 × 64 × 64, uint16")
    assert dialog.form.dims == (64, 64, 64)
    retype(dialog.dims[0], qtbot, "60")
    assert dialog.proposals.currentText() == "Own values"
    dialog.proposals.setFocus()
    qtbot.keyClick(dialog.proposals, Qt.Key.Key_Home)
    dialog.proposals.activated.emit(dialog.proposals.currentIndex())
    assert dialog.form.dims == (64, 64, 64)
    qtbot.keyClick(dialog, Qt.Key.Key_Escape)


def test_controls_of_the_raw_dialog_are_named_and_large_enough(
    make_window: Any, qtbot: QtBot, raw: Path
) -> None:
    window = make_window()
    window.open(str(raw))
    dialog: RawDialog = dialog_of(window, qtbot, RawDialog)
    for control in (*dialog.dims, *dialog.spacing, dialog.type, dialog.proposals, dialog.offset):
        assert control.accessibleName()
        assert control.height() >= 24
    dialog.reject()


def test_only_the_slice_that_is_shown_is_read(raw: Path) -> None:
    image = middle_slice(str(raw), RawGuess((40, 30, 20), ">i2", offset=64), 80)
    assert (image.width(), image.height()) == (80, 60)
    assert guess_raw(raw) == []


def test_a_slice_keeps_its_proportions(qapp: QApplication) -> None:
    plane = np.array([[0, np.inf, 5], [np.nan, 5, 10]], dtype=np.float32)
    image = slice_image(plane, (1.0, 3.0), 60)
    assert (image.width(), image.height()) == (30, 60)
