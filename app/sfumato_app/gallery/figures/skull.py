"""Figure 10: where the conventional lamp lets depth be seen: a hand off its ground, the sockets of a skull."""

from __future__ import annotations

from sfumato import Light, Scene, TransferFunction
from sfumato_samples import load

from ..figure import Figure, panels
from ..setting import headlamp, lit, look, still
from .hand import PORTRAIT, skin_before_cloth

BONE = (0.60, 0.53, 0.39)


def figure_10() -> Figure:
    """Hand and skull, each from the eye and from the top left."""
    transfer = TransferFunction.from_points(
        [(220, BONE, 0.0), (640, BONE, 0.9), (1500, (0.66, 0.61, 0.50), 0.95)]
    )
    volume = load("skull")
    skull = still(Scene(volume=volume, transfer=transfer, camera=look(volume.center, 250, turn=12, lift=4)))
    hand = skin_before_cloth()
    hand = hand.with_(camera=look((70.0, 48.0, 163.0), 158))
    return Figure(
        10,
        "Touching or not, deep or flat",
        "In (a) the fingers seem to lie on the cloth; in (b) the shadow lies apart from them, so there is a "
        "gap. The sockets of the skull look deeper in (d) than in (c), the cheek bone and the jaw stand out.",
        panels(
            (headlamp(hand), "headlamp"),
            (lit(hand), "top left"),
            (headlamp(skull), "headlamp"),
            (lit(skull, Light(tilt=40, aperture=26)), "top left"),
        ),
        PORTRAIT,
    )
