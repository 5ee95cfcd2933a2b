"""Parameters of `cone`."""

from __future__ import annotations

from dataclasses import dataclass

from ..multidirectional.params import ShadowParams


@dataclass(frozen=True)
class ConeParams(ShadowParams):
    """What the cone's shadows look like; where it stands and how wide it is, the lamp says."""
