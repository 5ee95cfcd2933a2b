"""A bucky ball of balls and rods in a box that is open to the front: many thin occluders, one plain receiver.

The box lies at 0 and the ball at 200, on either side of the air (60): each keeps its colour to the edge.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from .canvas import Canvas
from .grid import Grid

GRID = Grid(low=(-60.0, -60.0, -60.0), dims=(120, 120, 120), spacing=1.0)
AIR, BOX, BALL = 60, 0, 200
RADIUS = 40.0


def vertices() -> np.ndarray:
    """Return the 60 corners of the truncated icosahedron whose edges have length 2, shape (60, 3)."""
    phi = (1 + math.sqrt(5)) / 2
    kinds = ((0, 1, 3 * phi), (1, 2 + phi, 2 * phi), (phi, 2, 2 * phi + 1))
    found = set()
    for kind in kinds:
        for signs in itertools.product((-1, 1), repeat=3):
            signed = [round(s * c, 9) + 0.0 for s, c in zip(signs, kind, strict=True)]
            found |= {tuple(signed[(i + turn) % 3] for i in range(3)) for turn in range(3)}
    return np.array(sorted(found))


def generate() -> np.ndarray:
    """Return the ball in its box, uint8."""
    canvas = Canvas(GRID, AIR)
    canvas.box(BOX, (0, 54, 0), (56, 3, 56), 1)
    for side in (-1, 1):
        canvas.box(BOX, (side * 54, 0, 0), (3, 56, 56), 1)
        canvas.box(BOX, (0, 0, side * 54), (56, 56, 3), 1)
    corners = vertices()
    gaps = np.sqrt(((corners[:, None] - corners[None]) ** 2).sum(axis=-1))
    scale = RADIUS / float(np.sqrt((corners[0] ** 2).sum()))
    places = corners * scale
    for i, j in np.argwhere(np.triu((gaps > 0.1) & (gaps < 2.1))):
        canvas.rod(BALL, places[i], places[j], 1.9)
    for place in places:
        canvas.ball(BALL, place, 4.0)
    return canvas.finished(np.uint8, noise=1.0, seed=12)
