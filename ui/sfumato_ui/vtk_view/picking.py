"""Which line lies under the pointer: found in the picture, so that what is picked is what was clicked. No Qt, no VTK.

VTK's own cell picker takes whatever comes first along the ray within a tolerance in space, so it prefers a line that
passes before the one under the pointer, several pixels beside it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..tools.view import PictureView

#: How near a click must come to a line, in pixels.
REACH = 6.0
#: So near lines count as under the pointer: of these the nearest to the eye is taken.
UNDER = 2.0


@dataclass(frozen=True)
class Found:
    """A place on a line.

    Attributes
    ----------
    cell : int
        Which of the lines.
    point : ndarray, shape (3,)
        World mm, on the line.
    depth : float
        mm before the eye.
    away : float
        Pixels from where it was asked for.
    """

    cell: int
    point: np.ndarray
    depth: float
    away: float


def line_under(
    view: PictureView,
    at: tuple[float, float],
    points: np.ndarray,
    offsets: np.ndarray,
    before: float = np.inf,
) -> Found | None:
    """Return the line under, or else nearest to, a place of the picture.

    Parameters
    ----------
    at : (float, float)
        Widget pixels from the upper left.
    points : ndarray, shape (n, 3)
        World mm, line after line.
    offsets : ndarray, shape (lines + 1,)
        Where each line begins.
    before : float
        mm from the eye; what lies behind is hidden.
    """
    joined = np.ones(max(len(points) - 1, 0), dtype=bool)
    joined[np.asarray(offsets[1:-1], dtype=int) - 1] = False
    first = np.flatnonzero(joined)
    if not len(first):
        return None
    places = view.places(points) - np.asarray(at)
    depths = view.depths(points)
    start, way = places[first], places[first + 1] - places[first]
    with np.errstate(invalid="ignore", divide="ignore"):  # NaN: behind the eye
        length2 = np.maximum(np.einsum("ij,ij->i", way, way), 1e-12)
        share = np.clip(-np.einsum("ij,ij->i", start, way) / length2, 0, 1)
        away = np.hypot(*(start + share[:, None] * way).T)
        if not view.camera.parallel_projection:  # halfway in the picture is not halfway in space
            share = share * depths[first] / (depths[first + 1] + share * (depths[first] - depths[first + 1]))
        depth = depths[first] + share * (depths[first + 1] - depths[first])
        near = np.flatnonzero((away <= REACH) & (depth <= before))
    if not len(near):
        return None
    under = near[away[near] <= UNDER]
    best = int(under[np.argmin(depth[under])] if len(under) else near[np.argmin(away[near])])
    point = points[first[best]] + share[best] * (points[first[best] + 1] - points[first[best]])
    cell = int(np.searchsorted(offsets, first[best], side="right")) - 1
    return Found(cell, np.asarray(point, dtype=float), float(depth[best]), float(away[best]))


def under_pointer(view: PictureView, at: tuple[float, float], depth: float) -> tuple[float, float, float]:
    """Return the world point that is seen at a place of the picture, at a depth in mm."""
    start, along = view.ray(at)
    first = view.depth(start)
    rate = view.depth(start + along) - first
    x, y, z = start + along * ((depth - first) / rate)
    return float(x), float(y), float(z)
