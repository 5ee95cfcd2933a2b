"""Rigs: complete sets of lamps by name, to light any volume with one click.

They follow the illustrators' and photographers' conventions: light from the top left (Hodges2003, as cited in
Soltesova2010, section 1), the headlamp of a viewer, key, fill and rim of the studio, light from behind,
grazing light for relief, and light from all sides. All lamps turn with the camera. The strongest lamp is the
first, since some techniques know only one. Intensities are chosen so that a light surface is neither clipped
nor dull: a lamp of intensity 1 lights a wall that faces the viewer to its own colour, hence what faces a grazing
lamp to far more, and where several meet their light adds up. Less than 1 % of the heads, the ultrasound and the
embryo among the real scans is clipped under any rig (tests/core/test_rigs.py holds one head to it).
"""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import SceneError
from .light import Light


@dataclass(frozen=True)
class Rig:
    """A set of lamps.

    Parameters
    ----------
    id : str
        Name on the command line.
    title, description : str
        For people: a word or two, and what it is good for in one sentence.
    lights : tuple of Light
        The lamps, the key first.
    """

    id: str
    title: str
    description: str
    lights: tuple[Light, ...]


_ALL = (
    Rig(
        "top-left",
        "Top left",
        "One soft lamp from the top left: the convention of illustrators",
        (Light(),),
    ),
    Rig(
        "headlamp",
        "Headlamp",
        "One lamp at the viewer: nearly no shadows, everything in front is clear",
        (Light(name="headlamp", tilt=0.0, aperture=10.0),),
    ),
    Rig(
        "three-point",
        "Three-point",
        "Key, fill and rim, as in a photographer's studio",
        (
            Light(name="key", tilt=45.0, rotation=145.0, aperture=18.0, intensity=0.65),
            Light(name="fill", tilt=40.0, rotation=350.0, aperture=40.0, intensity=0.25),
            Light(name="rim", tilt=130.0, rotation=50.0, aperture=15.0, intensity=0.25),
        ),
    ),
    Rig(
        "rim",
        "Rim",
        "Light from behind on both sides: outlines glow, thin parts shine through",
        (
            Light(name="left rim", tilt=120.0, rotation=150.0, aperture=20.0, intensity=0.43),
            Light(name="right rim", tilt=120.0, rotation=30.0, aperture=20.0, intensity=0.36),
            Light(name="fill", tilt=10.0, rotation=90.0, aperture=40.0, intensity=0.28),
        ),
    ),
    Rig(
        "raking",
        "Raking",
        "A hard lamp at a grazing angle: relief and texture stand out",
        (
            Light(name="key", tilt=72.0, rotation=165.0, aperture=6.0, intensity=0.55),
            Light(name="fill", tilt=0.0, rotation=0.0, aperture=40.0, intensity=0.18),
        ),
    ),
    Rig(
        "flat",
        "Flat",
        "Light from all sides: even, with shade in the hollows alone",
        (Light(name="sky", tilt=0.0, aperture=75.0),),
    ),
    Rig(
        "under-light",
        "Under-light",
        "Light from below, as from a ground glass: hollows that look down open, forms look strange",
        (
            Light(name="under", tilt=50.0, rotation=270.0, aperture=20.0, intensity=0.65),
            Light(name="fill", tilt=0.0, rotation=90.0, aperture=40.0, intensity=0.12),
        ),
    ),
    Rig(
        "soft-box",
        "Soft box",
        "One large lamp from above: form without hard edges, as in a studio",
        (Light(name="soft box", tilt=35.0, rotation=110.0, aperture=50.0),),
    ),
)


def rigs() -> dict[str, Rig]:
    """Return all rigs by id, in the order in which they are shown; the window shows six at first."""
    return {rig.id: rig for rig in _ALL}


def rig_of(lights: tuple[Light, ...]) -> str:
    """Return the id of the rig that these lamps are, or an empty string."""
    return next((rig.id for rig in _ALL if rig.lights == lights), "")


def rig_named(name: str) -> Rig:
    """Return a rig by its id.

    Raises
    ------
    SceneError
        If there is none of that name.
    """
    known = rigs()
    if name not in known:
        raise SceneError("rig", name, "one of " + ", ".join(known))
    return known[name]
