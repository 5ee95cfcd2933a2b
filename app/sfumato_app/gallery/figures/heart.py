"""Figure 13: ultrasound of a heart, where gradients are of no use."""

from __future__ import annotations

from sfumato import ClipPlane, Scene, TransferFunction
from sfumato_samples import load

from ..figure import Cuts, Figure, panels
from ..setting import BOTTOM_LEFT, lit, look, phong, still

DEEP, WALL, LEAF = (0.36, 0.12, 0.06), (0.56, 0.30, 0.16), (0.66, 0.50, 0.34)


def figure_13() -> Figure:
    """Cuts, Phong, and two lamps."""
    transfer = TransferFunction.from_points(
        [(72, DEEP, 0.0), (105, WALL, 0.5), (150, WALL, 0.7), (240, LEAF, 0.85)]
    )
    volume = load("heart")
    x, y, z = volume.center
    plane = ClipPlane(point=(x, 20.0, z), normal=(0.0, 1.0, 0.0))
    heart = still(
        Scene(
            volume=volume,
            transfer=transfer,
            camera=look((x, y, z - 3.0), 114, turn=-14, lift=10),
            clip=(plane,),
        )
    )
    return Figure(
        13,
        "Ultrasound of a heart",
        "What a workstation shows are cuts (a). Speckle spoils gradients, and with them Phong's shading (b). "
        "Occlusion needs no gradients: light from the top left (c) and from the bottom left (d) "
        "shows how deep the ventricle, above, and the atrium, below, lie behind the plane that opens them.",
        panels(
            (Cuts(volume, (0.5, 0.35, 0.5), (0, 270)), "cuts"),
            (phong(heart, "raycast-phong"), "ray casting, Phong"),
            (lit(heart), "multidirectional occlusion, top left"),
            (lit(heart, BOTTOM_LEFT), "multidirectional occlusion, bottom left"),
        ),
    )
