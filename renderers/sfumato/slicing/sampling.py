"""Values of a volume on a slice and at a point, by linear interpolation between voxel centres.

`scipy.ndimage` does the work: it takes a matrix instead of a place for each pixel, any type of voxels without a
copy, and leaves Python's lock to others meanwhile, so that a window goes on while a thread of its own slices.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import ndimage

from ..scene.volume import Volume
from .frame import Frame

#: What counts as inside although rounding puts it outside, in voxels.
_ROUNDING = 1e-6


def sample(volume: Volume, frame: Frame) -> np.ndarray:
    """Return the values at the middles of a frame's pixels.

    Returns
    -------
    ndarray of float32, shape (height, width)
        NaN outside of the volume. The outer half of its outermost voxels has their value, also where there is but
        one of them along an axis.
    """
    start = _index_of(volume, frame.point(0.5, 0.5))
    down = _index_of(volume, frame.point(0.5, 1.5)) - start
    across = _index_of(volume, frame.point(1.5, 0.5)) - start
    values = np.empty((1, frame.height, frame.width), np.float32)
    # The array's axes are z, y, x; the first column belongs to the axis of length 1.
    matrix = np.stack([np.zeros(3), down[::-1], across[::-1]], axis=1)
    _interpolate(volume.data, matrix, start[::-1], values)
    picture: np.ndarray = values[0]
    picture[~_inside(volume, start, across, down, frame)] = np.nan
    return picture


def value_at(volume: Volume, point: Any) -> float:
    """Return the value at a world point in mm, NaN outside of the volume."""
    index = _index_of(volume, np.asarray(point, dtype=float))
    if (index < -0.5 - _ROUNDING).any() or (index > np.array(volume.dims) - 0.5 + _ROUNDING).any():
        return float("nan")
    value = np.empty((1, 1, 1), np.float32)
    _interpolate(volume.data, np.eye(3), index[::-1], value)
    return float(value[0, 0, 0])


def _interpolate(data: np.ndarray, matrix: np.ndarray, offset: np.ndarray, values: np.ndarray) -> None:
    """Fill values (n, height, width) with those at ``matrix @ (i, row, column) + offset``."""
    ndimage.affine_transform(
        data, matrix, offset, output_shape=values.shape, output=values, order=1, mode="nearest"
    )


def _inside(
    volume: Volume, start: np.ndarray, across: np.ndarray, down: np.ndarray, frame: Frame
) -> np.ndarray:
    """Tell which pixels lie in the volume, whose outermost voxels reach half a voxel beyond their centres."""
    columns, rows = np.arange(frame.width), np.arange(frame.height)[:, None]
    inside = np.ones((frame.height, frame.width), dtype=bool)
    for axis, count in enumerate(volume.dims):
        index = start[axis] + columns * across[axis] + rows * down[axis]
        inside &= (index >= -0.5 - _ROUNDING) & (index <= count - 0.5 + _ROUNDING)
    return inside


def _index_of(volume: Volume, point: np.ndarray) -> np.ndarray:
    """Return the voxel index (x, y, z) of a world point."""
    matrix = volume.texture_from_world
    return np.asarray((matrix[:3, :3] @ point + matrix[:3, 3]) * np.array(volume.dims) - 0.5)


__all__ = ["sample", "value_at"]
