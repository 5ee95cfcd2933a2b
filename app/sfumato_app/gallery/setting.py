"""Cameras and lamps that the figures share."""

from __future__ import annotations

import math

from sfumato import Camera, Light, Scene

from .figure import FRAMES, PAPER

Vec3 = tuple[float, float, float]

#: The lamp at the eye, the illustrators' lamp and its mirror image below.
HEADLAMP = Light(tilt=0, aperture=42)
TOP_LEFT = Light(tilt=31, aperture=30, rotation=135)
BOTTOM_LEFT = Light(tilt=31, aperture=30, rotation=225)
#: Light that no shadow takes away: shadows in print keep some colour.
AMBIENT = 0.15


def look(center: Vec3, height: float, *, turn: float = 0.0, lift: float = 0.0, lens: float = 20.0) -> Camera:
    """Return a camera that looks at a point.

    Parameters
    ----------
    center : (x, y, z)
        World space, mm.
    height : float
        What the picture's height spans at that point, mm.
    turn : float
        How far the eye has walked around to the patient's left, degrees from the front.
    lift : float
        How far it has risen, degrees.
    lens : float
        Vertical opening in degrees.
    """
    a, b = math.radians(turn), math.radians(lift)
    away = height / 2 / math.tan(math.radians(lens) / 2)
    side = (math.sin(a) * math.cos(b), -math.cos(a) * math.cos(b), math.sin(b))
    x, y, z = (c + away * s for c, s in zip(center, side, strict=True))
    return Camera(position=(x, y, z), focal_point=center, view_up=(0, 0, 1), view_angle=lens)


def still(scene: Scene) -> Scene:
    """Return a scene on paper, drawn with as many frames as print needs."""
    return scene.with_(background=PAPER, frames=FRAMES)


def phong(scene: Scene, technique: str) -> Scene:
    """Return a scene with gradient shading, lit from the eye."""
    shading = {"technique.ambient": 0.2, "technique.diffuse": 0.75, "technique.specular": 0.15}
    return scene.with_(technique=technique, lights=(HEADLAMP,)).with_(shading)


def headlamp(scene: Scene, **shading: float) -> Scene:
    """Return a scene with directional occlusion shading, lit from the eye."""
    return _occluded(scene, "directional", HEADLAMP, shading)


def lit(scene: Scene, light: Light = TOP_LEFT, **shading: float) -> Scene:
    """Return a scene with multidirectional occlusion shading."""
    return _occluded(scene, "multidirectional", light, shading)


def _occluded(scene: Scene, technique: str, light: Light, shading: dict[str, float]) -> Scene:
    changes = {f"technique.{name}": value for name, value in {"ambient": AMBIENT, **shading}.items()}
    return scene.with_(technique=technique, lights=(light,)).with_(changes)
