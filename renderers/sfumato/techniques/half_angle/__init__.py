"""Half-angle slicing (Kniss2003), for comparison.

Slices are perpendicular to the vector halfway between view and light, so that one stack serves both: each
slice is composited into the picture and then into the light's own buffer, which the next slice reads. When
the light stands behind the subject, the order towards the eye is reversed, and the picture jumps: this
method's lesson, told by Soltesova2010 in section 5.1.

Use it to compare. Its limits: one light, the first; slices that slant against the view, so that surfaces
show them as bands, worst where the light grazes (Soltesova2010, Fig. 14: beyond a tilt of 60 degrees).

What differs from the paper: a slice stands for a slab, classified between both its faces, whose own light
is integrated along the eye's and the light's way through it; so brightness does not depend on the number of
slices, and a surface that faces the viewer has its own colour, as in the other techniques.
"""

from ..registry import Technique
from .params import HalfAngleParams

TECHNIQUES = (
    Technique(
        "half-angle",
        "Half-angle slicing",
        "Shadows from one light by slices halfway between view and light, for comparison",
        HalfAngleParams,
        "..techniques.half_angle.passes:HalfAnglePainter",
        source="Kniss2003",
        orbit_pops=True,
        max_lights=1,
    ),
)
