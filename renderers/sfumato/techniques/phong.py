"""The parameters of gradient-based (Blinn-Phong) shading, shared by the techniques that have it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..scene.params import Param
from ..scene.scene import TechniqueParams

Shininess = Annotated[
    float,
    Param(
        "Sharpness of highlights", label="Shininess", ge=1, le=1000, soft=(1, 200), tab="light", level="more"
    ),
]
SlopeShading = Annotated[
    float,
    Param(
        "How much surfaces that turn away from a lamp are darker",
        label="Slope shading",
        ge=0,
        le=1,
        tab="light",
        level="more",
    ),
]


@dataclass(frozen=True)
class PhongParams(TechniqueParams):
    """Blinn-Phong shading of gradients computed on the fly."""

    ambient: Annotated[
        float, Param("Light that reaches every side", label="Ambient", ge=0, le=1, tab="light")
    ] = 0.15
    diffuse: Annotated[
        float,
        Param("Light scattered by a surface that faces the lamp", label="Diffuse", ge=0, le=2, tab="light"),
    ] = 0.85
    specular: Annotated[
        float, Param("Strength of highlights", label="Specular", ge=0, le=2, soft=(0, 1), tab="light")
    ] = 0.25
    shininess: Shininess = 40.0
