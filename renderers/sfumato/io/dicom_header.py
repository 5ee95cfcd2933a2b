"""One DICOM header: what kind of image it announces, where its frames lie, how their values are scaled."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .reading import Task, need

Numbers = tuple[float, ...]
#: Group length, character set, image type, creation date, class, instance, study date.
_FIRST_ELEMENTS = (0x00, 0x05, 0x08, 0x12, 0x16, 0x18, 0x20)
#: Enhanced multi-frame objects keep a frame's place in one of these sequences (patient or probe coordinates).
_PLACES = (
    ("PlanePositionSequence", "ImagePositionPatient"),
    ("PlanePositionVolumeSequence", "ImagePositionVolume"),
)
_TURNS = (
    ("PlaneOrientationSequence", "ImageOrientationPatient"),
    ("PlaneOrientationVolumeSequence", "ImageOrientationVolume"),
)


@dataclass(frozen=True)
class Frame:
    """One image: where it lies in which file, and where in the patient.

    Parameters
    ----------
    position : 3 numbers, optional
        Centre of the first pixel in mm (LPS).
    orientation : 6 numbers, optional
        Unit vectors along a row (x) and down a column (y).
    spacing : (float, float)
        Between rows (y) and between columns (x) in mm.
    slope, intercept : float
        Stored value to unit (Hounsfield ...).
    order : tuple
        Time, echo, acquisition, instance: orders images at the same place.
    """

    file: Path
    index: int
    position: Numbers | None
    orientation: Numbers | None
    spacing: tuple[float, float]
    slope: float
    intercept: float
    order: tuple[Any, ...]
    location: float | None = None


def is_dicom(path: Path) -> bool:
    """Whether a file's content is DICOM, with or without the preamble."""
    try:
        with path.open("rb") as stream:
            head = stream.read(132)
    except OSError:
        return False
    if head[128:132] == b"DICM":
        return True
    return _begins_bare(head)


def _begins_bare(head: bytes) -> bool:
    """Whether bytes begin like a data set without a preamble: a plausible element of group 2 or 8."""
    if len(head) < 8:
        return False
    group, element, length = struct.unpack_from("<HHI", head)
    if head[:4] == b"\x00\x08\x00\x05":  # big endian, character set first
        return True
    if group not in (2, 8) or element not in _FIRST_ELEMENTS:
        return False
    return head[4:6] in (b"UL", b"CS", b"UI", b"DA") or (2 <= length <= 128 and length % 2 == 0)


def read_header(file: Path, task: Task) -> Any:
    """Return a file's data set without its pixels, or None if it cannot be read."""
    pydicom = need("pydicom", task)
    try:
        return pydicom.dcmread(file, stop_before_pixels=True, force=True)
    except Exception:  # whatever a damaged file does to the parser, it is not an image
        return None


# -- elements ---------------------------------------------------------------------------------------
def description(header: Any) -> str:
    """Return the series description, unless it repeats something of the patient's name or number."""
    text = " ".join(str(header.get("SeriesDescription") or "").split())[:64]
    private = f"{header.get('PatientName') or ''}^{header.get('PatientID') or ''}".replace(" ", "^").split(
        "^"
    )
    if text.lower() == "none":
        return ""
    return "" if any(len(part) > 2 and part.lower() in text.lower() for part in private) else text


def shared_groups(header: Any) -> Any:
    """Return the functional groups that all frames of an enhanced object share, or None."""
    groups = header.get("SharedFunctionalGroupsSequence")
    return groups[0] if groups else None


def frames_of(header: Any, file: Path) -> Iterator[Frame]:
    """Yield the frames of a file; a plain image has one."""
    count = max(1, int(number_of(header.get("NumberOfFrames")) or 1))
    per_frame, shared = header.get("PerFrameFunctionalGroupsSequence") or (), shared_groups(header)
    for index in range(count):
        own = per_frame[index] if index < len(per_frame) else None
        yield _frame(header, shared, own, file, index, count)


def _frame(header: Any, shared: Any, own: Any, file: Path, index: int, count: int) -> Frame:
    top = header if count == 1 or "GridFrameOffsetVector" in header else None
    detector = (header.get("DetectorInformationSequence") or [None])[0]
    position = _vector(_first(_PLACES, own, shared, top), 3)
    orientation = _vector(_first(_TURNS, own, shared, header, detector), 6)
    offsets = header.get("GridFrameOffsetVector")
    if position is not None and orientation is not None and offsets is not None and index < len(offsets):
        normal = np.cross(orientation[:3], orientation[3:])
        step = float(offsets[index]) - (
            float(offsets[0]) if offsets[0] == header.ImagePositionPatient[2] else 0.0
        )
        position = tuple(float(c) for c in np.array(position) + normal * step)
    spacing = _vector(
        measure_of(shared, own, "PixelSpacing", header) or header.get("ImagerPixelSpacing"), 2
    ) or (1.0, 1.0)
    value = (
        _group(own, "PixelValueTransformationSequence")
        or _group(shared, "PixelValueTransformationSequence")
        or header
    )
    return Frame(
        file, index, position, _unit(orientation), (abs(spacing[0]) or 1.0, abs(spacing[1]) or 1.0),
        number_of(value.get("RescaleSlope")) or 1.0, number_of(value.get("RescaleIntercept")) or 0.0,
        _order(header, own, index, file), number_of(header.get("SliceLocation")) if count == 1 else None,
    )  # fmt: skip


def _order(header: Any, own: Any, index: int, file: Path) -> tuple[Any, ...]:
    content = _group(own, "FrameContentSequence") or header
    echo = _group(own, "MREchoSequence") or header
    return (
        number_of(content.get("TemporalPositionIndex") or header.get("TemporalPositionIdentifier")) or 0.0,
        number_of(echo.get("EffectiveEchoTime") or header.get("EchoTime")) or 0.0,
        number_of(header.get("AcquisitionNumber")) or 0.0,
        number_of(header.get("InstanceNumber")) or 0.0,
        index,
        file.name,
    )


def _group(item: Any, name: str) -> Any:
    sequence = item.get(name) if item is not None else None
    return sequence[0] if sequence else None


def _first(paths: tuple[tuple[str, str], ...], own: Any, shared: Any, *plain: Any) -> Any:
    for sequence, name in paths:
        for item in (own, shared):
            group = _group(item, sequence)
            if group is not None and group.get(name) is not None:
                return group.get(name)
    for item in plain:
        if item is not None and item.get(paths[0][1]) is not None:
            return item.get(paths[0][1])
    return None


def measure_of(shared: Any, own: Any, name: str, header: Any) -> Any:
    """Return an element of a frame's, or all frames', pixel measures, else of the data set itself."""
    for item in (own, shared):
        group = _group(item, "PixelMeasuresSequence")
        if group is not None and group.get(name) is not None:
            return group.get(name)
    return header.get(name)


def number_of(value: Any) -> float | None:
    """Return a finite number, or None for what is none."""
    try:
        number = float(value[0]) if isinstance(value, (list, tuple)) else float(value)
    except (TypeError, ValueError, IndexError):
        return None
    return number if np.isfinite(number) else None


def _vector(value: Any, length: int) -> Numbers | None:
    try:
        numbers = tuple(float(v) for v in value)
    except (TypeError, ValueError):
        return None
    return numbers if len(numbers) == length and np.isfinite(numbers).all() else None


def _unit(orientation: Numbers | None) -> Numbers | None:
    """Return two orthonormal vectors, or None if the file's are no directions at all."""
    if orientation is None:
        return None
    x, y = np.array(orientation[:3]), np.array(orientation[3:])
    if min(np.linalg.norm(x), np.linalg.norm(y)) < 0.5:
        return None
    x = x / np.linalg.norm(x)
    y = y - x * np.dot(x, y)
    if np.linalg.norm(y) < 0.5:
        return None
    y = y / np.linalg.norm(y)
    return tuple(float(c) for c in (*x, *y))
