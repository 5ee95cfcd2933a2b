"""A volume that bodies are painted into, each only in its own window."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from . import sdf
from .grid import Axes, Grid, Point
from .noise import blurred, grain

Body = Callable[[Axes], np.ndarray]


def _deeper(body: Body, depth: float, axes: Axes) -> np.ndarray:
    return body(axes) + np.float32(depth)


class Canvas:
    """Values on a grid, with soft edges.

    Parameters
    ----------
    grid : Grid
        Where the voxels lie.
    background : float
        Value of empty space.
    edge : float
        Width in voxels over which a body's edge falls off.
    """

    def __init__(self, grid: Grid, background: float, edge: float = 2.0) -> None:
        self.grid = grid
        self.values = grid.full(background)
        self.edge = edge * grid.spacing

    def paint(self, value: float, body: Body, low: Point, high: Point) -> None:
        """Paint a body, given by its distance in mm, over what is there; it lies in the box low to high."""
        margin = self.edge
        window, axes = self.grid.window(np.subtract(low, margin), np.add(high, margin))
        share = sdf.inside(body(axes), self.edge)
        self.values[window] += share * (np.float32(value) - self.values[window])

    def layers(self, depths: dict[float, float], body: Body, low: Point, high: Point) -> None:
        """Paint a body and, inside it, what lies deeper than each depth (mm): its value."""
        for depth, value in depths.items():
            self.paint(value, partial(_deeper, body, depth), low, high)

    def everywhere(self, value: float, body: Body) -> None:
        """Paint a body that may fill the whole volume."""
        self.paint(value, body, (-1e4, -1e4, -1e4), (1e4, 1e4, 1e4))

    def ball(self, value: float, center: Point, radius: float) -> None:
        """Paint a ball."""
        self.paint(
            value,
            lambda a: sdf.sphere(a, center, radius),
            np.subtract(center, radius),
            np.add(center, radius),
        )

    def ellipsoid(self, value: float, center: Point, radii: Point) -> None:
        """Paint an ellipsoid along the axes."""
        self.paint(
            value,
            lambda a: sdf.ellipsoid(a, center, radii),
            np.subtract(center, radii),
            np.add(center, radii),
        )

    def box(self, value: float, center: Point, half: Point, rounding: float = 0.0) -> None:
        """Paint a box along the axes."""
        self.paint(
            value,
            lambda a: sdf.box(a, center, half, rounding),
            np.subtract(center, half),
            np.add(center, half),
        )

    def rod(self, value: float, start: Point, end: Point, radius: float, last: float | None = None) -> None:
        """Paint a rod with round ends, tapering to another radius."""
        reach = max(radius, radius if last is None else last)
        low, high = np.minimum(start, end) - reach, np.maximum(start, end) + reach
        self.paint(value, lambda a: sdf.capsule(a, start, end, radius, last), low, high)

    def chain(self, value: float, points: np.ndarray, radius: float, last: float | None = None) -> None:
        """Paint one body of rods through points, shape (n, 3), tapering from the first to the last."""
        radii = np.linspace(radius, radius if last is None else last, len(points))
        reach = float(radii.max()) + self.edge
        whole, _ = self.grid.window(points.min(axis=0) - reach, points.max(axis=0) + reach)
        distance = np.full(self.values[whole].shape, reach, dtype=np.float32)
        for i in range(len(points) - 1):
            ends = points[i : i + 2]
            window, axes = self.grid.window(ends.min(axis=0) - reach, ends.max(axis=0) + reach)
            part = tuple(
                slice(w.start - o.start, w.stop - o.start) for w, o in zip(window, whole, strict=True)
            )
            rod = sdf.capsule(axes, points[i], points[i + 1], float(radii[i]), float(radii[i + 1]))
            distance[part] = np.minimum(distance[part], rod)
        self.values[whole] += sdf.inside(distance, self.edge) * (np.float32(value) - self.values[whole])

    def finished(self, dtype: type, noise: float = 0.0, seed: int = 0) -> np.ndarray:
        """Return the values with white noise of a deviation, rounded to an integer type; CT is blurred a little."""
        if dtype is np.int16:
            self.values = blurred(self.values)
        values = self.values + grain(self.values.shape, seed) * np.float32(noise) if noise else self.values
        limits = (-1024, 3071) if dtype is np.int16 else (0, 255)
        return np.asarray(np.rint(np.clip(values, *limits)).astype(dtype))
