"""Changes of a whole transfer function: its colours from a library's map, and its mirror along the values."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .transfer import TransferFunction, TransferPoint
from .transfer_edit import point_at

#: Maps that are offered, by their names in `cmap`: even to the eye, or usual in the field.
COLOR_MAPS = {
    "Grey": "matlab:gray", "Bone": "matlab:bone", "Viridis": "bids:viridis", "Magma": "bids:magma",
    "Inferno": "bids:inferno", "Plasma": "bids:plasma", "Cividis": "cividis", "Ice": "cmocean:ice",
    "Thermal": "cmocean:thermal", "Matter": "cmocean:matter", "Lapaz": "crameri:lapaz", "Batlow": "crameri:batlow",
    "Lajolla": "crameri:lajolla", "Hot": "matlab:hot", "Cool to warm": "matplotlib:coolwarm",
    "Vik": "crameri:vik",
}  # fmt: skip
#: Points lie at least so close to each other, in parts of the map, that colours between them are those of the map.
CLOSE = 1 / 10


def map_colors(name: str, shares: np.ndarray) -> np.ndarray:
    """Return the linear RGB of a map of `cmap` at places from 0 to 1, shape (n, 3).

    Raises
    ------
    SceneError
        If there is no such map.
    """
    from ..geometry.color import color_table

    table = color_table(name)
    at = np.clip(shares, 0, 1) * (len(table) - 1)
    return np.stack([np.interp(at, np.arange(len(table)), channel) for channel in table.T], axis=-1)


def seen_range(transfer: TransferFunction) -> tuple[float, float]:
    """Return the values between which a function shows anything, from the last point of no opacity on."""
    points = transfer.points
    seen = [i for i, point in enumerate(points) if point.opacity > 0]
    if not seen:
        return points[0].value, points[-1].value
    return points[max(seen[0] - 1, 0)].value, points[min(seen[-1] + 1, len(points) - 1)].value


def colored(transfer: TransferFunction, name: str) -> TransferFunction:
    """Return the function with the colours of a map over the values that it shows; opacities stay.

    Points are added where two are so far apart that colours between them would not be those of the map.

    Parameters
    ----------
    name : str
        A map of `cmap`, such as ``bids:viridis``.

    Raises
    ------
    SceneError
        If there is no such map.
    """
    low, high = seen_range(transfer)
    span = high - low if high > low else 1.0
    points = _denser(transfer, low, high, CLOSE * span)
    colors = map_colors(name, np.array([(p.value - low) / span for p in points]))
    painted = tuple(replace(p, color=_rgb(c)) for p, c in zip(points, colors, strict=True))
    shapes = transfer.regions
    if shapes:
        middles = np.array([(sum(shape.value) / 2 - low) / span for shape in shapes])
        colors = map_colors(name, middles)
        shapes = tuple(replace(s, color=_rgb(c)) for s, c in zip(shapes, colors, strict=True))
    return replace(transfer, points=painted, regions=shapes)


def _denser(transfer: TransferFunction, low: float, high: float, most: float) -> list[TransferPoint]:
    """Return the points, with more of them where two that are seen lie farther apart than that."""
    points = [transfer.points[0]]
    for point in transfer.points[1:]:
        first = points[-1].value
        if first >= low and point.value <= high:
            parts = int(np.ceil((point.value - first) / most - 1e-9))
            between = first + (point.value - first) * np.arange(1, parts) / max(parts, 1)
            points += [point_at(transfer, float(value)) for value in between]
        points.append(point)
    return points


def inverted(transfer: TransferFunction) -> TransferFunction:
    """Return the function mirrored along the values, about the middle of its points: what was low is high."""
    pivot = transfer.points[0].value + transfer.points[-1].value
    points = tuple(replace(p, value=pivot - p.value) for p in reversed(transfer.points))
    shapes = tuple(
        replace(
            s,
            value=(pivot - s.value[1], pivot - s.value[0]),
            points=tuple((pivot - value, gradient) for value, gradient in s.points),
        )
        for s in transfer.regions
    )
    return replace(transfer, points=points, regions=shapes)


def _rgb(color: np.ndarray) -> tuple[float, float, float]:
    red, green, blue = (float(c) for c in color)
    return red, green, blue


__all__ = ["COLOR_MAPS", "colored", "inverted", "map_colors", "seen_range"]
