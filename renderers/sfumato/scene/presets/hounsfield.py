"""Presets in Hounsfield units; colours are linear RGB."""

from __future__ import annotations

from ..transfer import TransferFunction
from .preset import Preset

RGB = tuple[float, float, float]
SKIN: RGB = (0.52, 0.30, 0.20)
MUSCLE: RGB = (0.36, 0.095, 0.06)
MARROW: RGB = (0.44, 0.17, 0.11)
BLOOD: RGB = (0.55, 0.06, 0.04)
CARTILAGE: RGB = (0.54, 0.38, 0.24)
BONE: RGB = (0.48, 0.415, 0.30)
DENSE_BONE: RGB = (0.54, 0.485, 0.38)
METAL: RGB = (0.55, 0.58, 0.60)
LUNG: RGB = (0.40, 0.23, 0.20)

Points = list[tuple[float, RGB, float]]

_BONE: Points = [
    (160, MARROW, 0.0),
    (240, MARROW, 0.15),
    (320, CARTILAGE, 0.6),
    (430, BONE, 0.92),
    (1200, DENSE_BONE, 0.95),
    (2500, DENSE_BONE, 0.95),
    (3000, METAL, 0.95),
]
_SKIN: Points = [
    (-420, SKIN, 0.0),
    (-180, SKIN, 0.9),
    (150, SKIN, 0.95),
    (300, BONE, 0.95),
    (1500, DENSE_BONE, 0.95),
]
_MUSCLE: Points = [
    (-20, MUSCLE, 0.0),
    (50, MUSCLE, 0.5),
    (130, (0.43, 0.14, 0.09), 0.8),
    (240, CARTILAGE, 0.85),
    (400, BONE, 0.95),
    (1500, DENSE_BONE, 0.95),
]
_VESSELS: Points = [
    (150, BLOOD, 0.0),
    (230, BLOOD, 0.6),
    (380, (0.66, 0.14, 0.09), 0.9),
    (600, BONE, 0.95),
    (1500, DENSE_BONE, 0.95),
]
_LUNG: Points = [
    (-960, LUNG, 0.0),
    (-860, LUNG, 0.10),
    (-720, LUNG, 0.16),
    (-560, LUNG, 0.05),
    (-480, LUNG, 0.0),
]
_SKIN_AND_BONE: Points = [
    (-420, SKIN, 0.0),
    (-300, SKIN, 0.08),
    (-150, SKIN, 0.08),
    (-60, SKIN, 0.006),
    (150, MUSCLE, 0.006),
    (230, MUSCLE, 0.2),
    (320, CARTILAGE, 0.7),
    (450, BONE, 0.92),
    (1500, DENSE_BONE, 0.95),
]

_ALL: tuple[tuple[str, Points, str], ...] = (
    ("Bone", _BONE, "Bones in ivory; vessels with contrast agent in red"),
    ("Skin", _SKIN, "The body's surface"),
    ("Muscle", _MUSCLE, "Muscle and organs with bone, without skin and fat"),
    ("Vessels", _VESSELS, "Blood with contrast agent in red, calcium and bone in ivory"),
    ("Skin and bone", _SKIN_AND_BONE, "Bone through translucent skin"),
    ("Lung", _LUNG, "Air-filled tissue and airways"),
)


def hounsfield_presets(zero: float) -> tuple[Preset, ...]:
    """Return the presets for values in Hounsfield units.

    Parameters
    ----------
    zero : float
        The stored value that means 0 HU.
    """
    return tuple(
        Preset(
            name,
            TransferFunction.from_points(((v + zero, c, a) for v, c, a in points), name=name),
            text,
            "CT",
        )
        for name, points, text in _ALL
    )
