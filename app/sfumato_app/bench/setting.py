"""What is drawn: volume, view, light and sampling distance, the same for every contender."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import sfumato

from .phantom import EDGE_MM, TRANSFER, phantom

_MIDDLE = (EDGE_MM / 2,) * 3
#: A fixed perspective view: from the front, a little from the left and from above.
CAMERA = sfumato.Camera(
    position=(_MIDDLE[0] + 200.0, _MIDDLE[1] - 500.0, _MIDDLE[2] + 110.0),
    focal_point=_MIDDLE,
    view_angle=25.0,
)


@dataclass(frozen=True)
class Setting:
    """One task, set to all contenders alike.

    Parameters
    ----------
    size : int
        Voxels along each side of the volume.
    viewport : int
        Pixels along each side of the picture.
    step : float
        Sampling distance in voxels.
    tilt, aperture, rotation : float
        The light, in degrees.
    lights : int
        Number of lamps, 1 to 4, spread evenly about the view axis; all as bright together as one.
    """

    size: int = 256
    viewport: int = 512
    step: float = 0.5
    tilt: float = 37.0
    aperture: float = 20.0
    rotation: float = 135.0
    lights: int = 1

    @classmethod
    def sliced(cls, size: int, viewport: int, slices: int, lights: int) -> Setting:
        """Return the setting whose sampling distance cuts the volume's depth into a number of slices."""
        corners = np.array([(x, y, z) for x in (0, EDGE_MM) for y in (0, EDGE_MM) for z in (0, EDGE_MM)])
        depth = float(np.ptp(corners @ np.asarray(CAMERA.basis().forward)))
        return cls(size=size, viewport=viewport, step=depth / slices / (EDGE_MM / size), lights=lights)

    @property
    def picture_size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.viewport, self.viewport

    def scene(self, technique: str) -> sfumato.Scene:
        """Return the scene for one of our techniques; on black, so that peers' pictures can be compared."""
        lights = tuple(
            sfumato.Light(
                tilt=self.tilt, aperture=self.aperture, intensity=1 / self.lights,
                rotation=self.rotation + k * 360 / self.lights,
            )
            for k in range(self.lights)
        )  # fmt: skip
        return sfumato.Scene(
            volume=phantom(self.size), transfer=TRANSFER, camera=CAMERA, lights=lights, technique=technique,
            step=self.step, background=(0.0, 0.0, 0.0, 1.0),
        )  # fmt: skip

    def to_json(self) -> dict[str, Any]:
        """Return all numbers, for the report."""
        return {**asdict(self), "voxels": [self.size] * 3, "edge_mm": EDGE_MM, "projection": "perspective"}

    def __str__(self) -> str:
        n, p = self.size, self.viewport
        return f"{n} x {n} x {n} uint8, {p} x {p} pixels, step {self.step:g} voxel, perspective"
