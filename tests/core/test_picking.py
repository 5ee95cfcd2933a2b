"""What lies under a place of the picture, against geometry."""

from __future__ import annotations

import time

import numpy as np
import pytest

from sfumato import Camera, Scene, TransferFunction, Volume
from sfumato.scene import ClipPlane, CropBox, Region
from sfumato.scene.picking import material_under, ray_through, surface_under

N, RADIUS = 60, 20.0
CENTRE = np.array([30.0, 30.0, 30.0])
OPAQUE = TransferFunction.from_points([(0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.999)])


@pytest.fixture(scope="module")
def ball() -> Volume:
    """A ball of radius 20 mm around (30, 30, 30) in 60 mm; the value passes 0.5 at its surface."""
    z, y, x = np.mgrid[0:N, 0:N, 0:N] + 0.5
    distance = np.sqrt((x - 30) ** 2 + (y - 30) ** 2 + (z - 30) ** 2)
    return Volume(np.clip((RADIUS - distance) + 0.5, 0, 1).astype(np.float32))


@pytest.fixture(params=[False, True], ids=["perspective", "orthographic"])
def scene(request: pytest.FixtureRequest, ball: Volume) -> Scene:
    camera = Camera(
        (30.0, -170.0, 30.0), (30.0, 30.0, 30.0), parallel_projection=request.param, parallel_scale=50.0
    )
    return Scene(volume=ball, transfer=OPAQUE, camera=camera)


@pytest.mark.parametrize("place", [(0, 0), (0.1, 0.05), (-0.12, 0.1)])
def test_the_point_lies_on_the_ball_and_on_the_ray(scene: Scene, place: tuple[float, float]) -> None:
    point = surface_under(scene, *place, aspect=1.5)
    assert point is not None
    assert np.linalg.norm(np.asarray(point) - CENTRE) == pytest.approx(RADIUS, abs=0.6)
    start, along = ray_through(scene.camera, *place, aspect=1.5)  # type: ignore[arg-type]
    assert np.linalg.norm(np.cross(np.asarray(point) - start, along)) < 1e-6
    assert point[1] < 30, "the near side"


def test_beside_the_ball_there_is_nothing(scene: Scene) -> None:
    assert surface_under(scene, 0.9, 0.9, 1.0) is None
    assert surface_under(Scene(), 0, 0, 1.0) is None


def test_clip_and_crop_cut_away_what_is_before_them(scene: Scene) -> None:
    clipped = scene.with_(clip=(ClipPlane((0, 25, 0), (0, 2, 0)),))
    assert surface_under(clipped, 0, 0, 1.0) == pytest.approx((30, 25, 30), abs=0.2)
    off = scene.with_(clip=(ClipPlane((0, 25, 0), (0, 2, 0), enabled=False),))
    assert surface_under(off, 0, 0, 1.0) == pytest.approx((30, 10, 30), abs=0.6)
    cropped = scene.with_(crop=CropBox((0, 0.4, 0), (1, 1, 1)))
    assert surface_under(cropped, 0, 0, 1.0) == pytest.approx((30, 24, 30), abs=0.2)
    assert surface_under(scene.with_(crop=CropBox((0.9, 0, 0), (1, 1, 1))), 0, 0, 1.0) is None


def test_half_the_light_is_lost_at_the_known_depth() -> None:
    """In homogeneous tissue the point lies ln 2 / tau below the surface."""
    block = Volume(np.ones((20, 20, 20), np.float32))
    haze = TransferFunction.from_points([(0, (1, 1, 1), 0.1), (2, (1, 1, 1), 0.1)], unit_distance=1.0)
    camera = Camera((10, -80, 10), (10, 10, 10), parallel_projection=True, parallel_scale=20)
    point = surface_under(Scene(volume=block, transfer=haze, camera=camera), 0, 0, 1.0)
    assert point == pytest.approx((10, np.log(2) / -np.log(0.9), 10), abs=1e-6)


def test_place_and_direction_of_the_volume_count(ball: Volume) -> None:
    turn = ((0.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
    moved = Volume(ball.data, (2.0, 1.0, 1.0), (5.0, 6.0, 7.0), turn)
    middle = np.asarray(moved.center)
    camera = Camera(
        tuple(middle - np.array([0, 300, 0])), tuple(middle), parallel_projection=True, parallel_scale=80
    )
    point = surface_under(Scene(volume=moved, transfer=OPAQUE, camera=camera), 0, 0, 1.0)
    # Array x, spaced by 2 mm, runs along world -y.
    assert point == pytest.approx(middle - [0, 40, 0], abs=1.2)


def test_a_two_dimensional_function_finds_the_edge(scene: Scene) -> None:
    """What has a gradient alone is opaque: the ball's skin."""
    edge = TransferFunction(regions=(Region(value=(0.05, 0.95), gradient=(0.2, 2.0), opacity=1.0),))
    point = surface_under(scene.with_(transfer=edge), 0, 0, 1.0)
    assert point is not None
    assert np.linalg.norm(np.asarray(point) - CENTRE) == pytest.approx(RADIUS, abs=1.0)


def test_it_is_quick_enough_for_the_windows_thread() -> None:
    large = Volume(np.zeros((64, 512, 512), np.uint8))
    scene = Scene(volume=large, transfer=TransferFunction.from_points([(1, (1, 1, 1), 0), (9, (1, 1, 1), 1)]))
    started = time.perf_counter()
    surface_under(scene, 0, 0, 1.0)
    assert time.perf_counter() - started < 0.05


def test_the_material_that_is_seen_is_found() -> None:
    # A thin veil of 0.3 before a solid plate of 0.8: the plate makes the picture; without it, the veil does.
    data = np.zeros((20, 40, 20), dtype=np.float32)
    data[:, 10:14], data[:, 25:30] = 0.3, 0.8
    transfer = TransferFunction.from_points(
        [
            (0.1, (1, 1, 1), 0.0),
            (0.3, (1, 0, 0), 0.03),
            (0.5, (1, 1, 1), 0.0),
            (0.7, (1, 1, 1), 0.6),
            (1, (1, 1, 1), 0.9),
        ],
        1.0,
    )
    camera = Camera((10, -100, 10), (10, 20, 10), parallel_projection=True, parallel_scale=15)
    scene = Scene(volume=Volume(data), transfer=transfer, camera=camera)
    found = material_under(scene, 0, 0, 1.0)
    assert found is not None
    assert found.value == pytest.approx(0.8, abs=0.02)
    assert found.point[1] == pytest.approx(26, abs=1.5)
    assert found.opacity == pytest.approx(float(transfer.evaluate(np.array([found.value]))[0, 3]))
    veil = material_under(scene.with_(crop=CropBox((0, 0, 0), (1, 0.5, 1))), 0, 0, 1.0)
    assert veil is not None
    assert veil.value == pytest.approx(0.3, abs=0.02)
    assert material_under(scene, 0.95, 0.95, 1.0) is None
    assert material_under(Scene(), 0, 0, 1.0) is None


def test_a_function_of_the_gradient_too_tells_its_opacity(scene: Scene) -> None:
    edge = TransferFunction(regions=(Region(value=(0.05, 0.95), gradient=(0.2, 2.0), opacity=1.0),))
    found = material_under(scene.with_(transfer=edge), 0, 0, 1.0)
    assert found is not None
    assert np.linalg.norm(np.asarray(found.point) - CENTRE) == pytest.approx(RADIUS, abs=1.0)
    assert 0.3 < found.opacity <= 1, "the skin is what is seen"
