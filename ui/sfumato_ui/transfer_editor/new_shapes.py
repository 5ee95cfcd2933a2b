"""Where a new shape lies, and in which colour."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qtpy.QtCore import QPointF

from sfumato import Region
from sfumato.scene import region_edit

from .plane import Plane

#: Least sides of a shape in pixels.
LEAST = 4.0
#: Pixels by which a shape that would cover another just so lies aside.
ASIDE = 14.0
#: Parts of the view that a new shape takes, across and up, and its opacity.
_PART, _OPACITY = (0.2, 0.28), 0.5
#: Pixels by which a drawn outline may be simplified.
_TOLERANCE = 1.5
#: Linear RGB of skin, bone, blood, vein, nerve.
_COLOURS = ((0.75, 0.45, 0.3), (0.8, 0.7, 0.5), (0.6, 0.08, 0.06), (0.12, 0.3, 0.6), (0.75, 0.6, 0.1))


def new_region(shape: str, plane: Plane, about: QPointF, others: Sequence[Region]) -> Region:
    """Return a region about a place, as far as it fits into the view, aside of those that lie there just so."""
    rect = plane.rect
    half = QPointF(_PART[0] * rect.width() / 2, _PART[1] * rect.height() / 2)
    middle = QPointF(
        min(max(about.x(), rect.left() + half.x()), rect.right() - half.x()),
        min(max(about.y(), rect.top() + half.y()), rect.bottom() - half.y()),
    )
    (v0, g1), (v1, g0) = plane.pair(middle - half), plane.pair(middle + half)
    made = Region(shape, (v0, v1), (max(0.0, g0), g1), color=_next_color(others), opacity=_OPACITY)
    while any(np.allclose(made.extent, other.extent) for other in others):
        made = aside(made, plane)
    return made


def aside(region: Region, plane: Plane) -> Region:
    """Return a region a few pixels to the right and above."""
    across, up = plane.per_pixel
    return region_edit.moved(region, ASIDE * across, ASIDE * up)


def drawn_region(drawn: Sequence[QPointF], plane: Plane, others: Sequence[Region]) -> Region | None:
    """Return the region of an outline that was drawn, or None if it is none."""
    places = np.array([[p.x(), p.y()] for p in drawn])
    if np.ptp(places, axis=0).min() < LEAST:
        return None
    corners = region_edit.simplified(places, _TOLERANCE)
    if len(corners) > 3 and np.hypot(*(corners[0] - corners[-1])) < 3 * LEAST:
        corners = corners[:-1]  # it ends where it began
    if len(corners) < 3:
        return None
    pairs = [plane.pair(QPointF(x, y)) for x, y in corners.tolist()]
    points = tuple((value, max(0.0, gradient)) for value, gradient in pairs)
    return Region("polygon", points=points, color=_next_color(others), opacity=_OPACITY)


def _next_color(others: Sequence[Region]) -> tuple[float, float, float]:
    """Return a colour that the shapes do not have yet."""
    used = {region.color for region in others}
    return next((c for c in _COLOURS if c not in used), _COLOURS[len(others) % len(_COLOURS)])
