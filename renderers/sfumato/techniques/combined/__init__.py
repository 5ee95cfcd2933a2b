"""Geometry and volume under one light (`combined`): tracts, streamlines and meshes among tissue.

Tubes and tissue cast shadows on each other, so that the reader sees which fibre runs before which, and how
deep it lies. Each frame:

1. The surfaces are drawn once: colour, normal, depth (`surfaces`, the paper's G-buffer).
2. Each lamp's light is swept through the volume as in `cone`, and geometry takes part in the sweep: its
   triangles are put together to surfels (`surfels`), which cover texels of the lamp's own lattice, slab by
   slab (`cover`). So geometry casts also where it is hidden behind other geometry, from any direction.
3. The ray caster shades the volume up to the surfaces, with a partial last step.
4. Surfaces are shaded: light from the sweep (the paper's partial occlusion), times what the nearest
   neighbours in the picture block (vicinity occlusion), ambient, diffuse and specular light; the volume
   goes over them.

Use it whenever a scene has geometry. A scene without a volume works too.

Source: M. Schott et al., IEEE PacificVis 2012, Alg. 1-6. Beyond it: light from any direction and up to four
lamps, of which the vicinity term takes its directions too; geometry hidden by geometry casts; each of the
four interactions can be left out (``volume_on_geometry`` ...), each term shown alone (``show``).

Limits: surfaces are opaque to the eye; parallel light only; the sweep's shadows of geometry are as sharp as its
texels (``resolution``), what is finer the vicinity term adds as far as the picture shows it.
"""

from ..registry import Technique
from .params import CombinedParams

TECHNIQUES = (
    Technique(
        "combined",
        "Geometry and volume",
        "Tracts, streamlines and meshes that share the volume's light, with cone-accurate shadows on each other",
        CombinedParams,
        "..techniques.combined.passes:CombinedPainter",
        source="Schott2012",
        ambient_of_lamps=True,
        geometry=True,
    ),
)
