"""Multidirectional occlusion shading (Soltesova2010) and its headlamp special case (Schott2009).

The volume is cut into slices that face the viewer. A buffer of occlusion is carried from slice to slice,
and blurred at each by the elliptical footprint of the light's tilted cone (Eq. 2-11), so that shadows
soften with distance. What reaches a slice lights it.

`multidirectional` places the light anywhere before or behind the subject; `directional` is the same with
tilt 0, a headlamp. Use them for soft, fast, gradient-free shadows that work on noisy data too.

Source: V. Soltesova, D. Patel, S. Bruckner, I. Viola, CGF 29(3), 2010. What we do differently, and why, is
told in `sweep` (own grid of the occlusion buffer, exact moments of the footprint, slabs instead of points).

Limits, the method's own: repeated blurring makes the penumbra grow with the square root of the distance
instead of the distance, so shadows are too hard far from what casts them.
"""

from ..registry import Technique
from .params import DirectionalParams, MultidirectionalParams

TECHNIQUES = (
    Technique(
        "multidirectional",
        "Multidirectional occlusion",
        "Soft shadows from a lamp anywhere before or behind the subject",
        MultidirectionalParams,
        "..techniques.multidirectional.passes:OcclusionPainter",
        source="Soltesova2010",
        ambient_of_lamps=True,
    ),
    Technique(
        "directional",
        "Directional occlusion (headlamp)",
        "Soft shadows from a headlamp: creases darken, nothing is thrown aside",
        DirectionalParams,
        "..techniques.multidirectional.passes:OcclusionPainter",
        source="Schott2009",
        ambient_of_lamps=True,
        options={"headlamp": True},
    ),
)
