"""Opening and saving as a user does it: dropped folders, dialogs, bad files, unsaved work."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, generate_uid
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QMimeData, QPoint, QPointF, Qt, QTimer, QUrl
from qtpy.QtGui import QDragEnterEvent, QDropEvent
from qtpy.QtWidgets import QApplication, QDialog, QDialogButtonBox, QFileDialog, QMessageBox, QPushButton

from sfumato import Scene
from sfumato_ui.series_dialog import SeriesDialog
from sfumato_ui.window import MainWindow


def write_series(folder: Path, count: int, description: str, size: int = 32) -> None:
    """Write a small CT series: a bright ball in air."""
    folder.mkdir(exist_ok=True)
    series, study, frame = generate_uid(), generate_uid(), generate_uid()
    y, x = np.mgrid[0:size, 0:size] * (2 / (size - 1)) - 1
    for i in range(count):
        z = 2 * i / (count - 1) - 1
        hounsfield = np.where(x * x + y * y + z * z < 0.6, 800, -1000)
        meta = FileMetaDataset()
        meta.TransferSyntaxUID = ExplicitVRLittleEndian
        meta.MediaStorageSOPClassUID = CTImageStorage
        meta.MediaStorageSOPInstanceUID = generate_uid()
        image = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
        image.SOPClassUID, image.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
        image.StudyInstanceUID, image.SeriesInstanceUID, image.FrameOfReferenceUID = study, series, frame
        image.Modality, image.SeriesDescription, image.InstanceNumber = "CT", description, i + 1
        image.ImagePositionPatient, image.ImageOrientationPatient = [0, 0, i * 1.5], [1, 0, 0, 0, 1, 0]
        image.PixelSpacing, image.SliceThickness = [1.0, 1.0], 1.5
        image.Rows = image.Columns = size
        image.SamplesPerPixel, image.PhotometricInterpretation = 1, "MONOCHROME2"
        image.BitsAllocated, image.BitsStored, image.HighBit, image.PixelRepresentation = 16, 16, 15, 1
        image.RescaleSlope, image.RescaleIntercept = 1, -1024
        image.PixelData = (hounsfield + 1024).astype("<i2").tobytes()
        image.save_as(folder / f"{description}-{i:03d}.dcm", enforce_file_format=True)


def drop(window: MainWindow, path: Path) -> None:
    """Drop a file or folder on the window."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    at = QPoint(200, 200)
    copy, left, none = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(at, copy, data, left, none)
    QApplication.sendEvent(window, enter)
    assert enter.isAccepted()
    QApplication.sendEvent(window, QDropEvent(QPointF(at), copy, data, left, none))


def dialog_of(window: MainWindow, qtbot: QtBot, kind: type[QDialog]) -> Any:
    """Wait for a dialog of a kind and return it."""
    found: list[QDialog] = []

    def there() -> bool:
        found[:] = [d for d in window.findChildren(kind) if d.isVisible()]
        return bool(found)

    qtbot.waitUntil(there, timeout=20_000)
    return found[0]


def type_file_name(dialog: QFileDialog, qtbot: QtBot, path: Path) -> None:
    """Name a file in a file dialog and press Save."""
    # Typed letters would open the list of proposals, a window of its own that takes the next click.
    dialog.selectFile(str(path))
    accept = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Save)
    qtbot.mouseClick(accept, Qt.MouseButton.LeftButton)


@pytest.fixture(autouse=True)
def qt_file_dialogs(qapp: QApplication) -> Any:
    """Use Qt's own file dialogs, into which a test can type."""
    qapp.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs, True)
    yield
    qapp.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs, False)


def test_dropping_a_dicom_folder_opens_it(
    make_window: Any, hand_of: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    write_series(tmp_path / "study", 12, "head")
    window = make_window()
    hand = hand_of(window)
    drop(window, tmp_path / "study")
    assert "Opening study" in window.messages.text, "progress shows at once"
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=30_000)
    assert window.editor.scene.volume.dims == (32, 32, 12)
    assert window.editor.scene.volume.spacing == pytest.approx((1, 1, 1.5))
    hand.wait_for_picture()
    assert (hand.pixels()[..., 3] > 200).mean() > 0.1
    assert "32 × 32 × 12" in window.status.data.text()
    assert "study" in window.windowTitle() or "head" in window.windowTitle()
    assert not window.editor.document.modified


def test_several_series_are_offered_and_enter_opens_the_largest(
    make_window: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    write_series(tmp_path / "study", 6, "scout")
    write_series(tmp_path / "study", 14, "thorax")
    window = make_window()
    drop(window, tmp_path / "study")
    dialog = dialog_of(window, qtbot, SeriesDialog)
    assert dialog.list.topLevelItemCount() == 2
    assert "thorax" in dialog.list.currentItem().text(0)
    qtbot.keyClick(dialog.list, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=30_000)
    assert window.editor.scene.volume.dims[2] == 14


def test_a_bad_file_shows_a_message_and_the_picture_stays(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    before, scene = hand.pixels(), window.editor.scene
    bad = tmp_path / "broken.nii.gz"
    bad.write_bytes(b"no volume at all")
    drop(window, bad)
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=30_000)
    assert "broken.nii.gz" in window.messages.text
    assert "\n" not in window.messages.text
    assert window.editor.scene is scene
    assert np.array_equal(hand.pixels(), before)


def test_loading_can_be_cancelled(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    scene = window.editor.scene
    np.save(tmp_path / "large.npy", np.zeros((200, 200, 200), np.float32))
    drop(window, tmp_path / "large.npy")
    cancel = next(b for b in window.messages.findChildren(QPushButton) if b.text() == "Cancel")
    qtbot.mouseClick(cancel, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.files.loader.alive, timeout=30_000)
    qtbot.wait(50)
    assert window.editor.scene is scene
    assert not window.messages.isVisible()


def test_saving_the_scene_and_opening_it_again(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    np.save(tmp_path / "ball.npy", window.editor.scene.volume.data)
    drop(window, tmp_path / "ball.npy")
    qtbot.waitUntil(lambda: window.editor.scene.volume.info.path == str(tmp_path / "ball.npy"))
    window.editor.change_light("Move the light", tilt=55.0)
    assert window.isWindowModified()
    hand.press(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    target = tmp_path / "study.sfumato"
    type_file_name(dialog_of(window, qtbot, QFileDialog), qtbot, target)
    qtbot.waitUntil(target.exists)
    assert not window.isWindowModified()
    assert "study" in window.windowTitle()
    saved = window.editor.scene
    window.editor.change_light("Move the light", tilt=20.0)
    hand.press(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert Scene.open(target).lights[0].tilt == 20, "the second time needs no question"
    window.editor.reset(saved)
    drop(window, target)
    qtbot.waitUntil(lambda: window.editor.scene.lights[0].tilt == 20, timeout=30_000)


def test_a_volume_that_has_moved_is_found_or_asked_for(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    data = window.editor.scene.volume.data
    for folder in ("scans", "work", "away"):
        (tmp_path / folder).mkdir()
    np.save(tmp_path / "scans" / "ball.npy", data)
    there = tmp_path / "scans" / "ball.npy"

    def found() -> bool:
        volume = window.editor.scene.volume
        return volume is not None and volume.info.path == str(there)

    drop(window, there)
    qtbot.waitUntil(found, timeout=30_000)
    window.editor.change_light("Move the light", tilt=55.0)
    scene = tmp_path / "work" / "study.sfumato"
    assert window.files.save_scene_as(str(scene))
    key = window.editor.scene.volume.key
    # Renamed beside where it was: the folder is known from the recent files.
    there = tmp_path / "scans" / "renamed.npy"
    (tmp_path / "scans" / "ball.npy").rename(there)
    drop(window, scene)
    qtbot.waitUntil(found, timeout=30_000)
    assert f"found as {there}" in window.messages.text
    # Nowhere that one would look: the user says where.
    there.rename(tmp_path / "away" / "b.npy")
    there = tmp_path / "away" / "b.npy"
    drop(window, scene)
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=30_000)
    assert "the scene's volume is not there" in window.messages.text
    assert "What was open stays open" in window.messages.text
    find = next(b for b in window.messages.findChildren(QPushButton) if b.text() == "Find it…")
    qtbot.mouseClick(find, Qt.MouseButton.LeftButton)
    dialog = dialog_of(window, qtbot, QFileDialog)
    dialog.selectFile(str(there))
    accept = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open)
    qtbot.mouseClick(accept, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(found, timeout=30_000)
    assert window.editor.scene.volume.key == key
    assert window.editor.scene.lights[0].tilt == 55
    assert "not the volume" not in window.messages.text


@pytest.mark.parametrize(("answer", "stays"), [("Cancel", True), ("Discard", False)])
def test_closing_with_unsaved_work_asks(window: MainWindow, qtbot: QtBot, answer: str, stays: bool) -> None:
    window.editor.change_light("Move the light", tilt=50.0)
    asked: list[str] = []

    def click() -> None:
        box = QApplication.activeModalWidget()
        assert isinstance(box, QMessageBox)
        asked.append(box.text())
        button = box.button(getattr(QMessageBox.StandardButton, answer))
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    QTimer.singleShot(200, click)
    window.close()
    assert asked
    assert "ball" in asked[0]
    assert window.isVisible() is stays
    assert window.worker.alive is stays


def test_what_is_dropped_last_is_shown_whatever_was_under_way(
    make_window: Any, hand_of: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    for n in (30, 20, 16):
        z, y, x = np.mgrid[:n, :n, :n] * (2 / (n - 1)) - 1
        np.save(tmp_path / f"{n}.npy", np.clip(400 * (0.8 - np.sqrt(x * x + y * y + z * z)), 0, 200))
    window = make_window()
    drop(window, tmp_path / "30.npy")
    drop(window, tmp_path / "20.npy")  # while the first is read
    qtbot.waitUntil(lambda: window.viewport.picture is not None, timeout=60_000)
    assert window.editor.scene.volume.dims == (20, 20, 20)
    drop(window, tmp_path / "16.npy")  # while the second is refined
    qtbot.waitUntil(lambda: window.editor.scene.volume.dims == (16, 16, 16), timeout=30_000)
    hand_of(window).wait_for_picture()
    assert window.viewport.picture.scene.volume.dims == (16, 16, 16)
    assert window.messages.kind in ("", "notice")
