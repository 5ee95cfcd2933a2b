"""The hand's skeleton as distances: 14 phalanges, 5 metacarpals, 8 carpals, ends of radius and ulna."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..grid import Axes, Grid
from ..sdf import Frame, capsule, ellipsoid, length, smooth_max, smooth_min, sphere
from .pose import Bone, long_bones

#: Along a bone (0 base, 1 head): half width and half depth in mm for the middle finger.
PROFILES: dict[str, tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]] = {
    "metacarpal": (
        (0, 0.08, 0.24, 0.50, 0.74, 0.88, 1),
        (6.8, 6.9, 4.7, 4.0, 5.0, 6.9, 6.6),
        (7.2, 6.9, 4.7, 4.2, 5.0, 7.2, 6.9),
    ),
    "proximal": (
        (0, 0.08, 0.28, 0.56, 0.80, 0.92, 1),
        (7.5, 7.6, 5.3, 4.5, 5.2, 6.2, 5.8),
        (6.0, 6.1, 4.5, 3.6, 3.9, 4.6, 4.4),
    ),
    "middle": (
        (0, 0.10, 0.30, 0.58, 0.80, 0.92, 1),
        (6.6, 6.7, 4.5, 3.8, 4.5, 5.4, 5.0),
        (5.1, 5.2, 3.7, 3.0, 3.3, 4.0, 3.7),
    ),
    "distal": (
        (0, 0.12, 0.34, 0.60, 0.80, 0.92, 1),
        (5.6, 5.6, 3.7, 3.0, 3.6, 4.1, 3.4),
        (4.1, 4.0, 2.5, 1.9, 1.9, 1.8, 1.5),
    ),
}
#: Bow of the shaft towards the back of the hand, mm.
BOW = {"metacarpal": 1.4, "proximal": 1.2, "middle": 0.7, "distal": 0.3}
#: Carpals of the left hand: centre, direction of the long axis, half axes (u, v, w).
CARPALS = {
    "scaphoid": ((-13.2, -2.5, 11.0), (-0.55, -0.40, 0.75), (7.2, 7.4, 13.5)),
    "lunate": ((-0.5, 0.5, 7.5), (0.0, 0.3, 1.0), (9.4, 9.4, 8.6)),
    "triquetrum": ((13.0, 1.0, 11.0), (0.5, 0.0, 0.8), (7.9, 7.9, 8.8)),
    "pisiform": ((17.0, -9.5, 12.5), (0.0, 0.1, 1.0), (4.9, 4.7, 6.2)),
    "trapezium": ((-19.8, -7.0, 24.0), (-0.4, -0.3, 0.8), (8.4, 7.6, 8.2)),
    "trapezoid": ((-9.5, 1.5, 26.0), (-0.15, 0.0, 1.0), (6.6, 8.4, 8.6)),
    "capitate": ((0.8, 1.5, 22.5), (0.02, 0.0, 1.0), (7.4, 8.6, 14.0)),
    "hamate": ((13.0, 0.5, 24.0), (0.15, 0.0, 1.0), (8.6, 8.2, 10.5)),
}
#: Width of the joints in mm.
GAP = 1.6


@dataclass(frozen=True)
class Part:
    """A bone as a distance with the box outside of which it does not matter.

    ``shaft`` is 1 where the bone has a marrow cavity under thick cortex, 0 where it is spongy under thin.
    """

    low: np.ndarray
    high: np.ndarray
    distance: Callable[[Axes], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Skeleton:
    """Distance to the nearest bone, to the second nearest, and how much of a shaft the nearest is there."""

    distance: np.ndarray
    cartilage: np.ndarray
    shaft: np.ndarray


def skeleton(grid: Grid) -> Skeleton:
    """Return the bones on a grid, parted at the joints.

    Where two bones come closer than the joint's gap both give way in equal parts, so that the surfaces
    of a joint fit each other as they do in life.
    """
    nearest, second, shaft = grid.full(9), grid.full(9), grid.full(0)
    for part in parts():
        window, axes = grid.window(part.low, part.high)
        distance, along = part.distance(axes)
        old, closer = nearest[window], distance < nearest[window]
        second[window] = np.minimum(second[window], np.maximum(old, distance))
        shaft[window] = np.where(closer, along, shaft[window])
        nearest[window] = np.minimum(old, distance)
    parted = np.maximum(nearest, (nearest - second + np.float32(GAP)) * np.float32(0.5))
    return Skeleton(parted, second, shaft)


@cache
def parts() -> tuple[Part, ...]:
    """Return all 29 bones."""
    return (*(_long(bone) for bone in long_bones()), *(_carpal(name) for name in CARPALS), _radius(), _ulna())


def _part(
    points: np.ndarray, margin: float, distance: Callable[[Axes], tuple[np.ndarray, np.ndarray]]
) -> Part:
    return Part(points.min(axis=0) - margin, points.max(axis=0) + margin, distance)


@cache
def _profile(kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    t, width, depth = (np.asarray(row, dtype=float) for row in PROFILES[kind])
    fine = np.linspace(0, 1, 65)
    return fine, _rounded(np.interp(fine, t, width)), _rounded(np.interp(fine, t, depth))


def _rounded(table: np.ndarray) -> np.ndarray:
    """Smooth the corners of a table, its ends kept."""
    padded = np.concatenate([2 * table[0] - table[4:0:-1], table, 2 * table[-1] - table[-2:-6:-1]])
    return np.convolve(padded, np.array([1, 2, 3, 4, 5, 4, 3, 2, 1]) / 25, mode="valid")


def _long(bone: Bone) -> Part:
    def distance(axes: Axes) -> tuple[np.ndarray, np.ndarray]:
        u, v, w = bone.frame.local(axes)
        t = np.clip(w * np.float32(1 / bone.length), 0, 1)
        fine, width, depth = _profile(bone.kind)
        a = np.interp(t, fine, width * bone.size).astype(np.float32)
        b = np.interp(t, fine, depth * bone.size).astype(np.float32)
        arch = np.float32(4) * t * (1 - t)
        v = v - np.float32(BOW[bone.kind]) * arch
        # The palmar side is flatter than the dorsal one.
        b = np.where(v < 0, b * np.float32(0.86), b)
        q = length(u / a, v / b)
        slope = length(u / (a * a), v / (b * b))
        tube = q * (q - 1) / np.maximum(slope, np.float32(1e-4))
        half = np.float32(0.5 * bone.length)
        body = smooth_max(tube, np.abs(w - half) - half, 3.0 * bone.size)
        return _ends(bone, body, (u, v, w)), np.clip(np.float32(1.9) * arch - np.float32(0.75), 0, 1)

    ends = np.array([bone.start, bone.end])
    return _part(ends, 11.5 * bone.size, distance)


def _ends(bone: Bone, body: np.ndarray, local: Axes) -> np.ndarray:
    """Add what makes the heads: a ball for the knuckles, two condyles with a groove for the finger joints."""
    s = bone.size
    if bone.kind == "metacarpal":
        return smooth_min(
            body, ellipsoid(local, (0, -0.8, bone.length - 6.2 * s), (6.9 * s, 7.8 * s, 6.9 * s)), 3.0
        )
    if bone.kind == "distal":
        return body
    r = (4.4 if bone.kind == "proximal" else 3.8) * s
    for side in (-1, 1):
        body = smooth_min(body, sphere(local, (side * 0.62 * r, -0.4, bone.length - 0.9 * r), r), 1.6)
    return body


def _carpal(name: str) -> Part:
    center, axis, radii = CARPALS[name]
    frame = Frame.along(center, axis)

    def distance(axes: Axes) -> tuple[np.ndarray, np.ndarray]:
        d = ellipsoid(frame.local(axes), (0, 0, 0), radii)
        if name == "hamate":  # its hook
            d = smooth_min(d, capsule(axes, (11.8, -4, 23.0), (12.2, -12.5, 25.5), 3.4, 2.3), 3.0)
        if name == "trapezium":  # its ridge, a wall of the carpal tunnel
            d = smooth_min(d, capsule(axes, (-16.5, -9, 22), (-14.5, -13.5, 23), 3.2, 2.0), 3.0)
        return d, np.zeros_like(d)

    return _part(np.array([center]), max(radii) + 8, distance)


def _radius() -> Part:
    frame = Frame.along((-6.0, 1.0, 3.0), (0.02, -0.02, -1.0))

    def distance(axes: Axes) -> tuple[np.ndarray, np.ndarray]:
        u, v, w = frame.local(axes)
        t = np.clip(w * np.float32(1 / 30), 0, 1)
        flare = (1 - t) * (1 - t)
        q = length(
            u / (np.float32(7.2) + np.float32(9.6) * flare), v / (np.float32(6.5) + np.float32(4.5) * flare)
        )
        shank = smooth_max((q - 1) * (np.float32(6.5) + np.float32(4.5) * flare), -w, 4.0)
        styloid = capsule(axes, (-15.5, 0.0, -8), (-20.5, 0.0, 4.0), 6.5, 3.6)
        return smooth_min(shank, styloid, 8), np.clip(t * np.float32(2.2) - np.float32(0.9), 0, 1)

    return Part(np.array([-32.0, -18, -60]), np.array([22.0, 20, 14]), distance)


def _ulna() -> Part:
    def distance(axes: Axes) -> tuple[np.ndarray, np.ndarray]:
        shank = capsule(axes, (17.5, 3.0, -12), (14.5, 2.0, -70), 5.8, 6.2)
        head = ellipsoid(axes, (17.5, 3.0, -8.5), (8.2, 8.2, 7.0))
        styloid = capsule(axes, (21.2, 5.5, -8), (21.8, 6.0, -1.0), 3.6, 2.4)
        d = smooth_min(smooth_min(shank, head, 4), styloid, 2.5)
        return d, np.broadcast_to(np.clip((-axes[2] - 12) * np.float32(0.09), 0, 1), d.shape)

    return Part(np.array([2.0, -12, -60]), np.array([34.0, 20, 8]), distance)
