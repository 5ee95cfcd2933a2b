"""The clip planes in the picture: outline, a handle that moves the plane along its normal, one that tilts it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from sfumato import Scene
from sfumato.scene import ClipPlane

from ..clip_planes import moved_to, unit, vec
from .crop import EDGES, along
from .handles import Handle
from .view import PictureView, Place

#: Length in pixels of the arm whose end tilts a plane, and the least at which its handle is drawn.
ARM, LEAST_ARM = 64.0, 34.0
_OUTWARDS = (0.25, 0.5, 0.75, 0.95)
#: How far past the rim, in arms, the hand swings the arm to the other side.
OVER_THE_RIM = 1.15


def outline(scene: Scene, plane: ClipPlane) -> np.ndarray:
    """Return the corners, in world mm and in order, of what a plane cuts out of the crop box; (n, 3)."""
    assert scene.volume is not None
    corners = scene.volume.corners(scene.crop.low, scene.crop.high)
    normal = unit(plane.normal)
    side = (corners - np.asarray(plane.point)) @ normal
    a, b = EDGES[:, (side[EDGES[0]] > 0) != (side[EDGES[1]] > 0)]
    if len(a) < 3:
        return np.zeros((0, 3))
    points = corners[a] + (corners[b] - corners[a]) * (side[a] / (side[a] - side[b]))[:, None]
    middle = points.mean(axis=0)
    across = unit(points[0] - middle)
    angles = np.arctan2((points - middle) @ np.cross(normal, across), (points - middle) @ across)
    return np.asarray(points[np.argsort(angles)])


def pivot(scene: Scene, view: PictureView, plane: ClipPlane) -> np.ndarray:
    """Return where a plane's handle sits and it turns about.

    The middle of its outline, or towards a corner of it if that is outside the picture; where the plane
    cuts nothing, its point nearest to the volume's middle.
    """
    assert scene.volume is not None
    corners = outline(scene, plane)
    if len(corners):
        middle = np.asarray(corners.mean(axis=0))
        spots = np.concatenate([middle[None], *(middle + share * (corners - middle) for share in _OUTWARDS)])
        return np.asarray(spots[int(np.argmax(view.shows(spots)))])
    normal, centre = unit(plane.normal), np.asarray(scene.volume.center)
    return np.asarray(centre + normal * float(normal @ (np.asarray(plane.point) - centre)))


def handles(scene: Scene, view: PictureView) -> list[Handle]:
    """Return the two handles of each plane that cuts."""
    made = []
    for i, plane in enumerate(scene.clip):
        middle = pivot(scene, view, plane)
        place = view.place(middle)
        if not plane.enabled or place is None:
            continue
        assert scene.volume is not None
        offset = float(unit(plane.normal) @ np.subtract(plane.point, scene.volume.center))
        move = along(view, middle, unit(plane.normal))
        made.append(Handle(f"plane.{i}.move", f"Plane {i + 1}: {offset:.1f} mm", place, move, "diamond"))
        made.append(
            Handle(f"plane.{i}.tilt", f"Tilt plane {i + 1}", arm_place(view, place, plane), None, "round")
        )
    return made


def arm(view: PictureView, plane: ClipPlane) -> np.ndarray:
    """Return the unit direction to the side that is cut away, in the camera's axes (right, up, back)."""
    return np.asarray(view.camera_axes @ -unit(plane.normal))


def arm_place(view: PictureView, middle: Place, plane: ClipPlane) -> Place:
    """Return where the end of a plane's arm is drawn: never so near that it hides the other handle."""
    x, y, _ = (float(c) for c in ARM * arm(view, plane))
    length = math.hypot(x, y)
    if length < 1e-6:
        return middle[0] + LEAST_ARM, middle[1]
    grown = max(length, LEAST_ARM) / length
    return middle[0] + grown * x, middle[1] - grown * y


class MoveGrip:
    """A plane in the hand that moves it."""

    def __init__(self, scene: Scene, view: PictureView, index: int, at: Place) -> None:
        assert scene.volume is not None
        self._plane, self._start, self._pivot = scene.clip[index], at, pivot(scene, view, scene.clip[index])
        self._normal = unit(self._plane.normal)
        centre = np.asarray(scene.volume.center)
        self._offset = float(self._normal @ (np.asarray(self._plane.point) - centre))
        reach = (scene.volume.corners() - centre) @ self._normal
        self._range = float(reach.min()), float(reach.max())

    def moved(self, view: PictureView, at: Place) -> ClipPlane:
        """Return the plane for a place of the pointer; it stays within the volume."""
        return self.travelled(view.travel(self._pivot, self._normal, self._start, at))

    def travelled(self, mm: float) -> ClipPlane:
        """Return the plane moved along its normal."""
        wanted = min(max(self._offset + mm, self._range[0]), self._range[1])
        return replace(self._plane, point=vec(moved_to(self._plane, wanted, self._offset)))


class TiltGrip:
    """A plane in the hand that tilts it: the end of the arm moves on a sphere, as wide as the arm is long."""

    def __init__(self, scene: Scene, view: PictureView, index: int, at: Place) -> None:
        self._plane, self._pivot = scene.clip[index], pivot(scene, view, scene.clip[index])
        tip = arm(view, self._plane)
        self._before = 1.0 if tip[2] >= 0 else -1.0
        self._outside = False
        # The pointer holds the arm where it took it.
        self._slip = tip[:2] - self._on_sphere(view, at)

    def _on_sphere(self, view: PictureView, at: Place) -> np.ndarray:
        middle = view.place(self._pivot) or (view.width / 2, view.height / 2)
        return np.array([at[0] - middle[0], middle[1] - at[1]]) / ARM

    def moved(self, view: PictureView, at: Place) -> ClipPlane:
        """Return the plane for a place of the pointer."""
        x, y = self._on_sphere(view, at) + self._slip
        radius = math.hypot(x, y)
        outside = radius > (1.0 if self._outside else OVER_THE_RIM)
        if outside and not self._outside:
            self._before = -self._before
        self._outside = outside
        if radius > 1:
            x, y = x / radius, y / radius
        tip = np.array([x, y, self._before * math.sqrt(max(0.0, 1 - x * x - y * y))])
        return turned(self._plane, self._pivot, view, tip)


def turned(plane: ClipPlane, middle: np.ndarray, view: PictureView, tip: np.ndarray) -> ClipPlane:
    """Return a plane through a point whose arm has a direction given in the camera's axes."""
    away = view.camera_axes.T @ tip
    return replace(plane, point=vec(middle), normal=vec(-unit(away)))


def tilted_by(scene: Scene, view: PictureView, index: int, right: float, up: float) -> ClipPlane:
    """Return a plane whose arm is turned to the right and up, in degrees as the eye sees it."""
    plane = scene.clip[index]
    x, y, z = arm(view, plane)
    a, b = math.radians(right), math.radians(up)
    x, z = x * math.cos(a) + z * math.sin(a), z * math.cos(a) - x * math.sin(a)
    y, z = y * math.cos(b) + z * math.sin(b), z * math.cos(b) - y * math.sin(b)
    return turned(plane, pivot(scene, view, plane), view, np.array([x, y, z]))
