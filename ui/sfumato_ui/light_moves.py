"""Where a lamp is drawn on the dial's disc, and which lamp a place on the disc means. No Qt.

The disc is the hemisphere of directions before the subject, seen from the viewer: a front light of tilt t
lies at radius sin t. A ring around it, a third as wide, holds the lights behind the subject: tilt 90
degrees at its inner edge, 180 at its outer. x points right, y up; the disc's radius is 1.
"""

from __future__ import annotations

import math

import numpy as np

from sfumato import Light
from sfumato.scene import nearest_possible_tilt
from sfumato.scene.light import GRAZING_MARGIN
from sfumato.scene.vectors import angles_of

#: Outer radius of the ring of rear lights.
RING = 1.32
#: Softest light that the dial and the slider offer, in degrees.
MAX_APERTURE = 80.0
MIN_APERTURE = 1.0


def to_disc(tilt: float, rotation: float) -> tuple[float, float]:
    """Return the place on the disc of a light's tilt and rotation in degrees."""
    radius = math.sin(math.radians(tilt)) if tilt <= 90 else 1 + (RING - 1) * (tilt - 90) / 90
    phi = math.radians(rotation)
    return radius * math.cos(phi), radius * math.sin(phi)


def from_disc(x: float, y: float, rotation: float = 0.0) -> tuple[float, float]:
    """Return tilt and rotation in degrees of a place on the disc; at the very centre the rotation stays."""
    radius = math.hypot(x, y)
    if radius > 1e-6:
        rotation = math.degrees(math.atan2(y, x)) % 360.0
    if radius <= 1:
        return math.degrees(math.asin(radius)), rotation
    return min(180.0, 90 + 90 * (radius - 1) / (RING - 1)), rotation


def direction(tilt: float, rotation: float) -> np.ndarray:
    """Return the unit vector (right, up, towards the viewer) of a tilt and rotation in degrees."""
    t, phi = math.radians(tilt), math.radians(rotation)
    return np.array([math.sin(t) * math.cos(phi), math.sin(t) * math.sin(phi), math.cos(t)])


def cone_outline(light: Light, points: int = 64) -> list[tuple[float, float]]:
    """Return the edge of a light's cone as places on the disc."""
    axis = direction(light.tilt, light.rotation)
    across, along = _tangents(light.rotation, axis)
    a = math.radians(light.aperture)
    edge = []
    for phi in np.linspace(0, 2 * math.pi, points, endpoint=False):
        edge.append(
            to_disc(
                *angles_of(
                    math.cos(a) * axis + math.sin(a) * (math.cos(phi) * across + math.sin(phi) * along)
                )
            )
        )
    return edge


def cone_handle(light: Light) -> tuple[float, float]:
    """Return the place on the cone's edge, sideways of the light, where its handle sits."""
    axis = direction(light.tilt, light.rotation)
    across, _ = _tangents(light.rotation, axis)
    a = math.radians(light.aperture)
    return to_disc(*angles_of(math.cos(a) * axis + math.sin(a) * across))


def _tangents(rotation: float, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    phi = math.radians(rotation)
    across = np.array([-math.sin(phi), math.cos(phi), 0.0])
    return across, np.cross(across, axis)


def moved(light: Light, dx: float, dy: float) -> dict[str, float]:
    """Return the tilt and rotation of a light moved over the disc by (dx, dy) radii, as far as allowed."""
    x, y = to_disc(light.tilt, light.rotation)
    tilt, rotation = from_disc(x + dx, y + dy, light.rotation)
    return {"tilt": nearest_possible_tilt(tilt, light.aperture), "rotation": rotation}


def largest_aperture(tilt: float) -> float:
    """Return the softest aperture in degrees that a tilt allows, clear of grazing incidence."""
    room = 90 - tilt if tilt < 90 else tilt - 90
    return max(MIN_APERTURE, min(MAX_APERTURE, room - GRAZING_MARGIN))


def tilt_ranges(aperture: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ranges of tilt in degrees before and behind the subject that an aperture allows."""
    return (0.0, max(0.0, 90 - aperture - GRAZING_MARGIN)), (
        min(180.0, 90 + aperture + GRAZING_MARGIN),
        180.0,
    )
