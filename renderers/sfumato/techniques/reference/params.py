"""Parameters of `reference`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...scene.params import Param
from ...scene.scene import TechniqueParams


@dataclass(frozen=True)
class ReferenceParams(TechniqueParams):
    """How finely the ray-traced cone integral is sampled."""

    directions: Annotated[
        int,
        Param(
            "Directions in each light's cone, uniform in solid angle",
            label="Directions",
            ge=1,
            le=4096,
            soft=(16, 256),
            tab="light",
        ),
    ] = 64
    light_step: Annotated[
        float,
        Param(
            "Sampling distance towards the light",
            label="Light step",
            unit="voxel",
            ge=0.05,
            le=8,
            tab="light",
            level="more",
        ),
    ] = 0.5
