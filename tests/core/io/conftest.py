"""Volumes that say which voxel is which, and writers of DICOM series with every fault that scanners make."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, generate_uid

Writer = Callable[..., Path]


@pytest.fixture
def ramp() -> np.ndarray:
    """Array (5, 6, 7) whose every voxel has another value."""
    return np.arange(5 * 6 * 7, dtype=np.int16).reshape(5, 6, 7)


@pytest.fixture
def write_slice() -> Writer:
    """Write one CT slice; ``more`` sets any other element."""
    return _write_slice


def _write_slice(
    path: Path, pixels: np.ndarray, position: np.ndarray, *,
    orientation: tuple[float, ...] = (1, 0, 0, 0, 1, 0), spacing: tuple[float, float] = (0.7, 0.5),
    series: str = "1.2.3.4", number: int = 1, syntax: str = ExplicitVRLittleEndian, **more: object,
) -> Path:  # fmt: skip
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = CTImageStorage
    meta.MediaStorageSOPInstanceUID = generate_uid()
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data = Dataset()
    data.file_meta = meta
    data.SOPClassUID, data.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
    data.PatientName, data.PatientID = "Doe^Jane", "4711-A"
    data.Modality, data.SeriesInstanceUID, data.SeriesNumber = "CT", series, 3
    data.InstanceNumber, data.FrameOfReferenceUID = number, "1.2.9"
    data.ImagePositionPatient = [f"{p:.6f}" for p in position]
    data.ImageOrientationPatient = [f"{c:.8f}" for c in orientation]
    data.PixelSpacing = list(spacing)
    data.SliceThickness = 99
    data.RescaleSlope, data.RescaleIntercept = 1, -1024
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.Rows, data.Columns = pixels.shape[:2]
    data.BitsAllocated, data.BitsStored, data.HighBit = 16, 12, 11
    data.PixelRepresentation = 0
    data.PixelData = np.ascontiguousarray(pixels, dtype="<u2").tobytes()
    for name, value in more.items():
        setattr(data, name, value)
    if syntax != ExplicitVRLittleEndian:
        data.compress(syntax)
    data.save_as(path, enforce_file_format=True)
    return path


@pytest.fixture
def write_series(tmp_path: Path) -> Writer:
    """Write planes (z, y, x) of stored values at given positions, names shuffled; return the folder."""

    def write(planes: np.ndarray, positions: np.ndarray, *, folder: str = "series", **more: object) -> Path:
        target = tmp_path / folder
        target.mkdir(exist_ok=True)
        names = np.random.default_rng(3).permutation(len(planes)) + len(list(target.iterdir()))
        for k, (plane, position) in enumerate(zip(planes, positions, strict=True)):
            _write_slice(target / f"IM{names[k]:03d}", plane, position, number=int(names[k]), **more)  # type: ignore[arg-type]
        return target

    return write
