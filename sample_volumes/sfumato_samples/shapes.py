"""Four solids before a wall, each with layers under its surface, for local and directional light.

Values: skin of the solids 110 (4 mm), flesh 170, core 235; the wall lies at 0, on the other side of the
air (50), so that no solid's edge passes through the wall's colour.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from . import sdf
from .canvas import Canvas
from .grid import Axes, Grid

GRID = Grid(low=(-64.0, -32.0, -64.0), dims=(128, 80, 128), spacing=1.0)
AIR, WALL, LAYERS = 50, 0, {0.0: 110.0, 4.0: 170.0, 11.0: 235.0}
Solid = tuple[tuple[float, float, float], Callable[[Axes], np.ndarray]]


def _lying(axes: Axes, center: tuple[float, float, float]) -> Axes:
    """Return coordinates in which the torus's axis points to the front."""
    return axes[0] - np.float32(center[0]), axes[2] - np.float32(center[2]), axes[1] - np.float32(center[1])


SOLIDS: tuple[Solid, ...] = (
    ((-30.0, 0.0, 30.0), lambda a: sdf.sphere(a, (-30, 0, 30), 24)),
    ((30.0, 0.0, 30.0), lambda a: sdf.torus(_lying(a, (30, 0, 30)), (0, 0, 0), 17, 9)),
    ((-30.0, 0.0, -30.0), lambda a: sdf.box(a, (-30, 0, -30), (21, 21, 21), 3)),
    ((30.0, 0.0, -30.0), lambda a: sdf.cone(a, (30, 0, -54), 25, 48)),
)


def generate() -> np.ndarray:
    """Return the shapes, uint8."""
    canvas = Canvas(GRID, AIR)
    canvas.box(WALL, (0, 42, 0), (63, 3, 63), 2)
    for center, solid in SOLIDS:
        canvas.layers(LAYERS, solid, np.subtract(center, 28), np.add(center, 28))
    return canvas.finished(np.uint8, noise=1.5, seed=11)
