"""How a volume's values and gradient magnitudes go together: what two-dimensional functions are drawn over.

The gradient is the renderer's: central differences over two voxels, values beyond the edge being those at
it. Boundaries between two tissues are arcs from one value to the other, steepest half way (Kniss2002).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from .volume import Volume

#: Voxels that are looked at: of larger volumes every second, every third, … along each axis.
BUDGET = 4_000_000
#: The same for a first look.
GLANCE = 40_000
#: Bins over the values and over the usual gradient magnitudes, at most.
BINS = (256, 192)
#: Times the usual gradients that have bins of their own.
_BEYOND = 4
#: Bins of the first, fine count, of which several become one.
_FINE = 4096
#: Share of the voxels that may be steeper than what is worth seeing.
OUTSIDE = 1e-3


@dataclass(frozen=True, eq=False)
class JointHistogram:
    """Counts of voxels over value and gradient magnitude.

    Attributes
    ----------
    counts : ndarray, shape (gradients, values)
        Voxels in each bin.
    values : (float, float)
        From the first bin's lower to the last one's upper edge; the volume's unit.
    gradients : (float, float)
        The same of the gradient magnitude, value per mm; what is steeper counts in the last bin.
    steepest : float
        The largest gradient magnitude that was found.
    usual : float
        All but `OUTSIDE` of the voxels have smaller ones.
    """

    counts: np.ndarray
    values: tuple[float, float]
    gradients: tuple[float, float]
    steepest: float
    usual: float

    def bin_of(self, value: float, gradient: float) -> tuple[int, int]:
        """Return row and column of the bin of a value and a gradient magnitude, the nearest if it lies outside."""
        place = []
        for at, (low, high), n in (
            (gradient, self.gradients, self.counts.shape[0]),
            (value, self.values, self.counts.shape[1]),
        ):
            place.append(min(max(int((at - low) / (high - low) * n), 0), n - 1))
        return place[0], place[1]

    @property
    def heights(self) -> np.ndarray:
        """Logarithm of the counts, the largest being 1; shape as the counts."""
        logs = np.log1p(self.counts)
        return np.asarray(logs / max(float(logs.max()), 1e-9))


def steepest_possible(volume: Volume) -> float:
    """Return a gradient magnitude (value per mm) that no place of a volume exceeds."""
    low, high = volume.value_range
    return (high - low) / 2 * float(np.sqrt(sum(1 / s**2 for s in volume.spacing)))


def sampled(
    volume: Volume, budget: int = BUDGET, stop: Callable[[], bool] = lambda: False
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield values and gradient magnitudes (value per mm) at evenly chosen voxels, slice by slice; float32.

    Parameters
    ----------
    budget : int
        About how many voxels there may be in all.
    stop : callable
        Asked before each slice; where it says so, nothing more comes.
    """
    step = max(1, round((volume.data.size / budget) ** (1 / 3)))
    chosen = [np.arange(min(step // 2, n - 1), n, step) for n in volume.data.shape]
    before = [np.maximum(index - 1, 0) for index in chosen]
    after = [np.minimum(index + 1, n - 1) for index, n in zip(chosen, volume.data.shape, strict=True)]
    x_mm, y_mm, z_mm = (2 * s for s in volume.spacing)
    y, x = np.ix_(*chosen[1:])
    for z, z_before, z_after in zip(chosen[0], before[0], after[0], strict=True):
        if stop():
            return
        plane = volume.data[z]
        along_z = _difference(volume.data[z_after][y, x], volume.data[z_before][y, x])
        along_y = _difference(plane[np.ix_(after[1], chosen[2])], plane[np.ix_(before[1], chosen[2])])
        along_x = _difference(plane[np.ix_(chosen[1], after[2])], plane[np.ix_(chosen[1], before[2])])
        gradient = np.hypot(np.hypot(along_x / x_mm, along_y / y_mm), along_z / z_mm)
        yield plane[y, x].astype(np.float32).ravel(), gradient.ravel()


def _difference(after: np.ndarray, before: np.ndarray) -> np.ndarray:
    return np.asarray(after.astype(np.float32) - before)


def first_look(volume: Volume) -> JointHistogram:
    """Count so few of a volume's voxels that nobody waits for it; the same volume always has the same."""
    counted = _count(volume, lambda: False, GLANCE)
    assert counted is not None
    return counted


_kept: WeakKeyDictionary[Volume, JointHistogram] = WeakKeyDictionary()


def known_histogram(volume: Volume) -> JointHistogram | None:
    """Return a volume's joint histogram if it was counted before; volumes of one key share it."""
    return _kept.get(volume)


def joint_histogram(
    volume: Volume, stop: Callable[[], bool] = lambda: False, budget: int = BUDGET
) -> JointHistogram | None:
    """Count a volume's values and gradient magnitudes; None if it was stopped. Kept as long as the volume lives."""
    if volume not in _kept:
        counted = _count(volume, stop, budget)
        if counted is None:
            return None
        return _kept.setdefault(volume, counted)
    return _kept[volume]


def _count(volume: Volume, stop: Callable[[], bool], budget: int) -> JointHistogram | None:
    low, high = volume.value_range
    high = high if high > low else low + 1.0
    across, up = BINS
    if volume.data.dtype.kind in "ui":
        # Whole numbers of values to a bin: else every n-th bin would hold twice as much.
        per_bin = max(1, int(np.ceil((high - low + 1) / across)))
        across = int(np.ceil((high - low + 1) / per_bin))
        low, high = low - 0.5, low - 0.5 + per_bin * across
    bound = max(steepest_possible(volume), 1e-9)
    bins, steepest = [], 0.0
    for values, gradients in sampled(volume, budget, stop):
        columns = np.clip((values - low) * (across / (high - low)), 0, across - 1).astype(np.int32)
        rows = np.clip(gradients * (_FINE / bound), 0, _FINE - 1).astype(np.int32)
        bins.append(rows * across + columns)
        steepest = max(steepest, float(gradients.max(initial=0)))
    if stop():
        return None
    fine = np.bincount(np.concatenate(bins), minlength=_FINE * across).reshape(_FINE, across)
    return _gathered(fine, (low, high), bound, up, steepest)


def _gathered(
    fine: np.ndarray, values: tuple[float, float], bound: float, up: int, steepest: float
) -> JointHistogram:
    """Make fewer rows of many, so that what nearly all voxels stay below has enough of them."""
    share = np.cumsum(fine.sum(axis=1)) / max(1, int(fine.sum()))
    usual = int(np.searchsorted(share, 1 - OUTSIDE)) + 1
    last = int(np.flatnonzero(fine.any(axis=1))[-1]) + 1
    per_row = -(-usual // up)
    rows = -(-min(last, _BEYOND * usual) // per_row)
    used = rows * per_row
    counts = np.zeros((used, fine.shape[1]), dtype=np.int64)
    counts[: min(used, _FINE)] = fine[:used]
    counts[-1] += fine[used:].sum(axis=0)
    counts = counts.reshape(rows, per_row, -1).sum(axis=1)
    unit = bound / _FINE
    return JointHistogram(counts, values, (0.0, used * unit), steepest, usual * unit)


__all__ = [
    "JointHistogram",
    "first_look",
    "joint_histogram",
    "known_histogram",
    "sampled",
    "steepest_possible",
]
