"""DICOM: single files, enhanced multi-frame objects, and folders with one or several series.

The geometry is decided from the positions of the slices themselves, since neither their order in the folder
nor the declared thickness says where they lie: sorted along the normal; copies dropped; missing ones filled;
uneven distances and gantry tilt resampled onto a straight grid. Each of these leaves a notice.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import LoadError
from .deskew import even, shift_plane
from .dicom_header import Frame, is_dicom, read_header
from .dicom_pixels import Decoder, to_units, unit_dtype
from .dicom_series import Series, SeriesInfo, files_below, info_of, scan
from .reading import Reading, Source, Task, pick_frame

#: Slices that wander by less than this many pixels over the whole stack count as straight.
_DRIFT_PIXELS = 0.5


@dataclass
class _Plan:
    """How planes of the volume come from frames: which two, blended how, moved where."""

    frames: list[Frame]
    planes: list[tuple[int, int, float]]
    shifts: np.ndarray
    shape: tuple[int, int, int]
    axes: np.ndarray
    origin: np.ndarray | None


def find_series(path: Path, task: Task) -> tuple[SeriesInfo, ...]:
    """Return what series a folder (or the file's folder) holds, most slices first."""
    return tuple(info_of(series) for series in _all_series(path, task))


def read(task: Task) -> Reading:
    """Read the series that a task asks for, or that with most slices."""
    found = _all_series(task.path, task)
    if not found:
        raise task.error("no DICOM image with pixel data was found in it", "choose a folder with images")
    series = _chosen(found, task)
    notices: list[str] = []
    if len(found) > 1 and task.series is None and task.path.is_dir():
        rest = len(found) - 1
        notices.append(
            f"The folder holds {rest} more series: this is {series.label}, the one with most slices."
        )
    plan = _plan(series, task, notices)
    known = series.patient and plan.origin is not None and series.orientation is not None
    if series.inverted:
        notices.append(
            "Stored for display as a negative; CT numbers are kept."
            if series.modality == "CT"
            else "Stored as a negative: inverted."
        )
    return Reading(
        _source(series, plan, task),
        plan.axes,
        plan.origin,
        series.modality if series.modality in _MODALITIES else "",
        known,
        series.label,
        notices,
        begun=0.3,
    )


def middle_slices(path: Path, task: Task) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the key and the middle frame in units of each series that can be decoded."""
    for series in _all_series(path, task):
        task.step(0.0, "Previews")
        depths = series.depths()
        order = range(len(series.frames)) if depths is None else np.argsort(depths, kind="stable")
        frame = series.frames[int(order[len(order) // 2])]
        try:
            plane = to_units(Decoder(series, task).values(frame), frame, unit_dtype(series))
        except LoadError:
            continue
        yield series.key, plane


_MODALITIES = ("CT", "MR", "US", "PT", "NM", "XA", "OCT", "OPT", "MG")


def _all_series(path: Path, task: Task) -> list[Series]:
    if path.is_dir():
        return scan(files_below(path, task), task)
    header = read_header(path, task)
    if header is None or "Rows" not in header or "Columns" not in header:
        raise task.error(
            "this DICOM file holds no pixel data", "open the folder with the images of the examination"
        )
    if int(header.get("NumberOfFrames") or 1) > 1:
        return scan([path], task)
    # One slice was opened: its brothers lie beside it.
    own = scan([path], task)[0]
    beside = [p for p in sorted(path.parent.iterdir()) if p.is_file() and is_dicom(p)]
    return [s for s in scan(beside, task) if s.key == own.key] or [own]


def _chosen(found: list[Series], task: Task) -> Series:
    if task.series is None:
        return found[0]
    if isinstance(task.series, int) and 0 <= task.series < len(found):
        return found[task.series]
    for series in found:
        if series.key == task.series:
            return series
    raise task.error(
        f"there is no series {task.series!r} in it",
        "it holds " + "; ".join(f"{s.key} ({s.label})" for s in found[:8]),
    )


# -- geometry --------------------------------------------------------------------------------------
def _plan(series: Series, task: Task, notices: list[str]) -> _Plan:
    depths = series.depths()
    if depths is None:
        return _plan_without_places(series, task, notices)
    frames = _one_per_place(series.frames, depths, task, notices)
    if len(frames) < 2:
        raise task.error(
            "it holds only one slice", "a volume needs at least 2: open the folder of the whole series"
        )
    return _plan_with_places(frames, series, notices)


def _plan_without_places(series: Series, task: Task, notices: list[str]) -> _Plan:
    stacks = series.stacks()
    chosen = stacks[pick_frame(task, len(stacks), notices, "stacks of the same series")]
    frames = sorted(chosen, key=lambda f: (f.location is None, f.location or 0.0, f.order[2:]))
    notices.append("The file does not say where its slices lie: stacked in order of their numbers.")
    if not series.spacing_known:
        notices.append("The size of its voxels is not known: taken as 1 mm.")
    dy, dx = series.frames[0].spacing
    axes = np.diag([dx, dy, series.slice_distance]) if series.spacing_known else np.eye(3)
    n = len(frames)
    shape = (n, series.rows, series.columns)
    return _Plan(frames, [(i, i, 0.0) for i in range(n)], np.zeros((n, 2)), shape, axes, None)


def _plan_with_places(frames: list[Frame], series: Series, notices: list[str]) -> _Plan:
    turn = np.array(frames[0].orientation)
    x, y = turn[:3], turn[3:]
    normal = np.cross(x, y)
    positions = np.array([f.position for f in frames])
    distance, planes, notice = even(positions @ normal)
    if notice:
        notices.append(notice)
    dy, dx = frames[0].spacing
    shifts = np.stack([(positions - positions[0]) @ x / dx, (positions - positions[0]) @ y / dy], axis=1)
    size = np.array([series.columns, series.rows])
    origin = positions[0]
    if np.ptp(shifts, axis=0).max() > _DRIFT_PIXELS:
        notices.append(_tilt_notice(shifts * (dx, dy), positions @ normal))
        low = np.floor(shifts.min(axis=0) + 1e-6)
        shifts = np.maximum(shifts - low, 0)
        size = size + np.ceil(shifts.max(axis=0) - 1e-6).astype(int)
        origin = origin + x * dx * low[0] + y * dy * low[1]
    else:
        shifts = np.zeros_like(shifts)
    axes = np.column_stack([x * dx, y * dy, normal * distance])
    return _Plan(frames, planes, shifts, (len(planes), int(size[1]), int(size[0])), axes, origin)


def _tilt_notice(shifts_mm: np.ndarray, depths: np.ndarray) -> str:
    along = float(depths[-1] - depths[0])
    angle = np.degrees(np.arctan2(np.linalg.norm(shifts_mm[-1] - shifts_mm[0]), along))
    return f"The slices are sheared by {angle:.1f} degrees (gantry tilt): resampled onto a straight grid."


def _one_per_place(frames: list[Frame], depths: np.ndarray, task: Task, notices: list[str]) -> list[Frame]:
    """Return one frame a place, along the normal; the rest are phases (chosen by ``frame``) or copies."""
    order = sorted(range(len(frames)), key=lambda i: (depths[i], frames[i].order))
    places: list[list[Frame]] = []
    last = -np.inf
    for i in order:
        if depths[i] - last > 0.01:  # mm; thinner slices do not exist in medicine
            places.append([])
            last = depths[i]
        places[-1].append(frames[i])
    for place in places:
        place.sort(key=lambda f: f.order)
    counts = {len(place) for place in places}
    if counts == {1}:
        return [place[0] for place in places]
    if len(counts) == 1 and len(places) > 1:
        count = counts.pop()
        if not 0 <= task.frame < count:
            raise task.error(f"there is no frame {task.frame}", f"it has {count}: 0 to {count - 1}")
        which = f"number {task.frame + 1} is shown"
        notices.append(f"There are {count} images at every place (phases, echoes or copies): {which}.")
        return [place[task.frame] for place in places]
    extra = len(frames) - len(places)
    notices.append(
        f"{extra} slice{' was' if extra == 1 else 's were'} there twice: the first of each place is used."
    )
    return [place[0] for place in places]


# -- voxels ----------------------------------------------------------------------------------------
def _source(series: Series, plan: _Plan, task: Task) -> Source:
    decoder, dtype = Decoder(series, task), unit_dtype(series)
    shape = plan.shape[1:]
    moved = bool(plan.shifts.any())
    cache: dict[int, np.ndarray] = {}

    def frame(i: int) -> np.ndarray:
        if i not in cache:
            for old in [k for k in cache if k < i - 1]:
                del cache[old]
            plane = to_units(decoder.values(plan.frames[i]), plan.frames[i], dtype)
            cache[i] = (
                shift_plane(plane, float(plan.shifts[i][0]), float(plan.shifts[i][1]), shape)
                if moved
                else plane
            )
        return cache[i]

    def planes(z0: int, z1: int) -> np.ndarray:
        out = np.empty((z1 - z0, *shape), dtype=dtype)
        for k in range(z0, z1):
            i, j, weight = plan.planes[k]
            mixed = frame(i) if i == j else frame(i) * np.float32(1 - weight) + frame(j) * np.float32(weight)
            out[k - z0] = np.rint(mixed) if dtype.kind in "iu" and mixed.dtype.kind == "f" else mixed
        return out

    return Source(plan.shape, dtype, planes)


def has_dicom(folder: Path, task: Task) -> bool:
    """Whether a folder, or one below it, holds any DICOM file."""
    return next(files_below(folder, task), None) is not None
