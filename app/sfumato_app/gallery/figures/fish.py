"""Figure 9: the skeleton of a carp."""

from __future__ import annotations

from sfumato import Light, Scene, TransferFunction
from sfumato_samples import load

from ..figure import Figure, panels
from ..setting import headlamp, lit, look, still
from ..staging import CLOTH_POINTS, before_cloth

BONE = (0.60, 0.52, 0.38)


def figure_9() -> Figure:
    """Headlamp and top left."""
    transfer = TransferFunction.from_points(
        [*CLOTH_POINTS, (260, BONE, 0.0), (600, BONE, 0.92), (1000, (0.66, 0.61, 0.50), 0.95)]
    )
    camera = look(load("fish").center, 150, turn=8, lift=4)
    fish = still(Scene(volume=before_cloth("fish", -24, 60, 5.0), transfer=transfer, camera=camera))
    return Figure(
        9,
        "A carp's skeleton, from the eye and from the top left",
        "Lit from the eye the skeleton is flat. From the top left spine and skull are round, the "
        "near ribs shade the far ones, and the shadow on the cloth draws spine, ribs and fins once more.",
        panels(
            (headlamp(fish), "directional occlusion, headlamp"),
            (lit(fish, Light(tilt=36, aperture=22)), "multidirectional occlusion, top left"),
        ),
        (768, 416),
    )
