"""Directions of rays: the face centres of a subdivided tetrahedron, octahedron or icosahedron (Hernell2007, 4.2)."""

from __future__ import annotations

import functools

import numpy as np

_GOLDEN = (1 + 5**0.5) / 2
_TETRAHEDRON = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
_OCTAHEDRON = np.concatenate([np.eye(3), -np.eye(3)])
_ICOSAHEDRON = np.array(
    [v for s in (1, -1) for g in (_GOLDEN, -_GOLDEN) for v in ((0, s, g), (s, g, 0), (g, 0, s))]
)
#: Number of directions: corners of a solid, and how often its faces are cut in four. One is the way to the lamp.
SETS: dict[int, tuple[np.ndarray, int]] = {
    4 * 4**k: (_TETRAHEDRON, k) for k in range(4)
} | {8 * 4**k: (_OCTAHEDRON, k) for k in range(4)} | {20 * 4**k: (_ICOSAHEDRON, k) for k in range(3)}  # fmt: skip


def nearest_count(wanted: int) -> int:
    """Return the number of directions, 1 or one of `SETS`, that comes closest, as a ratio."""
    return min((1, *SETS), key=lambda count: abs(np.log(count / wanted)))


@functools.cache
def directions(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a set of directions and their weights.

    They come in an order in which the first ones are already spread over all of space, so that their mean is good
    early. The weights are the faces' solid angles, with mean 1: faces of a subdivided solid differ in size.

    Parameters
    ----------
    count : int
        One of `SETS`.

    Returns
    -------
    units : ndarray, shape (count, 3)
    weights : ndarray, shape (count,)
    """
    corners, times = SETS[count]
    faces = _faces(corners / np.linalg.norm(corners, axis=1, keepdims=True))
    for _ in range(times):
        faces = _cut_in_four(faces)
    centers = faces.sum(axis=1)
    centers /= np.linalg.norm(centers, axis=1, keepdims=True)
    angles = _solid_angles(faces)
    order = _spread(centers)
    return centers[order], angles[order] / angles.mean()


def preferred(units: np.ndarray, weights: np.ndarray, towards: np.ndarray, share: float) -> np.ndarray:
    """Return weights (mean 1) of which a share follows the cosine with a preferred direction."""
    cosine = np.maximum(units @ towards, 0) * weights
    return np.asarray((1 - share) * weights + share * cosine / max(float(cosine.mean()), 1e-9))


def _faces(corners: np.ndarray) -> np.ndarray:
    """Return the triangles between corners that are next to each other; shape (n, 3, 3)."""
    apart = np.linalg.norm(corners[:, None] - corners[None], axis=-1)
    near = np.isclose(apart, apart[apart > 1e-6].min())
    number = len(corners)
    found = [
        (i, j, k)
        for i in range(number)
        for j in range(i)
        for k in range(j)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    return np.asarray(corners[np.array(found)])


def _cut_in_four(faces: np.ndarray) -> np.ndarray:
    a, b, c = np.moveaxis(faces, 1, 0)
    ab, bc, ca = (m / np.linalg.norm(m, axis=1, keepdims=True) for m in (a + b, b + c, c + a))
    parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def _solid_angles(faces: np.ndarray) -> np.ndarray:
    """Solid angles of spherical triangles (Van Oosterom and Strackee)."""
    a, b, c = np.moveaxis(faces, 1, 0)
    volume = np.abs(np.einsum("ij,ij->i", a, np.cross(b, c)))
    dots = [np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a))]
    return np.asarray(2 * np.arctan2(volume, 1 + sum(dots)))


def _spread(units: np.ndarray) -> np.ndarray:
    """Return an order in which each direction is as far as can be from those before it."""
    order, closest = [0], units @ units[0]
    for _ in range(len(units) - 1):
        closest[order[-1]] = np.inf
        # Rounded: equals are taken in their own order on every machine.
        order.append(int(np.round(closest, 9).argmin()))
        closest = np.maximum(closest, units @ units[order[-1]])
    return np.array(order)
