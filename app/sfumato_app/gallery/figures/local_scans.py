"""Figures 6 to 9 of Hernell2007: what reduction and few directions cost, and scans beside diffuse shading."""

from __future__ import annotations

from sfumato import Scene, TransferFunction
from sfumato_samples import load

from ..figure import Difference, Figure, panels
from ..setting import look, phong
from .hand import BONE, TENDON
from .local import BLOCK, PAPER, local, still_local

#: The paper's data reductions and numbers of directions; all are compared with the first.
REDUCTIONS, DIRECTIONS = (8.5, 15.7, 31.4, 92.8), (128, 64, 16, 8)
#: Of the light around where no lamp is beside it.
BRIGHTNESS = 1.4
TALL = (240, 280)
#: Distance in CIELAB that is white in the pictures of differences.
WHITE = 10.0
VESSEL = (0.62, 0.20, 0.10)  # linear RGB


def _chest() -> Scene:
    """Return the ribs, before contrast medium in heart and aorta."""
    transfer = TransferFunction.from_points(
        [(150, VESSEL, 0.0), (200, VESSEL, 0.5), (240, VESSEL, 0.5), (300, BONE, 0.6), (420, BONE, 0.9),
         (1500, (0.66, 0.61, 0.50), 0.95)]
    )  # fmt: skip
    volume = load("torso")
    return still_local(
        Scene(volume=volume, transfer=transfer, camera=look(volume.center, 372, turn=20, lift=6))
    )


def _radius(scene: Scene) -> float:
    """Return the paper's radius, a block's edge, in mm."""
    assert scene.volume is not None
    return BLOCK * float(scene.volume.min_spacing)


def _compared(number: int, title: str, caption: str, rows: list[tuple[Scene, str]]) -> Figure:
    """Return a figure with pictures above and their differences from the first below."""
    first = rows[0][0]
    below = [(Difference(scene, first, WHITE), f"{note}: difference from (a)") for scene, note in rows[1:]]
    return Figure(number, title, caption, panels(*rows, *below), TALL, PAPER, len(rows))


def figure_6() -> Figure:
    """Compare data reductions."""
    chest = _chest()
    shown: dict[str, object] = {
        "brightness": BRIGHTNESS,
        "radius": _radius(chest),
        "coarsest": 0,
        "directions": 16,
    }
    return _compared(
        6,
        "Data reduction",
        f"The light of fewer and fewer texels. A difference of {WHITE:g} in CIELAB is white in the lower row; our "
        "volume has 168 × 112 × 176 voxels, the paper's 512 × 512 × 512.",
        [(local(chest, reduction=r, **shown), f"{r:g} : 1") for r in REDUCTIONS],
    )


def figure_7() -> Figure:
    """Numbers of directions."""
    chest = _chest()
    shown: dict[str, object] = {
        "brightness": BRIGHTNESS,
        "radius": _radius(chest),
        "reduction": 31.4,
        "coarsest": 0,
    }
    return _compared(
        7,
        "Fewer directions",
        f"Eight rays from each point differ little from 128. A difference of {WHITE:g} in CIELAB is white in the "
        "lower row.",
        [(local(chest, directions=n, **shown), f"{n} directions") for n in DIRECTIONS],
    )


def figure_8() -> Figure:
    """Tendons on bones, whole and near."""
    transfer = TransferFunction.from_points(
        [(74, TENDON, 0.0), (90, TENDON, 0.5), (160, TENDON, 0.5), (220, BONE, 0.4), (420, BONE, 0.8),
         (1000, (0.66, 0.61, 0.50), 0.95)]
    )  # fmt: skip
    volume = load("hand")
    x, y, z = volume.center
    hand = still_local(Scene(volume=volume, transfer=transfer, camera=look((x, y, z), 236, turn=-20, lift=4)))
    near = hand.with_(camera=look((x, y, z - 12), 84, turn=-20, lift=4))
    shown: dict[str, object] = {"brightness": BRIGHTNESS, "directions": 32, "radius": 2 * _radius(hand)}
    return Figure(
        8,
        "What lies on what",
        "The paper shows vessels before a skull; here tendons lie on the bones of a hand. Light from all around "
        "tells which of them lies on which, and how deep it is between the bones.",
        panels(
            (phong(hand, "raycast-phong"), "diffuse"),
            (local(hand, **shown), "local occlusion, 32 rays"),
            (phong(near, "raycast-phong"), "(a) from near"),
            (local(near, **shown), "(b) from near"),
        ),
        (300, 360),
        PAPER,
        2,
    )


def figure_9() -> Figure:
    """Look at a skull."""
    transfer = TransferFunction.from_points(
        [(200, BONE, 0.0), (500, BONE, 0.6), (800, BONE, 0.9), (1500, (0.66, 0.61, 0.50), 0.97)]
    )
    volume = load("skull")
    skull = still_local(
        Scene(volume=volume, transfer=transfer, camera=look(volume.center, 250, turn=24, lift=4))
    )
    return Figure(
        9,
        "How dense bone is",
        "Diffuse shading shows slopes; light from all around is taken by dense bone and let through by thin, "
        "without gradients.",
        panels(
            (phong(skull, "raycast-phong"), "diffuse"),
            (local(skull, directions=64, radius=2 * _radius(skull), brightness=BRIGHTNESS), "local occlusion"),
        ),
        (340, 380),
        PAPER,
    )
