"""Parameters of `local-occlusion`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...scene.params import Param
from ...scene.scene import TechniqueParams
from ..phong import SlopeShading


@dataclass(frozen=True)
class LocalOcclusionParams(TechniqueParams):
    """How far each point looks, how often, and what the light is combined with."""

    brightness: Annotated[
        float,
        Param(
            "Strength of the light from all around; open space gets it all, a plain surface half",
            label="Brightness",
            ge=0,
            le=10,
            soft=(0, 3),
            tab="light",
        ),
    ] = 1.8
    radius: Annotated[
        float | None,
        Param(
            "How far each point looks for what takes its light; automatic: 6 % of the volume's longest side",
            label="Radius",
            unit="mm",
            gt=0,
            le=1e6,
            soft=(1, 60),
            source="Hernell2007, Eq. 1",
            stale="light",
            tab="light",
            none_label="automatic",
        ),
    ] = None
    bias: Annotated[
        float,
        Param(
            "Light that every point gets, however deep it lies",
            label="Least light",
            ge=0,
            le=1,
            soft=(0, 0.5),
            source="Hernell2007, Eq. 3",
            tab="light",
        ),
    ] = 0.05
    lamps: Annotated[
        str,
        Param(
            "What the lamps add: nothing, shading of what faces them, or shadows as in cone or multidirectional",
            label="Lamps",
            choices=("off", "diffuse", "shadows", "multidirectional"),
            source="Hernell2007, Fig. 10",
            stale="program",
            tab="light",
        ),
    ] = "diffuse"
    mode: Annotated[
        str,
        Param(
            "How lamps and light from all around are combined",
            label="Combination",
            choices=("product", "mix"),
            stale="program",
            tab="light",
        ),
    ] = "product"
    share: Annotated[
        float,
        Param("Share of the lamps in a mix", label="Share of lamps", ge=0, le=1, tab="light"),
    ] = 0.4
    emission: Annotated[
        str,
        Param(
            "Where tissue that gives off light is seen: on its surroundings, in itself, both, or nowhere",
            label="Emission",
            choices=("both", "gathering", "casting", "none"),
            source="Hernell2007, Fig. 4",
            stale="light",
            tab="light",
        ),
    ] = "both"
    directions: Annotated[
        int,
        Param(
            "Rays from each point: 4, 8, 16, 20, 32, 64, 80, 128 or more, the nearest counts; 1 goes to the lamp",
            label="Directions",
            ge=1,
            le=512,
            soft=(1, 128),
            source="Hernell2007, 4.2",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 32
    samples: Annotated[
        int,
        Param(
            "Samples along each ray where the blocks are finest",
            label="Samples",
            ge=2,
            le=128,
            soft=(4, 64),
            source="Hernell2007, Eq. 2",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 16
    offset: Annotated[
        float,
        Param(
            "Where rays begin, so that a surface does not shade itself",
            label="Start of rays",
            unit="voxel",
            ge=0,
            le=16,
            soft=(0, 4),
            source="Hernell2007, Eq. 1",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 0.8
    gamma: Annotated[
        float,
        Param(
            "Exponent on what matter lets through: how dark its shadows are",
            label="Shadow strength",
            ge=0,
            le=20,
            soft=(0, 4),
            source="Hernell2007, Eq. 5",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 1.0
    preference: Annotated[
        float,
        Param(
            "How much light from the first lamp's side counts more than light from elsewhere",
            label="Preferred side",
            ge=0,
            le=1,
            source="Hernell2007, Eq. 3",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 0.0
    facing: SlopeShading = 1.0
    reduction: Annotated[
        float | None,
        Param(
            "Voxels of the volume to a texel of its light, at least; automatic: more for larger volumes",
            label="Data reduction",
            ge=1,
            le=1000,
            soft=(1, 100),
            source="Hernell2007, 4.1",
            stale="light",
            tab="light",
            level="more",
            none_label="automatic",
        ),
    ] = None
    coarsest: Annotated[
        int,
        Param(
            "Lowest resolution of blocks that show something: 2 to this power texels along their edge",
            label="Coarsest level",
            ge=0,
            le=4,
            source="Hernell2007, 4.1",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 2
    joined: Annotated[
        bool,
        Param(
            "Interpolate the light between neighbouring blocks",
            label="Join blocks",
            source="Hernell2007, 4.2",
            stale="program",
            tab="light",
            level="more",
        ),
    ] = True
    adaptive: Annotated[
        bool,
        Param(
            "Longer steps of the view rays where blocks are coarse",
            label="Adaptive steps",
            source="Hernell2007, 4.2",
            stale="program",
            tab="light",
            level="more",
        ),
    ] = True
    ends: Annotated[
        bool,
        Param(
            "Light comes from the ends of the rays alone, as a comparison: few rays give shadows with edges",
            label="Light from ends",
            source="Hernell2007, Fig. 1",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = False
