"""Figures 2, 4 and 6 of Schlegel2011: light from all around, soft shadows, colour bleeding."""

from __future__ import annotations

from sfumato import Light, Scene, TransferFunction
from sfumato_samples import load
from sfumato_samples import scene as sample

from ..figure import Explicit, Figure, panels
from ..setting import look
from ..staging import CLOTH_POINTS, before_cloth
from .extinction_places import beside, lit_by

BONE = (0.60, 0.53, 0.39)
KEY = Light(tilt=42, aperture=4, rotation=135)


def bones() -> Scene:
    """Return the bones of the hand before a cloth."""
    transfer = TransferFunction.from_points(
        [*CLOTH_POINTS, (180, BONE, 0.0), (360, BONE, 0.9), (1500, (0.66, 0.61, 0.50), 0.95)]
    )
    volume = before_cloth("hand", -6, 44, 6.0)
    return Scene(volume=volume, transfer=transfer, camera=look((64.0, 48.0, 128.0), 214))


def figure_2() -> Figure:
    """Few shells and many."""
    skull = sample("skull").with_(camera=look(load("skull").center, 250, turn=12, lift=4))
    around = {"ambient": 0.9, "facing": 0.0, "shell_strength": 1.2, "bleeding": 0.0}
    return Figure(
        2,
        "Light from all around by few shells and by many",
        "No lamp: what is hollow or narrow is dark. Three shells do as well as fifteen, as the paper says, and both "
        "nearly as well as a look at each cell within seven, which takes many times as long (`sfumato bench`).",
        panels(
            (Explicit(lit_by(skull, **around)), "a look at each cell around each cell"),
            (lit_by(skull, shells=15, **around), "15 shells"),
            (lit_by(skull, shells=3, **around), "3 shells"),
        ),
        (300, 370),
        "Schlegel2011",
    )


def figure_4() -> Figure:
    """Shadow rays and cones."""
    return Figure(
        4,
        "Shadow rays and soft shadows",
        "A cone of next to no width is a shadow ray: its shadows are as sharp as the cells of the light cache are "
        "small. One of 10° gives soft shadows, softer with distance, and takes no longer.",
        panels(
            (lit_by(bones(), KEY, cone_angle=0.3), "cone angle 0.3°"),
            (lit_by(bones(), KEY, cone_angle=10.0), "cone angle 10°"),
        ),
        (360, 420),
        "Schlegel2011",
    )


def figure_6() -> Figure:
    """Draw a room without and with colour bleeding."""
    middle = load("room").center
    lamp = Light(
        kind="area",
        shape="rectangle",
        position=beside((0.0, -8.0, 42.0), middle),
        direction=(0, 0, -1),
        size=(30.0, 30.0),
        intensity=0.7,
    )
    room = sample("room").with_(camera=look(middle, 118))
    shown = {"ambient": 0.85, "shells": 8, "radius": 22.0, "shell_strength": 2.6}
    return Figure(
        6,
        "A room with walls of two colours",
        "A lamp of 30 × 30 mm under the ceiling. In (b) what is white takes on the colour of the wall beside it, and "
        "the room is lighter: light that walls give off again is not lost.",
        panels(
            (lit_by(room, lamp, bleeding=0.0, **shown), "soft shadows and light from all around"),
            (lit_by(room, lamp, bleeding=1.0, **shown), "with colour bleeding"),
        ),
        (400, 400),
        "Schlegel2011",
    )
