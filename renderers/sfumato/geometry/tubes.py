"""Tubes: a ring of points swept along each line, without twist, closed at both ends.

The frames are rotation-minimising (Bishop 1975): each point gets any frame about its tangent; the angle by
which the frame carried over from the point before differs from it is summed along the line and turned back.
That is one cumulative sum for all lines together, where vtkTubeFilter walks them one by one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .polyline import Strand


@dataclass(frozen=True)
class Tubes:
    """Swept tubes.

    Parameters
    ----------
    points, normals : ndarray, shape (n * sides + caps, 3), float32
        Ring after ring, then the caps' rings.
    triangles : ndarray, shape (m, 3), uint32
        Counter-clockwise seen from outside.
    source : ndarray, shape (n * sides + caps,)
        The line's point that each belongs to, for its colour.
    """

    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    source: np.ndarray


def tangents_of(strand: Strand) -> np.ndarray:
    """Return unit tangents, shape (n, 3): the mean of the directions of both segments at a point."""
    steps = np.diff(strand.points, axis=0)
    steps /= np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), 1e-30)
    steps[~strand.joined] = 0
    none = np.zeros((1, 3), np.float32)
    ahead, behind = np.concatenate([steps, none]), np.concatenate([none, steps])
    summed = ahead + behind
    length = np.linalg.norm(summed, axis=1, keepdims=True)
    # A hairpin's two directions cancel: it takes the one that leads on.
    summed = np.where(length > 1e-4, summed, ahead)
    return np.asarray(summed / np.maximum(np.linalg.norm(summed, axis=1, keepdims=True), 1e-30))


def frames_of(strand: Strand, tangents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors across each tangent, (n, 3) each, that turn as little as the line allows."""
    u, v = _any_frame(tangents)
    carried = _carried(u[:-1], tangents[:-1], tangents[1:])
    turned = np.arctan2((carried * v[1:]).sum(axis=1), (carried * u[1:]).sum(axis=1))
    turned[~strand.joined] = 0
    angle = np.concatenate([[0.0], np.cumsum(turned, dtype=np.float64)])
    cos, sin = (f(angle)[:, None].astype(np.float32) for f in (np.cos, np.sin))
    return cos * u + sin * v, cos * v - sin * u


def _any_frame(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Duff et al., Building an Orthonormal Basis, Revisited (JCGT 6(1), 2017)."""
    x, y, z = t.T
    sign = np.where(z >= 0, np.float32(1), np.float32(-1))
    a = -1 / (sign + z)
    b = x * y * a
    u = np.stack([1 + sign * x * x * a, sign * b, -sign * x], axis=1)
    v = np.stack([b, sign + y * y * a, -y], axis=1)
    return u, v


def _carried(u: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Rotate u, which is across ``before``, by the smallest rotation from ``before`` to ``after``."""
    cosine = (before * after).sum(axis=1, keepdims=True)
    share = (u * after).sum(axis=1, keepdims=True) / np.maximum(1 + cosine, 1e-6)
    return np.asarray(u - share * (before + after))


def sweep(strand: Strand, tangents: np.ndarray, radius: np.ndarray, sides: int) -> Tubes:
    """Sweep rings along lines.

    Parameters
    ----------
    tangents : ndarray, shape (n, 3)
        As from `tangents_of`.
    radius : ndarray, shape (n,)
        In mm at each point.
    sides : int
        Points of a ring, at least 3.
    """
    u, v = frames_of(strand, tangents)
    angle = np.arange(sides) * (2 * np.pi / sides)
    cos, sin = np.cos(angle).astype(np.float32), np.sin(angle).astype(np.float32)
    normals = cos[None, :, None] * u[:, None] + sin[None, :, None] * v[:, None]
    points = strand.points[:, None] + np.asarray(radius, np.float32)[:, None, None] * normals
    # Cutting a ring off square, its edge is sharp: the cap has a ring of its own with the line's direction.
    first = np.flatnonzero(np.concatenate([[True], ~strand.joined]))
    last = np.append(first[1:], len(strand.points)) - 1
    ends = np.concatenate([first, last])
    facing = np.concatenate([-tangents[first], tangents[last]])
    cap_normals = np.broadcast_to(facing[:, None], (len(ends), sides, 3)).reshape(-1, 3)
    count = len(strand.points) * sides
    return Tubes(
        np.concatenate([points.reshape(-1, 3), points[ends].reshape(-1, 3)]),
        np.concatenate([normals.reshape(-1, 3), cap_normals]),
        np.concatenate([_walls(strand, sides), _caps(count, len(first), sides)]),
        np.repeat(np.concatenate([np.arange(len(strand.points)), ends]), sides),
    )


def _walls(strand: Strand, sides: int) -> np.ndarray:
    ring = np.flatnonzero(strand.joined).astype(np.uint32)[:, None] * np.uint32(sides)
    j = np.arange(sides, dtype=np.uint32)
    k = np.roll(j, -1)
    a, b, c, d = ring + j, ring + k, ring + sides + j, ring + sides + k
    return np.stack([a, b, d, a, d, c], axis=-1).reshape(-1, 3)


def _caps(base: int, lines: int, sides: int) -> np.ndarray:
    fan = np.array([[0, k, k + 1] for k in range(1, sides - 1)], dtype=np.uint32).reshape(-1, 3)
    rings = base + np.arange(2 * lines, dtype=np.uint32)[:, None, None] * np.uint32(sides)
    # Seen from before its first point, a line's ring runs clockwise.
    return (
        np.concatenate([rings[:lines] + fan[:, ::-1], rings[lines:] + fan]).reshape(-1, 3).astype(np.uint32)
    )
