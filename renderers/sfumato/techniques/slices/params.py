"""Parameters of `slices` and `slices-phong`."""

from __future__ import annotations

from dataclasses import dataclass

from ...scene.scene import TechniqueParams
from ..phong import PhongParams


@dataclass(frozen=True)
class SlicesParams(TechniqueParams):
    """Unlit slicing has nothing to set."""


@dataclass(frozen=True)
class SlicesPhongParams(PhongParams):
    """Slicing with gradient-based shading."""
