"""Parameters of `raycast` and `raycast-phong`."""

from __future__ import annotations

from dataclasses import dataclass

from ...scene.scene import TechniqueParams
from ..phong import PhongParams


@dataclass(frozen=True)
class RaycastParams(TechniqueParams):
    """Unlit ray casting has nothing to set."""


@dataclass(frozen=True)
class RaycastPhongParams(PhongParams):
    """Ray casting with gradient-based shading."""
