"""Two streams that mix in a pipe with baffles: temperature as the scalar, and the flow as vectors.

The flow is the curl of a potential, so that it is free of sources: a laminar stream along the pipe (x), bent
around the baffles, with a swirl that sets in downstream. It follows no equation of motion.
"""

from __future__ import annotations

import numpy as np

from . import sdf
from .canvas import Canvas
from .grid import Grid

GRID = Grid(low=(-72.0, -28.0, -28.0), dims=(144, 56, 56), spacing=1.0)
RADIUS, WALL = 22.0, 2.5
#: Values: wall and baffles, outside, coldest and hottest fluid.
SOLID, OUTSIDE, COLD, HOT = 0.0, 40.0, 90.0, 250.0
BAFFLES = (-42.0, -18.0, 6.0, 30.0)
PITCH = 24.0
SPEED, SWIRL = 120.0, 1.6


def generate() -> np.ndarray:
    """Return the temperature (COLD to HOT; solids SOLID, outside OUTSIDE), uint8."""
    canvas = Canvas(GRID, OUTSIDE)
    x, y, z = GRID.axes()
    r = sdf.length(y, z)
    canvas.everywhere(SOLID, lambda a: r + 0 * x - np.float32(RADIUS + WALL))
    fluid = _temperature()
    share = sdf.inside(r - np.float32(RADIUS) + 0 * x, canvas.edge)
    canvas.values += share * (fluid - canvas.values)
    for i, place in enumerate(BAFFLES):
        _baffle(canvas, place, 1 if i % 2 else -1)
    # Cut open, so that one looks in.
    canvas.everywhere(OUTSIDE, lambda a: y + np.float32(9) + 0 * x + 0 * z)
    return canvas.finished(np.uint8, noise=1.5, seed=14)


def _baffle(canvas: Canvas, place: float, side: int) -> None:
    """Paint a plate that leaves a third of the section open, above or below."""
    low, high = (place - 3, -RADIUS, -RADIUS), (place + 3, RADIUS, RADIUS)

    def plate(a: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
        disc = np.maximum(
            sdf.length(a[1], a[2]) - np.float32(RADIUS), np.abs(a[0] - np.float32(place)) - np.float32(1.5)
        )
        return np.maximum(disc, side * a[2] - np.float32(6))

    canvas.paint(SOLID, plate, low, high)


def _center(x: np.ndarray) -> np.ndarray:
    """Height at which the stream passes, mm: below one baffle, above the next."""
    phase = (x - np.float32(BAFFLES[0])) * np.float32(1 / PITCH)
    # A triangle wave with rounded corners: +1 at the first baffle, -1 at the second.
    saw = np.abs(phase - 2 * np.floor(phase * np.float32(0.5)) - 1) * 2 - 1
    rounded = saw * (np.float32(1.5) - np.float32(0.5) * saw * saw)
    inside = np.clip((x + 66) * np.float32(1 / 24), 0, 1) * np.clip((54 - x) * np.float32(1 / 24), 0, 1)
    return np.asarray(np.float32(11) * rounded * inside)


def _temperature() -> np.ndarray:
    """Return hot above cold at the inlet; the boundary follows the stream, turns, and blurs downstream."""
    x, y, z = GRID.axes()
    way = np.clip((x + 50) * np.float32(1 / 110), 0, 1)
    turn = way * way * np.float32(2.2)
    # A rotation by the rational parametrisation of the circle: no sine, the same everywhere.
    cos, sin = (1 - turn * turn) / (1 + turn * turn), 2 * turn / (1 + turn * turn)
    height = (z - np.float32(0.8) * _center(x)) * cos + y * sin
    curl = np.float32(3) * sdf.bump(y - np.float32(8), 9) - np.float32(3) * sdf.bump(y + np.float32(3), 9)
    share = np.clip((height + curl * way) / (np.float32(2.5) + 46 * way) + np.float32(0.5), 0, 1)
    return np.asarray(np.float32(COLD) + np.float32(HOT - COLD) * share, dtype=np.float32)


def vectors() -> np.ndarray:
    """Return velocities in mm/s, float32 (z, y, x, 3) with components x, y, z; 0 outside the pipe."""
    x, y, z = GRID.axes()
    square = (y * y + z * z) * np.float32(1 / (RADIUS * RADIUS))
    inner = np.clip(1 - square, 0, 1)
    # The potential of a laminar stream along x, and what bends it around the baffles ...
    around = np.float32(SPEED) * (np.float32(0.5) - np.float32(0.25) * square)
    along_y = np.float32(1.3 * SPEED) * _center(x) * inner * inner - around * z
    along_z = around * y + 0 * x
    # ... and of the swirl, a stream function in each section.
    growing = np.clip((x + 50) * np.float32(1 / 30), 0, 1)
    along_x = np.float32(SWIRL * SPEED * RADIUS / 8) * growing * inner * inner
    dx = {axis: np.gradient(field, GRID.spacing, axis=2) for axis, field in (("y", along_y), ("z", along_z))}
    dy = {axis: np.gradient(field, GRID.spacing, axis=1) for axis, field in (("x", along_x), ("z", along_z))}
    dz = {axis: np.gradient(field, GRID.spacing, axis=0) for axis, field in (("x", along_x), ("y", along_y))}
    flow = np.stack([dy["z"] - dz["y"], dz["x"] - dx["z"], dx["y"] - dy["x"]], axis=-1)
    return np.asarray((flow * (square < 1)[..., None]).astype(np.float32))
