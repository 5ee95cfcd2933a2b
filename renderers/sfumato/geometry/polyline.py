"""Polylines of many lengths in one array: chosen, smoothed, thinned out; all at once, with no loop over lines.

A `Strand` is what the sweep works on: points with the values that colour and thicken them.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..scene.geometry import Geometry, Roi
from ..scene.shapes import Lines

#: A round of thinning out that takes a smaller part of the points than this is the last.
FEW = 0.03


@dataclass(frozen=True)
class Strand:
    """Lines on their way to tubes.

    Parameters
    ----------
    points : ndarray, shape (n, 3), float32
        World mm.
    line : ndarray, shape (n,), int64
        Which line a point belongs to: growing along the array.
    values : ndarray, shape (n, c), float32
        Values that travel with the points (scalars for colour and radius).
    """

    points: np.ndarray
    line: np.ndarray
    values: np.ndarray

    @property
    def joined(self) -> np.ndarray:
        """Whether point i and i + 1 belong together, shape (n - 1,)."""
        return np.asarray(self.line[1:] == self.line[:-1])

    def taken(self, mask: np.ndarray) -> Strand:
        """Return the strand with some of its points."""
        return Strand(self.points[mask], self.line[mask], self.values[mask])


def line_numbers(lines: Lines) -> np.ndarray:
    """Return the number of the line to which each point belongs, shape (n,)."""
    return np.repeat(np.arange(lines.count), np.diff(lines.offsets))


# -- which lines -----------------------------------------------------------------------------------
def kept_lines(geometry: Geometry) -> np.ndarray:
    """Return which lines the filters leave, shape (k,), bool: by length, by region, at random."""
    lines = geometry.shape
    assert isinstance(lines, Lines)
    kept = np.ones(lines.count, dtype=bool)
    if geometry.min_length > 0:
        kept &= lines.lengths >= geometry.min_length
    if geometry.max_length > 0:
        kept &= lines.lengths <= geometry.max_length
    for roi in geometry.rois:
        kept &= _passes(lines, roi)
    if geometry.fraction < 1:
        # Every line has its own random number: a larger part holds all lines of a smaller one.
        kept &= np.random.default_rng(geometry.seed).random(lines.count) < geometry.fraction
    return kept


def _passes(lines: Lines, roi: Roi) -> np.ndarray:
    """Tell which lines a region lets through; between its points a line is straight, and passes there too."""
    if roi.keep == "ends":
        inside = _touches(lines.points, lines.points, roi)
        return np.asarray(inside[lines.offsets[:-1]] | inside[lines.offsets[1:] - 1])
    # Only lines whose boxes meet the region's: most are elsewhere.
    half = np.asarray(roi.size if roi.kind == "box" else (roi.size[0],) * 3)
    low, high = lines.boxes
    center = np.asarray(roi.center)
    near = np.asarray(((low <= center + half) & (high >= center - half)).all(axis=1))
    touched = np.zeros(lines.count, dtype=bool)
    if near.any():
        touched[near] = _passing(lines, near, roi)
    return touched if roi.keep == "inside" else ~touched


def _passing(lines: Lines, chosen: np.ndarray, roi: Roi) -> np.ndarray:
    """Tell which of the chosen lines pass through a region."""
    lengths = np.diff(lines.offsets)[chosen]
    points = lines.points[np.repeat(chosen, np.diff(lines.offsets))]
    first = np.cumsum(lengths) - lengths
    # Each point with the next one; a line's last point with itself.
    after = np.arange(1, len(points) + 1)
    after[first + lengths - 1] -= 1
    return np.asarray(np.logical_or.reduceat(_touches(points, points[after], roi), first))


def _touches(start: np.ndarray, end: np.ndarray, roi: Roi) -> np.ndarray:
    """Tell which straight pieces, from start to end (n, 3), come into a region."""
    center, size = (np.asarray(v, np.float32) for v in (roi.center, roi.size))
    along, away = end - start, start - center
    if roi.kind == "sphere":
        length2 = np.maximum(np.einsum("ij,ij->i", along, along), np.float32(1e-30))
        nearest = np.clip(-np.einsum("ij,ij->i", along, away) / length2, 0, 1)
        away = away + nearest[:, None] * along
        return np.asarray(np.einsum("ij,ij->i", away, away) <= size[0] ** 2)
    # Slabs: the piece is in the box from the last entry into one to the first exit of one.
    first, last = np.zeros(len(start), np.float32), np.ones(len(start), np.float32)
    for axis in range(3):
        step = along[:, axis]
        flat = step == 0
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            ends = np.sort(np.stack([(s * size[axis] - away[:, axis]) / step for s in (-1, 1)]), axis=0)
        out = flat & (np.abs(away[:, axis]) > size[axis])
        first = np.maximum(first, np.where(flat, np.where(out, np.inf, -np.inf), ends[0]))
        last = np.minimum(last, np.where(flat, np.inf, ends[1]))
    return np.asarray(first <= last)


# -- how they run ----------------------------------------------------------------------------------
def without_repeats(strand: Strand) -> Strand:
    """Leave out points that repeat the one before, and lines of which only one point is left."""
    same = strand.joined & (strand.points[1:] == strand.points[:-1]).all(axis=1)
    strand = strand.taken(np.concatenate([[True], ~same]))
    linked = strand.joined
    return strand.taken(np.concatenate([[False], linked]) | np.concatenate([linked, [False]]))


def smoothed(strand: Strand, samples: int) -> Strand:
    """Run the lines along the uniform cubic B-spline whose control points they are.

    Parameters
    ----------
    samples : int
        Points on each segment; the ends stay where they are (their control points count three times).
    """
    if samples < 1 or len(strand.points) < 2:
        return strand
    joined = strand.joined
    before = np.concatenate([[0], np.where(joined, np.arange(len(joined)), np.arange(1, len(joined) + 1))])
    after = np.concatenate(
        [np.where(joined, np.arange(1, len(joined) + 1), np.arange(len(joined))), [len(joined)]]
    )
    first = np.flatnonzero(joined)
    second = first + 1
    corners = [before[first], first, second, after[second]]
    ends = np.flatnonzero(~np.concatenate([joined, [False]]))
    tables = np.concatenate([strand.points, strand.values], axis=1)
    # A line's end is no control point of a segment that begins there: it is appended as it is.
    pieces = np.empty((len(first), samples, tables.shape[1]), np.float32)
    for k in range(samples):
        weights = _spline_weights(k / samples)
        pieces[:, k] = sum(np.float32(w) * tables[c] for w, c in zip(weights, corners, strict=True))
    starts = np.flatnonzero(before[first] == first)
    pieces[starts, 0] = tables[first[starts]]
    made = np.concatenate([pieces.reshape(-1, tables.shape[1]), tables[ends]])
    order = np.argsort(
        np.concatenate(
            [np.repeat(first * samples, samples) + np.tile(np.arange(samples), len(first)), ends * samples]
        ),
        kind="stable",
    )
    line = np.concatenate([np.repeat(strand.line[first], samples), strand.line[ends]])
    return without_repeats(Strand(made[order, :3], line[order], made[order, 3:]))


def _spline_weights(t: float) -> tuple[float, float, float, float]:
    return (1 - t) ** 3 / 6, (3 * t**3 - 6 * t**2 + 4) / 6, (-3 * t**3 + 3 * t**2 + 3 * t + 1) / 6, t**3 / 6


def thinned_out(strand: Strand, tolerance: float, rounds: int = 4, bend: float = 0.01) -> Strand:
    """Leave out points that lie nearer than a tolerance to the chord of their neighbours.

    Every second point at most goes in a round, so that neighbours are never left out together; each round
    may move the line by half of the tolerance, the later ones rarely where an earlier one did. Values that
    bend too much keep their point too.

    Parameters
    ----------
    tolerance : float
        In mm.
    bend : float
        Of values, as a part of their largest.
    """
    slack = bend * np.nanmax(np.abs(strand.values), axis=0, initial=0.0)
    for _ in range(rounds):
        count = len(strand.points)
        inner = np.concatenate([[False], strand.joined[1:] & strand.joined[:-1], [False]])
        number = np.arange(count) - np.maximum.accumulate(np.where(_begins(strand), np.arange(count), 0))
        odd = np.flatnonzero(inner & (number % 2 == 1))
        if not len(odd):
            return strand
        dropped = odd[_straight(strand, odd, tolerance / 2, slack)]
        mask = np.ones(count, dtype=bool)
        mask[dropped] = False
        strand = strand.taken(mask)
        if len(dropped) < FEW * count:
            return strand
    return strand


def _begins(strand: Strand) -> np.ndarray:
    return np.concatenate([[True], ~strand.joined])


def _straight(strand: Strand, index: np.ndarray, tolerance: float, slack: np.ndarray) -> np.ndarray:
    """Tell which points are between their neighbours, and near the chord: by columns, which is quicker."""
    before = strand.points[index - 1]
    chord, here = strand.points[index + 1] - before, strand.points[index] - before
    length2 = np.maximum(np.einsum("ij,ij->i", chord, chord), 1e-30)
    dot = np.einsum("ij,ij->i", here, chord)
    along = dot / length2
    away2 = np.einsum("ij,ij->i", here, here) - along * dot
    straight = (away2 <= tolerance**2) & (along > 0) & (along < 1)
    if strand.values.shape[1]:
        left, value, right = (strand.values[index + k] for k in (-1, 0, 1))
        mixed = left + along[:, None] * (right - left)
        straight &= (np.abs(value - mixed) <= slack).all(axis=1)
    return np.asarray(straight)


def strand_of(geometry: Geometry, names: tuple[str, ...]) -> Strand:
    """Return the lines that the filters leave, with the scalars that are needed."""
    lines = geometry.shape
    assert isinstance(lines, Lines)
    columns = [geometry.scalar_values(name) for name in names]
    values = np.stack(columns, axis=1) if columns else np.empty((len(lines.points), 0), np.float32)
    whole = Strand(lines.points, line_numbers(lines), values)
    return whole.taken(kept_lines(geometry)[whole.line])


def split(strand: Strand, size: int) -> list[Strand]:
    """Return the strand in parts of whole lines, of about so many points each."""
    if not len(strand.points):
        return []
    begins = np.flatnonzero(_begins(strand))
    wanted = np.arange(0, len(strand.points), size)
    cuts = np.unique(
        np.append(begins[np.searchsorted(begins, wanted[wanted <= begins[-1]])], len(strand.points))
    )
    cuts = np.unique(np.insert(cuts, 0, 0))
    return [strand.taken(slice(a, b)) for a, b in pairwise(cuts)]  # type: ignore[arg-type]
