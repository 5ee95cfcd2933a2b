"""Where the bones of the hand lie: a left hand, raised, palm to the front (-y), fingers up (+z), thumb at -x.

Millimetres; the origin is the middle of the wrist joint. Lengths are those of a middle-sized adult hand
(metacarpals 46, 68, 65, 58, 54; proximal phalanges 32, 41, 45, 42, 33; middle 24, 28, 26, 19;
distal 22, 17, 18, 18, 16), rounded from tables in textbooks of anatomy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..sdf import Frame, unit

Vec3 = tuple[float, float, float]


@dataclass(frozen=True)
class Bone:
    """A long bone of the hand, its w axis from base to head, v dorsal, u sideways.

    Parameters
    ----------
    finger : int
        0 is the thumb, 4 the little finger.
    kind : str
        ``metacarpal``, ``proximal``, ``middle`` or ``distal``.
    frame : Frame
        Origin in the middle of the joint at its base.
    length : float
        From joint to joint in mm.
    size : float
        Thickness relative to the middle finger's.
    """

    finger: int
    kind: str
    frame: Frame
    length: float
    size: float

    @property
    def start(self) -> np.ndarray:
        """Joint at the base."""
        return self.frame.origin

    @property
    def end(self) -> np.ndarray:
        """Joint at the head, or the tip."""
        return self.frame.world(0, 0, self.length)


@dataclass(frozen=True)
class Ray:
    """A finger with its metacarpal: base and head of that, lengths of the phalanges, spread and bends."""

    base: Vec3
    head: Vec3
    lengths: tuple[float, ...]
    spread: float
    bends: tuple[float, ...]
    size: float


#: Index to little finger; the bends make the relaxed cascade: more towards the little finger.
FINGERS = (
    Ray((-9.0, 1.0, 33.0), (-22.5, 1.0, 99.5), (41, 24, 17), -9.5, (8, 11, 6), 0.98),
    Ray((1.5, 2.5, 33.5), (-1.5, 3.0, 98.5), (45, 28, 18), -1.5, (12, 15, 8), 1.03),
    Ray((11.5, 1.0, 33.0), (18.0, 0.5, 91.0), (42, 26, 18), 6.5, (16, 19, 9), 0.96),
    Ray((20.0, -3.0, 31.0), (34.5, -4.5, 83.0), (33, 19, 16), 16.5, (18, 22, 10), 0.82),
)
#: The thumb, opposed: joints from the saddle joint to the tip.
THUMB = ((-21.5, -11.0, 28.0), (-44.5, -36.0, 58.5), (-38.5, -47.5, 88.0), (-25.0, -50.0, 109.0))
#: Towards the thumb's pulp.
THUMB_PULP = (0.86, 0.42, 0.05)
THUMB_SIZE = 1.16


@cache
def long_bones() -> tuple[Bone, ...]:
    """Return metacarpals and phalanges, thumb first, each finger from base to tip."""
    bones = list(_thumb())
    for number, ray in enumerate(FINGERS, start=1):
        bones += _finger(number, ray)
    return tuple(bones)


def _thumb() -> list[Bone]:
    dorsal = [-c for c in THUMB_PULP]
    bones = []
    for kind, start, end in zip(("metacarpal", "proximal", "distal"), THUMB[:-1], THUMB[1:], strict=True):
        axis = np.subtract(end, start)
        bones.append(Bone(0, kind, Frame.along(start, axis, dorsal), math.hypot(*axis), THUMB_SIZE))
    return bones


def _finger(number: int, ray: Ray) -> list[Bone]:
    axis = np.subtract(ray.head, ray.base)
    bones = [Bone(number, "metacarpal", Frame.along(ray.base, axis), math.hypot(*axis), ray.size)]
    spread = math.radians(ray.spread)
    forward, dorsal = np.array([math.sin(spread), 0.0, math.cos(spread)]), np.array([0.0, 1.0, 0.0])
    joint = np.asarray(ray.head, dtype=float)
    for kind, span, bend in zip(("proximal", "middle", "distal"), ray.lengths, ray.bends, strict=True):
        cos, sin = math.cos(math.radians(bend)), math.sin(math.radians(bend))
        forward, dorsal = unit(cos * forward - sin * dorsal), unit(cos * dorsal + sin * forward)
        bones.append(Bone(number, kind, Frame.along(joint, forward, dorsal), float(span), ray.size))
        joint = joint + span * forward
    return bones
