"""Which lamp throws a shadow, or a highlight, where it is wanted: the lamp is solved for, not searched.

A point P shadows a point Q if the light comes along P - Q. A mirror shows a lamp where its normal halves the
angle between the eye and the lamp (Blinn's half vector). Both give a direction; a parallel lamp takes it as
tilt and rotation, a lamp with a place moves along it and keeps its distance. Not every lamp can take every
direction: the slice methods know no light beside the subject. Then the nearest is returned, and how far off.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from .camera import Basis
from .light import FARTHEST, PATIENT_BASIS, SHORTEST, Light, nearest_possible_tilt
from .picking import light_depths, ray_samples, value_gradient
from .scene import Scene
from .vectors import angles_of, vec3

#: Points that are nearer to each other than this, in voxels, give no direction.
NEAREST_VOXELS = 2.0
#: How often a direction and the place that it lights are found from each other; the second time moves it by a tenth of
#: the first.
ROUNDS = 3
#: Share of its light from which on a place counts as lit at all (`LitPlace.share`).
LIT = 0.2
#: Samples of a ray that the eye sees less of than this, compared with the one it sees most of, do not count.
LEAST_SEEN = 1e-3
#: Half of what counts as one layer, in samples of half a voxel.
HALF_LAYER = 6


@dataclass(frozen=True)
class Aimed:
    """What to change about a lamp, and what that leaves to be desired.

    Parameters
    ----------
    fields : dict
        The lamp's fields by name; empty if nothing can be said.
    off : float
        Angle in degrees between the wanted direction of light and the one that the lamp has then.
    """

    fields: dict[str, Any] = field(default_factory=dict)
    off: float = 0.0


def shadow_direction(scene: Scene, caster: np.ndarray, place: np.ndarray) -> np.ndarray | None:
    """Return the unit vector towards the light by which one point (world mm) shadows another.

    None if they are too near to each other to tell.
    """
    way = np.asarray(caster, dtype=float) - np.asarray(place, dtype=float)
    length = float(np.linalg.norm(way))
    least = NEAREST_VOXELS * scene.volume.min_spacing if scene.volume is not None else SHORTEST
    return way / length if length >= least else None


@dataclass(frozen=True)
class LitPlace:
    """Where the brightness of a place of the picture comes from, for light from one direction.

    Parameters
    ----------
    point : ndarray, shape (3,)
        Of the layer on the eye's ray that is seen brightest, the point before which half of its brightness comes from,
        world mm. A shadow there is seen, not one on the point up to which half of the ray is lost: light reaches the
        front of a soft surface more than what lies deeper, the more so the more it grazes it.
    share : float
        How much of the light the surface's own skin lets through on its way to what is seen, 0 to 1: next to nothing
        where the surface turns away from the light.
    """

    point: np.ndarray
    share: float


def lit_place(scene: Scene, x: float, y: float, aspect: float, towards: np.ndarray) -> LitPlace | None:
    """Return where the brightness of a place of the picture comes from; None if nothing is seen there.

    Parameters
    ----------
    x, y : float
        Place in half widths and half heights from the picture's centre, y up; -1 to 1.
    aspect : float
        The picture's width over its height.
    towards : ndarray, shape (3,)
        Unit vector towards the light, world space.
    """
    points, before, taken = ray_samples(scene, x, y, aspect)
    seen = np.exp(-before) * -np.expm1(-taken)
    if not seen.sum() > 0:
        return None
    first, last = np.flatnonzero(seen >= LEAST_SEEN * seen.max())[[0, -1]]
    points, seen = points[first : last + 1], seen[first : last + 1]
    lit = seen * np.exp(-light_depths(scene, points, towards))
    layer = np.convolve(lit, np.ones(2 * HALF_LAYER + 1), "same")
    brightest = int(layer.argmax())
    around = slice(max(0, brightest - HALF_LAYER), brightest + HALF_LAYER + 1)
    share = np.cumsum(lit[around])
    middles = share - 0.5 * lit[around]
    point = np.array([np.interp(0.5 * share[-1], middles, c) for c in points[around].T])
    return LitPlace(point, float(lit.sum() / seen.sum()))


def shadow_ends(
    scene: Scene, caster: np.ndarray, place: np.ndarray, at: tuple[float, float], aspect: float
) -> tuple[np.ndarray, LitPlace] | None:
    """Return the unit vector towards the light by which a point shadows a place, and what is lit there.

    None if they are too near to each other to tell.

    Parameters
    ----------
    caster, place : ndarray, shape (3,)
        What casts the shadow, and the surface at the place of the picture (`surface_under`), world mm.
    at : (float, float)
        The place of the picture, as in `lit_place`.
    """
    lit = LitPlace(np.asarray(place, dtype=float), 1.0)
    towards = shadow_direction(scene, caster, lit.point)
    for _ in range(ROUNDS):
        found = None if towards is None else lit_place(scene, *at, aspect, towards)
        if found is None:
            break
        if found.share < LIT:
            # What little comes through from behind says nothing of the place.
            lit = LitPlace(np.asarray(place, dtype=float), found.share)
            towards = shadow_direction(scene, caster, lit.point)
            break
        lit, towards = found, shadow_direction(scene, caster, found.point)
    return None if towards is None else (towards, lit)


def highlight_direction(scene: Scene, place: np.ndarray) -> np.ndarray | None:
    """Return the unit vector towards the light whose highlight lies at a point of a surface (world mm).

    The normal is the value's gradient, turned to the viewer as the renderers turn it. None where there is none.
    """
    assert scene.camera is not None
    gradient = value_gradient(scene, np.asarray(place, dtype=float)[None])[0]
    length = float(np.linalg.norm(gradient))
    if length <= 0:
        return None
    normal, back = gradient / length, -_sight(scene, place)
    cosine = float(normal @ back)
    towards = 2 * cosine * normal - back
    return np.asarray(towards / np.linalg.norm(towards))


def aimed(scene: Scene, light: Light, towards: np.ndarray, place: np.ndarray, through: np.ndarray) -> Aimed:
    """Return what makes a lamp shine from a direction, as far as it can.

    Parameters
    ----------
    towards : ndarray, shape (3,)
        Wanted unit vector towards the light, world space.
    place : ndarray, shape (3,)
        Where its light is wanted, world mm.
    through : ndarray, shape (3,)
        Point on the way there, from which a lamp with a place keeps its distance, world mm.
    """
    if scene.camera is None:
        return Aimed()
    if light.placed:
        fields = _moved(scene, light, towards, through)
    else:
        axes = _axes(scene.camera.basis() if light.attached == "viewer" else PATIENT_BASIS)
        tilt, rotation = angles_of(axes @ towards)
        fields = {"tilt": nearest_possible_tilt(tilt, light.aperture), "rotation": rotation}
    got = direction_in_effect(scene, replace(light, **fields), place)
    return Aimed(fields, math.degrees(math.acos(max(-1.0, min(1.0, float(got @ towards))))))


def direction_in_effect(scene: Scene, light: Light, place: np.ndarray) -> np.ndarray:
    """Return the unit vector from a point towards a lamp as the scene's technique lights it, world space.

    Techniques that know parallel light alone take a lamp with a place for light from there to the subject's
    middle, and keep light that comes from beside the subject out of the grazing band.
    """
    assert scene.camera is not None
    basis = scene.camera.basis()
    target = scene.volume.center if scene.volume is not None else scene.camera.focal_point
    if not _lights_in_space(scene):
        tilt, rotation = (math.radians(a) for a in light.angles(basis, target))
        local = [math.sin(tilt) * math.cos(rotation), math.sin(tilt) * math.sin(rotation), math.cos(tilt)]
        return np.asarray(np.array(local) @ _axes(basis))
    if light.placed:
        way = np.asarray(light.position) - np.asarray(place)
        return np.asarray(way / max(float(np.linalg.norm(way)), SHORTEST))
    return light.towards(basis, target)


def _moved(scene: Scene, light: Light, towards: np.ndarray, through: np.ndarray) -> dict[str, Any]:
    """Return the fields of a lamp with a place: moved about the point, or about what it is taken to light."""
    assert scene.camera is not None
    if _lights_in_space(scene):
        pivot = np.asarray(through, dtype=float)
    else:
        pivot = np.asarray(scene.volume.center if scene.volume is not None else scene.camera.focal_point)
    away = float(np.linalg.norm(np.asarray(light.position) - pivot))
    fields: dict[str, Any] = {"position": vec3(np.clip(pivot + away * towards, -FARTHEST, FARTHEST))}
    if light.needs_direction:
        fields["direction"] = vec3(-towards)
    return fields


def _lights_in_space(scene: Scene) -> bool:
    """Tell whether the technique knows lamps with a place as what they are."""
    from ..techniques import technique_for

    return len(technique_for(scene.technique).kinds) > 1


def _sight(scene: Scene, place: np.ndarray) -> np.ndarray:
    """Return the unit vector in which the eye sees a point."""
    assert scene.camera is not None
    if scene.camera.parallel_projection:
        return np.asarray(scene.camera.basis().forward)
    way = np.asarray(place, dtype=float) - np.asarray(scene.camera.position)
    return np.asarray(way / max(float(np.linalg.norm(way)), SHORTEST))


def _axes(basis: Basis) -> np.ndarray:
    return np.array([basis.right, basis.up, basis.back])


__all__ = [
    "LIT",
    "Aimed",
    "LitPlace",
    "aimed",
    "direction_in_effect",
    "highlight_direction",
    "lit_place",
    "shadow_direction",
    "shadow_ends",
]
