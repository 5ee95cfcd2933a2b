"""A regular grid in millimetres, and windows of it: shapes are only evaluated where they can matter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

Point = Sequence[float] | np.ndarray
Axes = tuple[np.ndarray, np.ndarray, np.ndarray]
Box = tuple[slice, slice, slice]


@dataclass(frozen=True)
class Grid:
    """Voxel centres at ``low + (i + 1/2) * spacing`` on each axis.

    Parameters
    ----------
    low : (x, y, z)
        Corner of the volume in mm.
    dims : (nx, ny, nz)
        Number of voxels along x, y and z.
    spacing : float
        Edge of a voxel in mm.
    """

    low: tuple[float, float, float]
    dims: tuple[int, int, int]
    spacing: float

    @property
    def shape(self) -> tuple[int, int, int]:
        """Shape of an array on the grid, (z, y, x)."""
        return self.dims[2], self.dims[1], self.dims[0]

    def full(self, value: float) -> np.ndarray:
        """Return a float32 array on the grid, filled with a value."""
        return np.full(self.shape, value, dtype=np.float32)

    def line(self, axis: int, start: int = 0, stop: int | None = None) -> np.ndarray:
        """Return voxel centres along an axis (0 is x) in mm, float32."""
        index = np.arange(start, self.dims[axis] if stop is None else stop)
        return (self.low[axis] + (index + 0.5) * self.spacing).astype(np.float32)

    def axes(self) -> Axes:
        """Return x, y and z of all voxels as arrays that broadcast to the grid's shape."""
        return self.line(0)[None, None, :], self.line(1)[None, :, None], self.line(2)[:, None, None]

    def window(self, low: Point, high: Point) -> tuple[Box, Axes]:
        """Return the part of the grid inside a box: its slices (z, y, x) and its x, y, z in mm."""
        spans = []
        for axis in range(3):
            start = int(np.floor((low[axis] - self.low[axis]) / self.spacing))
            stop = int(np.ceil((high[axis] - self.low[axis]) / self.spacing))
            spans.append((max(0, min(start, self.dims[axis])), max(0, min(stop, self.dims[axis]))))
        (x0, x1), (y0, y1), (z0, z1) = spans
        lines = (
            self.line(0, x0, x1)[None, None, :],
            self.line(1, y0, y1)[None, :, None],
            self.line(2, z0, z1)[:, None, None],
        )
        return (slice(z0, z1), slice(y0, y1), slice(x0, x1)), lines

    def coarser(self) -> Grid:
        """Return the grid with every second voxel, for smooth fields; `upsampled` takes it back."""
        nx, ny, nz = (n // 2 + 3 for n in self.dims)
        # Coarse voxel 1 sits on fine voxel 0: one voxel of border for the cubic interpolation.
        low = tuple(c + 0.5 * self.spacing - 3 * self.spacing for c in self.low)
        return Grid((low[0], low[1], low[2]), (nx, ny, nz), 2 * self.spacing)

    def upsampled(self, coarse: np.ndarray) -> np.ndarray:
        """Return a field on `coarser` interpolated to this grid (cubic, through the coarse values)."""
        for axis in range(3):
            coarse = _doubled(coarse, axis, self.shape[axis])
        return coarse


def _doubled(values: np.ndarray, axis: int, count: int) -> np.ndarray:
    values = np.moveaxis(values, axis, 0)
    result = np.empty((count, *values.shape[1:]), dtype=np.float32)
    half = count // 2
    result[0::2] = values[1 : half + 1 + count % 2]
    inner = values[1 : half + 1] + values[2 : half + 2]
    outer = values[0:half] + values[3 : half + 3]
    inner *= np.float32(9 / 16)
    outer *= np.float32(1 / 16)
    inner -= outer
    result[1::2] = inner
    return np.ascontiguousarray(np.moveaxis(result, 0, axis))
