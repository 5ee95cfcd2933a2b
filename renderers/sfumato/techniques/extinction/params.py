"""Parameters of `extinction`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...scene.params import Param
from ...scene.scene import TechniqueParams
from ..phong import Shininess, SlopeShading


@dataclass(frozen=True)
class ExtinctionParams(TechniqueParams):
    """Light from all around by shells, from lamps by cones."""

    shells: Annotated[
        int,
        Param(
            "Shells around each point in which matter takes away light from all around",
            label="Shells",
            ge=0,
            le=16,
            soft=(0, 12),
            source="Schlegel2011, 3.2",
            stale="light",
            tab="light",
        ),
    ] = 5
    radius: Annotated[
        float | None,
        Param(
            "Half the edge of the outermost shell; automatic: 8 % of the volume's longest side",
            label="Shell radius",
            unit="mm",
            gt=0,
            le=1e6,
            soft=(1, 60),
            source="Schlegel2011, 3.2",
            stale="light",
            tab="light",
            level="more",
            none_label="automatic",
        ),
    ] = None
    cone_angle: Annotated[
        float | None,
        Param(
            "Half angle of the cones towards the lamps: narrow for hard shadows, wide for scattered light",
            label="Cone angle",
            unit="deg",
            gt=0,
            lt=90,
            soft=(0.5, 60),
            source="Schlegel2011, 3.3",
            stale="light",
            tab="light",
            none_label="from lamp",
        ),
    ] = None
    ambient: Annotated[
        float,
        Param("Light from all around", label="Ambient", ge=0, le=10, soft=(0, 1), tab="light"),
    ] = 0.35
    bleeding: Annotated[
        float,
        Param(
            "How much neighbours colour the light from all around",
            label="Colour bleeding",
            ge=0,
            le=1,
            source="Schlegel2011, Eq. 5",
            stale="light",
            tab="light",
        ),
    ] = 0.5
    shell_strength: Annotated[
        float,
        Param(
            "How dark the shells' shadows are; 1 as the extinction says",
            label="Shell strength",
            ge=0,
            le=20,
            soft=(0, 3),
            source="Schlegel2011, Eq. 8",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 0.7
    strength: Annotated[
        float,
        Param(
            "How dark the lamps' shadows are; 1 as the extinction says",
            label="Shadow strength",
            ge=0,
            le=20,
            soft=(0, 2),
            source="Schlegel2011, 3.3",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 1.0
    samples: Annotated[
        int,
        Param(
            "Sections of a cone that is as long as the volume's longest side, if they did not grow",
            label="Cone samples",
            ge=2,
            le=256,
            soft=(8, 128),
            source="Schlegel2011, 3.3",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 64
    growth: Annotated[
        float,
        Param(
            "How much longer each section of a cone is than the one before",
            label="Section growth",
            ge=0,
            le=1,
            soft=(0, 0.5),
            source="Schlegel2011, 3.3",
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 0.25
    cones: Annotated[
        int,
        Param(
            "Narrow cones that a lamp's cone is taken apart into; the paper has one, which shows its boxes",
            label="Narrow cones",
            ge=1,
            le=64,
            stale="light",
            tab="light",
            level="more",
        ),
    ] = 16
    facing: SlopeShading = 0.7
    specular: Annotated[
        float, Param("Strength of highlights", label="Highlights", ge=0, le=2, soft=(0, 1), tab="light")
    ] = 0.0
    shininess: Shininess = 40.0
    resolution: Annotated[
        int | None,
        Param(
            "Cells of the light cache along the longest side; automatic: by the volume, 64 to 128",
            label="Light resolution",
            unit="cell",
            ge=16,
            le=256,
            soft=(32, 256),
            source="Schlegel2011, Fig. 11",
            stale="light",
            tab="light",
            level="more",
            none_label="automatic",
        ),
    ] = None
