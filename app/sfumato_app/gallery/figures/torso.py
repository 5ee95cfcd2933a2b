"""Figure 12: the chest of the user study."""

from __future__ import annotations

from sfumato import Scene, TransferFunction
from sfumato_samples import load

from ..figure import Figure, panels
from ..setting import headlamp, lit, look, phong, still

BLOOD, CARTILAGE, BONE = (0.36, 0.085, 0.06), (0.56, 0.40, 0.26), (0.60, 0.53, 0.39)


def figure_12() -> Figure:
    """Four ways to light a chest."""
    transfer = TransferFunction.from_points(
        [(150, BLOOD, 0.0), (190, BLOOD, 0.15), (240, BLOOD, 0.16), (290, CARTILAGE, 0.7), (400, BONE, 0.95),
         (1500, (0.66, 0.61, 0.50), 0.95)]
    )  # fmt: skip
    volume = load("torso")
    chest = still(Scene(volume=volume, transfer=transfer, camera=look(volume.center, 372, turn=10, lift=3)))
    return Figure(
        12,
        "A chest, shaded in four ways",
        "The pictures of the paper's user study, where 41 of 42 people saw most depth in (d): the ribs' "
        "shadows fall on the heart and on the spine far behind, and tell which is nearer.",
        panels(
            (phong(chest, "raycast-phong"), "ray casting, Phong"),
            (phong(chest, "slices-phong"), "slices, Phong"),
            (headlamp(chest), "directional occlusion, headlamp"),
            (lit(chest), "multidirectional occlusion, top left"),
        ),
    )
