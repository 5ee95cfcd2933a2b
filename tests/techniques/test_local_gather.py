"""Truths about gathered light: against float64, and what is known without it (Hernell2007, Eq. 1-5)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from sfumato import ClipPlane, Scene, TransferFunction, Volume
from sfumato.reference.local_occlusion import intensity
from sfumato.renderer import FULL, Frame, Renderer
from sfumato.techniques.local_occlusion.blocks import Blocks, prepare_blocks
from sfumato.techniques.local_occlusion.gather import Gatherer, LightMap, rays, reach
from sfumato.techniques.local_occlusion.params import LocalOcclusionParams
from sfumato.techniques.marcher import Material, prepare_material

pytestmark = pytest.mark.gpu

#: Whole blocks, all at full resolution.
FINE: dict[str, Any] = {"reduction": 1.0, "coarsest": 4}
SOFT = TransferFunction.from_points(
    [(0.1, (1, 1, 1), 0.0), (1.0, (1, 1, 1), 0.7, (3.0, 1.0, 0.2))], unit_distance=1.0
)


@dataclass
class Bench:
    """A device on which light is gathered."""

    renderer: Renderer
    gatherer: Gatherer

    def prepare(self, scene: Scene) -> tuple[Frame, Material, Blocks, LightMap]:
        self.renderer.device.make_current()
        frame = Frame(self.renderer.device, scene, (8, 8), None, FULL)  # type: ignore[arg-type]
        material = prepare_material(frame)
        blocks = prepare_blocks(frame, material)
        return frame, material, blocks, self.gatherer.light_map(frame, material, blocks)

    def gather(self, scene: Scene) -> tuple[Frame, Blocks, LightMap]:
        frame, material, blocks, light = self.prepare(scene)
        for _ in self.gatherer.gather(frame, material, blocks, light, 1 << 20, 0.0):
            pass
        return frame, blocks, light

    def dense(self, scene: Scene) -> np.ndarray:
        """Return the light at each voxel (z, y, x, channels), NaN in empty blocks; all blocks must be fine."""
        _, blocks, light = self.gather(scene)
        return unpacked(blocks, light.mean())

    def dense_origins(self, scene: Scene) -> np.ndarray:
        """Return where the rays of each voxel begin, in voxels (z, y, x, 3: z, y, x)."""
        frame, blocks, _ = self.gather(scene)
        shifts = unpacked(blocks, self.gatherer._finder.origins(frame, blocks).shifts())[..., ::-1]
        return np.stack(np.meshgrid(*map(np.arange, shifts.shape[:3]), indexing="ij"), axis=-1) + shifts


def unpacked(blocks: Blocks, packed: np.ndarray) -> np.ndarray:
    """Return what texels hold at the places of their voxels; NaN in empty blocks."""
    index, levels = blocks.packing.index, blocks.packing.levels
    whole = np.full((*(16 * n for n in index.shape[:3]), packed.shape[-1]), np.nan)
    for at in np.argwhere(levels != 255):
        x, y, z = index[tuple(at)][:3].tolist()
        assert levels[tuple(at)] == 4
        place = tuple(slice(16 * a, 16 * a + 16) for a in at)
        whole[place] = packed[z : z + 16, y : y + 16, x : x + 16]
    return whole


@pytest.fixture(scope="module")
def bench() -> Iterator[Bench]:
    """A device of its own."""
    renderer = Renderer()
    gatherer = Gatherer(renderer.device)
    yield Bench(renderer, gatherer)
    renderer.device.make_current()  # objects of another context may have the same numbers
    gatherer.release()
    renderer.close()


def bumps(n: int, seed: int = 1) -> np.ndarray:
    """Return smooth hills, 0 to 1."""
    rng = np.random.default_rng(seed)
    z, y, x = (np.mgrid[:n, :n, :n] + 0.5) / n
    total = np.zeros(x.shape)
    for a, b, c in rng.uniform(0.2, 0.8, (5, 3)):
        total += np.exp(-((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2) / 0.02)
    return (total / total.max()).astype(np.float32)


def truth(scene: Scene, frame: Frame, at: np.ndarray, emission: bool) -> np.ndarray:
    """Return the float64 light at voxels (n, 3; z, y, x)."""
    volume, params = frame.volume, frame.params
    points = (at[:, ::-1] + 0.5) / volume.dims @ volume.world_from_texture[:3, :3].T
    units, weights = rays(frame)
    radius, offset = reach(frame)
    return intensity(
        scene, points + volume.world_from_texture[:3, 3], units, radius=radius, offset=offset,
        samples=params.samples, weights=weights, gamma=params.gamma, emission=emission,
    )  # fmt: skip


@pytest.mark.parametrize("emission", ["both", "none"])
def test_a_single_block_is_as_in_float64(bench: Bench, emission: str) -> None:
    volume = Volume(bumps(16), spacing=(1.0, 0.8, 1.3))
    params = LocalOcclusionParams(directions=20, gamma=1.4, radius=7.0, emission=emission, **FINE)
    scene = Scene(volume=volume, transfer=SOFT, technique=params)
    frame, _, _ = bench.gather(scene)
    light, at = bench.dense(scene), bench.dense_origins(scene).reshape(-1, 3)
    expected = truth(scene, frame, at, emission == "both")
    assert light.shape[-1] == (3 if emission == "both" else 1)
    np.testing.assert_allclose(light.reshape(len(at), -1), expected[:, : light.shape[-1]], atol=2e-3)


def test_many_blocks_are_as_in_float64(bench: Bench) -> None:
    volume = Volume(bumps(48, 2))
    params = LocalOcclusionParams(directions=8, emission="none", radius=12.0, **FINE)
    scene = Scene(volume=volume, transfer=SOFT, technique=params)
    frame, _, _ = bench.gather(scene)
    light = bench.dense(scene)[..., 0]
    known = np.argwhere(np.isfinite(light))
    known = np.random.default_rng(2).choice(known, 3000)
    origins = bench.dense_origins(scene)[tuple(known.T)]
    off = np.abs(light[tuple(known.T)] - truth(scene, frame, origins, False)[:, 0])
    # Rays look into the volume itself: no block's face is seen.
    assert off.max() < 2e-3


BALL = TransferFunction.from_points([(0.2, (1, 1, 1), 0.0), (0.8, (1, 1, 1), 0.95)], unit_distance=1.0)


def ball(n: int, radius: float) -> tuple[Volume, np.ndarray]:
    """Return a ball with a soft edge of 3 voxels, and the distance of voxels to its middle."""
    z, y, x = np.mgrid[:n, :n, :n] + 0.5 - n / 2
    away = np.sqrt(x**2 + y**2 + z**2)
    return Volume(np.clip(0.5 - (away - radius) / 3, 0, 1).astype(np.float32)), away


def test_rays_of_texels_next_to_a_surface_begin_on_it(bench: Bench) -> None:
    volume, away = ball(48, 14.3)
    scene = Scene(
        volume=volume, transfer=BALL, technique=LocalOcclusionParams(directions=4, radius=8.0, **FINE)
    )
    begins = np.linalg.norm(bench.dense_origins(scene)[:48, :48, :48] + 0.5 - 24, axis=-1)
    # An opacity of 0.2 is reached at a value of 0.326, half a voxel outside of the middle of the edge.
    near = np.abs(away - 14.3) < 2
    assert np.abs(begins[near] - 14.82).max() < 0.05
    deep = away < 8
    np.testing.assert_allclose(begins[deep], away[deep], atol=1e-6)


def test_blocks_of_all_resolutions_agree_on_the_light_of_a_surface(bench: Bench) -> None:
    volume, _ = ball(96, 36.0)
    base = LocalOcclusionParams(directions=32, radius=12.0, samples=16)
    surface = []
    for level in (2, 3, 4):
        scene = Scene(volume=volume, transfer=BALL, technique=replace(base, coarsest=level, reduction=1000.0))
        frame, blocks, light = bench.gather(scene)
        assert set(np.unique(blocks.packing.levels)) <= {level, 255}
        moved = np.abs(bench.gatherer._finder.origins(frame, blocks).shifts()).max(axis=-1) > 0
        surface.append(light.mean()[moved][:, 0])
    means = [float(values.mean()) for values in surface]
    assert max(means) - min(means) < 0.01
    assert all(values.std() < 0.005 for values in surface)


def solid(n: int, low: int, high: int) -> Scene:
    """Return an opaque cube in an empty volume."""
    data = np.zeros((n, n, n), dtype=np.float32)
    data[low:high, low:high, low:high] = 1
    transfer = TransferFunction.from_points([(0.4, (1, 1, 1), 0.0), (0.6, (1, 1, 1), 0.999)], 0.5)
    return Scene(volume=Volume(data), transfer=transfer)


def test_inside_what_is_opaque_is_one_sample_s_light_and_outside_all(bench: Bench) -> None:
    params = LocalOcclusionParams(directions=32, samples=10, radius=3.0, gamma=3.0, **FINE)
    scene = solid(64, 20, 44).with_(technique=params)
    light = bench.dense(scene)[..., 0]
    assert light[32, 32, 32] == pytest.approx(1 / 10, abs=1e-4)
    assert light[32, 32, 16] == pytest.approx(1, abs=1e-6)
    # Just below a face, not half of the directions are free.
    assert 0.2 < light[32, 32, 20] < 0.6


def test_coarse_blocks_are_as_dark_inside_as_fine_ones(bench: Bench) -> None:
    params = LocalOcclusionParams(directions=32, samples=16, radius=12.0, gamma=3.0, reduction=1, coarsest=2)
    _, blocks, light = bench.gather(solid(96, 16, 80).with_(technique=params))
    x, y, z = blocks.packing.index[2, 2, 2, :3].tolist()
    assert blocks.packing.levels[2, 2, 2] == 2  # homogeneous
    # They take fewer samples, but their first is as long: else blocks would differ.
    assert light.mean()[z + 2, y + 2, x + 2, 0] == pytest.approx(1 / 16, abs=1e-3)


def test_turning_the_volume_turns_the_light(bench: Bench) -> None:
    params = LocalOcclusionParams(directions=8, radius=10.0, **FINE)  # of an octahedron
    data = bumps(48, 5)
    scene = Scene(volume=Volume(data), transfer=SOFT, technique=params)
    turned = scene.with_(volume=Volume(np.rot90(data, axes=(1, 2)).copy()))
    straight, around = bench.dense(scene), bench.dense(turned)
    np.testing.assert_allclose(np.rot90(straight, axes=(1, 2)), around, atol=2e-4)


def test_what_is_cut_away_takes_no_light(bench: Bench) -> None:
    params = LocalOcclusionParams(directions=32, samples=12, radius=6.0, **FINE)
    whole = solid(64, 20, 44).with_(technique=params)
    cut = whole.with_(clip=(ClipPlane((0, 0, 32.0), (0, 0, 1)),))
    below, beside = bench.dense(whole)[32, 32, 32, 0], bench.dense(cut)[32, 32, 32, 0]
    assert below < 0.15
    assert 0.3 < beside < 0.65


def test_what_is_shown_is_the_exact_mean_at_each_step(bench: Bench) -> None:
    params = LocalOcclusionParams(directions=4, radius=5.0, **FINE)
    frame, material, blocks, light = bench.prepare(solid(80, 20, 60).with_(technique=params))
    assert light.slabs > 1
    means = []
    while not light.complete:
        pieces = bench.gatherer.gather(frame, material, blocks, light, 0, 1e9)
        next(pieces)
        pieces.close()  # a newer scene came in between
        means.append((light.done, light.slab, light.mean()))
    assert len(means) == 5 * light.slabs  # first it is found where rays begin
    at = tuple((blocks.packing.index[1, 1, 1, :3][::-1] + 4).tolist())  # inside
    outside = tuple((blocks.packing.index[1, 1, 1, :3][::-1]).tolist())
    for done, slab, mean in means:
        if done or at[0] < slab * 16:
            assert 0 < mean[at][0] <= mean[outside][0] <= 1 + 1e-6
    again = bench.prepare(solid(80, 20, 60).with_(technique=params))[3]
    assert again is light  # kept


def test_a_camera_keeps_the_light_and_a_transfer_function_does_not(bench: Bench) -> None:
    scene = solid(64, 20, 44).with_(technique=LocalOcclusionParams(directions=4))
    light = bench.prepare(scene)[3]
    moved = scene.with_(**{"camera.position": (1.0, 2.0, 3.0)})
    assert bench.prepare(moved)[3] is light
    assert bench.prepare(scene.with_(**{"transfer.points.1.opacity": 0.5}))[3] is not light
    assert bench.prepare(scene.with_(clip=(ClipPlane((0, 0, 32.0), (0, 0, 1)),)))[3] is not light
    brighter = scene.with_(**{"technique.brightness": 1.0, "technique.bias": 0.5, "technique.lamps": "off"})
    assert bench.prepare(brighter)[3] is light
