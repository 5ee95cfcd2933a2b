"""Which level each block gets: as fine as its significance under the transfer function asks for (Hernell2007, 4.1).

The error of a level is measured where it is seen, in colour: the distance in CIELAB between what a voxel looks
like and what its stand-in at that level does, before black and before white, so that opacity counts as well.
Levels are then chosen so that the sum of squared errors is least for a given number of texels.
"""

from __future__ import annotations

import numpy as np

from ...colorimetry import cielab
from ...scene import TransferFunction
from .pyramid import FINEST, LEVELS, Pyramid

#: Entries over the value range of the tables that classify samples.
ENTRIES = 4096
#: Blocks judged at a time.
CHUNK = 2048
#: Texels of a block at each level.
TEXELS = 8 ** np.arange(LEVELS)


def looks(transfer: TransferFunction, domain: tuple[float, float]) -> np.ndarray:
    """Return what values look like: CIELAB before black and before white; float32, shape (ENTRIES, 6).

    Of a two-dimensional function, each value's most opaque gradient counts.
    """
    values = np.linspace(*domain, ENTRIES)
    sampled = transfer.most_opaque(values)
    alpha = sampled[:, 3:4]
    light = alpha * (sampled[:, :3] + sampled[:, 4:])
    shown = [cielab(np.minimum(light + (1 - alpha) * back, 1)) for back in (0, 1)]
    return np.concatenate(shown, axis=1).astype(np.float32)


def errors(pyramid: Pyramid, wanted: np.ndarray, look: np.ndarray) -> np.ndarray:
    """Return the mean squared colour error of wanted blocks (indices) at each level; shape (n, LEVELS)."""
    result = np.zeros((len(wanted), LEVELS))
    scale = (ENTRIES - 1) / np.iinfo(pyramid.samples.dtype).max
    for start in range(0, len(wanted), CHUNK):
        part = wanted[start : start + CHUNK]
        entries = np.rint(pyramid.samples[:, part] * np.float32(scale)).astype(np.int32)
        exact = look[entries[FINEST]]
        for level in range(FINEST):
            away = look[entries[level]] - exact
            result[start : start + CHUNK, level] = np.einsum("bsc,bsc->b", away, away) / (2 * away.shape[1])
    return result


def choose(error: np.ndarray, texels: float, coarsest: int) -> np.ndarray:
    """Return the level of each block: least error with at most so many texels, none below `coarsest`.

    Parameters
    ----------
    error : ndarray, shape (n, LEVELS)
        Squared error at each level.
    texels : float
        Texels that there may be; where the coarsest levels have more, it is they.
    coarsest : int
        Level, 0 to `FINEST`.
    """
    cost = np.where(np.arange(LEVELS) < coarsest, np.inf, error)

    def at(price: float) -> np.ndarray:
        return np.asarray((cost + price * TEXELS).argmin(axis=1))

    low, high = 1e-12, 1e6  # of a texel, in squared colour distance
    best = at(low)
    if TEXELS[best].sum() <= texels:
        return best
    for _ in range(48):
        middle = float(np.sqrt(low * high))
        levels = at(middle)
        low, high = (low, middle) if TEXELS[levels].sum() <= texels else (middle, high)
    return at(high)
