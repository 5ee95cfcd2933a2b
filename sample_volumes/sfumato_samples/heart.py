"""A heart's left side as ultrasound shows it: a noisy sector with wall, two chambers and the valve between.

The near half is left out, so that one looks into the chambers as with an echocardiographer's crop plane.
"""

from __future__ import annotations

import numpy as np

from . import sdf
from .canvas import Canvas
from .grid import Grid
from .noise import blurred, grain, smooth_noise

GRID = Grid(low=(-60.0, -8.0, -104.0), dims=(120, 76, 112), spacing=1.0)
#: Echo strength of blood, muscle and of what surrounds the heart.
BLOOD, MUSCLE, TISSUE, VALVE = 8.0, 175.0, 36.0, 225.0
SEED = 13
#: Tangent of the sector's half angle, sideways and in depth.
SECTOR = (0.78, 0.62)


def generate() -> np.ndarray:
    """Return echoes, uint8; the probe is at the top."""
    canvas = Canvas(GRID, TISSUE, edge=3.0)
    _chambers(canvas)
    echoes = canvas.values * (np.float32(0.35) + np.float32(0.65) * _speckle(canvas.values.shape))
    echoes += np.float32(10) * smooth_noise(GRID.shape, 8, SEED + 3)
    return np.asarray(np.rint(np.clip(echoes * _sector(), 0, 255)).astype(np.uint8))


def _chambers(canvas: Canvas) -> None:
    """Paint the ventricle (apex up, to the probe), the atrium below, the valve and its muscles."""
    canvas.ellipsoid(MUSCLE, (-2, 14, -46), (37, 38, 42))
    canvas.ellipsoid(MUSCLE, (0, 14, -84), (29, 30, 22))
    canvas.ellipsoid(BLOOD, (-2, 14, -47), (24, 27, 31))
    canvas.ellipsoid(BLOOD, (0, 14, -86), (23, 25, 16))
    canvas.rod(BLOOD, (0, 14, -66), (0, 14, -80), 14)
    # The right ventricle, a crescent behind the septum, and the aorta's root.
    canvas.ellipsoid(BLOOD, (40, 16, -50), (11, 24, 27))
    canvas.rod(BLOOD, (20, 22, -66), (30, 30, -88), 7)
    for side in (-1, 1):
        leaf = np.array(
            [(side * 15.5, 14, -73), (side * 10, 14, -67), (side * 5, 14, -62), (side * 3.5, 14, -57)]
        )
        for depth in np.arange(-14, 17, 3.0):
            shorter = 1 - (depth / 22) ** 2
            row = leaf * (1, 1, 1) + (0, depth, 0)
            row[1:, 2] = row[0, 2] + (row[1:, 2] - row[0, 2]) * shorter
            canvas.chain(VALVE, row, 1.7, 1.1)
        canvas.rod(MUSCLE, (side * 18, 24, -34), (side * 9, 20, -45), 5.5, 3.0)
        for y in (14, 18, 22):
            canvas.rod(VALVE * 0.8, (side * 9, 20, -45), (side * 3.5, y, -58), 0.9)


def _speckle(shape: tuple[int, int, int]) -> np.ndarray:
    """Return the length of two smoothed normal variables: speckle that is wider than deep, mean about 1."""
    parts = []
    for k in range(2):
        noise = grain(shape, SEED + k)
        for axis, rounds in ((2, 2), (1, 2), (0, 1)):
            for _ in range(rounds):
                noise = blurred(noise, (axis,))
        parts.append(noise)
    # The smoothing leaves a deviation of 0.1674; a Rayleigh variable's mean is 1.2533 deviations.
    return sdf.length(*parts) * np.float32(1 / (0.1674 * 1.2533))


def _sector() -> np.ndarray:
    """Return 1 inside the probe's sector, 0 outside, a little fading with depth."""
    x, y, z = GRID.axes()
    reach = np.float32(10) - z
    edge = np.maximum(np.abs(x) - np.float32(SECTOR[0]) * reach, np.abs(y) - np.float32(SECTOR[1]) * reach)
    depth = sdf.length(x, y, reach)
    share = sdf.inside(np.maximum(edge * np.float32(0.8), np.maximum(depth - 112, 14 - depth)), 2.0)
    return np.asarray(share * (np.float32(1.1) - depth * np.float32(0.0025)))
