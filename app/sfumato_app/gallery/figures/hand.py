"""Figures 1 and 11: a hand, before a cloth and by itself."""

from __future__ import annotations

from sfumato import Scene, TransferFunction
from sfumato_samples import load

from ..figure import Figure, panels
from ..setting import headlamp, lit, look, phong, still
from ..staging import CLOTH_POINTS, before_cloth

#: Linear RGB.
SKIN, FLESH, TENDON, BONE = (0.56, 0.315, 0.21), (0.40, 0.10, 0.065), (0.58, 0.42, 0.30), (0.60, 0.53, 0.39)
PORTRAIT = (384, 512)


def skin_before_cloth() -> Scene:
    """Return the hand, skin and all, a few centimetres before a cloth."""
    transfer = TransferFunction.from_points(
        [
            *CLOTH_POINTS,
            (-420, SKIN, 0.0),
            (-180, SKIN, 0.9),
            (150, SKIN, 0.95),
            (240, (0.64, 0.43, 0.33), 0.95),
        ]
    )
    camera = look(load("hand").center, 236)
    return still(Scene(volume=before_cloth("hand", 2, 44, 6.0), transfer=transfer, camera=camera))


def figure_1() -> Figure:
    """Four ways to light a hand."""
    hand = skin_before_cloth()
    return Figure(
        1,
        "A hand, shaded in four ways",
        "Gradient shading shows each surface by itself: nothing tells how far the hand is from the cloth. "
        "A lamp at the eye darkens creases and gaps only. From the top left the thumb throws its shadow on "
        "the palm and the hand its own on the cloth, and the distance between them can be read.",
        panels(
            (phong(hand, "raycast-phong"), "ray casting, Phong"),
            (phong(hand, "slices-phong"), "slices, Phong"),
            (headlamp(hand), "directional occlusion, headlamp"),
            (lit(hand), "multidirectional occlusion, top left"),
        ),
        PORTRAIT,
    )


def figure_11() -> Figure:
    """Highlights."""
    # Fainter between tendon and bone: nails, thinner than a voxel, lie there.
    transfer = TransferFunction.from_points(
        [(36, FLESH, 0.0), (56, FLESH, 0.35), (80, FLESH, 0.4), (120, TENDON, 0.35), (150, TENDON, 0.1),
         (240, TENDON, 0.1), (420, BONE, 0.75), (1000, (0.66, 0.61, 0.50), 0.95)]
    )  # fmt: skip
    volume = load("hand")
    hand = still(Scene(volume=volume, transfer=transfer, camera=look(volume.center, 236, turn=-20, lift=4)))
    return Figure(
        11,
        "Occlusion with and without highlights",
        "The paper shows a foot; here are the muscles, tendons and bones of the hand. Highlights "
        "from gradients make (a) and (b) look wet and bring out fine relief; (c) and (d) are the pure "
        "occlusion models. In either pair the lamp moves from the eye to the top left.",
        panels(
            (headlamp(hand, specular=0.8, shininess=30), "headlamp, highlights"),
            (lit(hand, specular=0.8, shininess=30), "top left, highlights"),
            (headlamp(hand), "headlamp"),
            (lit(hand), "top left"),
        ),
        PORTRAIT,
    )
