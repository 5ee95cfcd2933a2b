"""What extinction-based light computes again, and what it keeps (Schlegel2011, Algorithm 1); at which resolution."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import sfumato
from sfumato import Camera, ClipPlane, Light, Renderer, Scene, SceneError, TransferFunction, Volume
from sfumato.renderer import DRAG, FULL, Quality
from sfumato.scene import MAX_LIGHTS
from sfumato.techniques.extinction.field import FieldMaker
from sfumato.techniques.extinction.params import ExtinctionParams
from sfumato.techniques.extinction.terms import TermMaker
from sfumato.techniques.frame import Frame

pytestmark = pytest.mark.gpu

LAMPS = (
    Light(kind="point", position=(60.0, -40.0, 70.0), radius=4.0, intensity=0.5),
    Light(kind="spot", position=(-20.0, -50.0, 60.0), direction=(44.0, 74.0, -36.0), intensity=0.5),
    Light(tilt=40, attached="patient", intensity=0.3),
)


@pytest.fixture(scope="module")
def renderer() -> Iterator[Renderer]:
    """A renderer of its own."""
    made = Renderer()
    yield made
    made.close()


@pytest.fixture
def scene(still_life: Volume, still_life_colors: TransferFunction) -> Scene:
    """The still life under three lamps that stand still when the camera moves."""
    camera = Camera(position=(49, -71, 44), focal_point=still_life.center, view_up=(0, 0, 1), view_angle=34)
    return Scene(
        volume=still_life,
        transfer=still_life_colors,
        camera=camera,
        lights=LAMPS,
        technique=ExtinctionParams(),
    )


@pytest.fixture
def passes(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Counts what is computed: tables, terms of light from all around, terms of lamps."""
    counts: Counter[str] = Counter()
    for maker, method, name in (
        (FieldMaker, "make", "table"), (TermMaker, "ambient", "shells"), (TermMaker, "lamp", "lamp")
    ):  # fmt: skip
        _count(monkeypatch, maker, method, name, counts)
    return counts


def _count(patch: pytest.MonkeyPatch, owner: Any, method: str, name: str, counts: Counter[str]) -> None:
    original = getattr(owner, method)

    def counted(*arguments: Any) -> Any:
        counts[name] += 1
        return original(*arguments)

    patch.setattr(owner, method, counted)


def draw(renderer: Renderer, scene: Scene, side: int = 24, quality: Quality = FULL) -> np.ndarray:
    """Draw one frame: linear light."""
    accumulation = renderer.begin(scene, (side, side), quality)
    try:
        for _ in accumulation.add_frame():
            pass
        return accumulation.linear()
    finally:
        accumulation.release()


def change(name: str, scene: Scene) -> Scene:
    """Return a scene of which one thing is another."""
    assert scene.camera is not None
    assert scene.transfer is not None
    assert scene.volume is not None
    points = scene.transfer.points
    thicker = tuple((p.value, p.color, min(1.0, p.opacity * 1.1)) for p in points)
    bluer = tuple((p.value, (0.2, 0.2, 1.0), p.opacity) for p in points)
    plane = ClipPlane(normal=(0.0, 1.0, 0.0), point=(24.0, 20.0, 24.0))
    changes: dict[str, dict[str, Any]] = {
        "a lamp's place": {"lights.0.position": (50.0, -45.0, 70.0)},
        "a lamp's colour": {"lights.1.color": (1.0, 0.5, 0.2), "lights.1.intensity": 0.8},
        "a lamp is added": {"lights": (*LAMPS, Light(kind="point", position=(0.0, -30.0, 0.0)))},
        "camera": {"camera": replace(scene.camera, position=(-60.0, -60.0, 30.0))},
        "highlights": {"technique.specular": 0.5, "technique.facing": 0.2},
        "ambient light": {"technique.ambient": 0.8},
        "shells": {"technique.shells": 3},
        "cone angle": {"technique.cone_angle": 25.0},
        "opacity": {"transfer": TransferFunction.from_points(list(thicker))},
        "colours": {"transfer": TransferFunction.from_points(list(bluer))},
        "clip": {"clip": (plane,)},
        "volume": {"volume": Volume(np.ascontiguousarray(scene.volume.data[::-1]))},
    }
    return scene.with_(changes[name])


@pytest.mark.parametrize(
    ("what", "table", "shells", "lamps"),
    [
        ("a lamp's place", 0, 0, 1),
        ("a lamp's colour", 0, 0, 0),
        ("a lamp is added", 0, 0, 1),
        ("camera", 0, 0, 0),
        ("highlights", 0, 0, 0),
        ("ambient light", 0, 0, 0),
        ("shells", 0, 1, 0),
        ("cone angle", 0, 0, 3),
        ("opacity", 1, 1, 3),
        # Colours bleed, and so the tables hold them; lamps' light is the same.
        ("colours", 1, 1, 0),
        ("clip", 1, 1, 3),
        ("volume", 1, 1, 3),
    ],
)
def test_only_what_changed_is_computed_again(
    renderer: Renderer, scene: Scene, passes: Counter[str], what: str, table: int, shells: int, lamps: int
) -> None:
    first = draw(renderer, scene)
    passes.clear()
    second = draw(renderer, change(what, scene))
    assert (passes["table"], passes["shells"], passes["lamp"]) == (table, shells, lamps)
    assert np.abs(first - second).max() > 1e-3, "the change is seen"
    passes.clear()
    np.testing.assert_array_equal(draw(renderer, scene), first)
    assert not passes, "what was there before is still kept"


def test_a_lamp_of_the_viewer_moves_with_the_camera(
    renderer: Renderer, scene: Scene, passes: Counter[str]
) -> None:
    scene = scene.with_(**{"lights.2.attached": "viewer"})
    draw(renderer, scene)
    passes.clear()
    draw(renderer, change("camera", scene))
    assert passes == {"lamp": 1}


def test_a_light_that_was_given_up_is_not_kept(
    renderer: Renderer, scene: Scene, passes: Counter[str]
) -> None:
    moved = scene.with_(**{"technique.radius": 5.0, "lights.0.radius": 9.0})
    accumulation = renderer.begin(moved, (16, 16))
    pieces = accumulation.add_frame()
    next(pieces)
    pieces.close()
    accumulation.release()
    passes.clear()
    draw(renderer, moved)
    assert passes["table"] == passes["shells"] == 1


def test_while_dragging_it_looks_the_same(renderer: Renderer, scene: Scene, passes: Counter[str]) -> None:
    """Half the cells, 29 dB, hardly another brightness; light that is there at full resolution is used as it is."""
    moved = scene.with_(**{"lights.0.position": (45.0, -50.0, 75.0)})
    coarse = draw(renderer, moved, 96, Quality(light=DRAG.light, progressive=True))
    fine = draw(renderer, moved, 96)
    passes.clear()
    again = draw(renderer, moved, 96, Quality(light=DRAG.light, progressive=True))
    assert not passes
    np.testing.assert_array_equal(again, fine)
    difference = (coarse - fine)[..., :3].clip(-1, 1)
    assert 10 * np.log10(1 / np.mean(difference**2)) >= 29
    assert abs(difference.mean()) < 0.05 * fine[..., :3].mean()


@pytest.fixture
def sides(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, ...]]:
    """Collects the sizes of light caches."""
    found: list[tuple[int, ...]] = []
    original = FieldMaker.make

    def watched(self: FieldMaker, frame: Frame, material: Any, grid: Any, *rest: Any) -> Any:
        found.append(grid.size)
        return original(self, frame, material, grid, *rest)

    monkeypatch.setattr(FieldMaker, "make", watched)
    return found


def test_a_cache_that_does_not_fit_is_worked_at_the_resolution_that_does(
    scene: Scene, sides: list[tuple[int, ...]]
) -> None:
    wished = scene.with_(**{"technique.resolution": 96, "lights": LAMPS[:1]})
    small, large = Renderer(budget=16 << 20), Renderer()
    try:
        got, wanted = draw(small, wished, 64), draw(large, wished, 64)
        assert max(sides[0]) < 64 < max(sides[1])
        difference = (got - wanted)[..., :3].clip(-1, 1)
        assert 10 * np.log10(1 / np.mean(difference**2)) >= 25
        # Measured: 0.07. The soft, translucent still life is a little brighter by cells as large as its voxels.
        assert abs(difference.mean()) < 0.08 * wanted[..., :3].mean()
    finally:
        small.close()
        large.close()


def test_a_cache_larger_than_the_device_allows_is_as_large_as_it_allows(
    renderer: Renderer, scene: Scene, sides: list[tuple[int, ...]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(renderer.device, "max_texture_3d", 48)
    picture = draw(renderer, scene.with_(**{"technique.resolution": 256}), 32)
    assert sides == [(48, 48, 48)]
    assert np.isfinite(picture).all()
    assert picture[..., :3].max() > 0.2


def test_more_lamps_than_can_be_are_refused(scene: Scene) -> None:
    lamp = LAMPS[0]
    with pytest.raises(SceneError, match=f"at most {MAX_LIGHTS}") as caught:
        scene.with_(lights=(lamp,) * (MAX_LIGHTS + 1))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("angle", [0.0, 90.0, float("nan"), float("inf")])
def test_a_cone_that_is_none_is_refused(angle: float) -> None:
    with pytest.raises(SceneError, match="cone_angle") as caught:
        ExtinctionParams(cone_angle=angle)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("angle", [1e-6, 89.999])
@pytest.mark.parametrize(
    "lamp",
    [
        Light(tilt=30),
        Light(kind="point", position=(24.0, 24.0, 24.0), radius=1e-9),
        Light(kind="point", position=(1e6, -1e6, 1e6), radius=1e6),
        Light(kind="spot", position=(24.0, 0.0, 24.0), direction=(0.0, 1.0, 0.0), spread=0.1, edge=0.0),
        Light(kind="area", shape="rectangle", position=(24.0, -20.0, 24.0), direction=(0, 1, 0), size=(1e-6, 1e6)),
        Light(kind="area", shape="tube", position=(24.0, -20.0, 24.0), axis=(0, 0, 1), size=(1e6, 1.0)),
        Light(kind="area", shape="sphere", position=(24.5, 24.5, 24.5), radius=1e-3),
    ],
    ids=["directional", "in a cell", "far", "thin beam", "slit", "long tube", "sphere"],
)  # fmt: skip
def test_extreme_lamps_are_drawn(renderer: Renderer, scene: Scene, lamp: Light, angle: float) -> None:
    """Neither black nor NaN: light from all around is there in any case."""
    picture = draw(renderer, scene.with_(**{"lights": (lamp,), "technique.cone_angle": angle}), 16)
    assert np.isfinite(picture).all()
    assert picture.min() >= 0
    assert picture[..., :3].max() > 0.1


def test_sixteen_lamps_are_drawn(renderer: Renderer, scene: Scene, faint_lamps: Callable[..., Any]) -> None:
    lamps, cheap = faint_lamps(MAX_LIGHTS), {"technique.ambient": 0.0, "technique.cones": 4}
    picture = draw(renderer, scene.with_(**{"lights": lamps, **cheap}), 24)
    half = draw(renderer, scene.with_(**{"lights": lamps[:8], **cheap}), 24)
    assert picture[..., :3].sum() > 1.5 * half[..., :3].sum()


@pytest.fixture
def faint_lamps() -> Callable[[int], tuple[Light, ...]]:
    """Return faint lamps around the still life."""

    def lamps(count: int) -> tuple[Light, ...]:
        turns = np.arange(count) * 2 * np.pi / count
        return tuple(
            Light(
                kind="point", position=(24 + 60 * np.cos(t), -40.0, 24 + 60 * np.sin(t)), radius=3.0,
                intensity=0.05,
            )
            for t in turns
        )  # fmt: skip

    return lamps


def test_the_picture_is_that_of_the_command(renderer: Renderer, scene: Scene) -> None:
    """What is kept from other scenes leaves no trace."""
    np.testing.assert_array_equal(draw(renderer, scene, 24), sfumato.render(scene, (24, 24), linear=True))


def test_light_that_rests_lies_beside_the_values(renderer: Renderer, scene: Scene) -> None:
    """On software renderers: one look-up for both, the same picture; moved lamps and slopes do without."""
    if not renderer.device.is_software:
        pytest.skip("not a software renderer")
    plain = scene.with_(**{"technique.facing": 0.0, "technique.specular": 0.0, "technique.resolution": 24})
    baker = renderer.painter(plain).baker
    first = draw(renderer, plain, 64)
    assert baker.filled == 0
    second, third = draw(renderer, plain, 64), draw(renderer, plain, 64)
    assert baker.filled == 1
    np.testing.assert_array_equal(second, third)
    assert np.abs(second - first).max() < 0.08
    # Measured: 0.0044. Light interpolated between cells is interpolated again between voxels.
    assert np.abs(second - first).mean() < 6e-3
    # Values of 16 bits are interpolated more finely than of 8.
    np.testing.assert_allclose(second[..., 3], first[..., 3], atol=0.015)
    brighter = plain.with_(**{"lights.0.intensity": 1.5})
    assert draw(renderer, brighter, 64)[..., :3].sum() > second[..., :3].sum()
    assert baker.filled == 1


@pytest.mark.parametrize(
    "wrong",
    [
        {"kind": "point", "position": (float("nan"), 0.0, 0.0)},
        {"kind": "point", "position": (0.0, float("inf"), 0.0)},
        {"kind": "point", "position": (0.0, 0.0, 0.0), "radius": 0.0},
        {"kind": "spot", "position": (0.0, 0.0, 0.0), "direction": (0.0, 0.0, 0.0)},
        {"kind": "area", "shape": "tube", "position": (0.0, 0.0, 0.0), "axis": (0.0, 0.0, 0.0)},
        {"kind": "area", "shape": "rectangle", "position": (0.0, 0.0, 0.0), "size": (0.0, 1.0)},
        {"aperture": 0.0},
        {"aperture": 90.0},
        {"intensity": float("inf")},
    ],
)
def test_lamps_that_cannot_be_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(SceneError, match="is not allowed") as caught:
        Light(**wrong)
    assert "\n" not in str(caught.value)
