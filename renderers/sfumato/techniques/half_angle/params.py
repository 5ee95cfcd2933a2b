"""Parameters of `half-angle`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...scene.params import Param
from ...scene.scene import TechniqueParams


@dataclass(frozen=True)
class HalfAngleParams(TechniqueParams):
    """Half-angle slicing for one light."""

    softness: Annotated[
        bool,
        Param(
            "Blur the light buffer by the lamp's aperture as it is carried on (off: hard shadows)",
            label="Soft",
            source="Kniss2003, section 3.3",
            tab="light",
        ),
    ] = True
    resolution: Annotated[
        float,
        Param(
            "Texels of the light buffer per voxel",
            label="Shadow resolution",
            unit="texel/voxel",
            ge=0.1,
            le=4,
            soft=(0.25, 2),
            tab="light",
            level="more",
        ),
    ] = 1.0
