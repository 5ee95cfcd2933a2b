"""Figure 9: the skeleton of a carp."""

from __future__ import annotations

from sfumato import Light, Scene, TransferFunction
from sfumato_samples import load

from ..figure import Figure, panels
from ..setting import headlamp, lit, look, still

BONE = (0.60, 0.52, 0.38)


def figure_9() -> Figure:
    """Headlamp and top left."""
    transfer = TransferFunction.from_points(
        [(180, BONE, 0.0), (340, BONE, 0.9), (500, BONE, 0.95), (1500, (0.66, 0.61, 0.50), 0.95)]
    )
    volume = load("fish")
    fish = still(Scene(volume=volume, transfer=transfer, camera=look(volume.center, 156, turn=8, lift=4)))
    return Figure(
        9,
        "A carp's skeleton, from the eye and from the top left",
        "Lit from the eye the skeleton is flat. From the top left the near ribs shade the far ones, the gill "
        "cover stands off the head and the spine becomes round.",
        panels(
            (headlamp(fish), "directional occlusion, headlamp"),
            (lit(fish, Light(tilt=50, aperture=16)), "multidirectional occlusion, top left"),
        ),
        (768, 416),
    )
