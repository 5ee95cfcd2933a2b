"""Figures 1 and 9 of Schlegel2011: lamps within the volume, in clear air, in smoke and in fog."""

from __future__ import annotations

from sfumato import Light, Scene
from sfumato.scene.presets import MEDIA, filled
from sfumato_samples import load
from sfumato_samples import scene as sample

from ..figure import Figure, panels
from ..setting import look, still

Vec3 = tuple[float, float, float]
SIZE = (320, 320)
#: Jittered frames of a panel.
FRAMES = 4
WHITE, RED, BLUE = (1.0, 1.0, 1.0), (1.0, 0.22, 0.12), (0.15, 0.35, 1.0)
#: Front corners of the bucky ball's box, mm from its middle.
TOP_LEFT, TOP_RIGHT = (-44.0, -50.0, 44.0), (44.0, -50.0, 44.0)
#: Lamps within the picture show on a dark ground.
NIGHT = (0.012, 0.013, 0.016, 1.0)


def bulb(place: Vec3, color: Vec3 = WHITE, intensity: float = 1.2, reach: float | None = 80.0) -> Light:
    """Return a small lamp."""
    return Light(kind="point", position=place, radius=2.0, color=color, intensity=intensity, reach=reach)


def lit_by(scene: Scene, *lights: Light, **params: float) -> Scene:
    """Return a scene lit by `extinction`."""
    changes = {f"technique.{name}": value for name, value in {"ambient": 0.12, **params}.items()}
    changed = scene.with_(technique="extinction", lights=lights).with_(changes)
    return (still(changed) if scene.background != NIGHT else changed).with_(frames=FRAMES)


def _ball() -> Scene:
    return sample("buckyball").with_(camera=look(load("buckyball").center, 134, turn=8, lift=5))


def beside(place: Vec3, center: Vec3) -> Vec3:
    """Return a place that is given from a centre, world mm."""
    x, y, z = (a + b for a, b in zip(place, center, strict=True))
    return x, y, z


def figure_1() -> Figure:
    """One to three lamps within a box."""
    ball, middle = _ball().with_(background=NIGHT), load("buckyball").center
    left, right = beside(TOP_LEFT, middle), beside(TOP_RIGHT, middle)
    pair = (
        bulb(beside((-18.0, -4.0, 6.0), middle), RED, 1.6),
        bulb(beside((18.0, 4.0, -8.0), middle), BLUE, 1.6),
    )
    return Figure(
        1,
        "A bucky ball, lit from without and within",
        "Lamps stand anywhere, also inside the volume. Two in the upper front corners of the box throw two shadows; "
        "one inside the ball throws its rods on all walls; in (c) and (d) a white lamp in the upper right corner, and "
        "two coloured ones inside.",
        panels(
            (lit_by(ball, bulb(left), bulb(right)), "two lamps in the corners"),
            (lit_by(ball, bulb(middle, intensity=1.8)), "one lamp inside"),
            (lit_by(ball, bulb(right), *pair), "one in a corner, two inside"),
            (
                lit_by(ball, bulb(right, intensity=0.6), *(lamp for lamp in pair), specular=0.4),
                "the same, the corner's lamp half as bright, with highlights",
            ),
        ),
        SIZE,
        "Schlegel2011",
    )


def figure_9() -> Figure:
    """Shafts of light in smoke, and a skull in fog."""
    smoke, fog = MEDIA[0], MEDIA[1]
    ball = _ball()
    assert ball.transfer is not None
    middle = load("buckyball").center
    air = ball.with_(transfer=filled(ball.transfer, smoke, load("buckyball")), background=NIGHT)
    beam = Light(
        kind="spot", position=beside((54.0, -56.0, 54.0), middle), direction=(-54.0, 56.0, -54.0), spread=20,
        edge=5, radius=1.5, intensity=2.5,
    )  # fmt: skip
    return Figure(
        9,
        "Light shafts in smoke, and fog around a skull",
        "In smoke light is seen on its way: a lamp inside the ball sends shafts through its meshes, a spot shines from "
        "the upper right. In fog a lamp behind the skull shines around it, and a spot from the upper left makes a "
        "shaft of its own.",
        panels(
            (lit_by(air, bulb(middle, intensity=3.0), beam, ambient=0.03), f"{smoke.name.lower()}"),
            (_skull_in_fog(), f"{fog.name.lower()}"),
        ),
        (400, 400),
        "Schlegel2011",
    )


def _skull_in_fog() -> Scene:
    volume, scene = load("skull"), sample("skull")
    assert scene.transfer is not None
    x, y, z = volume.center
    reach = 0.5 * max(n * s for n, s in zip(volume.dims, volume.spacing, strict=True))
    behind = bulb((x + 0.3 * reach, y + 0.95 * reach, z + 0.5 * reach), (1.0, 0.85, 0.6), 3.0, 1.2 * reach)
    place = (x - reach, y - 1.2 * reach, z + 1.1 * reach)
    towards = tuple(c - p for c, p in zip((x, y, z), place, strict=True))
    beam = Light(kind="spot", position=place, direction=towards, spread=34, edge=8, radius=3.0, intensity=2.0)  # type: ignore[arg-type]
    scene = scene.with_(
        transfer=filled(scene.transfer, MEDIA[1], volume),
        camera=look(volume.center, 2.3 * reach, turn=14, lift=4),
    )
    return lit_by(scene.with_(background=NIGHT), behind, beam, ambient=0.15)
