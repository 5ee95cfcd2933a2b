"""Signed distances (mm, negative inside) of simple bodies, and ways to join them.

Coordinates are x, y, z arrays that broadcast against each other; all arithmetic is float32 and uses nothing
but +, -, *, / and square roots, which are the same on every processor, so that a sample's checksum is too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .grid import Axes, Point


def unit(vector: Point) -> np.ndarray:
    """Return a vector of length 1."""
    array = np.asarray(vector, dtype=float)
    return np.asarray(array / np.sqrt((array * array).sum()))


@dataclass(frozen=True)
class Frame:
    """An origin and right-handed axes: u sideways, v up (dorsal), w along."""

    origin: np.ndarray
    u: np.ndarray
    v: np.ndarray
    w: np.ndarray

    @staticmethod
    def along(origin: Point, direction: Point, up: Point = (0, 1, 0)) -> Frame:
        """Return the frame whose w has this direction and whose v is as near to `up` as it can be."""
        w = unit(direction)
        hint = np.asarray(up, dtype=float)
        v = unit(hint - (hint * w).sum() * w)
        return Frame(np.asarray(origin, dtype=float), np.cross(v, w), v, w)

    def local(self, axes: Axes) -> Axes:
        """Return u, v, w of points x, y, z."""
        parts = []
        for axis in (self.u, self.v, self.w):
            offset = np.float32((axis * self.origin).sum())
            x, y, z = (np.float32(axis[i]) * axes[i] for i in range(3))
            parts.append(z - offset + y + x)
        return parts[0], parts[1], parts[2]

    def world(self, u: float, v: float, w: float) -> np.ndarray:
        """Return the point with local coordinates u, v, w."""
        return self.origin + u * self.u + v * self.v + w * self.w


def length(*parts: np.ndarray) -> np.ndarray:
    """Return the length of vectors given by their components."""
    return np.asarray(np.sqrt(sum((p * p for p in parts[1:]), parts[0] * parts[0])))


def sphere(axes: Axes, center: Point, radius: float) -> np.ndarray:
    """Distance to a ball."""
    return length(*(axes[i] - np.float32(center[i]) for i in range(3))) - np.float32(radius)


def ellipsoid(axes: Axes, center: Point, radii: Point) -> np.ndarray:
    """Distance to an ellipsoid along the axes, first-order exact at the surface."""
    scaled = [(axes[i] - np.float32(center[i])) / np.float32(radii[i]) for i in range(3)]
    radius = length(*scaled)
    slope = length(*(scaled[i] / np.float32(radii[i]) for i in range(3)))
    return np.asarray(radius * (radius - 1) / np.maximum(slope, np.float32(1e-6)))


def capsule(
    axes: Axes, start: Point, end: Point, radius: float, end_radius: float | None = None
) -> np.ndarray:
    """Distance to a rod with round ends; with a second radius, it tapers."""
    a, ab = np.asarray(start, dtype=float), np.subtract(end, start)
    x, y, z = (axes[i] - np.float32(a[i]) for i in range(3))
    scale = 1 / max(float((ab * ab).sum()), 1e-12)
    t = np.clip(
        z * np.float32(ab[2] * scale) + y * np.float32(ab[1] * scale) + x * np.float32(ab[0] * scale), 0, 1
    )
    distance = length(x - t * np.float32(ab[0]), y - t * np.float32(ab[1]), z - t * np.float32(ab[2]))
    last = radius if end_radius is None else end_radius
    return np.asarray(distance - (np.float32(radius) + t * np.float32(last - radius)))


def box(axes: Axes, center: Point, half: Point, rounding: float = 0.0) -> np.ndarray:
    """Distance to a box along the axes, its edges rounded by a radius."""
    q = [np.abs(axes[i] - np.float32(center[i])) - np.float32(half[i] - rounding) for i in range(3)]
    outside = length(*(np.maximum(c, 0) for c in q))
    return outside + np.minimum(np.maximum(np.maximum(q[0], q[1]), q[2]), 0) - np.float32(rounding)


def torus(axes: Axes, center: Point, radius: float, tube: float) -> np.ndarray:
    """Distance to a torus around the z axis."""
    x, y, z = (axes[i] - np.float32(center[i]) for i in range(3))
    return length(length(x, y) - np.float32(radius), z) - np.float32(tube)


def cone(axes: Axes, center: Point, radius: float, height: float) -> np.ndarray:
    """Distance to an upright cone (never too large); `center` is that of its base."""
    x, y, z = (axes[i] - np.float32(center[i]) for i in range(3))
    slope = np.sqrt(radius * radius + height * height)
    side = (length(x, y) * np.float32(height) + (z - np.float32(height)) * np.float32(radius)) / np.float32(
        slope
    )
    return np.maximum(side, -z)


def smooth_min(a: np.ndarray, b: np.ndarray, k: float) -> np.ndarray:
    """Union whose seam is a fillet of about `k` mm."""
    if k <= 0:
        return np.asarray(np.minimum(a, b))
    h = np.maximum(np.float32(k) - np.abs(a - b), 0)
    return np.asarray(np.minimum(a, b) - h * h * np.float32(0.25 / k))


def smooth_max(a: np.ndarray, b: np.ndarray, k: float) -> np.ndarray:
    """Intersection whose edge is rounded by about `k` mm."""
    return -smooth_min(-a, -b, k)


def inside(distance: np.ndarray, edge: float) -> np.ndarray:
    """Share of a voxel inside a body: 1 inside, 0 outside, falling linearly over `edge` mm at the surface.

    Linear, because trilinear interpolation then meets the surface exactly; a curved step two voxels wide
    gives the wood grain of terraces that are not there.
    """
    return np.asarray(np.clip(np.float32(0.5) - distance * np.float32(1 / edge), 0, 1))


def bump(x: np.ndarray, width: float) -> np.ndarray:
    """Bell of height 1 that ends at plus and minus `width`."""
    t = np.maximum(1 - x * x * np.float32(1 / (width * width)), 0)
    return np.asarray(t * t * t)
