"""Half-angle slicing (Kniss2003), for comparison.

Slices are perpendicular to the vector halfway between view and light, so that one stack serves both: each
slice is composited into the picture and then into the light's own buffer, which the next slice reads. When
the light stands behind the subject, the order towards the eye is reversed, and the picture jumps: this
method's lesson, shown by Soltesova2010 in Fig. 14. It serves the first light only.
"""

from ..registry import Technique
from .params import HalfAngleParams

TECHNIQUES = (
    Technique(
        "half-angle", "Half-angle slicing", "Shadows from one light by slices halfway between view and light, for comparison",
        HalfAngleParams, "..techniques.half_angle.passes:HalfAnglePainter", source="Kniss2003", orbit_pops=True,
    ),
)
