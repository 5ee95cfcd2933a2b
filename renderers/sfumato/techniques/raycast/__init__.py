"""Ray casting with emission and absorption, without shadows.

`raycast` shows each sample in its own colour; it is the *unlit* picture that others are compared with.
`raycast-phong` shades by the gradient (Levoy 1988): surfaces turn away from the lamp, but nothing casts a
shadow, and noise in the data becomes noise in the picture. Use it to compare, and for a first look.
"""

from ..registry import Technique
from .params import RaycastParams, RaycastPhongParams

TECHNIQUES = (
    Technique(
        "raycast",
        "Ray casting, unlit",
        "Each sample in its own colour: fast, flat",
        RaycastParams,
        "..techniques.marcher:MarchPainter",
        source="Max1995",
        shadows=False,
        lit=False,
        options={"slices": False, "phong": False},
    ),
    Technique(
        "raycast-phong",
        "Ray casting, Phong",
        "Surfaces shaded by their gradient, no shadows",
        RaycastPhongParams,
        "..techniques.marcher:MarchPainter",
        source="Levoy1988",
        shadows=False,
        options={"slices": False, "phong": True},
    ),
)
