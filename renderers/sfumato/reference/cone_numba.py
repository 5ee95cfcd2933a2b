"""The inner loops of `cone`, compiled by Numba: the same sums, pixel by pixel, with empty space skipped."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numba
import numpy as np
from scipy import ndimage

from .cone import DARK, OPAQUE
from .medium import CELLS, SAME, Medium
from .rays import SOLID_DEPTH

if TYPE_CHECKING:
    from .cone import Task

_jit: Any = numba.njit(cache=True, nogil=True)


def integrate(task: Task, pixels: np.ndarray) -> np.ndarray:
    """Return premultiplied colour and opacity of some pixels; shape (n, 4)."""
    medium, count = task.medium, len(task.cones[0].directions) if task.cones else 1
    directions = np.array([c.directions for c in task.cones]).reshape(-1, count, 3)
    secants = np.array([c.secants for c in task.cones]).reshape(-1, count)
    radiance = np.array([c.radiance for c in task.cones]).reshape(-1, 3)
    rear = np.array([c.rear for c in task.cones], dtype=np.bool_)
    return np.asarray(
        _pixels(
            task.rays.start[pixels],
            task.rays.slope[pixels],
            task.z_in[pixels],
            task.z_out[pixels],
            task.stack.z0,
            task.stack.d,
            task.stack.n,
            directions,
            secants,
            radiance,
            rear,
            np.array([cone.facing for cone in task.cones]),
            task.ambient,
            task.light_step,
            medium.voxels,
            np.ascontiguousarray(medium.index_from_world[:3]),
            medium.density,
            medium.integral,
            empty_distance(medium),
            task.region.half_spaces,
            task.region.solid,
            task.region.diagonal,
        )
    )


@lru_cache(maxsize=2)
def empty_distance(medium: Medium) -> np.ndarray:
    """Return each cell's distance, in cells, to the nearest one with any extinction; 0 within such a cell.

    A cell lies between eight voxel centres; its values are those between the smallest and largest of them.
    """
    low = ndimage.minimum_filter(medium.voxels, size=2, origin=-1, mode="nearest")
    high = ndimage.maximum_filter(medium.voxels, size=2, origin=-1, mode="nearest")
    count = np.concatenate([[0], np.cumsum(medium.tau > 0)])
    first = np.floor(low * CELLS).astype(np.int64)
    last = np.minimum(np.ceil(high * CELLS).astype(np.int64), CELLS)
    empty = count[last + 1] == count[first]
    if empty.all():
        return np.full(empty.shape, 255, dtype=np.uint8)
    distance = np.asarray(ndimage.distance_transform_cdt(empty, metric="chessboard"))
    return np.asarray(np.minimum(distance, 255), dtype=np.uint8)


@_jit
def _index(matrix, dims, axis, x, y, z):  # type: ignore[no-untyped-def]
    """Voxel coordinate along an axis, clamped."""
    i = matrix[axis, 0] * x + matrix[axis, 1] * y + matrix[axis, 2] * z + matrix[axis, 3]
    return min(max(i, 0.0), dims[2 - axis] - 1.0)


@_jit
def _value(voxels, matrix, x, y, z):  # type: ignore[no-untyped-def]
    dims = voxels.shape
    fx, fy = _index(matrix, dims, 0, x, y, z), _index(matrix, dims, 1, x, y, z)
    fz = _index(matrix, dims, 2, x, y, z)
    i, j, k = int(fx), int(fy), int(fz)
    fx, fy, fz = fx - i, fy - j, fz - k
    i1, j1, k1 = min(i + 1, dims[2] - 1), min(j + 1, dims[1] - 1), min(k + 1, dims[0] - 1)
    a = (voxels[k, j, i] * (1 - fx) + voxels[k, j, i1] * fx) * (1 - fy)
    a += (voxels[k, j1, i] * (1 - fx) + voxels[k, j1, i1] * fx) * fy
    b = (voxels[k1, j, i] * (1 - fx) + voxels[k1, j, i1] * fx) * (1 - fy)
    b += (voxels[k1, j1, i] * (1 - fx) + voxels[k1, j1, i1] * fx) * fy
    return a * (1 - fz) + b * fz


@_jit
def _interpolated(table, s, c):  # type: ignore[no-untyped-def]
    t = min(max(s * CELLS, 0.0), float(CELLS))
    i = min(int(t), CELLS - 1)
    return table[i, c] + (table[i + 1, c] - table[i, c]) * (t - i)


@_jit
def _mean(density, integral, s0, s1, c):  # type: ignore[no-untyped-def]
    if abs(s1 - s0) < SAME:
        return _interpolated(density, (s0 + s1) / 2, c)
    return (_interpolated(integral, s1, c) - _interpolated(integral, s0, c)) / (s1 - s0)


@_jit
def _to_edge(half_spaces, x, y, z, wx, wy, wz):  # type: ignore[no-untyped-def]
    """Distance from a point to the edge of the clipped box."""
    length = math.inf
    for r in range(half_spaces.shape[0]):
        a, b, c, offset = half_spaces[r]
        rate = a * wx + b * wy + c * wz
        room = a * x + b * y + c * z - offset
        if rate < -1e-14:
            length = min(length, -room / rate)
        elif rate < 1e-14 and room < 0:
            length = -math.inf
    return max(length, 0.0)


@_jit
def _on_solid_face(half_spaces, solid, diagonal, x, y, z, wx, wy, wz, inwards):  # type: ignore[no-untyped-def]
    """Whether a point lies on a solid face that a direction enters (or leaves) through."""
    for r in range(half_spaces.shape[0]):
        if not solid[r]:
            continue
        a, b, c, offset = half_spaces[r]
        near = abs(a * x + b * y + c * z - offset) < 1e-7 * diagonal * math.sqrt(a * a + b * b + c * c)
        rate = a * wx + b * wy + c * wz
        if near and (rate > 0 if inwards else rate < 0):
            return True
    return False


@_jit
def _solid_depth(voxels, matrix, density, integral, diagonal, x, y, z):  # type: ignore[no-untyped-def]
    s = _value(voxels, matrix, x, y, z)
    return min(_mean(density, integral, s, s, 0) * diagonal, SOLID_DEPTH)


@_jit
def _solid_faces(  # type: ignore[no-untyped-def]
    voxels, matrix, density, integral, half_spaces, solid, diagonal, length, x, y, z, wx, wy, wz
):
    """Optical depth of the solid faces that a way of a length begins under or ends at."""
    depth = 0.0
    if length <= 1e-7 * diagonal:  # it leaves at once: it begins on the face, not under it
        return depth
    if _on_solid_face(half_spaces, solid, diagonal, x, y, z, wx, wy, wz, True):
        depth += _solid_depth(voxels, matrix, density, integral, diagonal, x, y, z)
    x, y, z = x + wx * length, y + wy * length, z + wz * length
    if _on_solid_face(half_spaces, solid, diagonal, x, y, z, wx, wy, wz, False):
        depth += _solid_depth(voxels, matrix, density, integral, diagonal, x, y, z)
    return depth


@_jit
def _optical_depth(  # type: ignore[no-untyped-def]
    voxels, matrix, density, integral, empty, half_spaces, solid, diagonal, step, x, y, z, wx, wy, wz
):
    length = _to_edge(half_spaces, x, y, z, wx, wy, wz)
    # Voxels that a step crosses at most along one axis: how many steps an empty distance is worth.
    pace = 0.0
    for axis in range(3):
        pace = max(pace, abs(matrix[axis, 0] * wx + matrix[axis, 1] * wy + matrix[axis, 2] * wz) * step)
    depth, k, known, near = 0.0, 0, False, 0.0
    while k * step < length and depth < DARK:
        t = k * step
        px, py, pz = x + wx * t, y + wy * t, z + wz * t
        free = empty[
            int(_index(matrix, voxels.shape, 2, px, py, pz)),
            int(_index(matrix, voxels.shape, 1, px, py, pz)),
            int(_index(matrix, voxels.shape, 0, px, py, pz)),
        ]
        jump = int((free - 1) / pace) if free > 1 else 0
        if jump > 0:
            k, known = k + jump, False
            continue
        if not known:
            near = _value(voxels, matrix, px, py, pz)
        end = min((k + 1) * step, length)
        far = _value(voxels, matrix, x + wx * end, y + wy * end, z + wz * end)
        depth += _mean(density, integral, near, far, 0) * (end - t)
        near, known, k = far, True, k + 1
    if depth < DARK and solid.any():
        depth += _solid_faces(
            voxels, matrix, density, integral, half_spaces, solid, diagonal, length, x, y, z, wx, wy, wz
        )
    return depth


@_jit
def _slab_term(x, v, s, rear):  # type: ignore[no-untyped-def]
    if not rear:
        return -math.expm1(-x * (v + s)) * v / (v + s)
    y = x * abs(s - v)
    quotient = -math.expm1(-y) / y if y > 1e-9 else 1 - y / 2
    return v * x * math.exp(-x * min(v, s)) * quotient


@_jit
def _pixels(  # type: ignore[no-untyped-def]
    start,
    slope,
    z_in,
    z_out,
    z0,
    d,
    n,
    directions,
    secants,
    radiance,
    rear,
    facing,
    ambient,
    step,
    voxels,
    matrix,
    density,
    integral,
    empty,
    half_spaces,
    solid,
    diagonal,
):
    any_solid = solid.any()
    result = np.zeros((start.shape[0], 4))
    mean, light, pa, pb = np.zeros(7), np.zeros(3), np.zeros(3), np.zeros(3)
    for p in range(start.shape[0]):
        v = math.sqrt(slope[p, 0] ** 2 + slope[p, 1] ** 2 + slope[p, 2] ** 2)
        for i in range(n):
            za, zb = max(z0 + i * d, z_in[p]), min(z0 + (i + 1) * d, z_out[p])
            share = 1 - result[p, 3]
            if zb <= za or share <= OPAQUE:
                continue
            pa[:] = start[p] + slope[p] * za
            pb[:] = start[p] + slope[p] * zb
            s0 = _value(voxels, matrix, pa[0], pa[1], pa[2])
            s1 = _value(voxels, matrix, pb[0], pb[1], pb[2])
            face = (
                any_solid
                and za == z_in[p]
                and _on_solid_face(
                    half_spaces,
                    solid,
                    diagonal,
                    pa[0],
                    pa[1],
                    pa[2],
                    slope[p, 0],
                    slope[p, 1],
                    slope[p, 2],
                    True,
                )
            )
            if face:
                s1 = s0
            mean[0] = _mean(density, integral, s0, s1, 0)
            if mean[0] <= 0:
                continue
            for c in range(1, 7):
                mean[c] = _mean(density, integral, s0, s1, c) / mean[0]
            x = min(mean[0] * diagonal, SOLID_DEPTH) if face else mean[0] * (zb - za)
            alpha = -math.expm1(-x * v)
            light[:] = 0.0
            for lamp in range(directions.shape[0]):
                at = pb if rear[lamp] else pa
                if ambient >= 1:
                    light += radiance[lamp] * facing[lamp] * alpha
                    continue
                total = 0.0
                for k in range(directions.shape[1]):
                    w = directions[lamp, k]
                    depth = _optical_depth(
                        voxels,
                        matrix,
                        density,
                        integral,
                        empty,
                        half_spaces,
                        solid,
                        diagonal,
                        step,
                        at[0],
                        at[1],
                        at[2],
                        w[0],
                        w[1],
                        w[2],
                    )
                    if depth < DARK:
                        total += math.exp(-depth) * _slab_term(x, v, secants[lamp, k], rear[lamp])
                light += radiance[lamp] * (
                    (1 - ambient) * total / directions.shape[1] + ambient * facing[lamp] * alpha
                )
            for c in range(3):
                result[p, c] += share * (mean[1 + c] * light[c] + mean[4 + c] * alpha)
            result[p, 3] += share * alpha
    return result
