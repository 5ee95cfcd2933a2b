"""Lights, and the geometry of where they shine from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..errors import SceneError
from .camera import Basis
from .params import Param, check
from .vectors import angles_of

Vec3 = tuple[float, float, float]

KINDS = ("directional", "point", "spot", "area")
SHAPES = ("rectangle", "sphere", "tube")
#: No lamp is farther away or larger than this, in mm: what 32-bit numbers on the GPU still tell apart.
FARTHEST = 1e6
#: Shortest vector that still has a direction.
SHORTEST = 1e-6

#: Basis in which tilt and rotation of a light attached to the patient are meant: the standard front view.
PATIENT_BASIS = Basis(right=(1.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), back=(0.0, -1.0, 0.0))


@dataclass(frozen=True)
class Light:
    """One lamp.

    A *directional* light is parallel: ``tilt`` is its angle from the viewing axis, ``rotation`` runs
    counter-clockwise from image right (135 is the illustrators' top left), ``aperture`` is the *half*
    angle of its cone, and with it the softness of its shadows (Soltesova2010, Eq. 2). Attached to the
    ``viewer`` it turns with the camera; attached to the ``patient`` the angles refer to the standard
    front view and the lamp stays where it is when the camera moves.

    ``point``, ``spot`` and ``area`` lights have a place in world space and stay there whatever the camera
    does; techniques that know parallel light alone treat them as parallel light from that place (see
    `towards`). A point lamp is a small ball. A spot's beam is full up to ``spread - edge`` from its
    direction and dark from ``spread`` on. An area lamp is a ``rectangle`` that shines to the side its
    direction says, a ``sphere``, or a ``tube`` along its axis. What reaches a point at a distance is told
    by `sfumato.scene.lamps`.

    Raises
    ------
    SceneError
        If a value is out of range, tilt and aperture put the light neither before nor behind the subject,
        or a direction that the lamp needs has no length.
    """

    kind: Annotated[str, Param("Kind of lamp", choices=KINDS)] = "directional"
    tilt: Annotated[
        float,
        Param(
            "Angle between the light and the viewing axis; 0 is a headlamp",
            label="Tilt",
            unit="deg",
            ge=0,
            le=180,
            soft=(0, 180),
            source="Soltesova2010, Fig. 2",
            stale="kernel",
            tab="light",
        ),
    ] = 37.0
    aperture: Annotated[
        float,
        Param(
            "Half angle of the light's cone: the softness of its shadows",
            label="Aperture",
            unit="deg",
            gt=0,
            lt=90,
            soft=(1, 60),
            source="Soltesova2010, Eq. 2",
            stale="kernel",
            tab="light",
        ),
    ] = 20.0
    rotation: Annotated[
        float,
        Param(
            "Direction of the light in the picture, counter-clockwise from the right; 135 is top left",
            label="Rotation",
            unit="deg",
            ge=-360,
            le=720,
            soft=(0, 360),
            source="Soltesova2010, Eq. 12",
            stale="kernel",
            tab="light",
        ),
    ] = 135.0
    color: Annotated[tuple[float, float, float], Param("Colour, linear RGB", ge=0, le=100)] = (1.0, 1.0, 1.0)
    intensity: Annotated[
        float,
        Param(
            "1 lights a facing surface to its own colour",
            label="Intensity",
            ge=0,
            le=100,
            soft=(0, 3),
            tab="light",
        ),
    ] = 1.0
    attached: Annotated[str, Param("What the lamp moves with", choices=("viewer", "patient"))] = "viewer"
    name: str = "key"
    enabled: bool = True
    position: Annotated[
        Vec3, Param("Place of the lamp, world space", unit="mm", ge=-FARTHEST, le=FARTHEST)
    ] = (0.0, 0.0, 0.0)
    radius: Annotated[
        float,
        Param(
            "Radius of a point, spot, sphere or tube lamp: the larger, the softer its shadows",
            label="Radius",
            unit="mm",
            gt=0,
            le=FARTHEST,
            soft=(0.1, 50),
            stale="light",
            tab="light",
        ),
    ] = 1.0
    direction: Annotated[
        Vec3, Param("Direction in which a spot or a rectangle shines", ge=-FARTHEST, le=FARTHEST)
    ] = (0.0, 1.0, 0.0)
    spread: Annotated[
        float,
        Param(
            "Half angle of a spot's beam: from there on it is dark",
            label="Beam",
            unit="deg",
            gt=0,
            lt=90,
            soft=(1, 80),
            stale="light",
            tab="light",
        ),
    ] = 30.0
    edge: Annotated[
        float,
        Param(
            "Angle over which a spot's beam fades, inwards from where it is dark",
            label="Beam edge",
            unit="deg",
            ge=0,
            le=90,
            soft=(0, 30),
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 5.0
    shape: Annotated[str, Param("What an area lamp is", choices=SHAPES)] = "rectangle"
    size: Annotated[
        tuple[float, float],
        Param("Width and height of a rectangle; the first is a tube's length", unit="mm", gt=0, le=FARTHEST),
    ] = (10.0, 10.0)
    axis: Annotated[
        Vec3, Param("Direction of a tube, or of a rectangle's width", ge=-FARTHEST, le=FARTHEST)
    ] = (1.0, 0.0, 0.0)
    reach: Annotated[
        float | None,
        Param(
            "Distance at which the light has halved; none: it is as bright everywhere",
            label="Reach",
            unit="mm",
            gt=0,
            le=FARTHEST,
            soft=(1, 500),
            stale="light",
            tab="light",
            level="more",
            none_label="everywhere",
        ),
    ] = None
    solo: bool = False

    def __post_init__(self) -> None:
        check(self)
        if self.kind == "directional" and not tilt_is_possible(self.tilt, self.aperture):
            raise SceneError(
                "tilt",
                self.tilt,
                f"with aperture {self.aperture:g} deg allowed: 0 <= tilt < {90 - self.aperture:g} (before the subject) "
                f"or {90 + self.aperture:g} < tilt <= 180 (behind it)",
            )
        if self.needs_direction and not math.hypot(*self.direction) > SHORTEST:
            raise SceneError("direction", self.direction, "a direction of non-zero length is needed")
        if self.kind == "area" and self.shape == "tube" and not math.hypot(*self.axis) > SHORTEST:
            raise SceneError("axis", self.axis, "a direction of non-zero length is needed")

    @property
    def placed(self) -> bool:
        """Whether the lamp has a place in the world."""
        return self.kind != "directional"

    @property
    def needs_direction(self) -> bool:
        """Whether the lamp shines to one side."""
        return self.kind == "spot" or (self.kind == "area" and self.shape == "rectangle")

    @property
    def sides(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors along a rectangle's width and height; the width follows ``axis`` as far as it can."""
        shines = np.asarray(self.direction) / math.hypot(*self.direction)
        width = np.asarray(self.axis) - shines * float(np.dot(shines, self.axis))
        if np.linalg.norm(width) <= SHORTEST * max(1.0, math.hypot(*self.axis)):
            width = np.cross(shines, np.eye(3)[int(np.argmin(np.abs(shines)))])
        width = width / np.linalg.norm(width)
        return width, np.cross(shines, width)

    def towards(self, basis: Basis, target: Vec3) -> np.ndarray:
        """Return the unit vector from the subject towards the light, world space.

        Parameters
        ----------
        basis : Basis
            The camera's basis.
        target : tuple of float
            The subject's centre in mm, for lamps that have a place.
        """
        if self.kind != "directional":
            away = np.subtract(self.position, target)
            length = float(np.linalg.norm(away))
            return away / length if length > 0 else np.asarray(basis.back, dtype=float)
        frame = basis if self.attached == "viewer" else PATIENT_BASIS
        tilt, phi = math.radians(self.tilt), math.radians(self.rotation)
        return np.asarray(
            math.sin(tilt) * math.cos(phi) * np.asarray(frame.right)
            + math.sin(tilt) * math.sin(phi) * np.asarray(frame.up)
            + math.cos(tilt) * np.asarray(frame.back)
        )

    def angles(self, basis: Basis, target: Vec3) -> tuple[float, float]:
        """Return the light's tilt and rotation in degrees as a camera sees it.

        A light that is attached to the patient, or that has a place, can come to stand beside the
        subject, where the slice methods have no answer: its tilt is moved to the nearest one that has.
        """
        if self.kind == "directional" and self.attached == "viewer":
            return self.tilt, self.rotation % 360.0
        towards = self.towards(basis, target)
        tilt, rotation = angles_of(np.array([basis.right, basis.up, basis.back]) @ towards)
        return nearest_possible_tilt(tilt, self.aperture), rotation


def shining(lights: tuple[Light, ...]) -> tuple[Light, ...]:
    """Return the lamps that shine: those that are not muted; of them only the solo ones, if there are any."""
    enabled = tuple(light for light in lights if light.enabled)
    chosen = tuple(light for light in enabled if light.solo) or enabled
    return tuple(light for light in chosen if light.intensity > 0)


#: Angle in degrees that keeps a cone clear of grazing incidence, where its section grows without bound.
GRAZING_MARGIN = 1.0


def tilt_is_possible(tilt: float, aperture: float) -> bool:
    """Tell whether a cone lies wholly before or wholly behind the slices (Soltesova2010, section 3.2)."""
    return 0.0 <= tilt < 90.0 - aperture or 90.0 + aperture < tilt <= 180.0


def nearest_possible_tilt(tilt: float, aperture: float) -> float:
    """Return the tilt in degrees nearest to the wanted one that `tilt_is_possible` and is not grazing."""
    front = max(0.0, 90.0 - aperture - GRAZING_MARGIN)
    rear = min(180.0, 90.0 + aperture + GRAZING_MARGIN)
    tilt = max(0.0, min(180.0, tilt))
    if tilt <= front or tilt >= rear:
        return tilt
    return front if tilt - front <= rear - tilt else rear
