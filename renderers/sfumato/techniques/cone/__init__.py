"""Cone-accurate shadows (ours): as a ray-traced cone casts them, at the cost of a few fetches a voxel.

Each lamp's cone is taken apart into directions, which are swept through the volume in the lamp's own space
(`light_volume`); their mean, the light prepass, lies in a 3D texture that the shared ray caster reads. What
stands close to a sample the ray caster looks for itself (`near_field`), so contact shadows are as sharp as
the picture. Each frame takes other directions: their mean converges to the cone.

Use it for everything that is to look right: penumbrae grow in proportion to the distance, from hard at the
contact to soft, whatever the number of slices. The light volume is kept while lamp and opacity stay the same,
so a change of colours, a zoom or a crop of the picture costs one ray casting.

Source: our own; measured against `reference` in ``docs/accuracy.md``, with what else was tried in
``docs/candidates.md``. The slab term and the normalisation of the light are those of `multidirectional`.

Limits: an occluder grows by up to half a texel of the light volume (1 to 1.5 voxels), which small thick things
in wide light show; a single frame has faint stripes where light grazes a surface; parallel light only; in the
near field, two-dimensional transfer functions are read at gradient 0.
"""

from ..registry import Technique
from .params import ConeParams

TECHNIQUES = (
    Technique(
        "cone",
        "Cone-accurate shadows",
        "Soft shadows as a ray-traced cone casts them, from a lamp anywhere before or behind the subject",
        ConeParams,
        "..techniques.cone.passes:ConePainter",
        source="sfumato",
        ambient_of_lamps=True,
    ),
)
