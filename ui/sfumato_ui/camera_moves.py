"""Cameras that result from the moves of a hand: orbit, pan, zoom, lens, projection. No Qt.

The orbit is a turntable: sideways turns about the up axis, upwards tips towards the pole, and stops short
of it, so that the picture never flips over.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from sfumato import Camera, Scene
from sfumato.scene import STANDARD_VIEWS
from sfumato.scene.presets import suggest_view
from sfumato.scene.vectors import vec3

from .subject import bounds_of

#: Closest approach to the poles in degrees.
POLE_MARGIN = 1.0
#: Limits of the distance between eye and focal point, relative to the subject's size.
NEAREST, FARTHEST = 0.02, 50.0


def _turned(vector: np.ndarray, axis: np.ndarray, degrees: float) -> np.ndarray:
    """Rotate a vector about a unit axis (Rodrigues)."""
    a = math.radians(degrees)
    turned = (
        vector * math.cos(a)
        + np.cross(axis, vector) * math.sin(a)
        + axis * (axis @ vector) * (1 - math.cos(a))
    )
    return np.asarray(turned)


def orbit(camera: Camera, azimuth: float, elevation: float) -> Camera:
    """Turn the camera about its focal point.

    Parameters
    ----------
    azimuth : float
        Degrees about the up axis; positive turns the subject to the right.
    elevation : float
        Degrees towards the up pole; positive looks more from above.
    """
    up = np.asarray(camera.view_up, dtype=float)
    up /= np.linalg.norm(up)
    arm = np.subtract(camera.position, camera.focal_point)
    # The angle from the pole stays within its limits, so that up never becomes parallel to the view.
    polar = math.degrees(math.acos(float(np.clip(arm @ up / np.linalg.norm(arm), -1, 1))))
    elevation = polar - max(POLE_MARGIN, min(180 - POLE_MARGIN, polar - elevation))
    right = np.asarray(camera.basis().right)
    arm = _turned(_turned(arm, right, -elevation), up, -azimuth)
    return replace(camera, position=vec3(np.asarray(camera.focal_point) + arm))


def pan(camera: Camera, dx: float, dy: float) -> Camera:
    """Shift the camera so that the focal plane follows the hand by (dx, dy) picture heights, y up."""
    basis = camera.basis()
    height = 2 * picture_half_height(camera)
    shift = -height * (dx * np.asarray(basis.right) + dy * np.asarray(basis.up))
    return replace(
        camera,
        position=vec3(np.asarray(camera.position) + shift),
        focal_point=vec3(np.asarray(camera.focal_point) + shift),
    )


def zoom(camera: Camera, factor: float, x: float = 0.0, y: float = 0.0, size: float = 0.0) -> Camera:
    """Enlarge the picture by a factor, keeping what is under the cursor in its place.

    Parameters
    ----------
    x, y : float
        Cursor's offset from the picture's centre in picture heights, y up.
    size : float
        Diameter of the subject in mm, which bounds the zoom; no bounds if 0.
    """
    half = picture_half_height(camera)
    if size > 0:
        factor = half / max(NEAREST * size, min(FARTHEST * size, half / factor))
    arm = np.subtract(camera.position, camera.focal_point)
    closer = replace(camera, position=vec3(np.asarray(camera.focal_point) + arm / factor))
    if camera.parallel_projection:
        # The eye keeps its distance, so that it does not move into the subject.
        closer = replace(camera, parallel_scale=camera.parallel_scale / factor)
    return pan(closer, x * (1 - factor), y * (1 - factor))


def centred(camera: Camera, point: tuple[float, float, float]) -> Camera:
    """Return the camera moved sideways and along the view so that it looks at, and turns about, a point."""
    shift = np.subtract(point, camera.focal_point)
    return replace(
        camera,
        position=vec3(np.asarray(camera.position) + shift),
        focal_point=vec3(np.asarray(point)),
        window_center=(0.0, 0.0),
    )


def picture_half_height(camera: Camera) -> float:
    """Return half the height in mm of what the picture shows in the focal plane."""
    if camera.parallel_projection:
        return camera.parallel_scale
    return camera.distance * math.tan(math.radians(camera.view_angle) / 2)


def with_lens(camera: Camera, view_angle: float) -> Camera:
    """Change the opening of a perspective view, stepping back so that the subject keeps its size."""
    distance = picture_half_height(camera) / math.tan(math.radians(view_angle) / 2)
    return _at_distance(replace(camera, view_angle=view_angle), distance)


def with_projection(camera: Camera, parallel: bool) -> Camera:
    """Switch between orthographic and perspective, keeping the size in the focal plane."""
    if parallel == camera.parallel_projection:
        return camera
    half = picture_half_height(camera)
    if parallel:
        return replace(camera, parallel_projection=True, parallel_scale=half)
    distance = half / math.tan(math.radians(camera.view_angle) / 2)
    return _at_distance(replace(camera, parallel_projection=False), distance)


def _at_distance(camera: Camera, distance: float) -> Camera:
    arm = np.subtract(camera.position, camera.focal_point)
    arm = arm / np.linalg.norm(arm) * distance
    return replace(camera, position=vec3(np.asarray(camera.focal_point) + arm))


def from_side(camera: Camera, view: str) -> Camera:
    """Return the camera moved to a standard view, with the same focal point, distance and lens."""
    side, up = STANDARD_VIEWS[view]
    arm = np.asarray(side, dtype=float) * camera.distance
    return replace(camera, position=vec3(np.asarray(camera.focal_point) + arm), view_up=up)


def whole_view(scene: Scene, aspect: float, view: str = "") -> Camera | None:
    """Return the camera that sees the whole subject, with the lens and projection of the scene's own.

    Parameters
    ----------
    aspect : float
        The picture's width over its height.
    view : str
        Name of a standard view; the camera's own direction if empty.
    """
    camera = scene.camera
    corners = bounds_of(scene)
    if corners is None or camera is None:
        return None
    looking = from_side(camera, view) if view else camera
    basis = looking.basis()
    if scene.volume is None:
        whole = Camera.fit(
            corners, (basis.back, basis.up), aspect=aspect,
            view_angle=camera.view_angle, parallel_projection=camera.parallel_projection,
        )  # fmt: skip
        return replace(whole, view_up=looking.view_up)
    whole = suggest_view(
        scene.volume, scene.transfer, (basis.back, basis.up), aspect=aspect,
        view_angle=camera.view_angle, parallel_projection=camera.parallel_projection,
    )  # fmt: skip
    # The turntable's axis stays what it was: a tilted camera's own up is only what is up in the picture.
    return replace(whole, view_up=looking.view_up)


def edge_letters(camera: Camera) -> dict[str, str]:
    """Return the patient's direction (R, L, A, P, S, I) at the picture's right, left, top and bottom edge."""
    basis = camera.basis()
    return {
        "right": _letter(basis.right), "left": _letter(tuple(-c for c in basis.right)),
        "top": _letter(basis.up), "bottom": _letter(tuple(-c for c in basis.up)),
    }  # fmt: skip


def _letter(axis: tuple[float, ...]) -> str:
    """Name the nearest axis of the patient (LPS)."""
    i = int(np.argmax(np.abs(axis)))
    return ("RL", "AP", "IS")[i][int(axis[i] > 0)]
