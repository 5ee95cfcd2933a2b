"""Regions of the plane of value and gradient magnitude: of what two-dimensional transfer functions are made."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from ..errors import SceneError
from .params import Param, check

RGB = tuple[float, float, float]
Corner = tuple[float, float]
SHAPES = ("rectangle", "ellipse", "trapezoid", "polygon", "curve")
#: Samples across a polygon from which its deepest place is judged.
_ACROSS = 48


@dataclass(frozen=True)
class Region:
    """A shape in the plane of value and gradient magnitude, for two-dimensional functions.

    Parameters
    ----------
    shape : str
        ``rectangle``, ``ellipse``, ``trapezoid`` (narrow at its low-gradient end), ``polygon``, or ``curve``: a
        rectangle in which the function's points show, `opacity` of what they show.
    value, gradient : (float, float)
        Extent along value and along gradient magnitude (value per mm).
    points : tuple of (value, gradient)
        Corners of a polygon.
    feather : float
        Fraction of the shape over which opacity fades to nothing at its edge, 0 to 1. An edge at gradient 0
        does not fade: nothing lies below it.
    """

    shape: Annotated[str, Param("Shape", choices=SHAPES)] = "rectangle"
    value: tuple[float, float] = (0.0, 1.0)
    gradient: tuple[float, float] = (0.0, 1.0)
    points: tuple[Corner, ...] = ()
    color: Annotated[RGB, Param("Linear RGB", ge=0, le=1)] = (1.0, 1.0, 1.0)
    opacity: Annotated[float, Param("Opacity at unit distance", ge=0, le=1)] = 0.5
    emission: Annotated[RGB, Param("Linear RGB given off", ge=0, le=1000)] = (0.0, 0.0, 0.0)
    feather: Annotated[float, Param("Soft edge", ge=0, le=1)] = 0.2

    def __post_init__(self) -> None:
        check(self)
        if self.shape == "polygon" and len(self.points) < 3:
            raise SceneError("points", self.points, "a polygon needs at least three corners")
        if self.shape != "polygon" and not (
            self.value[0] < self.value[1] and self.gradient[0] < self.gradient[1]
        ):
            raise SceneError("value", (self.value, self.gradient), "each extent needs low < high")

    @property
    def look(self) -> np.ndarray:
        """Colour, opacity within the region and emission; shape (7,). A curve's come from the points."""
        return np.array([*self.color, 1.0, *self.emission])

    @property
    def extent(self) -> tuple[Corner, Corner]:
        """Lowest and highest value, and lowest and highest gradient magnitude."""
        if self.shape != "polygon":
            return self.value, self.gradient
        corners = np.asarray(self.points, dtype=float)
        (v0, g0), (v1, g1) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
        return (v0, v1), (g0, g1)

    def rescaled(self, scale: float, offset: float) -> Region:
        """Return the region with every value v moved to ``scale * v + offset``."""
        low, high = sorted(v * scale + offset for v in self.value)
        return replace(self, value=(low, high), points=tuple((v * scale + offset, g) for v, g in self.points))

    def coverage(self, value: np.ndarray, gradient: np.ndarray) -> np.ndarray:
        """Return how much of the region's opacity holds at each (value, gradient), 0 to 1."""
        if self.shape == "polygon":
            return _faded_polygon(self.points, value, gradient, self.feather)
        u = 2 * (value - self.value[0]) / (self.value[1] - self.value[0]) - 1
        v = (gradient - self.gradient[0]) / (self.gradient[1] - self.gradient[0])
        if self.shape == "ellipse":
            depth = 1 - np.hypot(u, 2 * v - 1)
        else:
            # A trapezoid's half width grows from a tenth at its low end to the whole at its high end.
            width = np.clip(0.1 + 0.9 * v, 1e-6, None) if self.shape == "trapezoid" else 1.0
            up = np.where(v >= 0, 2 - 2 * v, -1) if self.gradient[0] <= 0 else 1 - np.abs(2 * v - 1)
            depth = np.minimum(1 - np.abs(u) / width, up)
        return np.clip(depth / max(self.feather, 1e-6), 0, 1)


def _faded_polygon(
    points: tuple[Corner, ...], value: np.ndarray, gradient: np.ndarray, feather: float
) -> np.ndarray:
    """Return 1 inside a polygon, fading towards its edges by their distance, as seen in its bounding box."""
    x, y = np.broadcast_arrays(value, gradient)
    corners = np.asarray(points, dtype=float)
    inside = inside_polygon(x, y, corners)
    covered = inside.astype(float)
    if feather > 0 and inside.any():
        depth = _depth(points, np.stack([x[inside], y[inside]], axis=-1)) / _deepest(points)
        covered[inside] = np.clip(depth / feather, 0, 1)
    return covered


def _depth(points: tuple[Corner, ...], at: np.ndarray) -> np.ndarray:
    """Return the distance of places (n, 2) from a polygon's edges, in half its width and half its height."""
    corners = np.asarray(points, dtype=float)
    half = np.maximum((corners.max(axis=0) - corners.min(axis=0)) / 2, 1e-12)
    nearest = np.full(len(at), np.inf)
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if start[1] <= 0 and end[1] <= 0:
            continue  # nothing lies below gradient 0
        way, away = (end - start) / half, (at - start) / half
        along = np.clip(away @ way / max(float(way @ way), 1e-24), 0, 1)
        nearest = np.minimum(nearest, np.linalg.norm(away - along[:, None] * way, axis=1))
    return nearest


@functools.lru_cache(maxsize=64)
def _deepest(points: tuple[Corner, ...]) -> float:
    """Return the largest depth inside a polygon."""
    corners = np.asarray(points, dtype=float)
    low, high = corners.min(axis=0), corners.max(axis=0)
    share = (np.arange(_ACROSS) + 0.5) / _ACROSS
    x, y = np.meshgrid(*(low[i] + (high[i] - low[i]) * share for i in (0, 1)))
    inside = inside_polygon(x, y, corners)
    deepest = _depth(points, np.stack([x[inside], y[inside]], axis=-1)).max(initial=0.0)
    return float(deepest) if np.isfinite(deepest) and deepest > 0 else 1.0


def inside_polygon(x: np.ndarray, y: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Tell which places lie inside a polygon with corners (n, 2), by the even-odd rule."""
    x, y = np.broadcast_arrays(x, y)
    inside = np.zeros(x.shape, dtype=bool)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        crosses = (y0 > y) != (y1 > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            inside ^= crosses & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return inside
