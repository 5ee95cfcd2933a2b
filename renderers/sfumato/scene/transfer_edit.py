"""Edits of a transfer function's points: each takes a function and returns a changed one.

Where the order of the points can change, the place of the point in question is returned with it, so that
an editor keeps it selected.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from .transfer import TransferFunction, TransferPoint

#: Points that always stay.
MIN_POINTS = 2


def point_at(transfer: TransferFunction, value: float) -> TransferPoint:
    """Return the point that can be put into a function at a value without changing it."""
    found = [float(v) for v in transfer.evaluate(np.array([value]))[0]]
    return TransferPoint(value, (found[0], found[1], found[2]), found[3], (found[4], found[5], found[6]))


def with_point_added(transfer: TransferFunction, point: TransferPoint) -> tuple[TransferFunction, int]:
    """Return the function with a point more, and that point's index."""
    index = sum(p.value <= point.value for p in transfer.points)
    points = (*transfer.points[:index], point, *transfer.points[index:])
    return replace(transfer, points=points), index


def without_point(transfer: TransferFunction, index: int) -> TransferFunction:
    """Return the function without a point; at least two stay."""
    if len(transfer.points) <= MIN_POINTS:
        return transfer
    return replace(transfer, points=transfer.points[:index] + transfer.points[index + 1 :])


def with_point_changed(
    transfer: TransferFunction, index: int, **changes: Any
) -> tuple[TransferFunction, int]:
    """Return the function with other fields of one point, and the point's new index.

    Raises
    ------
    SceneError
        If a field is out of range.
    """
    point = replace(transfer.points[index], **changes)
    before, after = transfer.points[:index], transfer.points[index + 1 :]
    # At equal values the point keeps its side: a step stays a step.
    while before and before[-1].value > point.value:
        before, after = before[:-1], (before[-1], *after)
    while after and after[0].value < point.value:
        before, after = (*before, after[0]), after[1:]
    return replace(transfer, points=(*before, point, *after)), len(before)


def between_neighbours(transfer: TransferFunction, index: int, value: float) -> float:
    """Return the value nearest to the wanted one that keeps a point between its neighbours."""
    points = transfer.points
    low = points[index - 1].value if index > 0 else float("-inf")
    high = points[index + 1].value if index + 1 < len(points) else float("inf")
    return min(max(value, low), high)


def level_and_width(transfer: TransferFunction) -> tuple[float, float]:
    """Return the middle between the first and the last point, and their distance, in values."""
    low, high = transfer.points[0].value, transfer.points[-1].value
    return (low + high) / 2, high - low


def scaled_about(
    transfer: TransferFunction, pivot: float, scale: float, shift: float = 0.0
) -> TransferFunction:
    """Return the function stretched about a value by a factor, and then moved along the values."""
    return transfer.rescaled(scale, pivot * (1 - scale) + shift)
