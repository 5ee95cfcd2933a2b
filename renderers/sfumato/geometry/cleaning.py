"""What readers hand back, and how it becomes a shape: what cannot be shown is left out and counted."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..io.reading import Task
from ..scene.shapes import Lines, Surface

#: World coordinates beyond this are no place in a patient, and their squares near float32's end: 10 km.
FARTHEST_MM = 1e7
#: Scalars that are kept, at most; the others are named in a notice.
MAX_SCALARS = 16


@dataclass
class RawLines:
    """Lines as a file holds them.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        World mm LPS; NaN allowed.
    lengths : ndarray, shape (k,)
        Points of each line; 0 and 1 allowed.
    point_values : dict of ndarray, shape (n,) or (n, c)
        Values at the points.
    line_values : dict of ndarray, shape (k,) or (k, c)
        Values of the lines.
    space : str
        The space that the file says it is in: ``LPS`` already converted, or empty if it does not say.
    """

    points: np.ndarray
    lengths: np.ndarray
    point_values: dict[str, np.ndarray] = field(default_factory=dict)
    line_values: dict[str, np.ndarray] = field(default_factory=dict)
    notices: list[str] = field(default_factory=list)
    space: str = "LPS"


@dataclass
class RawSurface:
    """Triangles as a file holds them; arrays as in `Surface`, NaN allowed."""

    points: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray | None = None
    point_values: dict[str, np.ndarray] = field(default_factory=dict)
    colors: np.ndarray | None = None
    notices: list[str] = field(default_factory=list)
    space: str = ""


def to_lps(points: np.ndarray) -> np.ndarray:
    """Return RAS coordinates (or directions) as LPS, or the reverse: x and y change their sign."""
    return np.asarray(points * np.array([-1, -1, 1], points.dtype))


def plural(count: int, noun: str) -> str:
    """Return ``1 line`` or ``3 lines``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def lines_of(raw: RawLines, task: Task) -> tuple[Lines, list[str]]:
    """Return the lines that can be shown, and notices that count the others.

    A line is cut where it has a point that is no place (NaN, infinite, more than 10 km away); what is left
    of it with two points or more is kept. Point repeats are kept here: the tubes leave them out.

    Raises
    ------
    LoadError
        If there is nothing to show.
    """
    notices = list(raw.notices)
    lengths = np.asarray(raw.lengths, dtype=np.int64)
    line = np.repeat(np.arange(len(lengths)), lengths)
    points = np.asarray(raw.points)
    good = _placed(points)
    # A piece ends where the line ends or a point is missing.
    piece = line + np.cumsum(~good)
    size = np.bincount(piece[good], minlength=int(piece[-1]) + 1 if len(piece) else 1)
    kept = good & (size[piece] > 1)
    _count_losses(notices, lengths, line, good, kept)
    if not kept.any():
        detail = "; ".join(n.rstrip(".") for n in notices) or "it holds no lines"
        raise task.error(f"there is nothing to show ({detail})", "check how it was exported")
    sizes = size[np.unique(piece[kept])]
    values, left_out = _columns(raw.point_values, raw.line_values, line)
    if left_out:
        notices.append(f"Of its values, {', '.join(left_out[:5])} and the like are left out.")
    scalars = tuple((name, column[kept]) for name, column in values.items())
    return Lines(points[kept], np.concatenate([[0], np.cumsum(sizes)]), scalars), notices


def _placed(points: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return np.asarray((np.abs(points) < FARTHEST_MM).all(axis=1))


def _count_losses(
    notices: list[str], lengths: np.ndarray, line: np.ndarray, good: np.ndarray, kept: np.ndarray
) -> None:
    empty, single = int((lengths == 0).sum()), int((lengths == 1).sum())
    cut = int(np.unique(line[~good]).size)
    lost = len(lengths) - int(np.unique(line[kept]).size) - empty - single
    if empty:
        notices.append(f"{plural(empty, 'line')} without points left out.")
    if single:
        notices.append(f"{plural(single, 'line')} of one point left out.")
    if cut:
        text = f"{plural(cut, 'line')} with {plural(int((~good).sum()), 'point')} that are NaN or far away cut there"
        notices.append(text + (f", {lost} of them left out whole." if lost > 0 else "."))


def _columns(
    point_values: dict[str, np.ndarray], line_values: dict[str, np.ndarray], line: np.ndarray
) -> tuple[dict[str, np.ndarray], list[str]]:
    """Return single values a point by name, vectors as their length, and the names of what is left out."""
    columns: dict[str, np.ndarray] = {}
    left_out: list[str] = []
    for name, values, at in [(n, v, None) for n, v in point_values.items()] + [
        (n, v, line) for n, v in line_values.items()
    ]:
        column = single_values(values)
        if column is None or len(columns) == MAX_SCALARS or name in columns:
            left_out.append(name)
        else:
            columns[name] = column if at is None else column[at]
    return columns, left_out


def single_values(values: np.ndarray) -> np.ndarray | None:
    """Return values as float32, one each: of a vector its length; nothing if they are no numbers."""
    array = np.asarray(values)
    if array.dtype.kind not in "uifb" or array.ndim not in (1, 2):
        return None
    with np.errstate(over="ignore", invalid="ignore"):
        if array.ndim == 2:
            array = array[:, 0] if array.shape[1] == 1 else np.linalg.norm(array.astype(np.float64), axis=1)
        column = array.astype(np.float32)
    column[~np.isfinite(column)] = np.nan
    return column


def surface_of(raw: RawSurface, task: Task) -> tuple[Surface, list[str]]:
    """Return the triangles that can be shown, and notices that count the others.

    Raises
    ------
    LoadError
        If there is nothing to show.
    """
    notices = list(raw.notices)
    points = np.asarray(raw.points, dtype=np.float32)
    triangles = np.asarray(raw.triangles)
    good = _placed(points)
    placed = good[triangles].all(axis=1)
    if not placed.all():
        notices.append(
            f"{plural(int((~placed).sum()), 'triangle')} with points that are NaN or far away left out."
        )
    corners = points[triangles[placed]]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    if (area == 0).any():
        notices.append(f"{plural(int((area == 0).sum()), 'triangle')} without area left out.")
    kept = triangles[placed][area > 0]
    if not len(kept):
        raise task.error("it holds no triangle that can be shown", "check how it was exported")
    points = np.where(good[:, None], points, np.float32(0))
    values, _ = _columns(raw.point_values, {}, np.empty(0, int))
    return Surface(points, kept, _unit(raw.normals), tuple(values.items()), raw.colors), notices


def _unit(normals: np.ndarray | None) -> np.ndarray | None:
    """Return unit normals, or nothing if some are not usable: then all are made from the triangles."""
    if normals is None:
        return None
    length = np.linalg.norm(normals.astype(np.float64), axis=1, keepdims=True)
    if not np.isfinite(length).all() or (length < 1e-6).any():
        return None
    return np.asarray(normals / length, dtype=np.float32)
