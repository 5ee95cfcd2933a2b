"""A volume cut into blocks, each at five resolutions, and a few samples of each by which levels are chosen.

Depends on the volume alone, so it is made once; transfer functions choose from it (`levels`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: Edge of a block in voxels (Hernell2007, 4.1).
EDGE = 16
#: Resolutions of a block: level l has 2^l texels along an edge.
LEVELS = 5
FINEST = LEVELS - 1
#: Voxels of each block, one in every 4^3, by which its significance is judged; its extremes come on top.
SAMPLES = 64


@dataclass(frozen=True)
class Pyramid:
    """Blocks of a volume at all levels.

    Attributes
    ----------
    levels : tuple of ndarray
        Normalised voxels (uint8 or uint16) of level 0 (one texel a block) to `FINEST`; shape (z, y, x), padded to
        whole blocks.
    samples : ndarray, shape (LEVELS, blocks, SAMPLES + 2)
        What the same places of each block hold at each level; in (z, y, x) order of the blocks.
    """

    levels: tuple[np.ndarray, ...]
    samples: np.ndarray

    @property
    def grid(self) -> tuple[int, int, int]:
        """Blocks along z, y and x."""
        z, y, x = self.levels[0].shape
        return z, y, x

    @property
    def extremes(self) -> np.ndarray:
        """Smallest and largest value (0 to 1) of each block; shape (2, blocks)."""
        return np.asarray(self.samples[FINEST, :, SAMPLES:].T / np.iinfo(self.samples.dtype).max)

    @property
    def size(self) -> int:
        """Bytes on the CPU."""
        return sum(level.nbytes for level in self.levels) + self.samples.nbytes


def build_pyramid(voxels: np.ndarray) -> Pyramid:
    """Cut normalised voxels (uint8 or uint16, shape (z, y, x)) into blocks at all levels, by means of 2^3."""
    beyond = [(0, -n % EDGE) for n in voxels.shape]
    finest = np.pad(voxels, beyond, mode="edge") if any(after for _, after in beyond) else voxels
    levels = [finest]
    for _ in range(FINEST):
        levels.insert(0, _halved(levels[0]))
    return Pyramid(tuple(levels), _samples(levels))


def _halved(fine: np.ndarray) -> np.ndarray:
    z, y, x = fine.shape
    coarse = np.empty((z // 2, y // 2, x // 2), dtype=fine.dtype)
    for k, pair in enumerate(fine.reshape(z // 2, 2, y, x)):  # by pairs of planes: no wide copy of the whole
        sums = pair.sum(axis=0, dtype=np.uint32)
        sums = sums[0::2] + sums[1::2]
        coarse[k] = (sums[:, 0::2] + sums[:, 1::2] + 4) >> 3
    return coarse


def by_blocks(level: np.ndarray, edge: int) -> np.ndarray:
    """View a level as blocks of an edge: shape (bz, by, bx, edge, edge, edge)."""
    z, y, x = (n // edge for n in level.shape)
    return level.reshape(z, edge, y, edge, x, edge).transpose(0, 2, 4, 1, 3, 5)


def _samples(levels: list[np.ndarray]) -> np.ndarray:
    """Take the samples: the same pattern in every block, and the places of its smallest and largest value."""
    cell = EDGE // 4
    corner = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) * cell
    places = corner + np.random.default_rng(0).integers(0, cell, corner.shape)
    finest = by_blocks(levels[FINEST], EDGE)
    blocks = np.stack(np.meshgrid(*map(np.arange, finest.shape[:3]), indexing="ij"), axis=-1).reshape(
        -1, 1, 3
    )
    extremes = np.empty((len(blocks), 2, 3), dtype=np.int64)
    for k, row in enumerate(finest):  # row by row of blocks: the copies stay small
        flat = row.reshape(-1, EDGE**3)
        at = np.stack([flat.argmin(axis=1), flat.argmax(axis=1)], axis=1)
        extremes[k * len(flat) : (k + 1) * len(flat)] = np.stack(np.unravel_index(at, (EDGE,) * 3), axis=-1)
    within = np.concatenate([np.broadcast_to(places, (len(blocks), *places.shape)), extremes], axis=1)
    at = blocks * EDGE + within
    taken = [level[tuple(np.moveaxis(at >> (FINEST - k), -1, 0))] for k, level in enumerate(levels)]
    return np.stack(taken)
