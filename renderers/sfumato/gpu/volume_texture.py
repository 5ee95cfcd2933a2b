"""The volume on the GPU: voxels as normalised texture, and the map of empty space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from scipy.ndimage import distance_transform_cdt

from ..errors import GpuError
from ..scene import Volume
from .device import Device

#: Edge of a block of the empty-space map in voxels.
BLOCK = 8


@dataclass
class VolumeTexture:
    """Voxels as an 8- or 16-bit normalised 3D texture.

    Attributes
    ----------
    domain : (float, float)
        Values that the texture's 0 and 1 stand for.
    low, high : ndarray, shape (bz, by, bx)
        Smallest and largest normalised value that interpolation can meet in each block.
    """

    texture: Any  # None if the voxels are not on the GPU
    domain: tuple[float, float]
    low: np.ndarray
    high: np.ndarray
    size: int

    def release(self) -> None:
        """Free the texture."""
        if self.texture is not None:
            self.texture.release()


def survey_volume(volume: Volume) -> VolumeTexture:
    """Return what is known of a volume without its voxels on the GPU."""
    voxels, domain = normalised(volume)
    return VolumeTexture(None, domain, *_normalised_extremes(voxels), 0)


def upload_volume(device: Device, volume: Volume) -> VolumeTexture:
    """Put a volume on the GPU.

    Raises
    ------
    GpuError
        If the device has no room for it, or a side is longer than it takes.
    """
    if max(volume.dims) > device.max_texture_3d:
        raise GpuError(
            f"a volume of {' x '.join(map(str, volume.dims))} voxels",
            f"{device.name} takes at most {device.max_texture_3d} along a side; load it at a lower resolution",
            "smaller volume",
        )
    voxels, domain = normalised(volume)
    low, high = _normalised_extremes(voxels)
    with device.checked(f"{voxels.nbytes >> 20} MiB for the volume", "smaller volume"):
        texture = device.ctx.texture3d(volume.dims, 1, voxels, alignment=1, dtype=_DTYPE[voxels.itemsize])
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = texture.repeat_z = False
    return VolumeTexture(texture, domain, low, high, voxels.nbytes)


def _normalised_extremes(voxels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    scale = np.float32(1 / np.iinfo(voxels.dtype).max)
    low, high = block_extremes(voxels)
    return low * scale, high * scale


_DTYPE = {1: "f1", 2: "nu2"}


def normalised(volume: Volume) -> tuple[np.ndarray, tuple[float, float]]:
    """Return the voxels as uint8 or uint16 and the values that 0 and the type's maximum stand for."""
    if volume.data.dtype == np.uint8:
        return np.ascontiguousarray(volume.data), (0.0, 255.0)
    low, high = volume.value_range
    high = high if high > low else low + 1.0
    out = np.empty(volume.data.shape, dtype=np.uint16)
    for k, plane in enumerate(volume.data):  # plane by plane: no float copy of the whole volume
        np.rint((plane.astype(np.float64) - low) * (65535 / (high - low)), out=out[k], casting="unsafe")
    return out, (low, high)


def block_extremes(voxels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the smallest and largest voxel that trilinear interpolation can reach from each block."""
    results = []
    for reduce in (np.minimum, np.maximum):
        part = voxels
        for axis in range(3):
            part = _reduce_blocks(part, axis, reduce)
        results.append(part)
    return results[0], results[1]


def _reduce_blocks(values: np.ndarray, axis: int, reduce: np.ufunc) -> np.ndarray:
    count = values.shape[axis]
    starts = np.arange(0, count, BLOCK)
    within = reduce.reduceat(values, starts, axis=axis)
    # Interpolation reaches one voxel beyond the block on either side.
    before = np.take(values, np.maximum(starts - 1, 0), axis=axis)
    after = np.take(values, np.minimum(starts + BLOCK, count - 1), axis=axis)
    return np.asarray(reduce(within, reduce(before, after)))


@dataclass
class EmptySpace:
    """Chessboard distance, in blocks, to the nearest block in which something is visible.

    Attributes
    ----------
    bounds : ndarray, shape (2, 3), or None
        Texture coordinates of the box around all that is visible; None if nothing is.
    centers : ndarray, shape (n, 3)
        Texture coordinates of the centres of the blocks in which something is visible.
    half_block : ndarray, shape (3,)
        Half a block's size in texture coordinates.
    """

    texture: Any
    centers: np.ndarray
    half_block: np.ndarray
    bounds: np.ndarray | None
    size: int

    def release(self) -> None:
        """Free the texture."""
        self.texture.release()


def map_empty_space(device: Device, volume: Volume, occupied: np.ndarray) -> EmptySpace:
    """Make the map from the blocks that hold something visible; `occupied` has shape (bz, by, bx)."""
    if occupied.all():
        distance = np.zeros(occupied.shape, dtype=np.uint8)
    elif not occupied.any():
        distance = np.full(occupied.shape, 255, dtype=np.uint8)
    else:
        distance = np.minimum(distance_transform_cdt(~occupied, metric="chessboard"), 255).astype(np.uint8)
    bz, by, bx = occupied.shape
    texture = device.ctx.texture3d((bx, by, bz), 1, np.ascontiguousarray(distance), alignment=1, dtype="u1")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    half = BLOCK / 2 / np.asarray(volume.dims)
    centers = (np.argwhere(occupied)[:, ::-1] * 2 + 1) * half
    return EmptySpace(texture, centers, half, _bounds(volume, occupied), distance.nbytes)


def _bounds(volume: Volume, occupied: np.ndarray) -> np.ndarray | None:
    if not occupied.any():
        return None
    low, high = [], []
    for axis, count in zip((2, 1, 0), volume.dims, strict=True):
        hits = np.flatnonzero(occupied.any(axis=tuple(k for k in range(3) if k != axis)))
        low.append(hits[0] * BLOCK / count)
        high.append(min(1.0, (hits[-1] + 1) * BLOCK / count))
    return np.array([low, high])
