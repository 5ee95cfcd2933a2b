"""Cone-accurate shadows: as a ray-traced cone casts them, and swept only when what stops or sends light moved."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy import ndimage

import sfumato
from sfumato import Camera, ClipPlane, Light, Renderer, Scene, TransferFunction, Volume
from sfumato.reference import cone as traced
from sfumato.techniques import marcher
from sfumato.techniques.frame import DRAG, FULL
from sfumato.techniques.light_cache import BYTES_PER_TEXEL, LightCache
from sfumato.techniques.light_volume import DIRECTIONS, LightSweeper, directions_of_cone

pytestmark = pytest.mark.gpu

SOLID = TransferFunction.from_points([(0.0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.999)], 1.0)
SIDE = 48


def stage(light: Light, edge: float | None = None, ball: bool = True, **more: Any) -> Scene:
    """A wall's face at y = 40 of 48 mm, before it a ball, or a half plane at depth `edge` that covers x < 24."""
    _, y, x = np.indices((48, 48, 48))
    z = np.indices((48, 48, 48))[0]
    data = np.clip(0.5 + y - 40, 0, 1)
    if edge is not None:
        data = np.maximum(data, ((np.abs(y - edge) < 1) & (x < 24)).astype(float))
    elif ball:
        away = np.sqrt((x - 23.5) ** 2 + (y - 20) ** 2 + (z - 23.5) ** 2)
        data = np.maximum(data, np.clip(6.5 - away, 0, 1))
    volume = Volume(data.astype(np.float32))
    camera = Camera.fit(volume.corners(), "front", parallel_projection=True, fill=1.0)
    values = {"technique": "cone", "transfer": SOLID, "camera": camera, "lights": (light,), **more}
    return Scene(volume=volume, **values)


def linear(scene: Scene, side: int = SIDE) -> np.ndarray:
    return sfumato.render(scene, (side, side), linear=True)[..., 0].astype(np.float64)


@pytest.mark.parametrize(
    ("tilt", "aperture"),
    [(35, 15), (50, 25), *(pytest.param(*p, marks=pytest.mark.slow) for p in ((0, 30), (70, 8)))],
)
def test_a_balls_shadow_is_the_ray_traced_one(tilt: float, aperture: float) -> None:
    light = Light(tilt=tilt, aperture=aperture, rotation=140)
    bare, truth = (
        traced.render(stage(light, ball=b), (SIDE, SIDE), directions=128)[..., 0] for b in (False, True)
    )
    away = np.hypot(*(np.indices((SIDE, SIDE)) - 23.5))
    wall = (away > 8) & (np.abs(np.indices((SIDE, SIDE)) - 23.5) < 21).all(axis=0)

    def error(scene: Scene) -> float:
        return float(np.sqrt(np.mean(((linear(scene) - truth) / np.median(bare))[wall] ** 2)))

    one = error(stage(light))
    assert one <= 0.05
    # A texel of the light volume is a quarter of this ball; `sfumato quality` holds 0.03 on larger things.
    assert error(stage(light, frames=8)) <= 0.04
    assert one < 0.5 * error(stage(light, technique="multidirectional"))


def test_the_penumbra_grows_as_the_distance() -> None:
    light, widths = Light(tilt=0, aperture=14), []
    for depth in (30, 20, 10):
        lit = linear(stage(light, edge=depth, frames=4), 96)[30:66].mean(axis=0)
        lit = lit[49:] / lit[-6:].mean()  # the half that the edge does not hide
        # Half of the penumbra lies beyond the edge: from half light to nine tenths of it.
        widths.append(1.5 + float(np.interp(0.9, np.maximum.accumulate(lit), np.arange(len(lit)))))
    near, middle, far = widths
    assert far / near == pytest.approx(3, rel=0.3)
    assert middle / near == pytest.approx(2, rel=0.3)


def test_slices_do_not_matter() -> None:
    """Brightness, unshadowed = 1; how bright a solid skin is at each step, `test_truth_gpu` tests."""
    steps = (0.0625, 0.125, 0.25, 0.5)
    shown = [linear(stage(Light(), step=s)) / linear(stage(Light(), ball=False, step=s)) for s in steps]
    wall = np.hypot(*(np.indices((SIDE, SIDE)) - 23.5)) > 8
    for other in shown[:-1]:
        assert np.abs(other - shown[-1])[wall].mean() < 1 / 255


@pytest.mark.parametrize("tilt", [80.0, 100.0, 165.0])
def test_steep_light_and_light_from_behind_are_drawn(tilt: float) -> None:
    shown = linear(stage(Light(tilt=tilt, aperture=5)))
    assert np.isfinite(shown).all()
    assert shown.min() >= 0
    if tilt < 90:
        assert np.median(shown) == pytest.approx(1, abs=0.15)


@pytest.mark.parametrize("technique", ["cone", "multidirectional"])
def test_the_prepass_agrees_with_a_finer_one(technique: str) -> None:
    """For a ball of 6 voxels; `docs/candidates.md` tells of samples and real data."""
    scene = stage(Light(tilt=35, aperture=15), technique=technique, frames=8)
    coarse, fine = linear(scene), linear(scene.with_(**{"technique.resolution": 3}))
    assert 10 * np.log10(1 / np.mean((coarse - fine) ** 2)) >= 38


def test_a_box_that_is_no_voxel_thick_keeps_its_shadow() -> None:
    """Slabs are looked at in their middle too: what is thinner than they are is not leapt over."""
    y = np.indices((48, 48, 48))[1]
    light, shades = Light(tilt=0, aperture=26), []
    for at in (19.5, 19.75, 20.0, 20.25):
        sheet = np.clip(1 - np.abs(y - at), 0, 1) * (np.indices((48, 48, 48))[2] < 24)
        data = np.maximum(np.clip(0.5 + y - 40, 0, 1), sheet).astype(np.float32)
        shades.append(linear(stage(light).with_(volume=Volume(data)))[20:28, 36:44].mean())
    assert np.ptp(shades) < 0.03


def grain(picture: np.ndarray) -> float:
    """Return the fine structure in the middle of a picture."""
    side = len(picture)
    fine = picture - ndimage.gaussian_filter(picture, 3)
    return float(np.std(fine[side // 4 : -side // 4, side // 4 : -side // 4]))


def test_a_lit_floor_has_no_more_grain_than_the_ray_traced_one() -> None:
    y, z = np.indices((48, 48, 48))[1::-1]
    data = np.clip(0.5 + 0.94 * (y - 24) + 0.34 * (z - 24), 0, 1).astype(np.float32)
    light = Light(tilt=50, aperture=20)
    scene = stage(light).with_(volume=Volume(data))
    true = grain(traced.render(scene, (64, 64), directions=32)[..., 0])
    assert grain(linear(scene, 64)) <= 1.5 * true


@pytest.mark.parametrize(("tilt", "aperture"), [(37, 20), (65, 8)])
def test_a_floor_that_faces_the_viewer_is_smooth_in_one_frame(tilt: float, aperture: float) -> None:
    """Half of one step of an 8-bit picture, or 1.5 times what a finer prepass has."""
    scene = stage(Light(tilt=tilt, aperture=aperture), ball=False)
    fine = grain(linear(scene.with_(**{"technique.resolution": 3}), 128))
    assert grain(linear(scene, 128)) <= max(1.5 * fine, 0.5 / 255)


def test_a_wall_is_lit_evenly_to_its_edge() -> None:
    """Steep light comes in from beyond the volume, where nothing stands in its way."""
    scene = stage(Light(tilt=69, aperture=10, rotation=90), ball=False, technique="multidirectional")
    for frames in (1, 2, 3):
        shown = linear(scene.with_(**{"frames": frames, "technique.resolution": 1.0}))
        assert shown[:12, SIDE // 2].min() > 0.98 * np.median(shown)


def test_coarse_pictures_look_the_same() -> None:
    """While dragging: 30 dB and no other brightness."""
    renderer, pictures = Renderer(), []
    for quality in (FULL, replace(DRAG, scale=1.0)):
        job = renderer.begin(stage(Light()), (SIDE, SIDE), quality)
        for _ in job.add_frame():
            pass
        pictures.append(job.linear()[..., 0].astype(np.float64))
        job.release()
    renderer.close()
    difference = pictures[0] - pictures[1]
    assert 10 * np.log10(1 / np.mean(difference**2)) > 27
    assert abs(difference.mean()) < 0.02


# -- what is swept anew ---------------------------------------------------------------------------------
@pytest.fixture
def sweeps(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Return a list that grows with each lamp that is swept."""
    swept: list[Any] = []
    whole = LightSweeper.sweep

    def sweep(self: LightSweeper, *arguments: Any) -> Iterator[float]:
        swept.append(arguments[2])
        return whole(self, *arguments)

    monkeypatch.setattr(LightSweeper, "sweep", sweep)
    return swept


def test_only_what_moved_is_swept(sweeps: list[Any]) -> None:
    renderer = Renderer()

    def draw(scene: Scene) -> int:
        before = len(sweeps)
        job = renderer.begin(scene, (24, 24))
        for _ in job.add_frame():
            pass
        job.release()
        return len(sweeps) - before

    two = stage(Light(name="a")).with_(lights=(Light(name="a"), Light(name="b", rotation=20)))
    assert draw(two) == 2
    assert draw(two) == 0
    assert two.camera is not None
    colours = TransferFunction.from_points([(0.0, (1, 0, 0), 0.0), (1, (0, 1, 0), 0.999)], 1.0)
    assert draw(two.with_(transfer=colours)) == 0, "colours stop no light"
    assert draw(two.with_(camera=two.camera.cropped(0.2, 0.2, 0.8, 0.8))) == 0, "nor does a closer look"
    assert draw(two.with_(**{"lights.0.color": (1, 0, 0), "lights.1.intensity": 0.3})) == 0
    assert draw(two.with_(**{"lights.1.rotation": 40})) == 1
    denser = TransferFunction.from_points([(0.0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.9)], 1.0)
    assert draw(two.with_(transfer=denser)) == 2
    assert draw(two.with_(clip=(ClipPlane((0, 10, 0), (0, 1, 0)),))) == 2
    renderer.close()


def test_a_cancelled_sweep_is_not_kept(sweeps: list[Any]) -> None:
    renderer, scene = Renderer(), stage(Light(rotation=33))
    for _ in range(2):
        job = renderer.begin(scene, (24, 24))
        next(iter(job.add_frame()))
        job.release()
    job = renderer.begin(scene, (24, 24))
    for _ in job.add_frame():
        pass
    assert len(sweeps) == 3
    assert job.picture()[..., 0].max() > 200
    job.release()
    renderer.close()


class Block:
    """Stands for a texture."""

    def __init__(self, size: tuple[int, int, int]) -> None:
        self.size, self.released = size, False

    def release(self) -> None:
        self.released = True


def test_the_cache_stays_within_its_budget() -> None:
    made: list[Block] = []

    def make(size: tuple[int, int, int]) -> Block:
        made.append(Block(size))
        return made[-1]

    cache = LightCache(make, budget=4 * 1000 * BYTES_PER_TEXEL)
    for n in range(40):
        texture = cache.take((10, 10, 10), in_use=0)
        cache.keep(n, texture)
        assert cache.bytes_in_use <= cache.budget
    assert len(made) == 4, "old ones are swept over"
    assert cache.find(39) is not None
    assert cache.find(0) is None
    cache.keep("large", cache.take((20, 20, 20), in_use=0))
    assert all(block.released for block in made[:4])
    cache.release()


# -- directions ----------------------------------------------------------------------------------------
@pytest.mark.parametrize("aperture", [1.0, 20.0, 60.0])
def test_directions_fill_the_cone_evenly(aperture: float) -> None:
    offsets, secants = directions_of_cone(aperture, DIRECTIONS, 0)
    assert secants.max() <= 1 / np.cos(np.radians(aperture)) + 1e-9
    assert np.allclose(np.hypot(*offsets.T) ** 2 + 1, secants**2)
    many = np.concatenate([directions_of_cone(aperture, DIRECTIONS, n)[0] for n in range(64)])
    assert np.abs(many.mean(axis=0)).max() < 0.02 * np.tan(np.radians(aperture))
    cosines = 1 / np.concatenate([directions_of_cone(aperture, DIRECTIONS, n)[1] for n in range(64)])
    assert cosines.mean() == pytest.approx((1 + np.cos(np.radians(aperture))) / 2, rel=1e-2)


def test_no_lamp_leaves_the_subject_dark(still: Callable[..., Scene]) -> None:
    dark = still("cone").with_(**{"lights.0.enabled": False})
    shown = sfumato.render(dark, (24, 24), linear=True)
    assert shown[..., :3].max() == 0


@pytest.mark.parametrize("technique", ["cone", "multidirectional"])
@pytest.mark.parametrize("tilt", [35.0, 150.0])
def test_what_is_thin_is_shaded_together_and_looks_the_same(
    monkeypatch: pytest.MonkeyPatch, technique: str, tilt: float
) -> None:
    fog = TransferFunction.from_points(
        [(0.0, (1, 1, 1), 0.01), (0.5, (1, 1, 1), 0.03), (1, (1, 1, 1), 0.999)], 1.0
    )
    scene = stage(Light(tilt=tilt, aperture=15, rotation=140), technique=technique, transfer=fog)
    together = linear(scene)
    monkeypatch.setattr(marcher, "TOGETHER_VOXELS", 0.0)
    apart = linear(scene)
    difference = np.abs(together - apart)
    assert 0 < difference.mean() < 1 / 255
    assert difference.max() < 5 / 255
