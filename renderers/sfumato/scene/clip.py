"""Clip planes and the crop box; what they cut away casts no shadow either."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..errors import SceneError
from .params import Param, check

Vec3 = tuple[float, float, float]

#: As many planes as the shaders take.
MAX_CLIP_PLANES = 6


@dataclass(frozen=True)
class ClipPlane:
    """A plane in world space; what lies on the side to which ``normal`` points is kept."""

    point: Annotated[Vec3, Param("A point of the plane", unit="mm")] = (0.0, 0.0, 0.0)
    normal: Annotated[Vec3, Param("Points to the side that is kept")] = (0.0, 1.0, 0.0)
    enabled: bool = True

    def __post_init__(self) -> None:
        check(self)
        if not any(self.normal):
            raise SceneError("normal", self.normal, "a direction of non-zero length is needed")


@dataclass(frozen=True)
class CropBox:
    """The part of the volume that is shown, in fractions of its array axes x, y, z."""

    low: Annotated[Vec3, Param("Lower bounds", ge=0, le=1, tab="view")] = (0.0, 0.0, 0.0)
    high: Annotated[Vec3, Param("Upper bounds", ge=0, le=1, tab="view")] = (1.0, 1.0, 1.0)

    def __post_init__(self) -> None:
        check(self)
        if any(a >= b for a, b in zip(self.low, self.high, strict=True)):
            raise SceneError("low", (self.low, self.high), "each lower bound must be below its upper bound")
