"""A scene's tissue in float64: trilinear values, pre-integrated extinction and colour."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..errors import SceneError
from ..scene import Scene

#: Cells of the tables over the value range; with so many, the trapezoidal rule is as good as exact.
CELLS = 65536
#: Differences of normalised values below which a segment counts as homogeneous.
SAME = 1e-4


class Medium:
    """Values, extinction and colour of a scene's volume.

    Parameters
    ----------
    scene : Scene
        With a volume and a one-dimensional transfer function.

    Raises
    ------
    SceneError
        If there is no volume, or the transfer function is two-dimensional.
    """

    def __init__(self, scene: Scene) -> None:
        volume, transfer = scene.volume, scene.transfer
        if volume is None or transfer is None:
            raise SceneError("volume", None, "a volume is needed")
        if transfer.regions:
            raise SceneError("transfer.regions", "2D function", "the reference knows 1D functions alone")
        self.low, high = volume.value_range
        self.range = high - self.low if high > self.low else 1.0
        self.voxels = (np.asarray(volume.data, dtype=np.float64) - self.low) / self.range
        self.dims = np.array(volume.dims)
        self.index_from_world = np.diag([*self.dims, 1.0]) @ volume.texture_from_world
        self.index_from_world[:3, 3] -= 0.5
        sampled = transfer.evaluate(self.low + self.range * np.arange(CELLS + 1) / CELLS)
        self.tau = transfer.extinction(sampled[:, 3], volume.unit_distance)
        #: Distance in mm to which opacities refer.
        self.unit_distance = transfer.unit_distance or volume.unit_distance
        #: tau, tau * colour, tau * emission at the table's nodes; shape (CELLS + 1, 7).
        self.density = self.tau[:, None] * np.insert(sampled[:, [0, 1, 2, 4, 5, 6]], 0, 1.0, axis=1)

    @cached_property
    def integral(self) -> np.ndarray:
        """Integral of `density` over the normalised value; shape (CELLS + 1, 7)."""
        steps = (self.density[1:] + self.density[:-1]) / (2 * CELLS)
        return np.concatenate([np.zeros((1, 7)), np.cumsum(steps, axis=0)])

    def value(self, p_world: np.ndarray) -> np.ndarray:
        """Return the normalised value at points (..., 3); trilinear, clamped at the edge."""
        index = p_world @ self.index_from_world[:3, :3].T + self.index_from_world[:3, 3]
        index = np.clip(index, 0, self.dims - 1)
        base = np.minimum(index.astype(np.int64), np.maximum(self.dims - 2, 0))
        fx, fy, fz = np.moveaxis(index - base, -1, 0)
        # Steps to the next voxel in the flat array; none along an axis of one voxel.
        dx, dy, dz = np.where(self.dims > 1, [1, self.dims[0], self.dims[0] * self.dims[1]], 0)
        at = base @ np.array([1, self.dims[0], self.dims[0] * self.dims[1]])
        flat = self.voxels.ravel()

        def row(first: np.ndarray) -> np.ndarray:
            return np.asarray(flat[first] * (1 - fx) + flat[first + dx] * fx)

        near = row(at) * (1 - fy) + row(at + dy) * fy
        far = row(at + dz) * (1 - fy) + row(at + dy + dz) * fy
        return np.asarray(near * (1 - fz) + far * fz)

    def extinction_between(self, s0: np.ndarray, s1: np.ndarray) -> np.ndarray:
        """Return the mean extinction (per mm) of segments along which the value runs from s0 to s1."""
        return self._mean(s0, s1, [0])[..., 0]

    def between(self, s0: np.ndarray, s1: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return mean extinction, and extinction-weighted mean colour and emission of segments."""
        mean = self._mean(s0, s1, list(range(7)))
        tau = mean[..., 0]
        share = mean[..., 1:] / np.where(tau > 0, tau, 1.0)[..., None]
        return tau, share[..., :3], share[..., 3:]

    def _mean(self, s0: np.ndarray, s1: np.ndarray, channels: list[int]) -> np.ndarray:
        """Mean of `density` over the values between s0 and s1 (Engel2001, section 3)."""
        nodes = np.arange(CELLS + 1) / CELLS
        same = np.abs(s1 - s0) < SAME
        width = np.where(same, 1.0, s1 - s0)
        columns = []
        for c in channels:
            rise = np.interp(s1, nodes, self.integral[:, c]) - np.interp(s0, nodes, self.integral[:, c])
            columns.append(np.where(same, np.interp((s0 + s1) / 2, nodes, self.density[:, c]), rise / width))
        return np.stack(columns, axis=-1)
