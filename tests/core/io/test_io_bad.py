"""Bad input: each kind gets one clear `LoadError`, and nothing large is allocated first."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import nibabel
import numpy as np
import pytest
import SimpleITK as sitk  # noqa: N813  (its own documentation does so)
import tifffile
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import sfumato
from sfumato import LoadError, Volume
from sfumato.io import LoadCancelled, find_series, load, register_scheme


def written(tmp_path: Path, name: str, data: np.ndarray) -> Path:
    """Write an array in the format of a name."""
    path = tmp_path / name
    if name.endswith(".npy"):
        np.save(path, data)
    elif name.endswith(".npz"):
        np.savez_compressed(path, data)
    elif name.endswith((".nii", ".nii.gz")):
        nibabel.save(nibabel.Nifti1Image(data.T, np.eye(4)), path)
    elif name.endswith(".tif"):
        tifffile.imwrite(path, data, compression="zlib", metadata=None)
    elif name.endswith((".vti", ".vtk")):
        import pyvista

        grid = pyvista.ImageData(dimensions=data.shape[::-1])
        grid.point_data["v"] = data.ravel()
        grid.save(path)
    else:
        sitk.WriteImage(sitk.GetImageFromArray(data), str(path))
    return path


NAMES = ["a.npy", "a.npz", "a.nii", "a.nii.gz", "a.nrrd", "a.mha", "a.tif", "a.vti", "a.vtk"]


@pytest.mark.parametrize("name", NAMES)
def test_truncated(tmp_path: Path, name: str) -> None:
    data = np.random.default_rng(1).integers(0, 1000, (12, 13, 14), dtype=np.int16)
    path = written(tmp_path, name, data)
    raw = path.read_bytes()
    np.testing.assert_array_equal(load(path).data, data)
    for part in (0.5, 0.05):
        path.write_bytes(raw[: int(len(raw) * part)])
        with pytest.raises(LoadError):
            load(path)
    path.write_bytes(b"")
    with pytest.raises(LoadError, match="empty"):
        load(path)


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(name=st.sampled_from(NAMES), at=st.floats(0, 0.3), noise=st.binary(min_size=1, max_size=12))
def test_damaged_bytes_never_leak_other_errors(tmp_path: Path, name: str, at: float, noise: bytes) -> None:
    data = np.arange(5 * 6 * 7, dtype=np.int16).reshape(5, 6, 7)
    path = written(tmp_path, name, data)
    raw = bytearray(path.read_bytes())
    start = int(at * len(raw))
    raw[start : start + len(noise)] = noise
    path.write_bytes(raw)
    try:
        message = repr(load(path))
    except LoadError as error:
        message = str(error)
    assert "\n" not in message


def test_header_that_promises_too_much(tmp_path: Path) -> None:
    header = nibabel.Nifti1Header()
    header.set_data_dtype(np.float32)
    header.set_data_shape((30000, 30000, 30000))
    (tmp_path / "a.nii").write_bytes(header.binaryblock + bytes(100))
    text = "NRRD0004\ntype: float\ndimension: 3\nsizes: 30000 30000 30000\nendian: little\nencoding: gzip\n\n"
    (tmp_path / "a.nrrd").write_bytes(text.encode() + bytes(100))
    text = "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 30000 30000 30000\n"
    (tmp_path / "a.vtk").write_text(
        text + "SPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 27000000000000\nSCALARS s float 1\n"
    )
    (tmp_path / "a.slc").write_bytes(b"11111\n30000 30000 30000 8\n1 1 1\n1 1 1 1\n0 0 X" + bytes(100))
    for name in ("a.nii", "a.nrrd", "a.vtk", "a.slc"):
        with pytest.raises(LoadError, match="truncated"):
            load(tmp_path / name)


@pytest.mark.parametrize("shape", [(1, 20, 20), (20, 1, 20), (20, 20)])
def test_one_slice(tmp_path: Path, shape: tuple[int, ...]) -> None:
    with pytest.raises(LoadError, match=r"one slice|flat"):
        load(written(tmp_path, "a.npy", np.zeros(shape, np.uint8)))
    if len(shape) == 2:
        for name in ("a.tif", "a.nrrd"):
            with pytest.raises(LoadError, match="one slice"):
                load(written(tmp_path, name, np.zeros(shape, np.uint8)))


def test_values_that_are_no_numbers(tmp_path: Path) -> None:
    data = np.ones((3, 4, 5), np.float32)
    data[0, 0, :2] = np.nan, np.inf
    volume = load(written(tmp_path, "a.npy", data))
    assert "2 voxels were NaN" in " ".join(volume.info.notices)
    assert "same value" in " ".join(load(written(tmp_path, "b.npy", np.ones((3, 4, 5)))).info.notices)
    for bad in (np.full((3, 4, 5), np.nan), np.ones((3, 4, 5), complex), np.zeros((0, 4, 5))):
        with pytest.raises(LoadError):
            load(written(tmp_path, "c.npy", bad))


def test_unknown_files_and_folders(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("hello")
    for path, words in (
        (tmp_path / "a.txt", "format is not known"),
        (tmp_path / "nothing", "no such file"),
        (tmp_path, "no volume was found"),
    ):
        with pytest.raises(LoadError, match=words):
            load(path)
    assert find_series(tmp_path) == find_series(tmp_path / "a.txt") == ()
    written(tmp_path, "a.nii", np.zeros((3, 4, 5), np.uint8))
    assert load(tmp_path).dims == (5, 4, 3)
    written(tmp_path, "b.nii", np.zeros((3, 4, 5), np.uint8))
    with pytest.raises(LoadError, match=r"2 volumes; open one of them: a\.nii, b\.nii"):
        load(tmp_path)


def test_huge_is_reduced_by_block_means(tmp_path: Path) -> None:
    z, y, x = np.mgrid[:20, :22, :26]
    path = written(tmp_path, "a.npy", (10 * z + 3 * y + x).astype(np.float32))
    volume = load(path, budget_bytes=20 * 22 * 26 * 4 // 7)
    assert volume.dims == (13, 11, 10)
    assert volume.spacing == (2, 2, 2)
    assert volume.data[0, 0, 0] == pytest.approx(7)  # mean of 2 x 2 x 2 voxels
    assert "Reduced from 26 x 22 x 20 voxels by a factor of 2" in volume.info.notices[1]
    halved = load(path, level=1)
    np.testing.assert_array_equal(halved.data, volume.data)
    long = load(written(tmp_path, "b.npy", np.zeros((2, 2, 5000), np.uint8)))
    assert long.dims == (1667, 2, 2)


def test_reduced_volume_keeps_its_place(tmp_path: Path) -> None:
    image = sitk.GetImageFromArray(np.arange(8 * 8 * 8, dtype=np.int16).reshape(8, 8, 8))
    image.SetOrigin((10, 20, 30))
    sitk.WriteImage(image, str(tmp_path / "a.nrrd"))
    assert load(tmp_path / "a.nrrd", level=1).origin == (10.5, 20.5, 30.5)


def test_modality_is_guessed_only_when_clear(tmp_path: Path) -> None:
    scan = np.full((10, 10, 10), -1000, np.int16)
    scan[3:7, 3:7, 3:7] = 40
    scan[5, 5, 5] = 1200
    assert load(written(tmp_path, "a.npy", scan)).info.modality == "CT"
    assert load(written(tmp_path, "b.npy", scan + 1024)).info.modality == ""
    assert load(written(tmp_path, "c.npy", np.clip(scan, 0, 255).astype(np.uint8))).info.modality == ""


def test_progress_and_cancel(tmp_path: Path) -> None:
    path = written(tmp_path, "a.nii.gz", np.zeros((64, 512, 512), np.uint8))
    told: list[float] = []
    load(path, progress=lambda fraction, text: told.append(fraction))
    assert told == sorted(told)
    assert told[0] == 0
    assert told[-1] == 1
    assert len(told) > 3
    asked: list[int] = []
    with pytest.raises(LoadCancelled):
        load(path, cancel=lambda: len(asked) > 1 or asked.append(1) is not None)


def test_schemes() -> None:
    volume = Volume(np.zeros((2, 3, 4), np.uint8))
    register_scheme("testing", {"cube": volume}.__getitem__)
    assert load("testing:cube") is volume
    with pytest.raises(LoadError, match="no testing of this name"):
        load("testing:sphere")


def test_import_is_quick_and_public() -> None:
    heavy = (
        "{'SimpleITK', 'pydicom', 'zarr', 'tifffile', 'vtkmodules', 'pyvista', 'PIL', 'scipy', 'imagecodecs'}"
    )
    code = f"import sys, sfumato.io; print(sorted({heavy} & set(sys.modules)))"
    assert (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        == "[]\n"
    )
    assert sfumato.load is load


def test_a_text_file_that_ends_early_is_no_volume(tmp_path: Path) -> None:
    header = "# vtk DataFile Version 2.0\nx\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 4 5 6\n"
    for axis, count in (("X", 4), ("Y", 5), ("Z", 6)):
        header += f"{axis}_COORDINATES {count} float\n{' '.join(map(str, range(count)))}\n"
    header += "POINT_DATA 120\nSCALARS s float\nLOOKUP_TABLE default\n"
    values = [f"{n / 7:.6f}" for n in range(120)]
    path = tmp_path / "text.vtk"
    path.write_text(header + "\n".join(values) + "\n", encoding="ascii")
    assert load(path).dims == (4, 5, 6)
    path.write_text(header + "\n".join(values[:70]), encoding="ascii")
    with pytest.raises(LoadError, match="ends before its last value"):
        load(path)


def test_a_stack_cut_off_is_not_called_one_slice(tmp_path: Path) -> None:
    path = tmp_path / "stack.tif"
    tifffile.imwrite(path, np.zeros((12, 16, 16), np.uint8), imagej=True)
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(LoadError, match="damaged"):
        load(path)


def test_a_header_without_its_voxels_says_so(tmp_path: Path) -> None:
    path = tmp_path / "head.mhd"
    sitk.WriteImage(sitk.GetImageFromArray(np.zeros((4, 5, 6), np.uint8)), str(path), useCompression=True)
    (tmp_path / "head.zraw").unlink()
    with pytest.raises(LoadError, match=r"is missing"):
        load(path)
