"""The chest as CT shows it: ribs before lungs, heart and spine, so that shadows fall through a cage."""

from __future__ import annotations

import math

import numpy as np

from . import sdf
from .canvas import Canvas
from .grid import Axes, Grid

GRID = Grid(low=(-168.0, -112.0, -6.0), dims=(168, 112, 176), spacing=2.0)
#: Height (mm), half width and half depth of the rib cage.
CAGE = np.array(
    [(0, 128, 84), (60, 130, 86), (140, 124, 84), (220, 102, 74), (270, 76, 60), (320, 46, 44)], dtype=float
)
CORTEX, SPONGY, CARTILAGE, CONTRAST = 900.0, 280.0, 330.0, 215.0
SPINE_Y = 56.0


def generate() -> np.ndarray:
    """Return the chest in Hounsfield units, int16."""
    canvas = Canvas(GRID, -1000)
    _body(canvas)
    _lungs(canvas)
    _heart(canvas)
    for side in (-1, 1):
        for number in range(12):
            _rib(canvas, side, number)
        _shoulder(canvas, side)
    _spine(canvas)
    front = -_cage(200)[1]
    for value, thinner in ((CORTEX * 0.7, 0.0), (SPONGY, 2.5)):
        for (x0, z0, r0), (x1, z1, r1) in _STERNUM:
            start, end = (x0, front + 2 - 0.06 * (280 - z0), z0), (x1, front + 2 - 0.06 * (280 - z1), z1)
            flat = sdf.Frame.along(start, np.subtract(end, start))
            _plate(
                canvas,
                value,
                flat,
                float(np.linalg.norm(np.subtract(end, start))),
                (r0 - thinner, r1 - thinner),
                5 - thinner,
            )
    return canvas.finished(np.int16, noise=8, seed=21)


#: Breastbone: handle, body, tip; at either end x, z and half width.
_STERNUM = (((0, 284, 25), (0, 252, 13)), ((0, 246, 13), (0, 170, 17)), ((0, 166, 12), (0, 144, 6)))


def _plate(
    canvas: Canvas, value: float, frame: sdf.Frame, span: float, widths: tuple[float, float], thick: float
) -> None:
    """Paint a flat bone along a frame's w axis, its half width going from one value to another."""
    reach = max(widths) + thick
    ends = np.array([frame.origin, frame.world(0, 0, span)])

    def distance(a: Axes) -> np.ndarray:
        u, v, w = frame.local(a)
        width = np.float32(widths[0]) + np.clip(w / np.float32(span), 0, 1) * np.float32(
            widths[1] - widths[0]
        )
        flat = (sdf.length(u / width, v * np.float32(1 / thick)) - 1) * np.float32(thick)
        return sdf.smooth_max(flat, np.abs(w - np.float32(span / 2)) - np.float32(span / 2), 4)

    canvas.paint(value, distance, ends.min(axis=0) - reach, ends.max(axis=0) + reach)


def _cage(z: float) -> tuple[float, float]:
    """Return half width and half depth of the rib cage at a height."""
    return float(np.interp(z, CAGE[:, 0], CAGE[:, 1])), float(np.interp(z, CAGE[:, 0], CAGE[:, 2]))


def _body(canvas: Canvas) -> None:
    """Paint skin, fat and muscle."""

    def distance(a: Axes) -> np.ndarray:
        x, y, z = a
        trunk = (sdf.length(x / np.float32(150), y / np.float32(103)) - 1) * np.float32(103)
        trunk = sdf.smooth_max(trunk, z - np.float32(300), 70)
        trunk = sdf.smooth_min(trunk, sdf.capsule(a, (0, 14, 270), (0, 8, 400), 52), 40)
        for side in (-1, 1):
            trunk = sdf.smooth_min(trunk, sdf.capsule(a, (side * 60, 10, 284), (side * 175, 14, 248), 44), 30)
        return trunk

    body = distance(GRID.axes())
    canvas.layers({0: 25, 3: -95, 14: 55}, lambda a: body, (-1e4, -1e4, -1e4), (1e4, 1e4, 1e4))


def _lungs(canvas: Canvas) -> None:
    x, y, z = GRID.axes()
    heights = GRID.line(2)
    width = np.interp(heights, CAGE[:, 0], CAGE[:, 1]).astype(np.float32)[:, None, None] - 7
    depth = np.interp(heights, CAGE[:, 0], CAGE[:, 2]).astype(np.float32)[:, None, None] - 7
    chest = (sdf.length(x / width, y / depth) - 1) * depth
    chest = sdf.smooth_max(chest, z - np.float32(312), 30)
    # Domes of the diaphragm from below, the space between the lungs in the middle.
    dome = np.minimum(sdf.sphere((x, y, z), (-64, 5, -40), 118), sdf.sphere((x, y, z), (62, 5, -48), 116))
    between = np.float32(24) - np.abs(x) - np.clip((z - 240) * np.float32(0.08), -6, 4)
    spine = sdf.length(x, y - np.float32(SPINE_Y)) - np.float32(27) + 0 * z
    lungs = sdf.smooth_max(sdf.smooth_max(chest, -dome, 10), sdf.smooth_max(between + 0 * y, -spine, 8), 12)
    inner = np.maximum(chest + 4, dome)
    canvas.everywhere(75, lambda a: inner)
    canvas.everywhere(-860, lambda a: lungs)
    for side in (-1, 1):
        _vessels(canvas, np.array([side * 26.0, 10.0, 190.0]), side)


def _vessels(canvas: Canvas, root: np.ndarray, side: int) -> None:
    """Paint the trees of the lungs' vessels: each branch splits twice."""
    random = np.random.Generator(np.random.PCG64(31 + side))
    tips = [(root, np.array([side * 1.0, 0.0, aim]), 6.0) for aim in (1.2, 0.1, -0.9)]
    for _ in range(4):
        grown = []
        for start, direction, radius in tips:
            end = start + sdf.unit(direction) * 17.0
            canvas.rod(40, start, end, radius * 0.55, radius * 0.42)
            grown += [
                (end, sdf.unit(direction) + random.uniform(-0.75, 0.75, 3), radius * 0.72) for _ in range(2)
            ]
        tips = grown


def _heart(canvas: Canvas) -> None:
    """Paint heart and great vessels, filled with contrast agent."""
    frame = sdf.Frame.along((20, -26, 142), (0.55, -0.35, -0.75))
    canvas.paint(
        60, lambda a: sdf.ellipsoid(frame.local(a), (0, 0, 0), (41, 38, 58)), (-60, -100, 60), (100, 50, 220)
    )
    canvas.paint(
        CONTRAST,
        lambda a: sdf.ellipsoid(frame.local(a), (4, -2, 4), (33, 30, 48)),
        (-60, -100, 60),
        (100, 50, 220),
    )
    arch = np.array(
        [
            (4, -22, 176),
            (-8, -26, 208),
            (-6, -18, 236),
            (8, 4, 250),
            (20, 26, 238),
            (22, 36, 200),
            (18, 36, 100),
            (12, 34, -20),
        ]
    )
    canvas.chain(CONTRAST, arch, 14, 10)
    canvas.chain(CONTRAST, np.array([(-24, -14, 150), (-26, -12, 210), (-24, -12, 262)]), 10, 8)
    canvas.chain(CONTRAST, np.array([(14, -34, 176), (16, -20, 206), (26, 4, 206)]), 12, 9)


def _rib(canvas: Canvas, side: int, number: int) -> None:
    """Paint a rib from the spine round to the front, and its cartilage up to the breastbone."""
    back, drop = 300.0 - number * 20.5, 26.0 + 6.5 * min(number, 8)
    last = (24, 22, 24, 27, 30, 34, 40, 50, 60, 70, 96, 118)[number]
    points = []
    for s in np.linspace(0, 1, 18):
        phi = math.radians(166 + (last - 166) * s)
        z = back - drop * s * (1.25 - 0.25 * s)
        width, depth = _cage(z + 0.3 * drop)
        points.append((side * width * math.sin(phi), -depth * math.cos(phi), z))
    curve = np.array(points)
    canvas.chain(CORTEX, curve, 5.2, 5.6)
    canvas.chain(SPONGY, curve, 2.2, 2.4)
    if number < 10:
        target = (side * 11, -_cage(200)[1] - 8, max(258.0 - number * 17.0, 150.0))
        canvas.chain(CARTILAGE, np.array([curve[-1], (curve[-1] + target) / 2 - (0, 3, 3), target]), 5.2, 4.2)


def _shoulder(canvas: Canvas, side: int) -> None:
    """Paint collar bone, shoulder blade and head of the upper arm."""
    collar = np.array([(18, -62, 290), (48, -66, 296), (84, -48, 302), (122, -14, 300), (138, 2, 294)]) * (
        side,
        1,
        1,
    )
    canvas.chain(CORTEX, collar, 6, 6.5)
    blade = sdf.Frame.along((side * 92, 76, 226), (side * 0.18, -0.12, 1), (side * 0.45, 1, 0))
    low, high = np.array([side * 92 - 60, 30, 140]), np.array([side * 92 + 60, 112, 312])
    canvas.paint(CORTEX * 0.8, lambda a: sdf.ellipsoid(blade.local(a), (0, 0, 0), (34, 4.5, 62)), low, high)
    canvas.chain(
        CORTEX * 0.8,
        np.array([(60, 88, 258), (96, 88, 274), (130, 60, 298), (142, 24, 304)]) * (side, 1, 1),
        5,
        7,
    )
    canvas.ball(CORTEX * 0.8, (side * 146, 14, 278), 22)
    canvas.ball(SPONGY, (side * 146, 14, 278), 18)
    canvas.rod(CORTEX, (side * 150, 14, 268), (side * 185, 16, 200), 13)


def _spine(canvas: Canvas) -> None:
    for i in range(15):
        z = 308.0 - i * 22.5
        canvas.box(CORTEX * 0.75, (0, SPINE_Y, z), (18, 15, 9), 6)
        canvas.box(SPONGY, (0, SPINE_Y, z), (15, 12, 7), 5)
        canvas.rod(CORTEX * 0.8, (0, SPINE_Y + 26, z - 2), (0, SPINE_Y + 36, z - 16), 4.5, 3.5)
        for side in (-1, 1):
            canvas.rod(CORTEX * 0.8, (side * 11, SPINE_Y + 10, z + 3), (side * 9, SPINE_Y + 24, z), 4)
            canvas.rod(CORTEX * 0.8, (side * 10, SPINE_Y + 22, z), (side * 32, SPINE_Y + 26, z + 3), 4.5, 4)
            canvas.rod(CORTEX * 0.8, (side * 10, SPINE_Y + 23, z), (0, SPINE_Y + 28, z - 3), 3.5)
