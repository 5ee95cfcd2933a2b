"""What the cone pass is told of a lamp: where its light comes from, in mm along the volume's axes."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...scene import Light
from ..frame import Frame
from ..world_light import CellGrid

#: Narrow cones for what is near, at most: they start spread over a cell, and more of them changed no error
#: (docs/extinction.md).
NEAR_CONES = 10
_GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))


@dataclass(frozen=True)
class Emitter:
    """One lamp for the shader ``lamp.frag.glsl``.

    Attributes
    ----------
    points : bool
        Whether it is given by places on it, not as a disc seen from each cell.
    uniforms : dict
        What the shader needs.
    near : dict
        What differs of it for the cones through what is near, which are fewer.
    tangent : float
        Of the half angle under which it is seen from where it looks smallest.
    key : hashable
        Equal for lamps that light alike, whatever their colour.
    """

    points: bool
    uniforms: dict[str, Any]
    near: dict[str, Any]
    tangent: float
    key: Hashable


def vogel_disc(count: int) -> np.ndarray:
    """Return places spread evenly over the unit disc (Vogel 1979), shape (count, 2); one alone lies in the middle."""
    if count == 1:
        return np.zeros((1, 2))
    k = np.arange(count)
    radius, turn = np.sqrt((k + 0.5) / count), k * _GOLDEN_ANGLE
    return np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)


def emitter(frame: Frame, grid: CellGrid, light: Light) -> Emitter:
    """Return a lamp as the cone pass needs it."""
    params, axes = frame.params, np.asarray(frame.volume.direction, dtype=float).T
    tangent = -1.0 if params.cone_angle is None else math.tan(math.radians(params.cone_angle))
    free = {"u_unshadowed": float(frame.unshadowed)}
    if light.kind == "directional":
        towards = axes @ light.towards(frame.camera.basis(), frame.volume.center)
        tangent = math.tan(math.radians(light.aperture)) if tangent < 0 else tangent
        given = {"u_lamp": (*towards.tolist(), 0.0), "u_tangent": tangent}
        return _made(False, tangent, free | given, _disc, params.cones)
    place = _in_grid(frame, grid, np.asarray(light.position, dtype=float))
    radius = _radius(light)
    common: dict[str, Any] = {
        "u_lamp": (*place.tolist(), 1.0), "u_tangent": tangent, "u_radius": radius,
        "u_reach": light.reach or 0.0, **free,
    }  # fmt: skip
    if tangent < 0:
        tangent = radius / _farthest(grid, place)
    shines = axes @ (np.asarray(light.direction) / max(float(np.linalg.norm(light.direction)), 1e-30))
    if light.kind == "area" and light.shape != "sphere":
        if light.shape == "rectangle":
            common["u_shines"] = tuple(shines.tolist())

        def places(count: int) -> dict[str, Any]:
            at, part = _surface(light, count)
            in_grid = np.array([_in_grid(frame, grid, p) for p in at])
            return _disc(count) | {"u_place": in_grid.astype(np.float32), "u_part": part}

        return _made(True, tangent, common, places, params.cones)
    if light.kind == "spot":
        inner = max(0.0, light.spread - light.edge)
        common["u_beam"] = tuple(shines.tolist())
        # A beam without an edge ends within a hundredth of a degree.
        common["u_beam_edge"] = tuple(
            math.cos(math.radians(a)) for a in (light.spread, min(inner, light.spread - 0.01))
        )
    return _made(False, tangent, common, _disc, params.cones)


def _radius(light: Light) -> float:
    """Return the radius in mm of a lamp, or of the disc that is as large as it."""
    if light.kind == "area" and light.shape == "rectangle":
        return math.sqrt(light.size[0] * light.size[1] / math.pi)
    if light.kind == "area" and light.shape == "tube":
        return max(light.radius, 0.5 * light.size[0])
    return light.radius


def _farthest(grid: CellGrid, place: np.ndarray) -> float:
    """Return the distance in mm from a place to the grid's farthest corner."""
    extent = np.asarray(grid.size) * grid.edges_mm
    return float(np.linalg.norm(np.maximum(np.abs(place), np.abs(place - extent))))


def _disc(count: int) -> dict[str, Any]:
    return {"u_disc": vogel_disc(count).astype(np.float32), "u_part": 1 / math.sqrt(count)}


def _made(
    points: bool, tangent: float, given: dict[str, Any], cones: Callable[[int], dict[str, Any]], count: int
) -> Emitter:
    """Return a lamp whose cone is taken apart into so many narrow ones."""
    zero = (0.0, 0.0, 0.0)
    uniforms = {
        "u_shines": zero, "u_beam": zero, "u_beam_edge": (1.0, -1.0), "u_reach": 0.0, "u_radius": 0.0,
        **cones(count), **given,
    }  # fmt: skip
    key = tuple(
        (name, value.tobytes() if isinstance(value, np.ndarray) else value)
        for name, value in sorted(uniforms.items())
    )
    return Emitter(points, uniforms, cones(min(count, NEAR_CONES)), tangent, (points, key))


def _surface(light: Light, count: int) -> tuple[np.ndarray, float]:
    """Return places (count, 3), world space, on a rectangle or a tube, and the radius in mm of a cone to each."""
    center = np.asarray(light.position, dtype=float)
    if light.shape == "tube":
        axis = np.asarray(light.axis, dtype=float) / np.linalg.norm(light.axis)
        length = light.size[0]
        along = (np.arange(count) + 0.5) / count - 0.5
        return center + (along * length)[:, None] * axis, max(light.radius, 0.5 * length / count)
    across, up = light.sides
    width, height = light.size
    # A lattice of rank one fills the rectangle evenly with any number of places.
    k = np.arange(count)
    shares = np.stack([(k + 0.5) / count, (k * 0.6180339887498949 + 0.5) % 1.0], axis=1) - 0.5
    places = center + shares[:, :1] * width * across + shares[:, 1:] * height * up
    return places, math.sqrt(width * height / (math.pi * count))


def _in_grid(frame: Frame, grid: CellGrid, place: np.ndarray) -> np.ndarray:
    """Return a place in mm along the volume's axes from the corner of cell 0."""
    at = frame.volume.texture_from_world @ np.append(place, 1.0)
    return np.asarray((at[:3] - grid.low) / grid.edges * grid.edges_mm)
