"""Figures 8 and 10 to 12 of Schlegel2011: scans, cone angles, resolutions and samples."""

from __future__ import annotations

from sfumato import Light, Scene, TransferFunction
from sfumato_samples import load

from ..figure import Difference, Figure, panels
from ..setting import look
from .extinction_places import lit_by
from .extinction_terms import BONE, KEY, bones
from .hand import skin_before_cloth

#: As many cells and samples as the paper's comparisons.
SAMPLES = 40


def _chest() -> Scene:
    transfer = TransferFunction.from_points(
        [(230, BONE, 0.0), (380, BONE, 0.9), (1500, (0.66, 0.61, 0.50), 0.95)]
    )
    volume = load("torso")
    return Scene(volume=volume, transfer=transfer, camera=look(volume.center, 372, turn=20, lift=6))


def figure_8() -> Figure:
    """Two lamps and one."""
    second = Light(tilt=50, aperture=4, rotation=20, color=(1.0, 0.9, 0.75), intensity=0.6)
    key = Light(tilt=42, aperture=4, rotation=140, intensity=0.8)
    return Figure(
        8,
        "Scans under two lamps and under one",
        "The chest has a shadow of each lamp; the hand one, on itself and on the cloth.",
        panels(
            (lit_by(_chest(), key, second, ambient=0.2), "two lamps"),
            (lit_by(skin_before_cloth(), KEY, ambient=0.3), "one lamp"),
        ),
        (400, 400),
        "Schlegel2011",
    )


def figure_10() -> Figure:
    """Cone angles."""
    chest = _chest()
    dark = lit_by(chest, Light(enabled=False), ambient=0.7)
    return Figure(
        10,
        "Without lamps, and with wider and wider cones",
        "Light from all around alone shows what is hollow, not what stands before what. The wider the cone, the "
        "softer the ribs' shadows on spine and shoulder blades.",
        panels(
            (dark, "no lamp"),
            *((lit_by(chest, KEY, cone_angle=a), f"cone angle {a:g}°") for a in (1.0, 3.0, 5.0)),
        ),
        (300, 320),
        "Schlegel2011",
    )


def figure_11() -> Figure:
    """Resolutions of the light cache."""
    return Figure(
        11,
        "Light caches of 64, 128, 192 and 256 cells a side",
        "Fewer cells blur the shadows' edges; their place and their darkness stay. 40 samples a cone, 2°.",
        panels(
            *(
                (lit_by(bones(), KEY, cone_angle=2.0, samples=SAMPLES, resolution=n), f"{n} cells")
                for n in (64, 128, 192, 256)
            )
        ),
        (280, 330),
        "Schlegel2011",
    )


def figure_12() -> Figure:
    """Few samples."""
    few = {"cone_angle": 6.0, "samples": 12, "growth": 0.0, "resolution": 128}
    one, narrow = (lit_by(bones(), KEY, cones=n, **few) for n in (1, 16))
    return Figure(
        12,
        "Twelve samples a cone",
        "With one cone, as in the paper, the boxes that stand for it show at the shadows' edges; with sixteen "
        "narrow ones their edges lie at different places, and average. (c) is bright where both differ.",
        panels(
            (one, "one cone"),
            (narrow, "sixteen narrow ones"),
            (Difference(one, narrow, 20.0), "how far they are apart; white: 20 in CIELAB"),
        ),
        (300, 350),
        "Schlegel2011",
    )
