"""What of a two-dimensional function lies under the pointer: handles of the selected shape, shapes, their edges."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from qtpy.QtCore import QPointF

from sfumato import Region
from sfumato.scene.region_edit import MIDDLE, handles, outline, topmost

from .canvas import HIT
from .plane import Plane

#: Sides shorter than so many pixels have no handle in their middle: the corners' and the centre's come first.
_ROOM = 3 * HIT


def handle_places(region: Region, plane: Plane) -> dict[str, QPointF]:
    """Return the places of a region's handles by name: those of the part in view, at the plot's edge at most."""
    if region.shape == "polygon":
        return {name: plane.clamped(plane.at(*pair)) for name, pair in handles(region).items()}
    (v0, v1), (g0, g1) = region.extent
    low, high = plane.clamped(plane.at(v0, g0)), plane.clamped(plane.at(v1, g1))
    wide, tall = high.x() - low.x(), low.y() - high.y()
    box = Region(value=(0, 1), gradient=(0, 1))
    left_out = ("upper", "lower") * (wide < _ROOM) + ("left", "right") * (tall < _ROOM)
    # What a curve shows does not move with it: its edges alone cut it to a part.
    left_out += (MIDDLE,) * (region.shape == "curve")
    return {
        name: QPointF(low.x() + u * wide, low.y() - v * tall)
        for name, (u, v) in handles(box).items()
        if name not in left_out
    }


def handle_at(region: Region, plane: Plane, at: QPointF) -> str:
    """Return the handle of a region within reach of a place, or nothing."""
    away = {
        name: math.hypot(place.x() - at.x(), place.y() - at.y())
        for name, place in handle_places(region, plane).items()
    }
    nearest = min(away, key=away.__getitem__, default="")
    return nearest if nearest and away[nearest] <= HIT else ""


def region_at(regions: Sequence[Region], plane: Plane, at: QPointF, selected: int) -> int:
    """Return the region at a place, the selected one first, else the one whose edge is within reach; -1: none."""
    if not plane.rect.adjusted(-HIT, -HIT, HIT, HIT).contains(at):
        return -1
    value, gradient = plane.pair(plane.clamped(at))
    inside = [i for i, region in enumerate(regions) if topmost((region,), value, gradient) == 0]
    # A curve lies under everything that is drawn upon it.
    solid = [i for i in inside if regions[i].shape != "curve"]
    if solid:
        return selected if selected in solid else solid[-1]
    away = {i: _away(region, plane, at) for i, region in enumerate(regions)}
    nearest = min(away, key=away.__getitem__, default=-1)
    if nearest >= 0 and away[nearest] <= HIT:
        return nearest
    return inside[-1] if inside else -1


def _away(region: Region, plane: Plane, at: QPointF) -> float:
    """Return the distance in pixels of a place from a region's edge."""
    corners = plane.places(outline(region))
    way = np.roll(corners, -1, axis=0) - corners
    to = np.array([at.x(), at.y()]) - corners
    along = np.clip((to * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-12), 0, 1)
    return float(np.hypot(*(to - along[:, None] * way).T).min())
