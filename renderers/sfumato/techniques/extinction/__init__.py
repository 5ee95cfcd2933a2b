"""Extinction-based shading and illumination (Schlegel2011): any number of lamps, also inside the volume.

The volume's extinction is summed up on a grid of cells, in a 3D summed-area table (`field`), so that the matter
in any box is known from eight numbers. Light from all around is dimmed by the matter in boxes around each cell,
shell by shell, and coloured by it (`terms`, Eq. 4 and 5); light of a lamp by the matter in a row of boxes along
the cone towards it (Eq. 7). What reaches each cell lies in a light cache, which the shared ray caster looks up
once a sample: a camera move costs nothing, a move of a lamp only that lamp's cones.

Use it for lamps that stand somewhere: beside, behind or inside the subject, for smoke and translucent matter, and
for neighbours that colour each other. `cone` is more accurate for parallel light.

Where we differ from the paper: boxes are turned into optical depths in mm, so neither the cache's resolution nor
the sampling of a cone sets the darkness; a cone may be taken apart into narrow ones, whose light is averaged (the
paper's single one dims by the mean of what is in the way, which is too dark behind edges); what counts of dense
matter for light from all around is limited (`terms.DEPTH_LIMIT`); light is carried on into the cells that a
surface runs through; Eq. 5 read literally makes a red wall swallow red light, ours makes it give red light off;
of wide lamps' cones and of the shells, what is far is worked out for 2^3 cells at once (`terms`); narrow cones
start beside each other within a cell, and along slanting ways no section is longer than its cone stays in its box,
so that small lamps' shadows have no steps.

Limits: shadows are as sharp as the cells are small; behind many small things in a wide cone they are too dark, with the
paper's single cone more than with narrow ones (``docs/extinction.md`` has both errors against the ray-traced cone).
"""

from ..registry import Technique
from .params import ExtinctionParams

TECHNIQUES = (
    Technique(
        "extinction",
        "Extinction-based light",
        "Lamps of all kinds, also inside the subject, light from all around, and neighbours that colour each other",
        ExtinctionParams,
        "..techniques.extinction.passes:ExtinctionPainter",
        source="Schlegel2011",
        max_lights=16,
        kinds=("directional", "point", "spot", "area"),
    ),
)
