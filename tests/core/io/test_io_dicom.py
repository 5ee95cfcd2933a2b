"""DICOM series with the faults of real ones: order, tilt, gaps, copies, syntaxes, several series."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from pydicom import dcmread
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.sequence import Sequence
from pydicom.uid import JPEG2000Lossless, RLELossless

from sfumato import LoadError
from sfumato.io import LoadCancelled, find_series, load

#: An oblique orientation: row and column direction, orthonormal.
ROW = np.array([0.8, 0.6, 0.0])
COLUMN = np.array([-0.36, 0.48, 0.8])
NORMAL = np.cross(ROW, COLUMN)


def stack(n: int = 8, step: float = 1.5) -> tuple[np.ndarray, np.ndarray]:
    """Stored values that are linear in space (so interpolation is exact), and positions along z."""
    z, y, x = np.mgrid[:n, :10, :12]
    return (1000 + 30 * z + 4 * y + 7 * x).astype(np.uint16), np.array(
        [[10, -20, 5 + step * k] for k in range(n)], float
    )


def test_shuffled_oblique_series_has_its_place(write_series) -> None:
    planes, _ = stack()
    positions = np.array([5.0, 6.0, 7.0]) + np.outer(np.arange(8) * 1.5, NORMAL)
    volume = load(write_series(planes, positions, orientation=(*ROW, *COLUMN)))
    np.testing.assert_array_equal(volume.data, planes.astype(np.int16) - 1024)
    np.testing.assert_allclose(volume.spacing, (0.5, 0.7, 1.5), atol=1e-5)
    np.testing.assert_allclose(volume.direction, np.column_stack([ROW, COLUMN, NORMAL]), atol=1e-6)
    np.testing.assert_allclose(volume.origin, (5, 6, 7), atol=1e-5)
    assert volume.info.modality == "CT"
    assert volume.info.orientation_known
    assert volume.info.notices == ()


def test_geometry_agrees_with_highdicom(write_series) -> None:
    import highdicom

    planes, _ = stack()
    positions = np.array([5.0, 6.0, 7.0]) + np.outer(np.arange(8) * 1.5, NORMAL)
    folder = write_series(planes, positions, orientation=(*ROW, *COLUMN))
    theirs = highdicom.get_volume_from_series([dcmread(p) for p in folder.iterdir()])
    volume = load(folder)
    axes = np.asarray(volume.direction) * volume.spacing
    for index in ((0, 0, 0), (3, 2, 5), (7, 9, 11)):
        ours = axes @ index[::-1] + volume.origin
        found = theirs.map_reference_to_indices(ours[None])[0]
        place = tuple(round(float(c)) for c in found)
        np.testing.assert_allclose(found, place, atol=1e-3)
        assert theirs.array[place] == volume.data[index]


def test_gantry_tilt_is_straightened(write_series) -> None:
    # Values depend on the world position alone, so a straight grid must show them at the right places.
    tilt = np.radians(20)
    normal = np.array([0.0, 0.0, 1.0])
    drift = np.array([0.0, np.tan(tilt), 0.0])
    positions = np.array([np.array([0.0, 0.0, 0.0]) + 2.0 * k * (normal + drift) for k in range(6)])
    y, x = np.mgrid[:10, :12]
    planes = np.array([1000 + 20 * (y * 0.7 + p[1]) + 10 * x * 0.5 + 5 * p[2] for p in positions])
    volume = load(write_series(np.rint(planes).astype(np.uint16), positions))
    assert volume.data.shape[0] == 6
    assert volume.data.shape[1] > 10
    np.testing.assert_allclose(np.asarray(volume.direction), np.eye(3), atol=1e-9)
    assert any("gantry tilt" in n and "20.0" in n for n in volume.info.notices)
    for k in range(6):
        row = round((positions[k, 1] - volume.origin[1]) / 0.7) + 4  # well inside the moved slice
        world_y = volume.origin[1] + 0.7 * row
        expected = 1000 + 20 * world_y + 10 * 3 * 0.5 + 5 * positions[k, 2] - 1024
        assert abs(volume.data[k, row, 3] - expected) <= 1


def test_missing_slices_are_filled(write_series) -> None:
    planes, positions = stack(10)
    kept = [0, 1, 2, 5, 6, 7, 8, 9]
    volume = load(write_series(planes[kept], positions[kept]))
    np.testing.assert_array_equal(volume.data, planes.astype(np.int16) - 1024)
    assert volume.info.notices == ("2 of 10 slices are missing: filled by interpolation.",)


def test_uneven_slices_are_resampled(write_series) -> None:
    depths = np.array([0, 1, 2, 3.4, 4.4, 6.0, 7, 8])
    y, x = np.mgrid[:10, :12]
    planes = np.array([1000 + 100 * d + x for d in depths]).astype(np.uint16) + 0 * y.astype(np.uint16)
    volume = load(write_series(planes, np.array([[0, 0, d] for d in depths])))
    assert volume.info.notices[0].startswith("Slice distances vary from 1 to 1.6 mm")
    expected = 1000 + 100 * volume.spacing[2] * np.arange(volume.data.shape[0]) - 1024
    assert (
        np.abs(volume.data[:, 5, 0] - expected).max() <= 6
    )  # places within 5 % of a slice are not interpolated
    assert volume.spacing[2] * (volume.data.shape[0] - 1) == pytest.approx(8.0)


def test_rounded_positions_are_even(write_series) -> None:
    planes, positions = stack(40, 0.625)
    positions = np.round(positions, 1)
    volume = load(write_series(planes, positions))
    assert volume.spacing[2] == pytest.approx(0.625, abs=0.003)
    assert volume.info.notices == ()


def test_duplicates_are_dropped(write_series) -> None:
    planes, positions = stack()
    again = [0, 1, 2, 3, 3, 4, 5, 6, 7, 7]
    volume = load(write_series(planes[again], positions[again]))
    np.testing.assert_array_equal(volume.data, planes.astype(np.int16) - 1024)
    assert volume.info.notices == ("2 slices were there twice: the first of each place is used.",)


def test_phases_are_chosen_by_frame(write_series) -> None:
    planes, positions = stack()
    folder = write_series(planes, positions, TemporalPositionIdentifier=1)
    write_series(planes + 1000, positions, TemporalPositionIdentifier=2)
    first, second = load(folder), load(folder, frame=1)
    np.testing.assert_array_equal(second.data - first.data, 1000)
    assert "2 images at every place" in first.info.notices[0]
    with pytest.raises(LoadError, match="no frame 2"):
        load(folder, frame=2)


def test_several_series_are_listed_and_chosen(write_series) -> None:
    planes, positions = stack()
    folder = write_series(planes, positions, SeriesDescription="Thorax soft")
    write_series(planes[:4], positions[:4], series="1.2.3.5", SeriesDescription="Scout of Jane")
    write_series(planes[:3], np.outer([0, 2, 4], [1, 0, 0]), orientation=(0, 1, 0, 0, 0, -1))
    found = find_series(folder)
    assert [s.count for s in found] == [8, 4, 3]
    assert found[0].label == "CT series 3 Thorax soft"
    assert found[0].dims == (12, 10, 8)
    assert found[0].spacing == pytest.approx((0.5, 0.7, 1.5))
    assert found[1].label == "CT series 3"  # the description repeats the patient's name
    largest, smaller = load(folder), load(folder, series=found[1].key)
    assert largest.dims[2] == 8
    assert "2 more series" in largest.info.notices[0]
    assert smaller.dims[2] == 4
    assert load(folder, series=1).key == smaller.key
    with pytest.raises(LoadError, match="no series 'x'"):
        load(folder, series="x")


def test_no_patient_data_is_kept(write_series) -> None:
    planes, positions = stack()
    folder = write_series(planes, positions, SeriesDescription="doe jane 4711-A")
    text = repr((load(folder).info, find_series(folder)))
    assert not any(word in text for word in ("Doe", "doe", "Jane", "4711", "1.2.3.4"))


def test_one_file_brings_its_series(write_series) -> None:
    planes, positions = stack()
    folder = write_series(planes, positions)
    assert load(next(folder.iterdir())).key == load(folder).key


def test_damaged_run_lengths(write_series) -> None:
    folder = write_series(*stack(), syntax=RLELossless)
    for path in folder.iterdir():
        raw = bytearray(path.read_bytes())
        raw[raw.rindex(b"\xfe\xff\x00\xe0") + 8] = 99  # number of segments
        path.write_bytes(raw)
    with pytest.raises(LoadError, match="cannot be decoded"):
        load(folder)


@pytest.mark.parametrize("syntax", [RLELossless, JPEG2000Lossless])
def test_compressed(write_series, syntax: str) -> None:
    planes, positions = stack()
    planes = np.tile(planes, (1, 4, 4))
    volume = load(write_series(planes, positions, syntax=syntax))
    np.testing.assert_array_equal(volume.data, planes.astype(np.int16) - 1024)


def test_rescale_differs_by_slice(write_series, write_slice, tmp_path: Path) -> None:
    folder = tmp_path / "pet"
    folder.mkdir()
    planes, positions = stack(4)
    for k in range(4):
        write_slice(
            folder / f"{k}", planes[k], positions[k], RescaleSlope=0.5 + k, RescaleIntercept=0, Modality="PT"
        )
    volume = load(folder)
    assert volume.data.dtype == np.float32
    np.testing.assert_allclose(volume.data, planes * (0.5 + np.arange(4))[:, None, None])


def test_negative_is_inverted(write_series) -> None:
    planes, positions = stack()
    volume = load(
        write_series(
            planes, positions, PhotometricInterpretation="MONOCHROME1", Modality="MR", RescaleIntercept=0
        )
    )
    np.testing.assert_array_equal(volume.data, 4095 - planes.astype(int))
    assert "inverted" in volume.info.notices[0]


def test_enhanced_multiframe(write_slice, tmp_path: Path) -> None:
    planes, positions = stack(5)
    order = [3, 0, 4, 1, 2]
    groups = []
    for k in order:
        place, frame = Dataset(), Dataset()
        place.ImagePositionPatient = list(positions[k])
        frame.PlanePositionSequence = Sequence([place])
        groups.append(frame)
    measures, turn, value, shared = Dataset(), Dataset(), Dataset(), Dataset()
    measures.PixelSpacing, measures.SliceThickness = [0.7, 0.5], 1.5
    turn.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    value.RescaleSlope, value.RescaleIntercept, value.RescaleType = 2, -1000, "HU"
    shared.PixelMeasuresSequence, shared.PlaneOrientationSequence = Sequence([measures]), Sequence([turn])
    shared.PixelValueTransformationSequence = Sequence([value])
    path = write_slice(
        tmp_path / "enhanced", planes[0], positions[0], NumberOfFrames=5,
        PixelData=planes[order].astype("<u2").tobytes(),
        SharedFunctionalGroupsSequence=Sequence([shared]), PerFrameFunctionalGroupsSequence=Sequence(groups),
    )  # fmt: skip
    volume = load(path)
    np.testing.assert_array_equal(volume.data, planes.astype(np.int16) * 2 - 1000)
    np.testing.assert_allclose(volume.origin, positions[0])
    assert volume.spacing == pytest.approx((0.5, 0.7, 1.5))


def test_without_pixel_data(write_slice, tmp_path: Path) -> None:
    path = write_slice(tmp_path / "a.dcm", stack()[0][0], np.zeros(3))
    data = dcmread(path)
    del data.PixelData, data.Rows, data.Columns
    data.save_as(path)
    with pytest.raises(LoadError, match="no pixel data"):
        load(path)
    with pytest.raises(LoadError, match="no DICOM image"):
        load(tmp_path)


def test_one_slice_and_truncated(write_slice, tmp_path: Path) -> None:
    planes, positions = stack()
    path = write_slice(tmp_path / "a.dcm", planes[0], positions[0])
    with pytest.raises(LoadError, match="one slice"):
        load(path)
    write_slice(tmp_path / "b.dcm", planes[1], positions[1])
    raw = path.read_bytes()
    path.write_bytes(raw[:-40])
    with pytest.raises(LoadError, match=r"a\.dcm cannot be decoded"):
        load(tmp_path)


def test_cancel_and_progress(write_series) -> None:
    planes, positions = stack()
    folder = write_series(planes, positions)
    told: list[float] = []
    load(folder, progress=lambda fraction, text: told.append(fraction))
    assert told == sorted(told)
    assert told[-1] == 1.0
    with pytest.raises(LoadCancelled):
        load(folder, cancel=lambda: len(told) > 0)


def test_without_preamble(write_series) -> None:
    planes, positions = stack()
    folder = write_series(planes, positions)
    for path in folder.iterdir():
        data = dcmread(path)
        data.file_meta, data.preamble = FileMetaDataset(), None
        data.save_as(path, implicit_vr=True, little_endian=True)
        assert path.read_bytes()[128:132] != b"DICM"
    np.testing.assert_array_equal(load(folder).data, planes.astype(np.int16) - 1024)


@pytest.mark.real_data
@pytest.mark.parametrize("syntax", ["", "_RLE", "_bigendian", "_jp2klossless", "_jpeg_ls_lossless"])
def test_signed_values_in_every_syntax(data_dir: Path, tmp_path: Path, syntax: str) -> None:
    folder = data_dir / "dicom_multiframe_and_syntaxes"
    expected = dcmread(folder / "MR_small.dcm").pixel_array
    for k in range(2):
        data = dcmread(folder / f"MR_small{syntax}.dcm")
        data.ImagePositionPatient = [0, 0, k]
        data.save_as(tmp_path / f"{k}.dcm")
    np.testing.assert_array_equal(load(tmp_path).data, [expected, expected])


def test_missing_package_is_named(write_series, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = write_series(*stack())
    monkeypatch.setitem(sys.modules, "pydicom", None)
    with pytest.raises(LoadError, match=r"needs pydicom; .*sfumato\[io\]"):
        load(folder)
