"""Parameters of `multidirectional` and `directional`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...scene.params import Param
from ...scene.scene import TechniqueParams
from ..phong import Shininess

#: How fine the light's grid is.
Resolution = Annotated[
    float,
    Param(
        "Texels of the occlusion buffer per voxel",
        label="Shadow resolution",
        unit="texel/voxel",
        ge=0.1,
        le=4,
        soft=(0.25, 2),
        stale="light",
        tab="light",
        level="more",
    ),
]


@dataclass(frozen=True)
class ShadowParams(TechniqueParams):
    """What all techniques that sweep light share."""

    specular: Annotated[
        float,
        Param(
            "Strength of gradient-based highlights",
            label="Highlights",
            ge=0,
            le=2,
            soft=(0, 1),
            source="Soltesova2010, Fig. 11",
            tab="light",
        ),
    ] = 0.0
    shininess: Shininess = 40.0
    ambient: Annotated[
        float, Param("Share of each lamp that no shadow takes away", label="Ambient", ge=0, le=1, tab="light")
    ] = 0.0
    resolution: Resolution = 1.0


@dataclass(frozen=True)
class OcclusionParams(ShadowParams):
    """What the published occlusion sweeps share."""

    # An edge of one voxel needs more than two texels, or it loses contrast (docs/candidates.md).
    resolution: Resolution = 1.25

    occlusion: Annotated[
        str,
        Param(
            "How opacity accumulates towards the light: ours, or one of the two published forms",
            label="Occlusion",
            choices=("extinction", "additive", "multiplicative"),
            source="Soltesova2010, Eq. 13-14; Schott2009",
            stale="program",
            tab="light",
            level="more",
        ),
    ] = "extinction"
    falloff: Annotated[
        str,
        Param(
            "Weight across the footprint",
            label="Fall-off",
            choices=("linear", "gaussian"),
            source="Soltesova2010, Eq. 10-11, Fig. 7",
            stale="kernel",
            tab="light",
            level="more",
        ),
    ] = "linear"


@dataclass(frozen=True)
class MultidirectionalParams(OcclusionParams):
    """Light from any tilt and rotation."""


@dataclass(frozen=True)
class DirectionalParams(OcclusionParams):
    """Every light is a headlamp."""
