"""PNG that carries its scene."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from sfumato import LoadError, Scene, SceneError, SfumatoError, Volume, VolumeInfo
from sfumato.export.linear import write_linear
from sfumato.export.png import open_png, read_scene_data, scene_text, write_png


@pytest.fixture
def volume():
    data = np.random.default_rng(1).integers(0, 255, (4, 5, 6), dtype=np.uint8)
    return Volume(data, info=VolumeInfo(path="/home/jane doe/private/head.npy"))


@pytest.fixture
def picture():
    return np.random.default_rng(2).integers(0, 255, (7, 9, 4), dtype=np.uint8)


def test_picture_and_scene_come_back(tmp_path, volume, picture):
    scene = Scene(volume=volume, technique="directional").with_(**{"lights.0.tilt": 12.5})
    write_png(tmp_path / "a.png", picture, scene)
    with Image.open(tmp_path / "a.png") as image:
        assert image.mode == "RGBA"
        assert "srgb" in image.info
        np.testing.assert_array_equal(np.asarray(image), picture)
    assert open_png(tmp_path / "a.png", volume) == scene
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]


def test_no_folder_is_told(volume):
    text = scene_text(Scene(volume=volume))
    assert "jane" not in text
    assert "private" not in text
    assert json.loads(text)["scene"]["volume"] == {"path": "head.npy", "hash": volume.key}
    windows = Volume(volume.data, info=VolumeInfo(path="C:\\Users\\jane\\head.npy"))
    assert "jane" not in scene_text(Scene(volume=windows))


def test_volume_is_looked_for_beside_the_picture(tmp_path, volume, picture):
    np.save(tmp_path / "head.npy", volume.data)
    write_png(tmp_path / "a.png", picture, Scene(volume=volume))
    assert open_png(tmp_path / "a.png").volume == volume
    np.save(tmp_path / "head.npy", volume.data + 1)
    with pytest.raises(LoadError, match="not the volume"):
        open_png(tmp_path / "a.png")
    (tmp_path / "head.npy").unlink()
    with pytest.raises(LoadError, match=r"head\.npy"):
        open_png(tmp_path / "a.png")


def test_a_strangers_path_is_not_followed(tmp_path, volume, picture, monkeypatch):
    np.save(tmp_path / "secret.npy", volume.data)
    here = tmp_path / "pictures"
    here.mkdir()
    evil = scene_text(Scene(volume=volume)).replace("head.npy", "../secret.npy")
    monkeypatch.setattr("sfumato.export.png.scene_text", lambda _scene: evil)
    write_png(here / "a.png", picture, Scene(volume=volume))
    with pytest.raises(LoadError, match="not beside"):
        open_png(here / "a.png")


def test_pictures_of_others(tmp_path, picture):
    Image.fromarray(picture).save(tmp_path / "other.png")
    with pytest.raises(LoadError, match="carries no scene"):
        read_scene_data(tmp_path / "other.png")
    with pytest.raises(LoadError, match="No such file"):
        read_scene_data(tmp_path / "none.png")
    with pytest.raises(LoadError):
        read_scene_data(tmp_path)


@pytest.fixture(scope="module")
def written(tmp_path_factory) -> bytes:
    path = tmp_path_factory.mktemp("png") / "a.png"
    write_png(path, np.zeros((2, 2, 4), np.uint8), Scene())
    return path.read_bytes()


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_damage_is_a_load_error(written, tmp_path_factory, data):
    end = data.draw(st.integers(0, len(written)))
    damaged = bytearray(written[:end])
    for _ in range(data.draw(st.integers(0, 3))):
        if damaged:
            damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    path: Path = tmp_path_factory.getbasetemp() / "damaged.png"
    path.write_bytes(damaged)
    # Any other exception fails the test.
    with contextlib.suppress(LoadError):
        assert isinstance(read_scene_data(path), dict)


def test_wrong_arrays_are_refused(tmp_path):
    for array in (
        np.zeros((2, 2, 3), np.uint8),
        np.zeros((2, 2, 4), np.float32),
        np.zeros((0, 2, 4), np.uint8),
    ):
        with pytest.raises(SceneError):
            write_png(tmp_path / "a.png", array)


def test_a_failed_write_leaves_nothing(tmp_path, picture):
    (tmp_path / "a.png").mkdir()
    with pytest.raises(SfumatoError, match=r"a\.png"):
        write_png(tmp_path / "a.png", picture)
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]


def test_linear_pictures(tmp_path):
    pixels = np.random.default_rng(3).random((3, 5, 8), np.float32)[..., ::2]
    assert not pixels.flags.c_contiguous
    write_linear(tmp_path / "a.npy", pixels)
    np.testing.assert_array_equal(np.load(tmp_path / "a.npy"), pixels)
    openexr = pytest.importorskip("OpenEXR")
    scene = Scene(technique="raycast")
    write_linear(tmp_path / "a.exr", pixels, scene)
    with openexr.File(str(tmp_path / "a.exr")) as file:
        np.testing.assert_array_equal(file.channels()["RGBA"].pixels, pixels)
        assert Scene.from_json(json.loads(file.header()["sfumato-scene"])["scene"]) == scene
    with pytest.raises(SfumatoError, match=r"\.exr or \.npy"):
        write_linear(tmp_path / "a.tif", pixels)


def write_dicom(study: Path, series: str, uid: str, count: int = 4) -> None:
    """Write a series of a patient whose name nothing may tell."""
    from pydicom.dataset import FileDataset, FileMetaDataset
    from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, generate_uid

    study.mkdir(exist_ok=True)
    for i in range(count):
        meta = FileMetaDataset()
        meta.TransferSyntaxUID, meta.MediaStorageSOPClassUID = ExplicitVRLittleEndian, CTImageStorage
        meta.MediaStorageSOPInstanceUID = generate_uid()
        image = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
        image.SOPClassUID, image.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
        image.StudyInstanceUID, image.SeriesInstanceUID, image.FrameOfReferenceUID = uid, series, uid
        image.Modality, image.PatientName, image.SeriesDescription = "CT", "DOE^JOHN", "Doe's head"
        image.InstanceNumber = i + 1
        image.ImagePositionPatient, image.ImageOrientationPatient = [0, 0, i * 2.0], [1, 0, 0, 0, 1, 0]
        image.PixelSpacing, image.SliceThickness, image.Rows, image.Columns = [1.0, 1.0], 2.0, 8, 8
        image.SamplesPerPixel, image.PhotometricInterpretation = 1, "MONOCHROME2"
        image.BitsAllocated, image.BitsStored, image.HighBit, image.PixelRepresentation = 16, 16, 15, 1
        image.RescaleSlope, image.RescaleIntercept = 1, -1024
        image.PixelData = np.full((8, 8), 100 * i + 10 * count, "<i2").tobytes()
        image.save_as(study / f"JOHN{series[-6:]}{i}.dcm", enforce_file_format=True)


def test_dicom_is_found_by_content_not_by_name(tmp_path, picture):
    pytest.importorskip("highdicom")
    from pydicom.uid import generate_uid

    import sfumato

    study = tmp_path / "DOE^JOHN"
    series, uid = generate_uid(), generate_uid()
    write_dicom(study, series, uid)
    scene = Scene(volume=sfumato.load(study))
    text = scene_text(scene)
    assert "JOHN" not in text
    assert "Doe" not in text
    assert str(uid) not in text
    assert str(series) not in text
    write_png(tmp_path / "a.png", picture, scene)
    assert open_png(tmp_path / "a.png") == scene
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "a.png").rename(tmp_path / "elsewhere" / "a.png")
    with pytest.raises(LoadError, match="not beside it"):
        open_png(tmp_path / "elsewhere" / "a.png")


def test_a_second_series_is_found_too(tmp_path, picture):
    pytest.importorskip("highdicom")
    from pydicom.uid import generate_uid

    import sfumato

    study, uid = tmp_path / "study", generate_uid()
    for count in (6, 4):
        write_dicom(study, generate_uid(), uid, count)
    second = sfumato.io.find_series(study)[1]
    scene = Scene(volume=sfumato.load(study, series=second.key))
    assert scene.volume.dims[2] == 4
    write_png(tmp_path / "a.png", picture, scene)
    assert open_png(tmp_path / "a.png") == scene


def test_a_halved_volume_is_found_too(tmp_path, picture):
    import sfumato

    np.save(tmp_path / "head.npy", np.arange(8 * 8 * 8, dtype=np.uint16).reshape(8, 8, 8))
    scene = Scene(volume=sfumato.io.reduce_volume(sfumato.load(tmp_path / "head.npy")))
    write_png(tmp_path / "a.png", picture, scene)
    assert open_png(tmp_path / "a.png").volume == scene.volume


def test_a_stack_of_pictures_is_found_by_its_content(tmp_path, picture):
    import sfumato

    stack = tmp_path / "Doe"
    stack.mkdir()
    for i in range(4):
        Image.fromarray(np.full((8, 8), 40 * i, np.uint8)).save(stack / f"{i}.tif")
    scene = Scene(volume=sfumato.load(stack))
    assert "Doe" not in scene_text(scene)
    for name in ("a.png", "b.png"):
        write_png(tmp_path / name, picture, scene)
    assert open_png(tmp_path / "b.png") == scene
