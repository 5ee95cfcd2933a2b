"""Geometry of half-angle slicing: the planes, what they cut out of a box, and the light's own grid.

Everything is in world space and millimetres. `axis` is the slices' normal and points to the side from which
the light comes; heights are measured along it, and fall from slice to slice.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..stack import PAD

#: Edges of a box whose corners are numbered as in `Volume.corners`: bit 2 is x, bit 1 is y, bit 0 is z.
_EDGES = np.array([(a, a | bit) for a in range(8) for bit in (1, 2, 4) if not a & bit])
#: A plane cuts at most twelve edges (through corners): a fan of ten triangles, most of them empty.
_FAN = np.array([(0, k, k + 1) for k in range(1, 11)]).ravel()
#: Vertices of one slice in the buffer.
VERTICES = len(_FAN)


def half_vector(back: np.ndarray, towards: np.ndarray) -> tuple[np.ndarray, bool]:
    """Return the slices' normal, and whether the eye meets the slices in the reverse order of the light.

    Parameters
    ----------
    back, towards : ndarray, shape (3,)
        Unit vectors to the viewer and to the light.
    """
    reverse = float(back @ towards) < 0
    half = towards - back if reverse else towards + back
    return half / np.linalg.norm(half), reverse


@dataclass(frozen=True)
class Slices:
    """Planes ``axis . p = top - k * spacing``, from the light's side on; each stands for a slab."""

    axis: np.ndarray
    top: float
    spacing: float
    count: int

    @staticmethod
    def through(
        axis: np.ndarray, whole: np.ndarray, part: np.ndarray, spacing: float, jitter: float
    ) -> Slices:
        """Return the slices that meet a part of a box; where they lie depends on the whole box alone.

        Parameters
        ----------
        whole, part : ndarray, shape (n, 3)
            Corners.
        jitter : float
            Offset in units of the spacing, in [0, 1).
        """
        start = float((whole @ axis).max()) - jitter * spacing
        heights = part @ axis
        first = max(0, math.ceil((start - float(heights.max())) / spacing))
        last = math.floor((start - float(heights.min())) / spacing)
        return Slices(axis, start - first * spacing, spacing, max(0, last - first + 1))

    @property
    def heights(self) -> np.ndarray:
        """Heights of the slices in mm, shape (count,)."""
        return np.asarray(self.top - np.arange(self.count) * self.spacing)

    def triangles(self, corners: np.ndarray) -> np.ndarray:
        """Return what the slices cut out of a box, as triangles; float32, shape (count, VERTICES, 3)."""
        points, hit = self._crossings(corners)
        center = (points * hit[..., None]).sum(axis=1) / np.maximum(hit.sum(axis=1), 1)[:, None]
        u = np.cross(self.axis, np.eye(3)[np.argmin(np.abs(self.axis))])
        v = np.cross(self.axis, u)
        offset = points - center[:, None]
        angle = np.where(hit, np.arctan2(offset @ v, offset @ u), np.inf)
        order = np.argsort(angle, axis=1)
        sorted_points = np.take_along_axis(points, order[..., None], axis=1)
        present = np.take_along_axis(hit, order, axis=1)
        # What is not there coincides with the first corner: its triangles are empty.
        polygon = np.where(present[..., None], sorted_points, sorted_points[:, :1])
        polygon[~present[:, 0]] = 0.0
        return np.ascontiguousarray(polygon[:, _FAN], dtype=np.float32)

    def _crossings(self, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return where planes meet the box's edges, (count, 12, 3), and whether they do, (count, 12)."""
        start, end = corners[_EDGES[:, 0]], corners[_EDGES[:, 1]]
        low, high = start @ self.axis, end @ self.axis
        # An edge in the plane has its corners on other edges too.
        span = np.where(np.abs(high - low) < 1e-12, np.inf, high - low)
        s = (self.heights[:, None] - low) / span
        hit = (s >= 0) & (s <= 1) & np.isfinite(span)
        return start + np.where(hit, s, 0.0)[..., None] * (end - start), hit


@dataclass(frozen=True)
class LightGrid:
    """The light buffer: a grid across a parallel light, over the projection of a box.

    Attributes
    ----------
    axes : ndarray, shape (2, 3)
        Unit vectors across the light.
    origin : ndarray, shape (2,)
        Position along the axes of texel coordinate (0, 0) in mm.
    """

    towards: np.ndarray
    axes: np.ndarray
    origin: np.ndarray
    texel: float
    size: tuple[int, int]

    @staticmethod
    def over(
        corners: np.ndarray,
        towards: np.ndarray,
        upright: np.ndarray,
        texel: float,
        offset: tuple[float, float],
    ) -> LightGrid:
        """Return the grid over a box.

        Parameters
        ----------
        upright : ndarray, shape (3, 3)
            Two axes, and a third at less than 120 degrees from the light; the grid is those two, turned with
            the third into the light by the shortest way, so that it does not jump as the light moves.
        texel : float
            mm.
        offset : (float, float)
            Shift of the grid in texels, in [-0.5, 0.5].
        """
        third = upright[2]
        across = upright[:2] - np.outer(upright[:2] @ towards / (1 + third @ towards), third + towards)
        at = corners @ across.T
        low, high = at.min(axis=0), at.max(axis=0)
        size = np.ceil((high - low) / texel).astype(int) + 2 * PAD
        origin = low + texel * (np.asarray(offset) - PAD)
        return LightGrid(towards, across, origin, texel, (int(size[0]), int(size[1])))

    @property
    def coordinates_from_world(self) -> np.ndarray:
        """Affine 2 x 4 from world mm to [0, 1]^2 over the buffer."""
        scale = 1 / (self.texel * np.asarray(self.size, dtype=float))
        return np.concatenate([self.axes, -self.origin[:, None]], axis=1) * scale[:, None]

    def columns(self, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the affine 3 x 3 from texels to world points at height 0, and their way per mm of height."""
        slope = self.towards / float(axis @ self.towards)
        # Slide each point across the light along the light, until it lies at height 0.
        flat = self.axes - np.outer(self.axes @ axis, slope)
        return np.column_stack([flat[0] * self.texel, flat[1] * self.texel, self.origin @ flat]), slope
