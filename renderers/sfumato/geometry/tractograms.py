"""TRK (TrackVis) and TCK (MRtrix), through nibabel: both are brought to RAS mm by their own header."""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np

from ..io.reading import Task, need
from .cleaning import RawLines, to_lps


class _Watched(io.BufferedReader):
    """A file that tells how far it was read, and stops when nobody wants it any more."""

    def __init__(self, task: Task) -> None:
        super().__init__(io.FileIO(task.path), 1 << 20)
        self._task, self._size, self._told = task, max(task.path.stat().st_size, 1), 0

    def read(self, size: int | None = -1, /) -> bytes:
        data = super().read(size)
        at = self.tell()
        if abs(at - self._told) > 1 << 20:
            self._told = at
            self._task.step(0.6 * at / self._size, "Reading")
        return data


def read_trk(task: Task) -> RawLines:
    """Read TrackVis' format."""
    return _read(task, "TrkFile")


def read_tck(task: Task) -> RawLines:
    """Read MRtrix' format."""
    return _read(task, "TckFile")


def _read(task: Task, kind: str) -> RawLines:
    streamlines = need("nibabel.streamlines", task)
    with _Watched(task) as stream, warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        tractogram = getattr(streamlines, kind).load(stream).tractogram
    lines = tractogram.streamlines
    points, lengths = _flat(lines)
    # Without a line nibabel's array has no columns.
    raw = RawLines(to_lps(points.reshape(-1, 3)), lengths, notices=_header_notices(heard))
    for name, values in tractogram.data_per_point.items():
        raw.point_values[str(name)] = _flat(values)[0]
    for name, values in tractogram.data_per_streamline.items():
        raw.line_values[str(name)] = np.asarray(values)
    return raw


def _flat(sequence: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the data of an ArraySequence in one array, and the length of each item."""
    lengths = np.fromiter((len(item) for item in sequence), np.int64, len(sequence))
    return np.asarray(sequence.get_data()), lengths


def _header_notices(heard: list[warnings.WarningMessage]) -> list[str]:
    texts = [str(w.message) for w in heard]
    notices = []
    if any("vox_to_ras" in text for text in texts):
        notices.append(
            "The file has no affine: its coordinates are taken as they are, so it may not lie on its scan."
        )
    if any("voxel order" in text.lower() for text in texts):
        notices.append("The file does not say its voxel order; LPS, TrackVis' own, is taken.")
    return notices
