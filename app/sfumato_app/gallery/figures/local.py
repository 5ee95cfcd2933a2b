"""Figures 1, 3, 4 and 10 of Hernell2007: local ambient occlusion and tissue that gives off light."""

from __future__ import annotations

from sfumato import Light, Scene, TransferFunction
from sfumato_samples import load

from ..figure import Figure, panels
from ..setting import look, phong, still
from .hand import BONE, FLESH

PAPER = "Hernell2007"
SQUARE = (288, 288)
#: Linear RGB: skin of the solids, their flesh and core, the wall.
SKIN, MEAT, CORE, WALL = (0.62, 0.60, 0.56), (0.55, 0.42, 0.34), (0.75, 0.55, 0.30), (0.50, 0.53, 0.58)
LAMP = Light(tilt=40, aperture=12, rotation=135)
#: Linear RGB that the cores of the solids and the splinter give off, brighter than the display's white.
GLOW = (5.0, 1.8, 0.4)
#: Voxels along a block's edge, the paper's usual radius; our shapes have voxels of 1 mm.
BLOCK = 16.0


def still_local(scene: Scene) -> Scene:
    """Return a scene on paper; light from all around is smooth, so that few frames are enough."""
    return still(scene).with_(frames=2)


def local(scene: Scene, **params: object) -> Scene:
    """Return a scene in local occlusion, lit from all around alone unless the parameters say so."""
    changes = {f"technique.{name}": value for name, value in {"lamps": "off", **params}.items()}
    return scene.with_(technique="local-occlusion", lights=(LAMP,)).with_(changes)


def _shapes(glow: bool = False) -> Scene:
    """Return the four solids; with `glow` one looks through skin and flesh at a core that shines."""
    volume = load("shapes")
    wall = [(0, WALL, 0.9), (20, WALL, 0.9), (36, WALL, 0.0)]
    if glow:
        rest = [
            (85, SKIN, 0.0),
            (110, SKIN, 0.05),
            (150, MEAT, 0.06),
            (190, MEAT, 0.06),
            (206, CORE, 0.5, GLOW),
        ]
    else:
        rest = [(70, SKIN, 0.0), (95, SKIN, 0.9), (140, SKIN, 0.95)]
    transfer = TransferFunction.from_points([*wall, *rest])
    return still_local(
        Scene(volume=volume, transfer=transfer, camera=look(volume.center, 140, turn=-14, lift=10))
    )


def figure_1() -> Figure:
    """Light at the ends of rays alone, and at each sample."""
    shapes = _shapes()
    few: dict[str, object] = {"directions": 8, "radius": 28.0, "samples": 28}
    return Figure(
        1,
        "Light from the ends of rays, or from all of their length",
        "Eight rays. Where light comes from their ends alone, each solid throws a shadow with an edge for each ray; "
        "where every sample brings its share, shadows grow by and by.",
        panels(
            (local(shapes, ends=True, **few), "from the ends alone"),
            (local(shapes, **few), "from each sample"),
        ),
        (384, 384),
        PAPER,
    )


def figure_3() -> Figure:
    """Diffuse shading, one ray, eight rays."""
    shapes = _shapes()
    return Figure(
        3,
        "Diffuse shading and local occlusion",
        "Gradient shading shows each surface by itself. One ray to the lamp throws distinct shadows; eight rays all "
        "around leave soft ones where surfaces meet.",
        panels(
            (phong(shapes, "raycast-phong"), "ray casting, diffuse"),
            (local(shapes, directions=1, radius=24.0, bias=0.1, brightness=1.0), "one ray to the lamp"),
            (local(shapes, directions=8, radius=BLOCK), "8 rays"),
        ),
        SQUARE,
        PAPER,
    )


def figure_4() -> Figure:
    """Show what shines in itself, by what it lights, or both."""
    shapes = _shapes(glow=True)
    return Figure(
        4,
        "Tissue that gives off light",
        "The core of each solid shines. In the ray casting alone it is bright but lights nothing; in "
        "the gathering alone, it lights what is around it; in both, it is what it looks like.",
        panels(
            (local(shapes, emission="casting", radius=BLOCK, directions=16), "in the ray casting"),
            (local(shapes, emission="gathering", radius=BLOCK, directions=16), "in the gathering"),
            (local(shapes, emission="both", radius=BLOCK, directions=16), "both"),
        ),
        SQUARE,
        PAPER,
    )


def splinter() -> Scene:
    """Return the hand, flesh like mist, in which a splinter of metal glows."""
    volume = load("hand-splinter")
    transfer = TransferFunction.from_points(
        [(30, FLESH, 0.0), (60, FLESH, 0.03), (150, FLESH, 0.03), (240, BONE, 0.06), (420, BONE, 0.6),
         (1250, BONE, 0.8), (1300, (0.9, 0.6, 0.3), 0.9, GLOW), (3000, (0.9, 0.6, 0.3), 0.95, GLOW)]
    )  # fmt: skip
    return still_local(
        Scene(volume=volume, transfer=transfer, camera=look((52.0, volume.center[1], 70.0), 130))
    )


def figure_10() -> Figure:
    """Show a splinter of metal in a hand."""
    hand = splinter()
    return Figure(
        10,
        "A splinter of metal",
        "The paper shows fragments of a bullet. Under diffuse light the splinter is one bright thing among others; "
        "luminous, it is found at once and shows what lies next to it.",
        panels(
            (phong(hand, "raycast-phong").with_({"transfer.points.6.emission": (0.0, 0.0, 0.0),
              "transfer.points.7.emission": (0.0, 0.0, 0.0)}), "diffuse"),
            (local(hand, directions=16), "local occlusion, luminous"),
            (local(hand, directions=16, lamps="diffuse", mode="product"), "... times diffuse shading"),
        ),
        SQUARE,
        PAPER,
    )  # fmt: skip
