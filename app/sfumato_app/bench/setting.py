"""What is drawn: volume, view, light and sampling distance, the same for every contender."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

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
    """

    size: int = 256
    viewport: int = 512
    step: float = 0.5
    tilt: float = 37.0
    aperture: float = 20.0
    rotation: float = 135.0

    @property
    def picture_size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.viewport, self.viewport

    def scene(self, technique: str) -> sfumato.Scene:
        """Return the scene for one of our techniques; on black, so that peers' pictures can be compared."""
        light = sfumato.Light(tilt=self.tilt, aperture=self.aperture, rotation=self.rotation)
        return sfumato.Scene(
            volume=phantom(self.size), transfer=TRANSFER, camera=CAMERA, lights=(light,), technique=technique,
            step=self.step, background=(0.0, 0.0, 0.0, 1.0),
        )  # fmt: skip

    def to_json(self) -> dict[str, Any]:
        """Return all numbers, for the report."""
        return {**asdict(self), "voxels": [self.size] * 3, "edge_mm": EDGE_MM, "projection": "perspective"}

    def __str__(self) -> str:
        n, p = self.size, self.viewport
        return f"{n} x {n} x {n} uint8, {p} x {p} pixels, step {self.step:g} voxel, perspective"
