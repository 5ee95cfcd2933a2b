"""A fish like a carp as CT shows it: hundreds of thin bones, the subject of the papers' fish pictures."""

from __future__ import annotations

import math

import numpy as np

from . import sdf
from .canvas import Canvas
from .grid import Grid

GRID = Grid(low=(-138.0, -42.0, -72.0), dims=(184, 56, 96), spacing=1.5)
BONE, RAY, FLESH = 950.0, 620.0, 45.0
#: Along the fish (mm, head at the left): belly, back, half width.
OUTLINE = np.array(
    [
        (-132, -6, 0, 3),
        (-122, -14, 9, 11),
        (-100, -27, 25, 19),
        (-70, -36, 40, 24),
        (-30, -40, 46, 25),
        (10, -34, 38, 22),
        (45, -22, 25, 15),
        (75, -12, 15, 8),
        (92, -11, 13, 5),
    ],
    dtype=float,
)


def generate() -> np.ndarray:
    """Return the fish in Hounsfield units, int16."""
    canvas = Canvas(GRID, -1000)
    _flesh(canvas)
    _spine(canvas)
    _head(canvas)
    _fins(canvas)
    return canvas.finished(np.int16, noise=8, seed=24)


def _outline(x: float) -> tuple[float, float, float]:
    return tuple(float(np.interp(x, OUTLINE[:, 0], OUTLINE[:, i])) for i in (1, 2, 3))  # type: ignore[return-value]


def _spine_z(x: float) -> float:
    return 6 + 4 * math.sin((x + 40) / 60) if x < 60 else 6.0


def _flesh(canvas: Canvas) -> None:
    x, y, z = GRID.axes()
    fine = (
        np.interp(GRID.line(0), np.linspace(-132, 92, 60), _smooth_outline(1)),
        np.interp(GRID.line(0), np.linspace(-132, 92, 60), _smooth_outline(2)),
    )
    width = np.interp(GRID.line(0), np.linspace(-132, 92, 60), _smooth_outline(3)).astype(np.float32)
    belly, back = (line.astype(np.float32) for line in fine)
    q = sdf.length(y / width, (z - (belly + back) / 2) / ((back - belly) / 2))
    tube = (q - 1) * width
    body = np.maximum(tube, np.maximum(np.float32(-134) - x, x - np.float32(94)))
    canvas.everywhere(FLESH, lambda a: body)
    canvas.ellipsoid(-850, (-20, 0, -6), (38, 7, 8))


def _smooth_outline(column: int) -> np.ndarray:
    """Return a column of OUTLINE at 60 places along the fish, its corners rounded."""
    values = np.interp(np.linspace(-132, 92, 60), OUTLINE[:, 0], OUTLINE[:, column])
    padded = np.pad(values, 3, mode="edge")
    return np.convolve(padded, np.array([1, 2, 3, 4, 3, 2, 1]) / 16, mode="valid")


def _spine(canvas: Canvas) -> None:
    """Paint the vertebrae with the spines above and below, and the ribs round the belly."""
    places = np.linspace(-66, 88, 29)
    for i, x in enumerate(places):
        z, (belly, back, width) = _spine_z(x), _outline(float(x))
        canvas.rod(BONE, (x - 1.4, 0, z), (x + 1.4, 0, z), 3.6 - 0.06 * i)
        canvas.rod(BONE, (x, 0, z + 2), (x + 9, 0, z + (back - z) * 0.72), 1.6, 1.1)
        if x > 5:
            canvas.rod(BONE, (x, 0, z - 2), (x + 9, 0, z + (belly - z) * 0.75), 1.6, 1.1)
        else:
            for side in (-1, 1):
                arc = [
                    (
                        x + 10 * t,
                        side * width * 0.86 * math.sin(0.25 + 2.3 * t),
                        z - 1 - (z - belly) * 0.86 * t**1.15,
                    )
                    for t in np.linspace(0, 1, 9)
                ]
                canvas.chain(BONE, np.array(arc), 1.8, 1.25)


def _head(canvas: Canvas) -> None:
    """Paint the skull's roof, the ring of the eye, jaws, cheek and gill cover."""
    crown = sdf.Frame.along((-99, 0, 14), (1, 0, 0.46), (0, 0, 1))
    low, high = (-132, -14, -14), (-64, 14, 42)
    canvas.layers(
        {0: BONE, 2.2: 250.0}, lambda a: sdf.ellipsoid(crown.local(a), (0, 0, 0), (11, 7, 31)), low, high
    )
    for side in (-1, 1):
        canvas.chain(
            BONE, np.array([(-128, side * 2, -4), (-118, side * 9, -9), (-106, side * 13, -14)]), 2.4, 2.0
        )
        canvas.chain(
            BONE, np.array([(-129, side * 2, -8), (-116, side * 8, -17), (-100, side * 12, -22)]), 2.2, 2.0
        )
        ring = [
            (-109 + 7 * math.cos(t), side * 13.0, 4 + 7 * math.sin(t))
            for t in np.linspace(0, 2 * math.pi, 15)
        ]
        canvas.chain(BONE, np.array(ring), 2.3)
        canvas.ellipsoid(BONE * 0.9, (-83, side * 18, -5), (16, 2.8, 23))
        canvas.ellipsoid(BONE * 0.9, (-99, side * 14.5, -13), (12, 2.6, 9))
        for i in range(4):
            arch = [
                (-92 + 3.5 * i + 6 * math.cos(t), side * (5 + 2 * math.sin(t)), -6 + 15 * math.sin(t))
                for t in np.linspace(-1.4, 1.4, 7)
            ]
            canvas.chain(RAY, np.array(arch), 1.2)
        canvas.chain(
            BONE, np.array([(-70, side * 14, 10), (-66, side * 17, -8), (-74, side * 12, -30)]), 2.4, 1.8
        )
    canvas.rod(BONE, (-92, 0, 12), (-78, 0, 5), 6, 4)


def _fins(canvas: Canvas) -> None:
    """Paint the rays of all fins: dorsal, tail, anal, and the pairs at breast and belly."""
    for i, x in enumerate(np.linspace(-38, 34, 18)):
        back = _outline(float(x))[1]
        high = 19 - 0.45 * i + (3 if i == 1 else 0)
        canvas.rod(
            RAY, (x, 0, back - 9), (x + 8 + 0.3 * i, 0, min(back + high, 68)), 1.9 if i < 2 else 1.35, 1.0
        )
    for t in np.linspace(-1, 1, 23):
        reach = 26 + 18 * abs(t) ** 1.4
        canvas.rod(RAY, (88, 0, 3 + 7 * t), (92 + reach * 0.98, 0, 2 + 40 * t), 1.4, 1.0)
    for i, x in enumerate(np.linspace(34, 56, 9)):
        belly = _outline(float(x))[0]
        canvas.rod(RAY, (x, 0, belly + 8), (x + 14, 0, belly - 17 + 1.3 * i), 1.7 if i < 2 else 1.35, 1.0)
    for side in (-1, 1):
        for i in range(8):
            canvas.rod(
                RAY,
                (-70, side * 15, -24 - 0.5 * i),
                (-44 - 2.2 * i, side * (20 + 0.8 * i), -32 - 3.4 * i),
                1.4,
                1.0,
            )
            canvas.rod(
                RAY,
                (-6 - 0.3 * i, side * 9, -36),
                (18 - 2.6 * i, side * (12 + 0.5 * i), -50 - 1.6 * i),
                1.4,
                1.0,
            )
