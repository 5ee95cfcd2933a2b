"""Light within a volume against what is known: slabs, walls, lamps, and what is cut away."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sfumato import Camera, ClipPlane, CropBox, Light, Region, Scene, TransferFunction, Volume
from sfumato.slicing import extinction_grid, light_at

#: Value 1 takes 0.2 per mm; value 2 is a wall.
PER_MM = 0.2
TISSUE = TransferFunction.from_points(
    [(0, (1, 1, 1), 0.0), (1, (1, 1, 1), 1 - np.exp(-PER_MM)), (2, (1, 1, 1), 0.9999)], unit_distance=1.0
)  # fmt: skip
FRONT = Camera((20.0, -200.0, 20.0), (20.0, 20.0, 20.0))
HEAD = Light(tilt=0.0, aperture=0.5)


def scene_of(data: np.ndarray, lights: tuple[Light, ...] = (HEAD,), **fields: object) -> Scene:
    volume = Volume(np.asarray(data, dtype=np.float32), fields.pop("spacing", (1.0, 1.0, 1.0)))  # type: ignore[arg-type]
    return Scene(volume=volume, transfer=TISSUE, camera=FRONT, lights=lights, **fields)  # type: ignore[arg-type]


def lit(scene: Scene, *points: tuple[float, float, float], rays: int = 7) -> np.ndarray:
    return light_at(scene, extinction_grid(scene), np.array(points, dtype=float), rays)[:, 0]


@pytest.mark.parametrize("turn", [None, (20, -30, 40)])
@pytest.mark.parametrize("n", [40, 200])
def test_a_homogeneous_block_takes_light_by_its_depth(n: int, turn: tuple[float, ...] | None) -> None:
    side = 40.0 / n
    direction = np.eye(3) if turn is None else Rotation.from_euler("xyz", turn, degrees=True).as_matrix()
    data = np.ones((n, n, n), np.float32)
    volume = Volume(data, (side,) * 3, direction=tuple(map(tuple, direction)))
    middle = np.asarray(volume.center)
    camera = Camera(tuple(middle - 300 * direction[:, 1]), tuple(middle), tuple(direction[:, 2]))
    scene = Scene(volume=volume, transfer=TISSUE, camera=camera, lights=(HEAD,))
    depths = np.array([2.0, 7.5, 20.0, 33.0])
    points = middle + (depths[:, None] - 20) * direction[:, 1]
    seen = light_at(scene, extinction_grid(scene), points)[:, 0]
    assert seen == pytest.approx(np.exp(-PER_MM * depths), rel=0.02)


def test_a_wall_casts_a_shadow_and_what_is_cut_away_does_not() -> None:
    data = np.zeros((40, 40, 40))
    data[:, 8:12, :20] = 2.0
    behind, beside = (8.0, 30.0, 20.0), (32.0, 30.0, 20.0)
    assert lit(scene_of(data), behind, beside) == pytest.approx([0, 1], abs=1e-3)
    cropped = scene_of(data, crop=CropBox((0, 0.4, 0), (1, 1, 1)))
    assert lit(cropped, behind) == pytest.approx(1, abs=1e-3)
    clipped = scene_of(data, clip=(ClipPlane((20, 15, 20), (0, 1, 0)),))
    assert lit(clipped, behind) == pytest.approx(1, abs=1e-3)


def test_a_wide_cone_has_a_soft_edge_and_a_narrow_one_a_hard_one() -> None:
    data = np.zeros((40, 40, 40))
    data[:, 8:12, :20] = 2.0
    across = [(x, 34.0, 20.0) for x in (10.0, 16.0, 20.0, 24.0, 30.0)]
    narrow, wide = (lit(scene_of(data, (Light(tilt=0, aperture=a),)), *across, rays=31) for a in (0.5, 20))
    assert narrow[[0, 1, 3, 4]] == pytest.approx([0, 0, 1, 1], abs=1e-3)
    assert (np.diff(wide) > -1e-6).all()
    assert 0.05 < wide[1] < 0.45
    assert 0.55 < wide[3] < 0.95


def test_a_lamp_within_the_volume_is_not_shadowed_by_what_lies_behind_it() -> None:
    data = np.zeros((40, 40, 40))
    data[:, :, 30:] = 2.0
    lamp = Light(kind="point", position=(25.0, 20.0, 20.0), radius=0.5)
    assert lit(scene_of(data, (lamp,)), (10.0, 20.0, 20.0)) == pytest.approx(1, abs=1e-3)
    outside = Light(kind="point", position=(60.0, 20.0, 20.0), radius=0.5)
    assert lit(scene_of(data, (outside,)), (10.0, 20.0, 20.0)) == pytest.approx(0, abs=1e-3)
    spot = Light(kind="spot", position=(20.0, 0.0, 20.0), direction=(0, 1, 0), spread=20, radius=0.5)
    assert lit(scene_of(0 * data, (spot,)), (20, 30, 20), (39, 10, 20)) == pytest.approx([1, 0], abs=1e-3)


def test_colours_and_intensities_add_up() -> None:
    lights = (
        Light(tilt=0, color=(1, 0, 0), intensity=2.0),
        Light(tilt=0, color=(0, 0.5, 1)),
        Light(enabled=False),
    )
    scene = scene_of(np.zeros((8, 8, 8)), lights)
    assert light_at(scene, extinction_grid(scene), np.array([[4.0, 4.0, 4.0]]))[0] == pytest.approx(
        [2, 0.5, 1]
    )


def test_thin_layers_of_large_volumes_keep_what_they_take() -> None:
    data = np.zeros((8, 300, 8))
    data[:, 50] = 1.0
    volume = Volume(data.astype(np.float32), (1.0, 0.2, 1.0))
    camera = Camera((4.0, -200.0, 4.0), (4.0, 30.0, 4.0))
    scene = Scene(volume=volume, transfer=TISSUE, camera=camera, lights=(HEAD,))
    grid = extinction_grid(scene)
    assert grid.blocks.shape[1] <= 96
    seen = light_at(scene, grid, np.array([[4.0, 40.0, 4.0]]), 1)[0, 0]
    assert -np.log(seen) == pytest.approx(PER_MM * 0.2, rel=0.05), (
        "the function ends at its last point's opacity"
    )


def test_functions_of_the_gradient_and_single_layers() -> None:
    edge = Region("rectangle", (-1.0, 3.0), (0.1, 0.9), opacity=0.999)
    data = np.zeros((20, 20, 20))
    data[:, 10:] = 1.0
    transfer = TransferFunction.from_points([(0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.0)])
    scene = scene_of(data).with_(transfer=replace(transfer, regions=(edge,)))
    assert lit(scene, (10, 5, 10), (10, 16, 10))[0] == pytest.approx(1, abs=1e-3)
    assert lit(scene, (10, 16, 10))[0] < 0.05, "the step between the halves stops it"
    for shape in ((1, 9, 9), (9, 1, 9), (1, 1, 1)):
        assert np.isfinite(lit(scene_of(np.ones(shape)), (0.5, 0.5, 0.5))).all()


@pytest.mark.measured
def test_a_slice_is_lit_in_a_moment() -> None:
    rng = np.random.default_rng(0)
    scene = scene_of(rng.random((256, 256, 256)) * 0.05, (Light(),))
    began = time.perf_counter()
    grid = extinction_grid(scene)
    points = np.stack(
        np.meshgrid(np.linspace(5, 250, 64), [128.0], np.linspace(5, 250, 64)), axis=-1
    ).reshape(-1, 3)
    mid = time.perf_counter()
    light_at(scene, grid, points)
    print(f"grid {mid - began:.2f} s, light {time.perf_counter() - mid:.2f} s")
    assert time.perf_counter() - began < 6
