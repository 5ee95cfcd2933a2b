"""Where each block lies in the packed texture, and which block lies where in it (Hernell2007, 4.1).

The packed texture is made of bricks of 16^3 texels. A brick holds blocks of one level, as many as fit: 1, 8, 64,
512 or 4096. An index says for each block of the volume where its texels are; the reverse index for each brick which
level it has and where its blocks begin in a list. So the reverse index needs an entry a block and not one for every
4^3 texels as the paper's, and no level is too small for it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import minimum_filter

from .levels import TEXELS
from .pyramid import EDGE, FINEST, LEVELS, Pyramid, by_blocks

#: Level of blocks that are empty, and of bricks that hold nothing.
NONE = 255
#: Of blocks that are empty, but of which a texel (level 0) is kept, since there is no other form of the volume.
HIDDEN = 64


@dataclass(frozen=True)
class Packing:
    """Places of blocks.

    Attributes
    ----------
    index : ndarray, uint16, shape (bz, by, bx, 4)
        Of each block its first texel (x, y, z) in the packed texture; in the low byte of the fourth its level
        (`NONE` or `HIDDEN` if it is empty), in the high byte the lowest level of it and its neighbours.
    bricks : ndarray, uint32, shape (nz, ny, nx, 2)
        Of each brick its level, and where its blocks begin in `blocks`.
    blocks : ndarray, uint16, shape (n, 4)
        Place (x, y, z) of each block in the volume's grid of blocks; the fourth is 0 where there is no block.
    """

    index: np.ndarray
    bricks: np.ndarray
    blocks: np.ndarray

    @property
    def grid(self) -> tuple[int, int, int]:
        """Blocks of the volume along x, y and z."""
        z, y, x = self.index.shape[:3]
        return x, y, z

    @property
    def size(self) -> tuple[int, int, int]:
        """Texels of the packed texture along x, y and z."""
        z, y, x = self.bricks.shape[:3]
        return x * EDGE, y * EDGE, z * EDGE

    @property
    def levels(self) -> np.ndarray:
        """Levels of the blocks, `NONE` or `HIDDEN` where empty; shape (bz, by, bx)."""
        return self.index[..., 3] & 255

    @property
    def texels(self) -> int:
        """Texels that hold something."""
        held = np.where(self.levels == HIDDEN, 0, self.levels)
        return int(sum((held == level).sum() * TEXELS[level] for level in range(LEVELS)))

    @property
    def reduction(self) -> float:
        """Voxels of the whole volume, in whole blocks, to a texel."""
        return float(self.levels.size * EDGE**3 / max(self.texels, 1))


def pack(levels: np.ndarray, longest: int = 2048) -> Packing:
    """Lay out blocks of given levels (bz, by, bx; `NONE` or `HIDDEN` where empty), `longest` texels a side at most."""
    held = np.where(levels == HIDDEN, 0, levels)
    counts = [int((held == level).sum()) for level in range(LEVELS)]
    number = [-(-count // 8 ** (FINEST - level)) for level, count in enumerate(counts)]
    shape = _cube(sum(number), longest // EDGE)
    bricks = np.zeros((int(np.prod(shape)), 2), dtype=np.uint32)
    bricks[:, 0] = NONE
    index = np.zeros((*levels.shape, 4), dtype=np.uint16)
    index[..., 3] = levels | minimum_filter(levels, 3, mode="nearest").astype(np.uint16) << 8
    lists, brick, first = [], 0, 0
    for level in reversed(range(LEVELS)):
        per_brick, edge = 8 ** (FINEST - level), 1 << (FINEST - level)
        at = np.argwhere(held == level)
        order = np.arange(len(at))
        entries = np.zeros((number[level] * per_brick, 4), dtype=np.uint16)
        entries[: len(at), :3] = at[:, ::-1]
        entries[: len(at), 3] = 1
        own = brick + order // per_brick
        corner = np.stack(np.unravel_index(own, shape)[::-1], axis=-1) * EDGE
        sub = np.stack(np.unravel_index(order % per_brick, (edge,) * 3)[::-1], axis=-1) << level
        index[(*at.T, slice(3))] = corner + sub
        bricks[brick : brick + number[level], 0] = level
        bricks[brick : brick + number[level], 1] = first + np.arange(number[level]) * per_brick
        lists.append(entries)
        brick, first = brick + number[level], first + len(entries)
    return Packing(index, bricks.reshape(*shape, 2), np.concatenate(lists))


def _cube(number: int, longest: int) -> tuple[int, int, int]:
    """Return the sides (z, y, x) of a box of at least so many bricks, nearly a cube."""
    x = min(longest, max(1, int(np.ceil(number ** (1 / 3) - 1e-9))))
    y = min(longest, max(1, int(np.ceil(np.sqrt(number / x) - 1e-9))))
    return max(1, -(-number // (x * y))), y, x


def packed_voxels(pyramid: Pyramid, packing: Packing) -> np.ndarray:
    """Return the packed texture's texels; shape (z, y, x)."""
    nz, ny, nx = packing.bricks.shape[:3]
    bricks = np.zeros((nz * ny * nx, EDGE, EDGE, EDGE), dtype=pyramid.levels[0].dtype)
    held = packing.bricks.reshape(-1, 2)
    for level in range(LEVELS):
        own = np.flatnonzero(held[:, 0] == level)
        if len(own) == 0:
            continue
        edge, res = 1 << (FINEST - level), 1 << level
        first = int(held[own[0], 1])
        entries = packing.blocks[first : first + len(own) * edge**3]
        x, y, z = entries[:, :3].T.astype(np.intp)
        texels = by_blocks(pyramid.levels[level], res)[z, y, x]
        texels = texels.reshape(-1, edge, edge, edge, res, res, res).transpose(0, 1, 4, 2, 5, 3, 6)
        bricks[own] = texels.reshape(-1, EDGE, EDGE, EDGE)
    whole = bricks.reshape(nz, ny, nx, EDGE, EDGE, EDGE).transpose(0, 3, 1, 4, 2, 5)
    return np.ascontiguousarray(whole).reshape(nz * EDGE, ny * EDGE, nx * EDGE)
