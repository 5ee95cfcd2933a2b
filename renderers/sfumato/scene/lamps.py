"""What a lamp is to a point: the direction towards it, how large it looks, how much of its light arrives there.

Shadows are not counted: this is light on its way through empty space. Points are world mm; a parallel
light looks the same from all of them. The window draws lamps by these, tests compare techniques with them.
"""

from __future__ import annotations

import math

import numpy as np

from .camera import Basis
from .light import Light, Vec3

#: Distance in mm below which a point counts as lying in the lamp's middle.
TOUCHING = 1e-9


def directions_towards(light: Light, points: np.ndarray, basis: Basis, target: Vec3) -> np.ndarray:
    """Return the unit vectors from points to the middle of a lamp, world space.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        World mm.
    basis, target
        The camera's basis and the subject's centre, as `Light.towards` needs them for a parallel light.

    Returns
    -------
    ndarray, shape (n, 3)
        In the lamp's very middle: the direction towards the viewer.
    """
    points = np.asarray(points, dtype=float)
    if not light.placed:
        return np.broadcast_to(light.towards(basis, target), points.shape).copy()
    away = np.asarray(light.position) - points
    length = np.linalg.norm(away, axis=-1, keepdims=True)
    return np.where(length > TOUCHING, away / np.maximum(length, TOUCHING), np.asarray(basis.back))


def distances(light: Light, points: np.ndarray) -> np.ndarray:
    """Return how far points (n, 3) are from the middle of a lamp that has a place, mm, shape (n,)."""
    return np.asarray(np.linalg.norm(np.asarray(points, dtype=float) - np.asarray(light.position), axis=-1))


def half_angles(light: Light, points: np.ndarray) -> np.ndarray:
    """Return the half angle in degrees of the cone under which points (n, 3) see a lamp, shape (n,).

    A ball fills asin(radius / distance), 90 degrees from within. A rectangle or a tube is taken for the
    disc of the same size as the side that it turns to the point; nothing of a rectangle is seen edge-on.
    """
    points = np.asarray(points, dtype=float)
    if not light.placed:
        return np.full(len(points), light.aperture)
    away = np.maximum(distances(light, points), TOUCHING)
    if light.kind != "area" or light.shape == "sphere":
        return np.asarray(np.degrees(np.arcsin(np.minimum(light.radius / away, 1.0))))
    return np.asarray(np.degrees(np.arctan(np.sqrt(_seen_area(light, points, away) / math.pi) / away)))


def _seen_area(light: Light, points: np.ndarray, away: np.ndarray) -> np.ndarray:
    """Return the area in mm² that a rectangle or a tube turns to points, shape (n,)."""
    sight = (points - np.asarray(light.position)) / away[:, None]
    if light.shape == "rectangle":
        cosine = np.abs(sight @ np.asarray(light.direction)) / math.hypot(*light.direction)
        return np.asarray(light.size[0] * light.size[1] * np.minimum(cosine, 1.0))
    cosine = np.minimum(np.abs(sight @ np.asarray(light.axis)) / math.hypot(*light.axis), 1.0)
    side = 2 * light.radius * light.size[0] * np.sqrt(1 - cosine**2)
    return np.asarray(side + math.pi * light.radius**2 * cosine)


def falloff(light: Light, points: np.ndarray) -> np.ndarray:
    """Return the share of light that distance leaves: 1 / (1 + (d / reach)²), or 1 without a reach; shape (n,)."""
    if not light.placed or light.reach is None:
        return np.ones(len(points))
    return np.asarray(1.0 / (1.0 + (distances(light, points) / light.reach) ** 2))


def beam_edges(light: Light) -> tuple[float, float]:
    """Return the angles in degrees from a spot's direction up to which it is full, and from which it is dark."""
    return max(0.0, light.spread - light.edge), light.spread


def beam(light: Light, points: np.ndarray) -> np.ndarray:
    """Return the share of light that a spot sends to points (n, 3): a smooth step over the cosine; shape (n,).

    Other lamps send the same everywhere; a rectangle the cosine to the side that it shines to, 0 behind it.
    """
    points = np.asarray(points, dtype=float)
    if not light.needs_direction:
        return np.ones(len(points))
    away = np.maximum(distances(light, points), TOUCHING)
    shines = np.asarray(light.direction) / math.hypot(*light.direction)
    cosine = (points - np.asarray(light.position)) @ shines / away
    if light.kind == "area":
        return np.asarray(np.clip(cosine, 0.0, 1.0))
    full, dark = (math.cos(math.radians(angle)) for angle in beam_edges(light))
    if full - dark < 1e-9:
        return np.asarray((cosine > dark).astype(float))
    t = np.clip((cosine - dark) / (full - dark), 0.0, 1.0)
    return np.asarray(t * t * (3 - 2 * t))


def arriving(light: Light, points: np.ndarray) -> np.ndarray:
    """Return the share of a lamp's intensity that reaches points (n, 3) through empty space; shape (n,)."""
    return np.asarray(falloff(light, points) * beam(light, points))


__all__ = ["arriving", "beam", "beam_edges", "directions_towards", "distances", "falloff", "half_angles"]
