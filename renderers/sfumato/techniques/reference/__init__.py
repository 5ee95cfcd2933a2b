"""The ray-traced cone integral: what the others are measured against. Slow, on the CPU, in float64.

Emission and absorption along each view ray; each sample is lit by the mean, over directions uniform in
solid angle within the light's cone, of exp(-optical depth) to the volume's edge (``methods.md``). The work
is done by `sfumato.reference.cone`.
"""

from ..registry import Technique
from .params import ReferenceParams

TECHNIQUES = (
    Technique(
        "reference",
        "Ray-traced reference",
        "The cone integral by brute force on the CPU: slow, for comparison",
        ReferenceParams,
        "..techniques.reference.passes:ReferencePainter",
        source="sfumato",
    ),
)
