"""Colours of points: one colour, a scalar through a colour map, or the direction of the line."""

from __future__ import annotations

import functools

import numpy as np

from ..errors import SceneError
from ..scene.geometry import Geometry
from ..scene.shapes import Surface

#: Linear grey of points whose scalar is NaN.
MISSING = (0.2, 0.2, 0.2)
_TABLE = 1024


def linear(srgb: np.ndarray) -> np.ndarray:
    """Return sRGB in [0, 1] as linear light (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((np.maximum(srgb, 0) + 0.055) / 1.055) ** 2.4)


@functools.lru_cache(maxsize=32)
def color_table(name: str) -> np.ndarray:
    """Return a colour map of `cmap` as linear RGB, shape (1024, 3), float32.

    Raises
    ------
    SceneError
        If there is no such map.
    """
    from cmap import Colormap

    try:
        rgba = Colormap(name)(np.linspace(0, 1, _TABLE))
    except (ValueError, KeyError, TypeError):
        raise SceneError(
            "colormap", name, "a map's name, such as viridis, magma, turbo, coolwarm or cividis"
        ) from None
    return linear(np.asarray(rgba)[:, :3]).astype(np.float32)


def scalar_colors(values: np.ndarray, low: float, high: float, name: str) -> np.ndarray:
    """Return the linear RGB of values between the ends of a colour map, shape (n, 3), float32."""
    table = color_table(name)
    # The difference of two finite float32 may exceed their range: in double it does not.
    place = (values.astype(np.float64) - low) / max(high - low, 1e-300)
    known = np.isfinite(place)
    index = np.where(known, np.clip(place, 0, 1) * (_TABLE - 1) + 0.5, 0).astype(np.int32)
    colors = table[index]
    colors[~known] = MISSING
    return colors


def direction_colors(tangents: np.ndarray) -> np.ndarray:
    """Return the usual colours of directions: |x| red, |y| green, |z| blue, as sRGB made linear."""
    return linear(np.abs(tangents)).astype(np.float32)


def point_colors(geometry: Geometry, tangents: np.ndarray | None, values: np.ndarray | None) -> np.ndarray:
    """Return linear RGB for points of a geometry's shape, or of lines made of it.

    Parameters
    ----------
    tangents : ndarray, shape (n, 3), optional
        Unit directions of the lines (for ``color_by="direction"``; surfaces take their normals).
    values : ndarray, shape (n,), optional
        The scalar's values (for ``color_by="scalar"``).
    """
    if geometry.color_by == "scalar" and values is not None:
        low, high = geometry.color_range()
        return scalar_colors(values, low, high, geometry.colormap)
    if geometry.color_by == "direction" and tangents is not None:
        return direction_colors(tangents)
    count = len(tangents) if tangents is not None else geometry.shape.points.shape[0]
    if (
        geometry.color_by == "file"
        and isinstance(geometry.shape, Surface)
        and geometry.shape.colors is not None
    ):
        return geometry.shape.colors
    return np.broadcast_to(np.asarray(geometry.color, np.float32), (count, 3))
