"""Volumes found again by their content: other series, halved ones; raw files described by the user."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sfumato import LoadError, Scene, Volume
from sfumato.io import (
    LoadCancelled,
    NeedsDescription,
    RawGuess,
    describe_raw,
    guess_raw,
    load,
    load_known,
    load_raw,
    reduce_volume,
)


@pytest.fixture
def ramp_file(tmp_path: Path) -> Path:
    """A volume of 24 x 16 x 12 voxels."""
    data = np.arange(24 * 16 * 12, dtype=np.uint16).reshape(12, 16, 24)
    np.save(tmp_path / "ramp.npy", data)
    return tmp_path / "ramp.npy"


def test_a_halved_volume_fills_the_same_space(ramp_file: Path) -> None:
    volume = load(ramp_file)
    half = reduce_volume(volume)
    assert half.dims == (12, 8, 6)
    assert half.spacing == (2.0, 2.0, 2.0)
    assert np.allclose(half.corners(), volume.corners())
    first = volume.data[:2, :2, :2].astype(float).mean()
    assert abs(float(half.data[0, 0, 0]) - first) <= 0.5
    assert half.info.path == volume.info.path
    assert any("factor of 2" in notice for notice in half.info.notices)


def test_halving_keeps_name_and_orientation_and_can_be_cancelled() -> None:
    turned = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    volume = Volume(np.zeros((8, 8, 8), np.uint8), spacing=(1, 2, 3), origin=(5, 6, 7), direction=turned)
    half = reduce_volume(volume)
    assert half.direction == volume.direction
    assert half.spacing == (2.0, 4.0, 6.0)
    assert half.info.path == ""
    assert np.allclose(half.corners(), volume.corners())
    with pytest.raises(LoadCancelled):
        reduce_volume(volume, cancel=lambda: True)


def test_a_scene_on_a_halved_volume_opens_again(ramp_file: Path) -> None:
    quarter = reduce_volume(reduce_volume(load(ramp_file)))
    Scene(volume=quarter).save(ramp_file.with_name("kept.sfumato"))
    volume = Scene.open(ramp_file.with_name("kept.sfumato")).volume
    assert volume is not None
    assert volume.key == quarter.key
    assert volume.dims == (6, 4, 3)


def test_another_content_is_refused(ramp_file: Path) -> None:
    with pytest.raises(LoadError, match="its content differs"):
        load_known(ramp_file, "0123")


@pytest.mark.parametrize("dtype", ["uint8", ">i2", "float32"])
def test_a_described_raw_file_opens_by_itself(tmp_path: Path, dtype: str) -> None:
    path = tmp_path / "scan.raw"
    data = (np.arange(5 * 6 * 7) % 120).astype(dtype).reshape(5, 6, 7)
    path.write_bytes(b"head" + data.tobytes() + b"tail")
    with pytest.raises(NeedsDescription):
        load(path)
    how = RawGuess((7, 6, 5), dtype, (1.0, 1.5, 2.0), 4)
    describe_raw(path, how)
    guess = guess_raw(path)[0]
    assert (guess.dims, np.dtype(guess.dtype), guess.spacing, guess.offset) == (
        how.dims, np.dtype(dtype), how.spacing, 4,
    )  # fmt: skip
    volume = load(path)
    assert np.array_equal(volume.data, data)
    assert volume.key == load_raw(path, how.dims, dtype, how.spacing, offset=4).key


def test_a_big_endian_name_is_read(tmp_path: Path) -> None:
    data = np.arange(5 * 6 * 7, dtype=">i2").reshape(5, 6, 7)
    (tmp_path / "scan_7x6x5_int16_be.raw").write_bytes(data.tobytes())
    assert np.array_equal(load(tmp_path / "scan_7x6x5_int16_be.raw").data, data)


def test_a_description_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    path = tmp_path / "scan.raw"
    path.write_bytes(b"12345678")
    path.with_name("scan.raw.json").mkdir()
    with pytest.raises(LoadError):
        describe_raw(path, RawGuess((2, 2, 2), "uint8"))
