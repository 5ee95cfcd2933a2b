"""Parameters of `combined`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ...scene.params import Param
from ..multidirectional.params import OcclusionParams, Resolution

#: What `show` may be.
TERMS = ("picture", "geometry", "volume", "occlusion", "partial", "vicinity")
#: What `light` may be.
LIGHTS = ("cone", "multidirectional")
_FIGURE_2 = "Schott2012, Fig. 2"


def _cast(meaning: str, label: str) -> Any:
    return Param(meaning, label=label, source=_FIGURE_2, stale="light", tab="light", level="more")


@dataclass(frozen=True)
class CombinedParams(OcclusionParams):
    """How volume and geometry shade each other, and what surfaces look like."""

    resolution: Resolution = 1.0
    light: Annotated[
        str,
        Param(
            "How light is carried: cone-accurate, each lamp by itself, or blurred from slice to slice of the view, as "
            "published; occlusion and fall-off are the latter's",
            label="Light by",
            choices=LIGHTS,
            source="Schott2012, Alg. 1; Soltesova2010",
            stale="program",
            tab="light",
            level="more",
        ),
    ] = "cone"
    geometry_opacity: Annotated[
        float,
        Param(
            "What geometry takes away of the light that meets it",
            label="Geometry shadows",
            ge=0,
            le=1,
            source="Schott2012, Alg. 3",
            stale="light",
            tab="light",
        ),
    ] = 1.0
    vicinity: Annotated[
        float,
        Param(
            "Strength of the shadows that geometry close by casts on geometry",
            label="Contact shadows",
            ge=0,
            le=1,
            source="Schott2012, Alg. 5",
            tab="light",
        ),
    ] = 1.0
    vicinity_distance: Annotated[
        float | None,
        Param(
            "How far contact shadows look towards the lamp (the virtual slice distance); automatic: as far "
            "as the shadows' own resolution does not reach",
            label="Contact distance",
            unit="mm",
            gt=0,
            le=1000,
            soft=(0.1, 20),
            source="Schott2012, 3.1.5",
            tab="light",
            level="more",
            none_label="automatic",
        ),
    ] = None
    vicinity_samples: Annotated[
        int,
        Param(
            "Points of the Poisson disc by which a frame finds contact shadows; each frame turns it",
            label="Contact samples",
            ge=1,
            le=118,
            soft=(4, 118),
            source="Schott2012, 3.1.5",
            tab="light",
            level="more",
        ),
    ] = 16
    vicinity_bias: Annotated[
        float,
        Param(
            "How much nearer than a surface something must be to cast a contact shadow, as a part of the distance",
            label="Contact bias",
            ge=0,
            le=0.5,
            soft=(0, 0.2),
            source="Schott2012, Alg. 5",
            tab="light",
            level="more",
        ),
    ] = 0.03
    surface_ambient: Annotated[
        float,
        Param(
            "Share of a surface's colour that does not depend on how it is turned",
            label="Surface ambient",
            ge=0,
            le=1,
            source="Schott2012, Alg. 6",
            tab="light",
            level="more",
        ),
    ] = 0.35
    surface_diffuse: Annotated[
        float,
        Param(
            "Strength of diffuse light on surfaces that face a lamp",
            label="Surface diffuse",
            ge=0,
            le=2,
            soft=(0, 1),
            source="Schott2012, Alg. 6",
            tab="light",
            level="more",
        ),
    ] = 0.65
    surface_specular: Annotated[
        float,
        Param(
            "Strength of highlights on surfaces",
            label="Surface highlights",
            ge=0,
            le=2,
            soft=(0, 1),
            source="Schott2012, Alg. 6",
            tab="light",
            level="more",
        ),
    ] = 0.1
    surface_shininess: Annotated[
        float,
        Param(
            "Sharpness of highlights on surfaces",
            label="Surface shininess",
            ge=1,
            le=1000,
            soft=(1, 200),
            tab="light",
            level="more",
        ),
    ] = 30.0
    volume_on_volume: Annotated[
        bool, _cast("Whether the volume casts shadows on itself", "Volume on volume")
    ] = True
    geometry_on_geometry: Annotated[
        bool, _cast("Whether geometry casts shadows on geometry", "Geometry on geometry")
    ] = True
    geometry_on_volume: Annotated[
        bool, _cast("Whether geometry casts shadows on the volume", "Geometry on volume")
    ] = True
    volume_on_geometry: Annotated[
        bool, _cast("Whether the volume casts shadows on geometry", "Volume on geometry")
    ] = True
    show: Annotated[
        str,
        Param(
            "The whole picture, or one part or term of it: partial is the shadow that light volumes cast on surfaces",
            label="Show",
            choices=TERMS,
            source="Schott2012, Fig. 6",
            tab="light",
            level="more",
        ),
    ] = "picture"
