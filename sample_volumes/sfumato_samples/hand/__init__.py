"""The hand: a computed tomography of a raised left hand, made by code; the face of the program.

Layers, from outside: skin, subcutaneous fat, muscle and tendons, bones with cortex, spongy ends and marrow.
Values are textbooks' Hounsfield units: air -1000, fat -100, muscle 60, spongy bone 200-400, cortex 900-1500.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..grid import Grid
from ..noise import blurred, grain, smooth_noise
from ..sdf import bump, capsule, inside
from .bones import Skeleton, skeleton
from .pose import FINGERS, long_bones
from .skin import add_relief, nail_coordinates, surface

GRID = Grid(low=(-66.0, -66.0, -36.0), dims=(160, 120, 284), spacing=0.8)
SEED = 7


def generate() -> np.ndarray:
    """Return the hand in Hounsfield units, int16 (z, y, x), 0.8 mm voxels."""
    values, _ = tissues(GRID)
    return finished(values)


@dataclass(frozen=True)
class Layers:
    """The distances from which the tissues follow: to the skin and to the bones (mm, negative inside)."""

    skin: np.ndarray
    bones: Skeleton


def tissues(grid: Grid) -> tuple[np.ndarray, Layers]:
    """Return noiseless Hounsfield units (float32) and the distances that they were made from."""
    skin = grid.upsampled(surface(grid.coarser()))
    add_relief(grid, skin)
    layers = Layers(skin, skeleton(grid))
    values = grid.full(-1000)
    # Most of the volume is air: everything below works on the list of voxels in and at the skin.
    body = np.flatnonzero(skin < 1.5 * grid.spacing)
    depth = -skin.ravel()[body]
    soft = _soft(grid, body, depth)
    soft = _bone(grid, body, soft, layers.bones)
    share = inside(-depth, 2.8 * grid.spacing)
    values.ravel()[body] = -1000 + (soft + 1000) * share
    _nails(grid, values, skin)
    return values, layers


def finished(values: np.ndarray) -> np.ndarray:
    """Return the values with the scanner's blur and noise (8 HU), rounded to int16."""
    noisy = blurred(values) + grain(values.shape, SEED) * np.float32(8)
    return np.rint(np.clip(noisy, -1024, 3071)).astype(np.int16)


def _soft(grid: Grid, body: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Skin 1.4 mm, then fat of changing thickness, then muscle with tendons."""
    wobble = smooth_noise(grid.shape, 8, SEED + 1).ravel()[body]
    fine = smooth_noise(grid.shape, 4, SEED + 2).ravel()[body]
    muscle = _muscle(grid).ravel()[body] - np.float32(1.2) * wobble
    fat = np.float32(-95) + np.float32(18) * fine
    flesh = np.float32(58) + np.float32(10) * fine
    inner = fat + (flesh - fat) * inside(np.maximum(muscle, 2.4 - depth), 1.6)
    tendon = _tendons(grid).ravel()[body]
    inner = inner + (np.float32(95) - inner) * inside(np.maximum(tendon, 1.6 - depth), 1.2)
    return np.asarray(inner + (np.float32(32) - inner) * inside(depth - np.float32(1.4), 1.2))


def _muscle(grid: Grid) -> np.ndarray:
    """Distance to the muscles: between the metacarpals, balls of thumb and little finger, forearm."""
    field = grid.full(5)
    rods: list[tuple[Any, Any, float, float]] = [
        ((-16, -14, 34), (-38, -33, 58), 13.0, 9.0),
        ((24, -10, 26), (32, -10, 76), 10.0, 7.0),
    ]
    rods += [((-26, -16, 50), (-22, -5, 78), 8.0, 5.0)]
    for left, right in itertools.pairwise(FINGERS):
        start, end = np.add(left.base, right.base) / 2, np.add(left.head, right.head) / 2
        rods.append((np.add(start, (0, -3, 4)), np.add(end, (0, -3, -6)), 8.0, 5.5))
    rods += [
        ((-9, -8, -6), (-12, -9, -50), 7.5, 12.0),
        ((8, -8, -6), (8, -9, -50), 8.0, 12.0),
        ((2, 9, -10), (0, 11, -50), 5.0, 8.0),
    ]
    _add_rods(grid, field, rods)
    return field


def _tendons(grid: Grid) -> np.ndarray:
    """Distance to the tendons: before and behind the bones of every finger, in palm and wrist."""
    field = grid.full(5)
    rods = []
    for bone in long_bones():
        reach = 0.45 if bone.kind == "distal" else 1.0
        for side, radius in ((-7.2, 2.3), (6.2, 1.3)):
            rods.append(
                (
                    bone.frame.world(0, side * bone.size, 0),
                    bone.frame.world(0, side * bone.size, reach * bone.length),
                    radius,
                    radius,
                )
            )
    for i, ray in enumerate(FINGERS):
        rods.append((np.array([-4.5 + 4 * i, -9, -40]), np.array([-3.5 + 3.5 * i, -10, 22]), 2.2, 2.2))
        rods.append((np.array([-3.5 + 3.5 * i, -10, 22]), np.add(ray.head, (0, -10.5, 0)), 2.2, 2.2))
    _add_rods(grid, field, rods)
    return field


def _add_rods(grid: Grid, field: np.ndarray, rods: list[tuple[Any, Any, float, float]]) -> None:
    for start, end, radius, last in rods:
        ends = np.array([start, end], dtype=float)
        window, axes = grid.window(
            ends.min(axis=0) - max(radius, last) - 4, ends.max(axis=0) + max(radius, last) + 4
        )
        field[window] = np.minimum(field[window], capsule(axes, start, end, radius, last))


def _bone(grid: Grid, body: np.ndarray, soft: np.ndarray, bones: Skeleton) -> np.ndarray:
    distance = bones.distance.ravel()[body]
    second = bones.cartilage.ravel()[body]
    # Cartilage and joint fluid fill the gaps.
    joint = inside(np.maximum(distance - np.float32(1.4), second - np.float32(2.4)), 1.0)
    soft = soft + (np.float32(105) - soft) * joint
    at = np.flatnonzero(distance < 1.2 * grid.spacing)
    near, where = distance[at], body[at]
    shaft = bones.shaft.ravel()[where]
    sponge = smooth_noise(grid.shape, 2, SEED + 3).ravel()[where]
    trabecular = np.float32(300) + np.float32(110) * sponge
    core = trabecular + (np.float32(70) - trabecular) * shaft
    cortex = np.float32(1050) + np.float32(450) * shaft
    thickness = np.float32(1.4) + np.float32(0.5) * shaft
    value = core + (cortex - core) * inside(-near - thickness, 1.2)
    soft[at] += (value - soft[at]) * inside(near, 2.2 * grid.spacing)
    return soft


def _nails(grid: Grid, values: np.ndarray, skin: np.ndarray) -> None:
    """Lay the nails, half a millimetre of horn, into the skin."""
    for bone in long_bones():
        if bone.kind != "distal":
            continue
        middle = bone.frame.world(0, 3, bone.length - 4)
        window, axes = grid.window(middle - 11, middle + 11)
        u, v, w = bone.frame.local(axes)
        plate = inside((nail_coordinates(bone, u, w) - 1) * np.float32(5), 1.0) * (v > 1)
        shell = bump(skin[window] + np.float32(0.7), 1.2)
        values[window] += plate * shell * np.maximum(np.float32(230) - values[window], 0) * np.float32(0.8)
