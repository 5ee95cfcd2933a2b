"""A distance field that grows by smooth unions and cuts, each evaluated only near its body."""

from __future__ import annotations

import numpy as np

from .grid import Grid, Point
from .sdf import Frame, capsule, ellipsoid, smooth_max, smooth_min

WORLD = Frame.along((0, 0, 0), (0, 0, 1))


class Field:
    """Distances in mm on a grid, at first `far` everywhere; bodies are joined with fillets of `k` mm."""

    def __init__(self, grid: Grid, far: float = 14.0) -> None:
        self.grid = grid
        self.far = far
        self.distance = grid.full(far)

    def rod(self, start: Point, end: Point, radius: float, last: float, k: float) -> None:
        """Add a tapered rod."""
        ends, reach = np.array([start, end], dtype=float), max(radius, last) + 0.65 * self.far
        window, axes = self.grid.window(ends.min(axis=0) - reach, ends.max(axis=0) + reach)
        self.distance[window] = smooth_min(self.distance[window], capsule(axes, start, end, radius, last), k)

    def pad(self, frame: Frame, center: Point, radii: Point, k: float) -> None:
        """Add an ellipsoid along a frame's axes, its centre in the frame's coordinates."""
        middle, reach = frame.world(center[0], center[1], center[2]), max(radii) + 0.65 * self.far
        window, axes = self.grid.window(middle - reach, middle + reach)
        body = ellipsoid(frame.local(axes), center, radii)
        self.distance[window] = smooth_min(self.distance[window], body, k)

    def cut(self, frame: Frame, center: Point, radii: Point, k: float) -> None:
        """Take an ellipsoid away."""
        middle, reach = frame.world(center[0], center[1], center[2]), max(radii) + 0.65 * self.far
        window, axes = self.grid.window(middle - reach, middle + reach)
        body = ellipsoid(frame.local(axes), center, radii)
        self.distance[window] = smooth_max(self.distance[window], -body, k)

    def join(self, other: Field, k: float) -> None:
        """Add another field on the same grid."""
        self.distance = smooth_min(self.distance, other.distance, k)
