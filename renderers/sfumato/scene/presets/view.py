"""The first view: what is visible fills the picture, upright, with its front towards the viewer."""

from __future__ import annotations

import numpy as np

from ..camera import STANDARD_VIEWS, Camera
from ..transfer import TransferFunction
from ..volume import Volume
from .visible import seen_points

Vec3 = tuple[float, float, float]

#: A subject thinner than this share of its other extents is seen along its thin axis.
THIN = 0.35


def suggest_view(volume: Volume, transfer: TransferFunction | None) -> Camera:
    """Return a view of what a transfer function shows of a volume.

    Where the orientation is known that is the front view; else the same along the array's axes. What is
    much thinner along one axis than along the others is seen along that axis: a few axial slices from
    the feet, as radiologists do.
    """
    from .table import face_side

    points = seen_points(volume, transfer) if transfer is not None else None
    if points is None:
        return Camera.standard(volume)
    axes = np.eye(3) if volume.info.orientation_known else np.asarray(volume.direction)
    extent = np.ptp(points @ axes, axis=0)
    name = _thin_view(extent) or (
        "front" if volume.info.orientation_known or face_side(volume) <= 0 else "back"
    )
    side, up = (_along(axes, v) for v in STANDARD_VIEWS[name])
    return Camera.fit(points, (side, up))


def _thin_view(extent: np.ndarray) -> str | None:
    axis = int(extent.argmin())
    others = np.delete(extent, axis)
    if extent[axis] >= THIN * others.min() or axis == 1:
        return None
    return ("left", "", "bottom")[axis]


def _along(axes: np.ndarray, direction: Vec3) -> Vec3:
    x, y, z = (axes @ np.asarray(direction, dtype=float)).tolist()
    return x, y, z
