"""A stage: occluders before a plain pale wall, or on a floor, in one volume, and a camera that looks at it.

The wall's value lies below the air's and the occluders' above it, so that interpolation between wall and air
never passes through the occluders' colours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from sfumato import Camera, TransferFunction, Volume, VolumeInfo

Vec3 = tuple[float, float, float]
Rgb = tuple[float, float, float]
#: Value of the air; the wall is 0, occluders go up to 255. Opacity begins half way to the wall.
AIR, TOP = 64, 255
#: Thickness of the wall in voxels, of 1 mm.
THICKNESS = 5
#: Linear colour of the wall, and opacity per mm of what is solid.
PALE: Rgb = (0.8, 0.78, 0.74)
SOLID = 0.999
#: Share of the wall's width that the picture shows, and vertical opening of a perspective view.
FILL, LENS = 0.96, 32.0


@dataclass(frozen=True)
class Placing:
    """Where things stand; lengths in voxels of 1 mm.

    Parameters
    ----------
    side : int
        Longest side of the occluders.
    wall : int
        Side of the square wall.
    gap : int
        Between the occluders and the wall.
    shift : (right, up)
        Of the occluders from the middle of the wall.
    elevation : float, optional
        With it the wall is a floor, which the camera looks down upon, so many degrees above the horizon.
    perspective : bool
        Instead of an orthographic view.
    """

    side: int = 56
    wall: int = 92
    gap: int = 6
    shift: tuple[int, int] = (0, 0)
    elevation: float | None = None
    perspective: bool = False


@dataclass(frozen=True)
class Stage:
    """A volume with a wall, the same without occluders, and the place of the wall's face.

    Attributes
    ----------
    center, normal : (x, y, z)
        Middle of the face in mm, and the direction towards the occluders.
    half : float
        Half the side of the square face in mm.
    """

    volume: Volume
    bare: Volume
    transfer: TransferFunction
    camera: Camera
    center: Vec3
    normal: Vec3
    half: float


def resampled(values: np.ndarray, spacing: Vec3, side: int) -> np.ndarray:
    """Return an array (z, y, x) on cubic voxels, ``side`` of them along the longest side; blurred first."""
    lengths = np.array(values.shape) * np.array(spacing[::-1])
    factor = side / lengths.max() * np.array(spacing[::-1])
    soft = ndimage.gaussian_filter(values.astype(np.float32), 0.4 * np.maximum(1 / factor - 1, 0))
    return np.asarray(ndimage.zoom(soft, factor, order=1, mode="nearest", grid_mode=True))


def transfer_function(points: tuple[tuple[float, Rgb, float], ...]) -> TransferFunction:
    """Return the wall's and the occluders' look; points are (value 0 to 1, linear rgb, opacity per mm)."""
    step = (TOP - AIR) / 1.0
    wall = [(0.0, PALE, SOLID), (0.4 * AIR, PALE, SOLID), (0.6 * AIR, PALE, 0.0), (float(AIR), PALE, 0.0)]
    return TransferFunction.from_points([*wall, *((AIR + step * t, rgb, a) for t, rgb, a in points)], 1.0)


def staged(occluders: np.ndarray, points: tuple[tuple[float, Rgb, float], ...], placing: Placing) -> Stage:
    """Put occluders before a wall.

    Parameters
    ----------
    occluders : ndarray, shape (z, y, x)
        0 (air) to 1, on cubic voxels.
    points : tuple
        See `transfer_function`.
    """
    floor = placing.elevation is not None
    body = np.rint(AIR + (TOP - AIR) * np.clip(occluders, 0, 1)).astype(np.uint8)
    # Built before a wall that stands behind, at the high end of y; a floor is the same, lying: z falls to it.
    body = np.flip(body.transpose(1, 0, 2), axis=1) if floor else body
    height, depth, width = body.shape
    face = 2 + depth + placing.gap
    bare = np.full((placing.wall, face + THICKNESS, placing.wall), AIR, dtype=np.uint8)
    bare[:, face:] = 0
    full = bare.copy()
    x, z = ((placing.wall - n) // 2 + s for n, s in zip((width, height), placing.shift, strict=True))
    full[_inside(z, height, placing.wall), 2 : 2 + depth, _inside(x, width, placing.wall)] = body
    middle, normal = (placing.wall / 2, float(face), placing.wall / 2), (0.0, -1.0, 0.0)
    if floor:
        full, bare = (np.flip(a, axis=1).transpose(1, 0, 2).copy() for a in (full, bare))
        middle, normal = (middle[0], middle[2], float(THICKNESS)), (0.0, 0.0, 1.0)
    info = VolumeInfo(name="stage")
    return Stage(
        Volume(full, info=info),
        Volume(bare, info=info),
        transfer_function(points),
        _camera(middle, placing),
        middle,
        normal,
        placing.wall / 2,
    )


def _inside(first: int, count: int, limit: int) -> slice:
    assert 0 <= first <= limit - count, "the occluders must stand within the wall's outline"
    return slice(first, first + count)


def _camera(middle: Vec3, placing: Placing) -> Camera:
    half = FILL * placing.wall / 2
    away = half / math.tan(math.radians(LENS) / 2)
    rise = math.radians(placing.elevation or 0.0)
    eye = (middle[0], middle[1] - away * math.cos(rise), middle[2] + away * math.sin(rise))
    return Camera(
        position=eye,
        focal_point=middle,
        view_angle=LENS,
        parallel_projection=not placing.perspective,
        parallel_scale=half,
    )
