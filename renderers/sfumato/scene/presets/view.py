"""The first view: what is visible fills the picture, upright, with its front towards the viewer."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..camera import STANDARD_VIEWS, Camera
from ..transfer import TransferFunction
from ..volume import Volume
from .table import face_side, suggest_clip
from .values import THIN
from .visible import outline, seen_cells

Vec3 = tuple[float, float, float]
Side = tuple[Vec3, Vec3]

#: A picture of which more than this share is one plane facing the viewer is of a cut, not of the subject.
FLAT = 0.7


def suggest_view(
    volume: Volume, transfer: TransferFunction | None, side: Side | None = None, **options: Any
) -> Camera:
    """Return a view of what a transfer function shows of a volume.

    Where the orientation is known that is the front view; else the same along the array's axes. What is
    much thinner along one axis than along the others is seen along that axis: a few axial slices from
    the feet, as radiologists do.

    Parameters
    ----------
    side : (side, up), optional
        Where to stand and what is up instead, as in `STANDARD_VIEWS`.
    **options
        As in `Camera.fit`: the picture's aspect, the lens.
    """
    cells = seen_cells(volume, transfer) if transfer is not None else None
    if cells is None or not cells.any():
        return Camera.fit(volume.corners(), side or "front", **options)
    points = outline(volume, cells)
    for plane in suggest_clip(volume):
        ahead = points @ plane.normal >= np.dot(plane.point, plane.normal)
        points = points[ahead] if ahead.any() else points
    return Camera.fit(points, side or _best_side(volume, cells, points), **options)


def _best_side(volume: Volume, cells: np.ndarray, points: np.ndarray) -> Side:
    known = volume.info.orientation_known
    axes = np.eye(3) if known else np.asarray(volume.direction)
    name = _thin_view(np.ptp(points @ axes, axis=0))
    if name is None:
        name = "front" if known else ("back" if face_side(volume) > 0 else _least_flat(cells))
    side, up = (_along(axes, v) for v in STANDARD_VIEWS[name])
    return side, up


def _thin_view(extent: np.ndarray) -> str | None:
    axis = int(extent.argmin())
    others = np.delete(extent, axis)
    if extent[axis] >= THIN * others.min() or axis == 1:
        return None
    return ("left", "", "bottom")[axis]


def _least_flat(cells: np.ndarray) -> str:
    """Return the front view, or where that faces a flat cut, the view that shows most relief."""
    flat = {
        name: _flatness(np.flip(cells, axis) if flip else cells, axis)
        for name, (axis, flip) in _SIDES.items()
    }
    return "front" if flat["front"] <= FLAT else min(flat, key=lambda name: flat[name])


#: Axis of an array (z, y, x) along which a view looks, and whether from its end.
_SIDES = {
    "front": (1, False),
    "top": (0, True),
    "left": (2, True),
    "right": (2, False),
    "back": (1, True),
    "bottom": (0, False),
}


def _flatness(cells: np.ndarray, axis: int) -> float:
    """Return the share of what is seen along an axis that lies as near as the nearest cells."""
    depth, seen = cells.argmax(axis=axis), cells.any(axis=axis)
    return float((depth[seen] <= depth[seen].min() + 1).mean())


def _along(axes: np.ndarray, direction: Vec3) -> Vec3:
    x, y, z = (axes @ np.asarray(direction, dtype=float)).tolist()
    return x, y, z
