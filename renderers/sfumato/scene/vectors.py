"""Small things done with places and boxes in space."""

from __future__ import annotations

import math

import numpy as np

Vec3 = tuple[float, float, float]


def vec3(values: np.ndarray) -> Vec3:
    """Return three numbers as the tuple of floats that scenes hold."""
    x, y, z = (float(v) for v in values)
    return x, y, z


def box_corners(bounds: np.ndarray) -> np.ndarray:
    """Return the corners, shape (8, 3), of the box between the smallest and largest coordinates, shape (2, 3)."""
    return np.array(
        [[bounds[i, 0], bounds[j, 1], bounds[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    )


def angles_of(towards: np.ndarray) -> tuple[float, float]:
    """Return tilt and rotation in degrees of a unit vector (right, up, back)."""
    tilt = math.degrees(math.acos(max(-1.0, min(1.0, float(towards[2])))))
    return tilt, math.degrees(math.atan2(towards[1], towards[0])) % 360.0


__all__ = ["Vec3", "angles_of", "box_corners", "vec3"]
