"""A scene for every technique, and the sides of pictures that each can draw in reasonable time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import sfumato
from sfumato import Camera, Light, Scene, TransferFunction, Volume

#: Sides in pixels of techniques that are slow by design.
SLOW = {"reference": 16}


@pytest.fixture(scope="session")
def side_of() -> Callable[[str, int], int]:
    """Return the side of a technique's pictures, given the usual one."""
    return lambda technique, usual: min(usual, SLOW.get(technique, usual))


@pytest.fixture(scope="session")
def still(still_life: Volume, still_life_colors: TransferFunction) -> Callable[..., Scene]:
    """Return the still life under one light, by a technique."""
    center = still_life.center
    eye = (center[0] + 25, center[1] - 95, center[2] + 20)
    camera = Camera(position=eye, focal_point=center, view_up=(0, 0, 1), view_angle=34)

    def scene(
        technique: Any, tilt: float = 40, aperture: float = 15, rotation: float = 135, **more: Any
    ) -> Scene:
        lights = (Light(tilt=tilt, aperture=aperture, rotation=rotation),)
        values = {"transfer": still_life_colors, "camera": camera, "lights": lights, **more}
        return Scene(volume=still_life, technique=technique, background=(0, 0, 0, 1), **values)

    return scene


@pytest.fixture(scope="session")
def draw() -> Callable[[Scene, int], Any]:
    """Draw a square picture: float, linear, premultiplied, clipped to what can be shown."""
    return lambda scene, side: sfumato.render(scene, (side, side), linear=True).clip(0, 1)
