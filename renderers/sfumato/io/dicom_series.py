"""Which DICOM series a folder holds: headers only, no patient data kept.

A *series* here is what makes one volume: images with the same series identifier, size and orientation, so
that a localiser's three directions, or a vendor's mixture, become separate entries.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .reading import Task, need

Numbers = tuple[float, ...]
#: More files than this in one folder tree are not a scan but somebody's home directory.
MAX_FILES = 50_000
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


@dataclass
class Series:
    """Frames that make one volume, and what they have in common."""

    identity: str
    modality: str
    number: str
    description: str
    rows: int
    columns: int
    bits: int
    signed: bool
    inverted: bool
    patient: bool
    slice_distance: float
    spacing_known: bool
    frames: list[Frame] = field(default_factory=list)

    @property
    def orientation(self) -> Numbers | None:
        """Orientation of the first frame."""
        return self.frames[0].orientation

    @property
    def key(self) -> str:
        """A short name that is the same at each visit and tells nothing about the patient."""
        turn = tuple(round(c, 2) + 0.0 for c in self.orientation or ())
        return hashlib.blake2b(
            repr((self.identity, self.rows, self.columns, turn)).encode(), digest_size=6
        ).hexdigest()

    @property
    def label(self) -> str:
        """Modality, number and description, without anything that identifies the patient."""
        words = [self.modality or "DICOM"]
        if self.number:
            words.append(f"series {self.number}")
        if self.description:
            words.append(self.description)
        return " ".join(words)

    def depths(self) -> np.ndarray | None:
        """Return the frames' places along their normal in mm; None if any has no place."""
        if any(f.position is None or f.orientation is None for f in self.frames):
            return None
        turn = np.array(self.orientation)
        normal = np.cross(turn[:3], turn[3:])
        return np.array([f.position for f in self.frames]) @ normal

    @property
    def slices(self) -> int:
        """Number of different places."""
        depths = self.depths()
        if depths is None:
            return max(len(stack) for stack in self.stacks())
        return len(np.unique(np.round(depths, 2)))

    def stacks(self) -> list[list[Frame]]:
        """Return the frames by file if each file holds several, else all of them as one stack."""
        by_file: dict[Path, list[Frame]] = {}
        for frame in self.frames:
            by_file.setdefault(frame.file, []).append(frame)
        several = all(len(frames) > 1 for frames in by_file.values())
        return list(by_file.values()) if several else [self.frames]


@dataclass(frozen=True)
class SeriesInfo:
    """What a dialog shows of one DICOM series.

    Parameters
    ----------
    key : str
        Give this to ``load(series=...)``.
    label : str
        Modality, series number and description; no patient data.
    modality : str
        As the file says: ``CT``, ``MR``, ``US`` ...
    count : int
        Number of slices at different places.
    dims : (int, int, int)
        Voxels along x, y, z, before any resampling.
    spacing : (float, float, float)
        In mm along x, y, z; 1 where it is not known.
    """

    key: str
    label: str
    modality: str
    count: int
    dims: tuple[int, int, int]
    spacing: tuple[float, float, float]


def info_of(series: Series) -> SeriesInfo:
    """Return the public description of a series."""
    depths, count = series.depths(), series.slices
    distance = series.slice_distance if series.spacing_known else 1.0
    if depths is not None and count > 1:
        distance = float(np.median(np.diff(np.unique(np.round(depths, 2)))))
    dy, dx = series.frames[0].spacing
    return SeriesInfo(
        series.key,
        series.label,
        series.modality,
        count,
        (series.columns, series.rows, count),
        (dx, dy, distance),
    )


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


def scan(files: Iterable[Path], task: Task) -> list[Series]:
    """Return the series in these files, that with most slices first; what holds no image is passed over."""
    found: list[Series] = []
    todo = list(files)
    for k, file in enumerate(todo):
        if k % 8 == 0:
            task.step(0.3 * k / len(todo), f"Reading DICOM headers ({k} of {len(todo)})")
        header = read_header(file, task)
        if header is not None and "Rows" in header and "Columns" in header:
            _sort_in(found, header, file)
    return sorted(found, key=lambda s: (-s.slices, -s.rows * s.columns, s.number, s.key))


def files_below(folder: Path, task: Task) -> Iterator[Path]:
    """Yield the DICOM files in a folder and below it, in order of their names."""
    seen = 0
    for path in sorted(folder.rglob("*")):
        if path.name.startswith(".") or not path.is_file():
            continue
        seen += 1
        if seen > MAX_FILES:
            raise task.error(
                f"there are more than {MAX_FILES} files in it", "open the folder of one examination"
            )
        if seen % 100 == 0:
            task.step(0.0, "Looking for DICOM files")
        if path.name != "DICOMDIR" and is_dicom(path):
            yield path


def read_header(file: Path, task: Task) -> Any:
    """Return a file's data set without its pixels, or None if it cannot be read."""
    pydicom = need("pydicom", task)
    try:
        return pydicom.dcmread(file, stop_before_pixels=True, force=True)
    except Exception:  # whatever a damaged file does to the parser, it is not an image
        return None


# -- one header ------------------------------------------------------------------------------------
def _sort_in(found: list[Series], header: Any, file: Path) -> None:
    common = _series_of(header, file)
    for frame in _frames_of(header, file):
        for series in found:
            same = (series.identity, series.rows, series.columns, series.modality)
            if same == (common.identity, common.rows, common.columns, common.modality) and _parallel(
                series.orientation, frame.orientation
            ):
                series.frames.append(frame)
                break
        else:
            new = _series_of(header, file)
            new.frames.append(frame)
            found.append(new)


def _parallel(a: Numbers | None, b: Numbers | None) -> bool:
    if a is None or b is None:
        return a is b
    return bool(np.dot(a[:3], b[:3]) > 0.9998 and np.dot(a[3:], b[3:]) > 0.9998)  # within a degree


def _series_of(header: Any, file: Path) -> Series:
    modality = str(header.get("Modality") or "")
    shared = _shared(header)
    distance = _number(_measure(shared, None, "SpacingBetweenSlices", header)) or _number(
        _measure(shared, None, "SliceThickness", header)
    )
    known = (
        _measure(shared, None, "PixelSpacing", header) is not None
        or header.get("ImagerPixelSpacing") is not None
    )
    return Series(
        identity=str(header.get("SeriesInstanceUID") or f"{header.get('SeriesNumber')} {file.parent}"),
        modality={"MRI": "MR"}.get(modality, modality),
        number=str(header.get("SeriesNumber") or ""),
        description=_description(header),
        rows=int(header.Rows),
        columns=int(header.Columns),
        bits=int(header.get("BitsStored") or header.get("BitsAllocated") or 16),
        signed=bool(header.get("PixelRepresentation") or 0),
        inverted=header.get("PhotometricInterpretation") == "MONOCHROME1",
        patient=True,
        slice_distance=abs(distance) if distance else 1.0,
        spacing_known=known,
    )


def _description(header: Any) -> str:
    """Return the series description, unless it repeats something of the patient's name or number."""
    text = " ".join(str(header.get("SeriesDescription") or "").split())[:64]
    private = f"{header.get('PatientName') or ''}^{header.get('PatientID') or ''}".replace(" ", "^").split(
        "^"
    )
    if text.lower() == "none":
        return ""
    return "" if any(len(part) > 2 and part.lower() in text.lower() for part in private) else text


def _shared(header: Any) -> Any:
    groups = header.get("SharedFunctionalGroupsSequence")
    return groups[0] if groups else None


def _frames_of(header: Any, file: Path) -> Iterator[Frame]:
    count = max(1, int(_number(header.get("NumberOfFrames")) or 1))
    per_frame, shared = header.get("PerFrameFunctionalGroupsSequence") or (), _shared(header)
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
        _measure(shared, own, "PixelSpacing", header) or header.get("ImagerPixelSpacing"), 2
    ) or (1.0, 1.0)
    value = (
        _group(own, "PixelValueTransformationSequence")
        or _group(shared, "PixelValueTransformationSequence")
        or header
    )
    return Frame(
        file, index, position, _unit(orientation), (abs(spacing[0]) or 1.0, abs(spacing[1]) or 1.0),
        _number(value.get("RescaleSlope")) or 1.0, _number(value.get("RescaleIntercept")) or 0.0,
        _order(header, own, index, file), _number(header.get("SliceLocation")) if count == 1 else None,
    )  # fmt: skip


def _order(header: Any, own: Any, index: int, file: Path) -> tuple[Any, ...]:
    content = _group(own, "FrameContentSequence") or header
    echo = _group(own, "MREchoSequence") or header
    return (
        _number(content.get("TemporalPositionIndex") or header.get("TemporalPositionIdentifier")) or 0.0,
        _number(echo.get("EffectiveEchoTime") or header.get("EchoTime")) or 0.0,
        _number(header.get("AcquisitionNumber")) or 0.0,
        _number(header.get("InstanceNumber")) or 0.0,
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


def _measure(shared: Any, own: Any, name: str, header: Any) -> Any:
    for item in (own, shared):
        group = _group(item, "PixelMeasuresSequence")
        if group is not None and group.get(name) is not None:
            return group.get(name)
    return header.get(name)


def _number(value: Any) -> float | None:
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
