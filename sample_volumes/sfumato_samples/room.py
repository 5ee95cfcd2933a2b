"""A room after Cornell's: left wall red, right wall green, the rest white, two blocks; open to the front.

Between a wall's value and the air's all values in between occur, so the air lies at 110 with red below (0),
white a little above (135) and green far above (255): only green is coated with white, a thirtieth of a voxel.
"""

from __future__ import annotations

import numpy as np

from .canvas import Canvas
from .grid import Grid
from .sdf import Frame, box

GRID = Grid(low=(-56.0, -56.0, -56.0), dims=(112, 112, 112), spacing=1.0)
AIR, RED, WHITE, GREEN = 110, 0, 135, 255


def generate() -> np.ndarray:
    """Return the room, uint8."""
    canvas = Canvas(GRID, AIR, edge=1.0)
    canvas.box(WHITE, (0, 51, 0), (55, 4, 55))
    for side in (-1, 1):
        canvas.box(WHITE, (0, 0, side * 51), (55, 55, 4))
    canvas.box(RED, (-51, 0, 0), (4, 55, 47))
    canvas.box(GREEN, (51, 0, 0), (4, 55, 47))
    # White on air passes through no other wall's value: the turned blocks may have soft edges.
    canvas.edge = 2.0 * GRID.spacing
    _block(canvas, (-17, 15, -20), (15, 15, 29), (0.32, 0, 0.95))
    _block(canvas, (18, -12, -34), (14, 14, 15), (-0.30, 0, 0.95))
    return canvas.finished(np.uint8)


def _block(
    canvas: Canvas,
    center: tuple[float, float, float],
    half: tuple[float, float, float],
    turn: tuple[float, float, float],
) -> None:
    """Paint a block, turned about the vertical."""
    # The frame's w axis lies in the floor, its v axis points up.
    frame = Frame.along(center, (turn[0], turn[2], 0), (0, 0, 1))
    size = (half[0], half[2], half[1])
    reach = max(half) * 1.5
    canvas.paint(
        WHITE,
        lambda a: box(frame.local(a), (0, 0, 0), size),
        np.subtract(center, reach),
        np.add(center, reach),
    )
