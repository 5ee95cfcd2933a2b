"""A skull as CT shows it: the eye sockets are what soft shadows are for."""

from __future__ import annotations

import itertools
import math

import numpy as np

from . import sdf
from .canvas import Canvas
from .field import WORLD, Field
from .grid import Grid

GRID = Grid(low=(-81.2, -112.0, -98.0), dims=(116, 156, 144), spacing=1.4)
CORTEX, SPONGY, ENAMEL = 1100.0, 380.0, 2100.0


def generate() -> np.ndarray:
    """Return the skull in Hounsfield units, int16."""
    bone = Field(GRID, far=34)
    _cranium(bone)
    _face(bone)
    _openings(bone)
    jaw = Field(GRID, far=16)
    _jaw(jaw)
    bone.join(jaw, 0.0)
    canvas = Canvas(GRID, -1000, edge=2.4)
    canvas.everywhere(CORTEX, lambda a: bone.distance)
    canvas.everywhere(SPONGY, lambda a: bone.distance + np.float32(3.2))
    _teeth(canvas)
    return canvas.finished(np.int16, noise=8, seed=22)


def _cranium(bone: Field) -> None:
    bone.pad(WORLD, (0, 14, 34), (69, 84, 62), 10)
    bone.pad(WORLD, (0, -38, 38), (54, 44, 46), 20)
    bone.pad(WORLD, (0, 46, 6), (54, 48, 42), 20)
    for side in (-1, 1):
        bone.pad(WORLD, (side * 44, 14, -8), (14, 26, 16), 12)
        bone.pad(WORLD, (side * 53, 22, -22), (11, 14, 20), 12)  # mastoids
        bone.rod((side * 10, -80, 18), (side * 46, -66, 15), 6.0, 5.5, 9)  # brows


def _face(bone: Field) -> None:
    bone.pad(WORLD, (0, -58, -30), (35, 30, 26), 12)
    bone.rod((0, -80, 10), (0, -92, -8), 6, 4, 7)
    for side in (-1, 1):
        cheek = [
            (side * 24, -72, -24),
            (side * 45, -62, -20),
            (side * 59, -42, -13),
            (side * 63, -14, -10),
            (side * 54, 12, -8),
        ]
        for i, (start, end) in enumerate(itertools.pairwise(cheek)):
            bone.rod(start, end, (9, 8.5, 6, 4.4)[i], (8.5, 6.5, 4.4, 4.6)[i], 6)
        bone.rod((side * 50, -62, 14), (side * 51, -57, -16), 5, 6, 7)  # outer rim of the socket
        bone.rod((side * 9, -84, 2), (side * 15, -78, -26), 5, 7, 6)
    # The arch that carries the upper teeth.
    for start, end in zip(_arch(26, 44, -46)[:-1], _arch(26, 44, -46)[1:], strict=True):
        bone.rod(start, end, 6.2, 6.2, 6)


def _openings(bone: Field) -> None:
    """Cut brain case, eye sockets, nose, temples and the way out to the spine."""
    bone.cut(WORLD, (0, 18, 40), (61.5, 73, 50), 1)
    bone.cut(WORLD, (0, -34, 48), (46, 36, 31), 1)
    bone.cut(WORLD, (0, 46, 9), (47.5, 41.5, 35), 1)
    bone.cut(WORLD, (0, 34, -40), (15, 18, 24), 3)
    for side in (-1, 1):
        socket = sdf.Frame.along((side * 29.5, -72, -2), (side * 0.36, -1, -0.08), (0, 0, 1))
        bone.cut(socket, (0, 0, 0), (18.5, 16.5, 29), 3)
        bone.cut(WORLD, (side * 10.5, -86, -29), (7.5, 22, 13), 3)
        bone.cut(WORLD, (side * 7.5, -90, -18), (6.0, 18, 12), 3)
        bone.cut(WORLD, (side * 62, -32, -6), (11, 20, 20), 4)
        bone.cut(WORLD, (side * 26, -34, -40), (16, 16, 22), 4)
        bone.cut(WORLD, (side * 20, -58, -33), (10, 14, 12), 2)


def _arch(width: float, depth: float, z: float, count: int = 15, back: float = -46.0) -> np.ndarray:
    """Return points along a dental arch, shape (count, 3)."""
    angles = np.linspace(-math.pi / 2, math.pi / 2, count)
    return np.array([(width * math.sin(t), back - depth * math.cos(t), z) for t in angles])


def _jaw(jaw: Field) -> None:
    rim = _arch(24.5, 43, -64)
    base = _arch(31, 43, -82, back=-44)
    for line, radius in ((rim, 5.4), (base, 5.2)):
        for start, end in itertools.pairwise(line):
            jaw.rod(start, end, radius, radius, 8)
    jaw.pad(WORLD, (0, -87, -84), (13, 7, 8), 8)
    for side in (-1, 1):
        jaw.rod((side * 30, -46, -76), (side * 48, -6, -66), 10, 8, 8)
        jaw.rod((side * 26, -46, -66), (side * 49, -12, -56), 6, 7, 8)
        jaw.rod((side * 48, -6, -64), (side * 53, 3, -22), 7.5, 4.5, 8)
        jaw.rod((side * 48, -14, -58), (side * 52, -20, -22), 6, 3, 8)
        jaw.rod((side * 48, -8, -52), (side * 51, -10, -38), 7, 6, 8)
        jaw.rod((side * 48, 4, -21), (side * 53, 4, -21), 4.2, 4.2, 4)


def _teeth(canvas: Canvas) -> None:
    for z, tip, width, depth in ((-47.0, -56.5, 26.0, 45.0), (-64.0, -57.5, 24.5, 43.5)):
        for i, place in enumerate(_arch(width, depth, z, count=16)):
            molar = abs(i - 7.5) > 4
            radius = 3.9 if molar else 2.9
            end = (place[0], place[1], tip)
            canvas.rod(ENAMEL, place, end, radius, radius * (1.0 if molar else 0.75))
