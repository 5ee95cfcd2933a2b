"""What a volume's values tell: Hounsfield units or not, and where the subject parts from the background."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from ..volume import Volume

#: Samples along each axis are enough to judge values by.
SAMPLES = 128
#: What is thinner than this share of its other extents is a slab.
THIN = 0.35
_BINS = 512


_Result = TypeVar("_Result")


def remembered(function: Callable[[Volume], _Result]) -> Callable[[Volume], _Result]:
    """Let a function keep its answer for each volume as long as the volume lives."""
    answers: WeakKeyDictionary[Volume, _Result] = WeakKeyDictionary()

    def ask(volume: Volume) -> _Result:
        if volume not in answers:
            answers[volume] = function(volume)
        return answers[volume]

    ask.__doc__ = function.__doc__
    ask.__name__ = function.__name__
    return ask


def thinned(volume: Volume, samples: int = SAMPLES) -> np.ndarray:
    """Return every n-th voxel along each axis, so that at most about `samples` remain on it; a view."""
    steps = tuple(max(1, n // samples) for n in volume.data.shape)
    return volume.data[:: steps[0], :: steps[1], :: steps[2]]


def is_slab(volume: Volume) -> bool:
    """Tell whether a volume is a few slices: much thinner along one axis than along the others."""
    thin, other, _ = sorted(n * s for n, s in zip(volume.dims, volume.spacing, strict=True))
    return thin < THIN * other


@remembered
def hounsfield_zero(volume: Volume) -> float | None:
    """Return the stored value that means 0 HU, or None if the values are no Hounsfield units.

    A modality of CT settles it; without one, air near -1000 beside soft tissue near 0 does, or the same
    1000 or 1024 higher, as unsigned files store it.
    """
    modality, (low, high) = volume.info.modality.upper(), volume.value_range
    if volume.data.dtype.itemsize == 1 or modality not in ("", "CT"):
        return None
    values = thinned(volume)
    offset = _stored_offset(values) if low > -500 else 0.0
    if offset == 0.0 and modality != "CT" and not (high > 200 and _has_air_and_tissue(values, 0.0)):
        return None
    return offset if offset is not None else (0.0 if modality == "CT" else None)


def _stored_offset(values: np.ndarray) -> float | None:
    """Return the offset of Hounsfield units that were stored without their intercept."""
    if not 1200 <= float(values.max()) <= 5000 or not _has_air_and_tissue(values, 1024.0):
        return None
    near = values[(values > 950) & (values < 1200)]
    counts, edges = np.histogram(near, bins=50, range=(950, 1200))
    # Soft tissue lies at 30 to 60 HU: its peak tells 1000 from 1024.
    return 1024.0 if edges[int(counts.argmax())] > 1045 else 1000.0


def _has_air_and_tissue(values: np.ndarray, zero: float) -> bool:
    """Tell whether there is a share of air and of soft tissue, and less between them than in the smaller."""
    air = float(((values > zero - 1150) & (values < zero - 800)).mean())
    tissue = float(((values > zero - 180) & (values < zero + 220)).mean())
    between = float(((values > zero - 650) & (values < zero - 350)).mean())
    return air > 0.01 and tissue > 0.02 and between < min(air, tissue)


@dataclass(frozen=True)
class Levels:
    """Values that part a volume: background, surface, inner parts.

    Attributes
    ----------
    background : float
        Value of what surrounds the subject.
    surface : float
        Half way from the background to the subject.
    inner : float
        Half way from the subject's darker parts to its brighter ones.
    top : float
        What all but the brightest thousandth of the subject stays below.
    """

    background: float
    surface: float
    inner: float
    top: float


def levels(volume: Volume) -> Levels:
    """Return the levels of a volume whose values mean nothing by themselves.

    The surface lies at Otsu's threshold; where that would fill more than half of the volume's faces,
    as when tissue surrounds bright vessels, at the threshold of what lies above it, and so on.
    """
    values = thinned(volume).astype(np.float32)
    low = float(values.min())
    top = max(float(np.percentile(values, 99.95)), low + 1e-6 * max(1.0, abs(low)))
    border = np.concatenate(
        [values[:, :, [0, -1]].ravel(), values[:, [0, -1]].ravel(), values[[0, -1]].ravel()]
    )
    background, chosen = low, values
    surface = otsu(chosen, top)
    for _ in range(2):
        if not (border > surface).mean() > 0.6:
            break
        background = float(np.median(border))
        chosen = values[values > surface]
        surface = otsu(chosen, top)
    if background == low:
        below = values[values <= surface]
        background = float(np.median(below)) if below.size else low
    subject = values[values > surface]
    inner = otsu(subject, top) if subject.size else (surface + top) / 2
    return Levels(background, surface, inner, top)


def otsu(values: np.ndarray, top: float) -> float:
    """Return the threshold between two classes of values with the least variance within them (Otsu1979)."""
    counts, edges = np.histogram(np.minimum(values, top), bins=_BINS)
    centers = (edges[1:] + edges[:-1]) / 2
    below, total = np.cumsum(counts), counts.sum()
    mass = np.cumsum(counts * centers)
    above = total - below
    with np.errstate(divide="ignore", invalid="ignore"):
        spread = below * above * (mass / below - (mass[-1] - mass) / above) ** 2
    spread = np.nan_to_num(spread[:-1])
    # Between two clusters the measure is flat: the middle of the plateau is the fairest.
    best = np.flatnonzero(spread >= spread.max() * (1 - 1e-9))
    return float((edges[best[0] + 1] + edges[best[-1] + 1]) / 2)
