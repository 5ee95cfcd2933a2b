"""Edits of a two-dimensional function's regions, and the way from one dimension to two and back.

Places are pairs of a value and a gradient magnitude (value per mm). A region is taken by its handles: the
corners and edges of its box, or a polygon's own corners, and its middle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from .joint_histogram import steepest_possible
from .region import Corner, Region
from .transfer import TransferFunction
from .volume import Volume

MIDDLE = "middle"
#: Share of the volume's values by which a curve over everything is wider than they are.
_MARGIN = 0.02
#: Corners that a freehand outline keeps at most.
MOST_CORNERS = 24
#: A box's handles: which side of the value and of the gradient each holds (0 low, 1 high, None: neither).
_BOX: dict[str, tuple[int | None, int | None]] = {
    "lower left": (0, 0), "lower right": (1, 0), "upper left": (0, 1), "upper right": (1, 1),
    "left": (0, None), "right": (1, None), "lower": (None, 0), "upper": (None, 1),
}  # fmt: skip


# -- the list of regions ----------------------------------------------------------------------------
def with_region_added(
    transfer: TransferFunction, region: Region, index: int | None = None
) -> tuple[TransferFunction, int]:
    """Return the function with a region more, laid over all others or put at a place, and that place."""
    at = len(transfer.regions) if index is None else index
    regions = (*transfer.regions[:at], region, *transfer.regions[at:])
    return replace(transfer, regions=regions), at


def without_region(transfer: TransferFunction, index: int) -> TransferFunction:
    """Return the function without a region; the last one stays: without any, the points would show."""
    if len(transfer.regions) <= 1:
        return transfer
    return replace(transfer, regions=transfer.regions[:index] + transfer.regions[index + 1 :])


def with_region_changed(transfer: TransferFunction, index: int, **changes: Any) -> TransferFunction:
    """Return the function with other fields of one region.

    Raises
    ------
    SceneError
        If a field is out of range.
    """
    return with_region(transfer, index, replace(transfer.regions[index], **changes))


def with_region(transfer: TransferFunction, index: int, region: Region) -> TransferFunction:
    """Return the function with another region in the place of one."""
    return replace(transfer, regions=(*transfer.regions[:index], region, *transfer.regions[index + 1 :]))


def reordered(transfer: TransferFunction, index: int, by: int) -> tuple[TransferFunction, int]:
    """Return the function with a region laid over (1) or under (-1) its neighbour, and its new place."""
    at = min(max(index + by, 0), len(transfer.regions) - 1)
    regions = list(transfer.regions)
    regions.insert(at, regions.pop(index))
    return replace(transfer, regions=tuple(regions)), at


# -- one region -------------------------------------------------------------------------------------
def handles(region: Region) -> dict[str, Corner]:
    """Return the places of a region's handles by their names."""
    (v0, v1), (g0, g1) = region.extent
    middle = {MIDDLE: ((v0 + v1) / 2, (g0 + g1) / 2)}
    if region.shape == "polygon":
        return {f"corner {i + 1}": corner for i, corner in enumerate(region.points)} | middle
    sides = {None: 0.5, 0: 0.0, 1: 1.0}
    return {
        name: (v0 + (v1 - v0) * sides[side], g0 + (g1 - g0) * sides[end])
        for name, (side, end) in _BOX.items()
    } | middle


def with_handle_at(region: Region, handle: str, place: Corner, least: Corner) -> Region:
    """Return a region with one of its handles at another place.

    Parameters
    ----------
    least : (float, float)
        Smallest width in values and height in gradients that a box keeps.
    """
    place = place[0], max(0.0, place[1])
    if handle == MIDDLE:
        (value, gradient) = handles(region)[MIDDLE]
        return moved(region, place[0] - value, place[1] - gradient)
    if region.shape == "polygon":
        index = int(handle.split()[1]) - 1
        return replace(region, points=(*region.points[:index], place, *region.points[index + 1 :]))
    extents = [list(region.value), list(region.gradient)]
    for extent, side, at, room in zip(extents, _BOX[handle], place, least, strict=True):
        if side == 0:
            extent[0] = min(at, extent[1] - room)
        elif side == 1:
            extent[1] = max(at, extent[0] + room)
    (v0, v1), (g0, g1) = extents
    return replace(region, value=(v0, v1), gradient=(g0, g1))


def moved(region: Region, values: float, gradients: float) -> Region:
    """Return a region moved along both axes; it stops at gradient 0."""
    gradients = max(gradients, min(0.0, -region.extent[1][0]))
    (v0, v1), (g0, g1) = region.value, region.gradient
    return replace(
        region,
        value=(v0 + values, v1 + values),
        gradient=(g0 + gradients, g1 + gradients),
        points=tuple((v + values, g + gradients) for v, g in region.points),
    )


def with_extent(region: Region, value: Corner, gradient: Corner) -> Region:
    """Return a region stretched to other extents, each low < high.

    Raises
    ------
    SceneError
        If an extent is empty.
    """
    if region.shape != "polygon":
        return replace(region, value=value, gradient=gradient)
    (v0, v1), (g0, g1) = region.extent
    points = tuple(
        (
            value[0] + (v - v0) / ((v1 - v0) or 1) * (value[1] - value[0]),
            gradient[0] + (g - g0) / ((g1 - g0) or 1) * (gradient[1] - gradient[0]),
        )
        for v, g in region.points
    )
    Region("rectangle", value, gradient)  # refuses empty ones, as it would for other shapes
    return replace(region, points=points)


def outline(region: Region, steps: int = 64) -> np.ndarray:
    """Return the corners of a region's edge, shape (n, 2); an ellipse's are many."""
    (v0, v1), (g0, g1) = region.extent
    if region.shape == "polygon":
        return np.asarray(region.points, dtype=float)
    if region.shape == "ellipse":
        angle = np.linspace(0, 2 * np.pi, steps, endpoint=False)
        u, v = (1 + np.cos(angle)) / 2, (1 + np.sin(angle)) / 2
    else:
        narrow = 0.45 if region.shape == "trapezoid" else 0.0
        u, v = np.array([narrow, 1 - narrow, 1, 0]), np.array([0, 0, 1, 1])
    return np.stack([v0 + (v1 - v0) * u, g0 + (g1 - g0) * v], axis=-1)


def topmost(regions: Sequence[Region], value: float, gradient: float, preferred: int = -1) -> int:
    """Return which region is met at a place: the preferred one if it is there, else the topmost; -1: none."""
    there = [i for i, region in enumerate(regions) if _holds(region, value, gradient)]
    return preferred if preferred in there else there[-1] if there else -1


def _holds(region: Region, value: float, gradient: float) -> bool:
    hard = replace(region, feather=0.0)
    return bool(hard.coverage(np.array(value), np.array(gradient)) > 0)


def simplified(places: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the corners that an outline (n, 2) needs, to within a tolerance in its own unit (Douglas1973)."""
    while (needed := _needed(places, tolerance)).sum() > MOST_CORNERS:
        tolerance *= 1.5
    return np.asarray(places[needed])


def _needed(places: np.ndarray, tolerance: float) -> np.ndarray:
    """Return which places are farther than the tolerance from the line between their kept neighbours."""
    needed = np.zeros(len(places), dtype=bool)
    needed[[0, -1]] = True
    open_parts = [(0, len(places) - 1)]
    while open_parts:
        first, last = open_parts.pop()
        if last - first < 2:
            continue
        way, away = places[last] - places[first], places[first + 1 : last] - places[first]
        length = float(np.hypot(*way))
        distance = (
            np.abs(away[:, 0] * way[1] - away[:, 1] * way[0]) / length if length > 0 else np.hypot(*away.T)
        )
        if distance.max() > tolerance:
            middle = first + 1 + int(distance.argmax())
            needed[middle] = True
            open_parts += [(first, middle), (middle, last)]
    return needed


# -- one dimension and two ---------------------------------------------------------------------------
def whole_curve(volume: Volume) -> Region:
    """Return the curve over all values and gradients of a volume: with it alone, the picture is the points' own."""
    low, high = volume.value_range
    margin = _MARGIN * (high - low) or 0.5
    steepest = steepest_possible(volume) or 1.0
    return Region("curve", (low - margin, high + margin), (0.0, steepest), opacity=1.0, feather=0.0)


def two_dimensional(
    transfer: TransferFunction, volume: Volume, regions: tuple[Region, ...] = ()
) -> TransferFunction:
    """Return a function of the gradient too: by these regions, else one that shows what the points show."""
    return replace(transfer, regions=regions or (whole_curve(volume),))


def one_dimensional(transfer: TransferFunction, suggested: TransferFunction) -> TransferFunction:
    """Return the function by its points; where it was made without any, with those of another."""
    none_of_its_own = transfer.points == TransferFunction().points
    points = suggested.points if none_of_its_own else transfer.points
    return replace(transfer, points=points, regions=())


__all__ = [
    "MIDDLE",
    "handles",
    "moved",
    "one_dimensional",
    "outline",
    "reordered",
    "simplified",
    "topmost",
    "two_dimensional",
    "whole_curve",
    "with_extent",
    "with_handle_at",
    "with_region",
    "with_region_added",
    "with_region_changed",
    "without_region",
]
