"""The volume's values behind the curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from sfumato import TransferFunction, Volume

#: Share of the voxels, at either end, that the first view may leave out.
OUTSIDE = 1e-4
#: Bins that lie between two values of scaled whole numbers at most.
_GAP = 8
#: Nothing in a body lies below air; scanners fill the corners with less.
LOWEST_HU = -1050.0


@dataclass(frozen=True)
class Histogram:
    """Logarithmic heights (0 to 1) at values."""

    values: np.ndarray
    heights: np.ndarray


def log_histogram(volume: Volume) -> Histogram:
    """Return a volume's histogram; values that fall unevenly into the bins make no comb."""
    counts, edges = volume.histogram
    density, values = counts.astype(float), (edges[1:] + edges[:-1]) / 2
    if volume.data.dtype.kind in "ui":
        first = np.ceil(edges)
        first[-1] += 1  # the last bin holds its upper edge
        inside = np.diff(first)
        kept = inside > 0
        density, values = density[kept] / inside[kept], values[kept]
    else:
        # Scaled whole numbers: bins between two of them are empty, and say nothing.
        kept = (density > 0) | (maximum_filter1d(density, 2 * _GAP + 1) == 0)
        density, values = density[kept], values[kept]
    # Where two of them share a bin: a ripple.
    density = np.convolve(np.pad(density, 1, mode="edge"), (0.25, 0.5, 0.25), mode="valid")
    heights = np.log1p(density)
    return Histogram(values, heights / max(1e-9, float(heights.max())))


def whole_range(volume: Volume, transfer: TransferFunction | None) -> tuple[float, float]:
    """Return the values of the volume and of the function's points, with a margin."""
    low, high = volume.value_range
    points = [p.value for p in transfer.points] if transfer is not None else []
    return _with_margin(min([low, *points]), max([high, *points]))


def first_range(volume: Volume, transfer: TransferFunction | None, zero: float | None) -> tuple[float, float]:
    """Return the values worth seeing: nearly all voxels, and the points among them."""
    counts, edges = volume.histogram
    share = np.cumsum(counts) / max(1, int(counts.sum()))
    first = int(np.searchsorted(share, OUTSIDE))
    last = min(int(np.searchsorted(share, 1 - OUTSIDE)) + 1, len(edges) - 1)
    low, high = float(edges[first]), float(edges[last])
    inside = [p.value for p in transfer.points if edges[0] <= p.value <= edges[-1]] if transfer else []
    low, high = min([low, *inside]), max([high, *inside])
    if zero is not None and high > zero:
        low = max(low, zero + LOWEST_HU)
    return _with_margin(low, high)


def _with_margin(low: float, high: float) -> tuple[float, float]:
    margin = 0.02 * (high - low) or 0.5
    return low - margin, high + margin
