"""Which DICOM series a folder holds: headers only, no patient data kept.

A *series* here is what makes one volume: images with the same series identifier, size and orientation, so
that a localiser's three directions, or a vendor's mixture, become separate entries.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .dicom_header import (
    Frame,
    Numbers,
    description,
    frames_of,
    is_dicom,
    measure_of,
    number_of,
    read_header,
    shared_groups,
)
from .reading import Task

#: More files than this in one folder tree are not a scan but somebody's home directory.
MAX_FILES = 50_000


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


# -- one header ------------------------------------------------------------------------------------
def _sort_in(found: list[Series], header: Any, file: Path) -> None:
    common = _series_of(header, file)
    for frame in frames_of(header, file):
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
    shared = shared_groups(header)
    distance = number_of(measure_of(shared, None, "SpacingBetweenSlices", header)) or number_of(
        measure_of(shared, None, "SliceThickness", header)
    )
    known = (
        measure_of(shared, None, "PixelSpacing", header) is not None
        or header.get("ImagerPixelSpacing") is not None
    )
    return Series(
        identity=str(header.get("SeriesInstanceUID") or f"{header.get('SeriesNumber')} {file.parent}"),
        modality={"MRI": "MR"}.get(modality, modality),
        number=str(header.get("SeriesNumber") or ""),
        description=description(header),
        rows=int(header.Rows),
        columns=int(header.Columns),
        bits=int(header.get("BitsStored") or header.get("BitsAllocated") or 16),
        signed=bool(header.get("PixelRepresentation") or 0),
        inverted=header.get("PhotometricInterpretation") == "MONOCHROME1",
        patient=True,
        slice_distance=abs(distance) if distance else 1.0,
        spacing_known=known,
    )
