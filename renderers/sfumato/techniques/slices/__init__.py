"""View-aligned slices, composited front to back, without shadows.

The samples lie on planes that face the viewer, exactly where the occlusion methods sample, so that
`slices` is their unlit picture and `slices-phong` the local shading that Soltesova2010 (Fig. 1b, 5.2)
compares with. In an orthographic view they agree with ray casting; in perspective, rays that leave the
axis take longer steps between the planes.
"""

from ..registry import Technique
from .params import SlicesParams, SlicesPhongParams

TECHNIQUES = (
    Technique(
        "slices",
        "Slices, unlit",
        "View-aligned slices in their own colour",
        SlicesParams,
        "..techniques.marcher:MarchPainter",
        source="Soltesova2010",
        shadows=False,
        lit=False,
        options={"slices": True, "phong": False},
    ),
    Technique(
        "slices-phong",
        "Slices, Phong",
        "View-aligned slices shaded by their gradient",
        SlicesPhongParams,
        "..techniques.marcher:MarchPainter",
        source="Soltesova2010",
        shadows=False,
        options={"slices": True, "phong": True},
    ),
)
