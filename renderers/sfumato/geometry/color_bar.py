"""The colour bar of a geometry that is coloured by a scalar: what a picture needs to draw one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..scene.geometry import Geometry
from ..scene.scene import Scene
from .color import color_table


@dataclass(frozen=True)
class ColorBar:
    """A strip of colours and the values beside it.

    Parameters
    ----------
    title : str
        The scalar's name.
    low, high : float
        Values at both ends.
    ticks : tuple of (value, text)
        Round values between them, three to six.
    colors : ndarray, shape (1024, 3), float32
        Linear RGB from low to high.
    """

    title: str
    low: float
    high: float
    ticks: tuple[tuple[float, str], ...]
    colors: np.ndarray


def color_bar(geometry: Geometry) -> ColorBar | None:
    """Return the colour bar of a geometry, or nothing if no scalar colours it."""
    if geometry.color_by != "scalar":
        return None
    low, high = geometry.color_range()
    return ColorBar(geometry.scalar, low, high, round_ticks(low, high), color_table(geometry.colormap))


def color_bars(scene: Scene) -> tuple[ColorBar, ...]:
    """Return the colour bars of all geometry that is seen; alike ones once."""
    found: dict[tuple[object, ...], ColorBar] = {}
    for geometry in scene.geometry:
        bar = color_bar(geometry) if geometry.visible else None
        if bar is not None:
            found.setdefault((bar.title, bar.low, bar.high, geometry.colormap), bar)
    return tuple(found.values())


def round_ticks(low: float, high: float) -> tuple[tuple[float, str], ...]:
    """Return three to six round values from low to high, with their texts.

    Parameters
    ----------
    low, high : float
        The ends, low < high.
    """
    rough = (high - low) / 4
    power = 10.0 ** math.floor(math.log10(rough))
    step = min((m * power for m in (1, 2, 2.5, 5, 10)), key=lambda s: abs(math.log(s / rough)))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return tuple((k * step, f"{k * step + 0.0:.6g}") for k in range(first, last + 1))
