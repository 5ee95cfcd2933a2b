"""A little tree in a pot: trunk, branches, and clumps of leaves that shade each other.

Pot (0) and wood (105) lie on either side of the air (70); the leaves (255) have the thinnest coat of wood.
"""

from __future__ import annotations

import numpy as np

from . import sdf
from .canvas import Canvas
from .grid import Grid
from .noise import smooth_noise

GRID = Grid(low=(-68.0, -60.0, -6.0), dims=(136, 120, 136), spacing=1.0)
AIR, POT, WOOD, LEAVES = 70.0, 0.0, 105.0, 255.0
TRUNK = np.array(
    [(6, 0, 22), (14, -2, 34), (12, 2, 46), (-2, 4, 56), (-10, 2, 68), (-4, -2, 80), (6, -2, 92), (8, 0, 104)]
)
#: Where a branch leaves the trunk (row of TRUNK), where it ends, half axes of its clump of leaves.
BRANCHES = (
    (2, (48, -6, 58), (19, 17, 9)),
    (3, (-44, -10, 64), (20, 18, 10)),
    (4, (-34, 26, 84), (17, 16, 9)),
    (4, (26, -28, 78), (15, 15, 8)),
    (5, (36, 14, 88), (18, 17, 9)),
    (5, (-26, -20, 96), (17, 15, 9)),
    (6, (-14, 18, 106), (15, 14, 8)),
    (7, (8, -2, 114), (19, 17, 10)),
)
SEED = 23


def generate() -> np.ndarray:
    """Return the bonsai, uint8."""
    canvas = Canvas(GRID, AIR)
    leaves = _leaves(canvas)
    canvas.everywhere(LEAVES, lambda a: leaves)
    _wood(canvas)
    _pot(canvas)
    return canvas.finished(np.uint8, noise=1.5, seed=SEED)


def _leaves(canvas: Canvas) -> np.ndarray:
    """Return the distance to the leaves: small balls strewn over flat clumps, ragged by noise."""
    random = np.random.Generator(np.random.PCG64(SEED))
    distance = GRID.full(6)
    for _, center, radii in BRANCHES:
        around = random.standard_normal((150, 3))
        around /= np.sqrt((around * around).sum(axis=1, keepdims=True))
        around *= random.random((150, 1)) ** 0.4
        for offset in around:
            # Flat below, domed above.
            lift = offset[2] if offset[2] > 0 else 0.35 * offset[2]
            place = np.add(center, (offset[0] * radii[0], offset[1] * radii[1], lift * radii[2] + 3))
            radius = float(random.uniform(1.7, 3.2))
            window, axes = GRID.window(place - radius - 3, place + radius + 3)
            distance[window] = np.minimum(distance[window], sdf.sphere(axes, place, radius))
    return distance + np.float32(0.7) * smooth_noise(GRID.shape, 2, SEED + 1)


def _wood(canvas: Canvas) -> None:
    canvas.chain(WOOD, TRUNK, 6.5, 2.4)
    for end in ((26, -10, 21), (-10, -12, 21), (-8, 12, 21), (22, 12, 21), (6, -20, 21)):
        canvas.rod(WOOD, (7, 0, 27), end, 4.0, 1.4)
    for row, end, radii in BRANCHES:
        start, tip = TRUNK[row].astype(float), np.asarray(end, dtype=float)
        middle = (start + tip) / 2 + (0, 0, -4)
        canvas.chain(WOOD, np.array([start, middle, tip]), 2.8, 1.3)
        for turn in ((1, 0), (-1, 0), (0, 1), (0, -1), (0.7, 0.7), (-0.7, 0.7)):
            twig = np.add(tip, (turn[0] * radii[0] * 0.75, turn[1] * radii[1] * 0.75, 3))
            canvas.rod(WOOD, (middle + 2 * tip) / 3, twig, 1.2, 0.7)


def _pot(canvas: Canvas) -> None:
    """Paint an oval pot on feet, filled with soil up to the roots."""

    def bowl(a: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
        x, y, z = a
        slope = np.float32(1) + (z - 10) * np.float32(0.010)
        side = (sdf.length(x / (46 * slope), y / (34 * slope)) - 1) * np.float32(34)
        return sdf.smooth_max(side, np.abs(z - np.float32(10)) - np.float32(11), 3)

    canvas.paint(POT, bowl, (-60, -50, -4), (60, 50, 26))
    canvas.paint(
        POT,
        lambda a: sdf.smooth_max(
            np.abs((sdf.length(a[0] / 49, a[1] / 37) - 1) * np.float32(37)) - np.float32(2.5),
            np.abs(a[2] - np.float32(20)) - np.float32(2),
            2,
        ),
        (-62, -52, 14),
        (62, 52, 26),
    )
    for x in (-1, 1):
        for y in (-1, 1):
            canvas.box(POT, (x * 26, y * 18, -2.5), (6, 5, 2.5), 1)
    canvas.ellipsoid(WOOD, (0, 0, 17), (43, 31, 6.5))
