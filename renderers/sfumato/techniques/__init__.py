"""Techniques: each folder is one way (or one family of ways) to light a volume, and reads like a short paper.

Adding one touches its folder and one line in `registry.FOLDERS`; its parameters, declared once in its
``params.py``, give it sliders, flags, JSON and checks.

Every fast technique is a *provider of light* for one shared ray caster (`marcher`): it says how much of
each light reaches a point, and the ray caster does the rest (skipping, early termination, pre-integrated
classification). The occlusion methods get that from a *sweep* over slices (`sweep`), batch by batch.
"""

from .registry import (
    Painter,
    Technique,
    id_of,
    params_from_json,
    params_of,
    technique_for,
    technique_with_geometry,
    techniques,
)

__all__ = [
    "Painter",
    "Technique",
    "id_of",
    "params_from_json",
    "params_of",
    "technique_for",
    "technique_with_geometry",
    "techniques",
]
