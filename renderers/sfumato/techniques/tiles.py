"""Which squares of a lattice a sweep has to touch at which slab.

Most of an occlusion buffer is empty air, in which nothing need be done. A tile of columns is *full* at a
slab if something visible may stand in it there; it is *dirty* once a full tile lay before it on the light's
way, and *needed* as long as one lies after it. Dirty and needed tiles that are not full are only filtered;
all others are left clear. Tiles are columns of the sheared lattice, so that light stays in its tile but for
the footprint's blur, by which dirty and needed tiles are dilated.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter

from .stack import SHEAR_UNIT, Lattice


@dataclass(frozen=True)
class Tiling:
    """How finely space is taken apart: edge of a tile in texels, and slabs that share a list of tiles."""

    edge: int
    group: int


#: For the slices of the view, whose passes are cheap, and for light volumes, whose texels are dear.
COARSE, FINE = Tiling(16, 8), Tiling(8, 4)
#: Standard deviations of blur that count.
TAIL = 3.0
#: Slabs behind geometry, as light goes, in which what it covers counts.
COVERED_BEHIND = 2
#: Centres of blocks in which something stands along a view's axes in mm, shape (n, 3), and half their extents.
Blocks = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class TileLists:
    """Lists of tiles, one of each kind for each group of slabs.

    Attributes
    ----------
    tiles : ndarray of int16, shape (n, 3)
        Runs of tiles: indices x, y of the first and their number along x; list after list.
    kinds : tuple of ndarray of int, shape (groups, 2)
        First run and number of runs of full tiles, of hollow ones, and of those in which geometry stands, if they
        are told apart.
    low : (int, int)
        Column at the corner of tile (0, 0).
    tiling : Tiling
        What a tile and a group are.
    """

    tiles: np.ndarray
    kinds: tuple[np.ndarray, ...]
    low: tuple[int, int]
    tiling: Tiling

    def of_slab(self, slab: int) -> list[tuple[int, int]]:
        """Return (first, count) of the runs of each kind at a slab."""
        return [
            (int(first), int(count))
            for first, count in (kind[slab // self.tiling.group] for kind in self.kinds)
        ]


def list_tiles(lattice: Lattice, blocks: Sequence[Blocks], variance: float, ahead: int) -> TileLists:
    """Sort the tiles of a lattice.

    Parameters
    ----------
    blocks : sequence of (centers, half_sizes)
        Sets of blocks in which something stands: their centres, shape (n, 3): lateral x, y and depth in mm,
        and half the extent of a block along the same axes, shape (3,).
    variance : float
        Blur of one slab, in texels squared, in its widest direction.
    ahead : int
        Slabs, towards the light, from which the ray caster reads besides a sample's own.
    """
    full, low = _full_of_all(lattice, blocks, ahead, COARSE)
    spread = math.ceil(TAIL * math.sqrt(lattice.stack.count * variance) / COARSE.edge)
    near = maximum_filter(full, size=(1, 2 * spread + 1, 2 * spread + 1))
    along = near[::-1] if lattice.rear else near
    dirty = np.maximum.accumulate(along, axis=0)
    needed = np.maximum.accumulate(along[::-1], axis=0)[::-1]
    active = dirty & needed
    if lattice.rear:
        active = active[::-1]
    return _lists((full, active & ~full), low, COARSE)


def list_cone_tiles(
    lattice: Lattice, blocks: Sequence[Blocks], geometry: Sequence[Blocks], slope: float, ahead: int
) -> TileLists:
    """Sort the tiles of a lattice through which light spreads as a cone: by `slope` texels a slab to each side.

    ``blocks`` of the volume and of the ``geometry`` are sets of centres and half sizes, as in `list_tiles`.
    """
    full, low = _full_of_all(lattice, [*blocks, *geometry], ahead, FINE)
    near = maximum_filter(full, size=(1, 3, 3))
    active = _widening(near, slope, FINE) & _widening(near[::-1], slope, FINE)[::-1]
    # What geometry covers counts in the two slabs behind it as well.
    covered = np.zeros_like(full)
    if geometry:
        covered = _full_of_all(lattice, geometry, COVERED_BEHIND, FINE)[0]
    return _lists((full & ~covered, active & ~full & ~covered, covered), low, FINE)


def _full_of_all(
    lattice: Lattice, blocks: Sequence[Blocks], ahead: int, tiling: Tiling
) -> tuple[np.ndarray, tuple[int, int]]:
    """Return `_full_tiles` of several sets of blocks."""
    groups = lattice.stack.count // tiling.group + 1
    sets = blocks or [(np.empty((0, 3)), np.zeros(3))]
    found = [_full_tiles(lattice, centers, half, groups, ahead, tiling) for centers, half in sets]
    return np.logical_or.reduce([full for full, _ in found]), found[0][1]


def _widening(tiles: np.ndarray, slope: float, tiling: Tiling) -> np.ndarray:
    """Return the tiles that lie behind any of these, in a cone that widens by `slope` texels a slab."""
    behind, reached = tiles.copy(), 0.0
    for group in range(1, len(tiles)):
        reached += slope * tiling.group
        step = int(reached // tiling.edge)
        reached -= step * tiling.edge
        before = maximum_filter(behind[group - 1], size=2 * step + 1) if step else behind[group - 1]
        behind[group] |= before
    return behind


def _lists(kinds: Sequence[np.ndarray], low: tuple[int, int], tiling: Tiling) -> TileLists:
    """Write down the runs of tiles of each kind, shape (groups, y, x) each."""
    groups = len(kinds[0])
    rows, spans, offset = [], [], 0
    for kind in kinds:
        runs, groups_of_runs = _runs(kind)
        counts = np.bincount(groups_of_runs, minlength=groups)
        spans.append(np.stack([offset + np.cumsum(counts) - counts, counts], axis=1))
        rows.append(runs)
        offset += len(runs)
    return TileLists(np.concatenate(rows).astype(np.int16), tuple(spans), low, tiling)


def _runs(kind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Join tiles that lie side by side; returns (x, y, length) of each run, shape (n, 3), and its group."""
    edges = np.diff(kind.astype(np.int8), axis=2, prepend=0, append=0)
    starts, ends = np.argwhere(edges == 1), np.argwhere(edges == -1)
    return np.stack([starts[:, 2], starts[:, 1], ends[:, 2] - starts[:, 2]], axis=1), starts[:, 0]


def _full_tiles(
    lattice: Lattice, centers: np.ndarray, half: np.ndarray, groups: int, ahead: int, tiling: Tiling
) -> tuple[np.ndarray, tuple[int, int]]:
    """Return which tiles can hold something visible in each group of slabs, and the first tile's column."""
    stack, tile, slabs = lattice.stack, tiling.edge, tiling.group
    shear = np.asarray(lattice.shear) / SHEAR_UNIT
    # All columns that lie on some plane of the stack.
    ends = np.array([lattice.base(0), lattice.base(stack.count + 1)])
    low = ends.min(axis=0) - 1
    shape = (ends.max(axis=0) + np.asarray(lattice.size) + 1 - low) // tile + 1
    full = np.zeros((groups, int(shape[1]), int(shape[0])), dtype=bool)
    if not len(centers):
        return full, (int(low[0]), int(low[1]))
    # One slab more on either side: a tile's values are first looked at before anything in it can be seen.
    before, behind = (1, 1 + ahead) if lattice.rear else (1 + ahead, 1)
    first = np.clip(
        np.floor((centers[:, 2] - half[2] - stack.z0) / stack.step).astype(int) - before, 0, stack.count - 1
    )
    last = np.clip(
        np.floor((centers[:, 2] + half[2] - stack.z0) / stack.step).astype(int) + behind, 0, stack.count - 1
    )
    across = (centers[:, :2] - lattice.origin) / lattice.texel - low
    reach = half[:2] / lattice.texel + 2
    for step in range(int((last // slabs - first // slabs).max()) + 1):
        group = first // slabs + step
        use = group <= last // slabs
        g, at = group[use], across[use]
        begin = np.maximum(g * slabs, first[use])[:, None] * shear
        end = (np.minimum(g * slabs + slabs - 1, last[use]) + 1)[:, None] * shear
        a = np.floor((at - reach + np.minimum(begin, end)) / tile).astype(int)
        b = np.floor((at + reach + np.maximum(begin, end)) / tile).astype(int)
        _mark(full, g, a, b)
    return full, (int(low[0]), int(low[1]))


def _mark(full: np.ndarray, group: np.ndarray, low: np.ndarray, high: np.ndarray) -> None:
    """Set the tiles low..high (inclusive) of each block's group."""
    top = np.array(full.shape[:0:-1]) - 1
    low, high = np.clip(low, 0, top), np.clip(high, 0, top)
    span = high - low
    for dy in range(int(span[:, 1].max(initial=0)) + 1):
        for dx in range(int(span[:, 0].max(initial=0)) + 1):
            use = (span[:, 0] >= dx) & (span[:, 1] >= dy)
            full[group[use], low[use, 1] + dy, low[use, 0] + dx] = True
