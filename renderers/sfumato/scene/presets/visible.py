"""Where a transfer function shows something: a coarse grid of opacity and its pieces."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from ..transfer import TransferFunction
from ..volume import Volume

#: Cells along the longest axis of the coarse grid.
CELLS = 64
#: Opacity at unit distance from which a voxel counts as seen.
SEEN = 0.1
#: Pieces with less than this share of the largest one are specks.
SPECK = 0.03


def seen_cells(volume: Volume, transfer: TransferFunction) -> np.ndarray:
    """Return which cells of a coarse grid, shape (z, y, x), show something that is no speck."""
    return _without_specks(_coarse_mask(volume, transfer))


def outline(volume: Volume, cells: np.ndarray) -> np.ndarray:
    """Return points, in world mm, on the outside of the marked cells of a grid; shape (n, 3)."""
    shell = cells & ~ndimage.binary_erosion(cells)
    index = np.argwhere(shell)[:, ::-1]
    # Not the cells' very corners: what is seen fills its outermost cell by half on average.
    corners = np.array([[i, j, k] for i in (0.15, 0.85) for j in (0.15, 0.85) for k in (0.15, 0.85)])
    at = ((index[:, None, :] + corners) / np.array(cells.shape[::-1])).reshape(-1, 3)
    matrix = volume.world_from_texture
    return np.asarray(at @ matrix[:3, :3].T + matrix[:3, 3])


def _coarse_mask(volume: Volume, transfer: TransferFunction) -> np.ndarray:
    """Return which cells of a coarse grid, shape (z, y, x), show something."""
    low, high = volume.value_range
    table = np.linspace(low, high, 4096)
    opacity = transfer.most_opaque(table)[:, 3]
    data = volume.data
    scale = 4095 / (high - low) if high > low else 0.0
    steps = tuple(max(1, n // (2 * CELLS)) for n in data.shape)
    index = ((data[:: steps[0], :: steps[1], :: steps[2]].astype(np.float32) - low) * scale).astype(np.int16)
    seen = (opacity.reshape(-1) >= min(SEEN, 0.5 * float(opacity.max()) or 1.0))[index]
    return _pooled(seen, tuple(max(1, n // CELLS) for n in seen.shape))


def _pooled(mask: np.ndarray, steps: tuple[int, ...]) -> np.ndarray:
    """Return which blocks of a mask hold a quarter of seen voxels or more."""
    share: np.ndarray = mask.astype(np.float32)
    for axis, step in enumerate(steps):
        starts = np.arange(0, share.shape[axis], step)
        counts = np.diff(np.append(starts, share.shape[axis]))
        shape = [1] * share.ndim
        shape[axis] = -1
        share = np.add.reduceat(share, starts, axis=axis) / counts.reshape(shape)
    return np.asarray(share >= 0.25)


def _without_specks(mask: np.ndarray) -> np.ndarray:
    """Return a mask without the pieces that are much smaller than the largest one."""
    labels, count = ndimage.label(mask, structure=np.ones((3, 3, 3)))
    if count < 2:
        return mask
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    return np.asarray((sizes >= SPECK * sizes.max())[labels] & mask)
