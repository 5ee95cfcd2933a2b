"""Peaks of a histogram: the values of the tissues, to which points of a transfer function snap."""

from __future__ import annotations

import functools

import numpy as np

from .volume import Volume

#: Width in bins by which counts are smoothed, and how far a peak rises above what is around, in the counts' logarithm.
SMOOTH, RISE = 2.0, 0.25
#: Most peaks.
MOST = 12


def peaks_of(volume: Volume) -> tuple[float, ...]:
    """Return the values at the peaks of a volume's logarithmic histogram, in ascending order.

    Of very many, those that rise most; none where all values are alike.
    """
    return _peaks(volume.key, volume)


@functools.lru_cache(maxsize=8)
def _peaks(key: str, volume: Volume) -> tuple[float, ...]:
    from scipy.ndimage import gaussian_filter1d
    from scipy.signal import find_peaks

    counts, edges = volume.histogram
    # Values of few bits leave most bins empty: what counts is the curve over the others.
    filled = np.flatnonzero(counts)
    height = np.interp(np.arange(len(counts)), filled, np.log10(1.0 + counts[filled]))
    height = gaussian_filter1d(height, SMOOTH, mode="constant")
    # A bin on either side, so that the first and last can be peaks.
    at, found = find_peaks(np.pad(height, 1), prominence=RISE)
    best = np.sort(at[np.argsort(found["prominences"])[::-1][:MOST]]) - 1
    return tuple(float(value) for value in (edges[:-1] + edges[1:])[best] / 2)


__all__ = ["peaks_of"]
