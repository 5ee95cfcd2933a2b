"""Where lamps stand as the eye sees them, what a hand's moves make of that, and how one kind becomes another. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from sfumato import Light, Scene
from sfumato.scene import MAX_LIGHTS, nearest_possible_tilt
from sfumato.scene.light import FARTHEST, PATIENT_BASIS
from sfumato.scene.vectors import Vec3, angles_of, vec3
from sfumato.techniques import Technique, technique_for

from . import light_moves

#: Parts of the visible box's diagonal: how far outside it a new lamp stands, and how large it is.
ROOM, BALL, SURFACE, TUBE = 0.12, 0.02, 0.25, 0.01
#: Distance in the same parts within which a lamp counts as standing in the middle.
MIDDLE = 1e-6


@dataclass(frozen=True)
class LampKind:
    """One entry of the menu of kinds: a kind, and for area lamps a shape."""

    id: str
    title: str
    kind: str
    shape: str = ""


KINDS = (
    LampKind("directional", "Parallel", "directional"),
    LampKind("point", "Point", "point"),
    LampKind("spot", "Spot", "spot"),
    LampKind("rectangle", "Rectangle", "area", "rectangle"),
    LampKind("sphere", "Sphere", "area", "sphere"),
    LampKind("tube", "Tube", "area", "tube"),
)


def kind_of(light: Light) -> LampKind:
    """Return a lamp's entry in the menu."""
    shape = light.shape if light.kind == "area" else ""
    return next(k for k in KINDS if (k.kind, k.shape) == (light.kind, shape))


def offered_kinds(technique: Technique, light: Light) -> tuple[LampKind, ...]:
    """Return the kinds that the technique lights as what they are, and the one that the lamp is."""
    return tuple(k for k in KINDS if k.kind in technique.kinds or k == kind_of(light))


def most_lamps(scene: Scene) -> int:
    """Return how many lamps are of use: four for a single-lamp technique, too, since another may be chosen."""
    return min(MAX_LIGHTS, max(4, technique_for(scene.technique).max_lights))


# -- where it is --------------------------------------------------------------------------------------
def middle_of(scene: Scene) -> np.ndarray:
    """Return the subject's middle, world mm."""
    assert scene.camera is not None
    return np.asarray(scene.volume.center if scene.volume else scene.camera.focal_point, dtype=float)


def diagonal_of(scene: Scene) -> float:
    """Return the diagonal of the visible box in mm; of what the camera looks at, if there is no volume."""
    if scene.volume is None:
        return scene.camera.distance if scene.camera is not None else 100.0
    corners = scene.volume.corners(scene.crop.low, scene.crop.high)
    return max(float(np.linalg.norm(np.ptp(corners, axis=0))), 1e-6)


def seen_angles(scene: Scene, light: Light) -> tuple[float, float]:
    """Return a lamp's tilt and rotation in degrees as the eye sees it, whatever it is attached to."""
    if scene.camera is None or (light.kind == "directional" and light.attached == "viewer"):
        return light.tilt, light.rotation
    basis = scene.camera.basis()
    axes = np.array([basis.right, basis.up, basis.back])
    return angles_of(axes @ light.towards(basis, vec3(middle_of(scene))))


def dial_angles(scene: Scene, light: Light) -> tuple[float, float]:
    """Return the tilt and rotation that dial and sliders show: of a lamp without a place, its own."""
    return seen_angles(scene, light) if light.placed else (light.tilt, light.rotation)


# -- moves --------------------------------------------------------------------------------------------
def placed(scene: Scene, light: Light, x: float, y: float) -> dict[str, Any]:
    """Return the fields of a lamp brought to a place of the disc, as far as its cone allows."""
    tilt, rotation = light_moves.from_disc(x, y, seen_angles(scene, light)[1])
    if scene.camera is None or (light.kind == "directional" and light.attached == "viewer"):
        return {"tilt": nearest_possible_tilt(tilt, light.aperture), "rotation": rotation}
    basis = scene.camera.basis()
    towards = np.array([basis.right, basis.up, basis.back]).T @ light_moves.direction(tilt, rotation)
    return pointed(scene, light, towards)


def pointed(scene: Scene, light: Light, towards: np.ndarray) -> dict[str, Any]:
    """Return the fields of a lamp that shines from a unit direction of the world, as far as its cone allows."""
    if light.placed:
        return turned(scene, light, towards)
    seen = scene.camera.basis() if scene.camera is not None else PATIENT_BASIS
    basis = seen if light.attached == "viewer" else PATIENT_BASIS
    tilt, rotation = angles_of(np.array([basis.right, basis.up, basis.back]) @ towards)
    return {"tilt": nearest_possible_tilt(tilt, light.aperture), "rotation": rotation}


def moved(scene: Scene, light: Light, dx: float, dy: float) -> dict[str, Any]:
    """Return the fields of a lamp moved over the disc by (dx, dy) radii, as far as its cone allows."""
    x, y = light_moves.to_disc(*seen_angles(scene, light))
    return placed(scene, light, x + dx, y + dy)


def turned(scene: Scene, light: Light, towards: np.ndarray) -> dict[str, Any]:
    """Return the fields of a lamp with a place, turned about the subject's middle to a unit direction.

    It keeps its distance, and shines to the same side of itself.
    """
    middle = middle_of(scene)
    arm = np.asarray(light.position) - middle
    distance = float(np.linalg.norm(arm))
    if distance <= MIDDLE * diagonal_of(scene):
        return {}
    rotation = rotation_between(arm / distance, towards)
    fields: dict[str, Any] = {"position": vec3(middle + distance * towards)}
    if light.kind in ("spot", "area"):
        fields |= {
            "direction": vec3(rotation @ np.asarray(light.direction)),
            "axis": vec3(rotation @ np.asarray(light.axis)),
        }
    return fields


def rotation_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the rotation matrix, shape (3, 3), that turns one unit vector into another the shortest way."""
    axis, cosine = np.cross(a, b), float(a @ b)
    if cosine < -1 + 1e-9:
        side = np.cross(a, np.eye(3)[int(np.argmin(np.abs(a)))])
        side = side / np.linalg.norm(side)
        return np.asarray(2 * np.outer(side, side) - np.eye(3))
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1 + cosine))


def within_reach(point: np.ndarray) -> Vec3:
    """Return a place as a lamp may have it."""
    return vec3(np.clip(point, -FARTHEST, FARTHEST))


# -- kinds --------------------------------------------------------------------------------------------
def as_kind(scene: Scene, light: Light, wanted: LampKind) -> dict[str, Any]:
    """Return the fields that make a lamp one of another kind.

    A parallel lamp that gets a place stands where its light came from, just outside the visible box, and
    shines to the subject's middle; one that loses it shines from where it stood.
    """
    if wanted == kind_of(light) or scene.camera is None:
        return {}
    if wanted.kind == "directional":
        return {"kind": "directional", **_direction_from_place(scene, light)}
    fields: dict[str, Any] = {"kind": wanted.kind}
    if wanted.shape:
        fields["shape"] = wanted.shape
    if not light.placed:
        fields |= _first_place(scene, light)
    size = diagonal_of(scene)
    fields["radius"] = (
        TUBE if wanted.id == "tube" else BALL * (2.0 if wanted.id == "sphere" else 1.0)
    ) * size
    if wanted.id == "tube":
        fields["size"] = (2 * SURFACE * size, TUBE * size)
        fields["axis"] = scene.camera.basis().right
    elif wanted.id == "rectangle":
        fields["size"] = (SURFACE * size, SURFACE * size)
        fields["axis"] = scene.camera.basis().right
    if wanted.kind in ("spot", "area") and not light.needs_direction:
        fields["direction"] = _to_the_middle(scene, fields.get("position", light.position))
    return fields


def _direction_from_place(scene: Scene, light: Light) -> dict[str, Any]:
    assert scene.camera is not None
    basis = scene.camera.basis() if light.attached == "viewer" else PATIENT_BASIS
    towards = light.towards(scene.camera.basis(), vec3(middle_of(scene)))
    tilt, rotation = angles_of(np.array([basis.right, basis.up, basis.back]) @ towards)
    return {"tilt": nearest_possible_tilt(tilt, light.aperture), "rotation": rotation}


def _first_place(scene: Scene, light: Light) -> dict[str, Any]:
    """Return the place towards a parallel light, just outside the visible box."""
    assert scene.camera is not None
    middle, size = middle_of(scene), diagonal_of(scene)
    towards = light.towards(scene.camera.basis(), vec3(middle))
    way = 0.5 * size
    if scene.volume is not None:
        corners = scene.volume.corners(scene.crop.low, scene.crop.high)
        centre, half = (corners.min(axis=0) + corners.max(axis=0)) / 2, np.ptp(corners, axis=0) / 2
        middle = centre
        # The way out of the box along the light: the nearest of its faces.
        way = float(np.min(half / np.maximum(np.abs(towards), 1e-9)))
    return {"position": within_reach(middle + towards * (way + ROOM * size))}


def _to_the_middle(scene: Scene, position: Vec3) -> Vec3:
    assert scene.camera is not None
    way = middle_of(scene) - np.asarray(position)
    length = float(np.linalg.norm(way))
    if length <= MIDDLE * diagonal_of(scene):
        return scene.camera.basis().forward
    return vec3(way / length)


# -- words --------------------------------------------------------------------------------------------
#: World axes (LPS): the letter where a coordinate is above zero and below, and what grows along it.
LETTERS = (("L", "R"), ("P", "A"), ("S", "I"))
AXES = (("Left", "right to left"), ("Back", "front to back"), ("Top", "bottom to top"))


def orientation_known(scene: Scene) -> bool:
    """Tell whether the world's axes are the patient's."""
    return scene.volume is None or scene.volume.info.orientation_known


def place_words(scene: Scene, position: Vec3) -> str:
    """Return a place in words: ``12.0 L, 3.5 A, 40.0 S mm``."""
    if not orientation_known(scene):
        return ", ".join(f"{name} {v:.1f}" for name, v in zip("xyz", position, strict=True)) + " mm"
    words = (f"{abs(v):.1f} {pair[v < 0]}" for v, pair in zip(position, LETTERS, strict=True))
    return ", ".join(words) + " mm"


def axis_names(scene: Scene) -> tuple[tuple[str, str], ...]:
    """Return the names of the world's axes: where a coordinate grows, and the whole way in words."""
    return AXES if orientation_known(scene) else tuple((name, name) for name in "xyz")


__all__ = [
    "KINDS",
    "LampKind",
    "as_kind",
    "axis_names",
    "diagonal_of",
    "dial_angles",
    "kind_of",
    "middle_of",
    "most_lamps",
    "moved",
    "offered_kinds",
    "place_words",
    "placed",
    "pointed",
    "seen_angles",
    "turned",
    "within_reach",
]
