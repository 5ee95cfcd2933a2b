"""The ray-traced cone integral against what is known without it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sfumato import Camera, ClipPlane, Light, Scene, TransferFunction, Volume
from sfumato.reference import cone, footprint, slab

Make = Callable[..., Any]

#: Where Numba is missing the pictures would take minutes; what they hold is the same.
fast = pytest.mark.skipif(cone._compiled() is None, reason="Numba is not installed: too slow for a test")


@fast
def test_compiled_loops_and_numpy_agree(lumpy: tuple, make_scene: Make) -> None:
    volume, transfer = lumpy
    lights = (Light(), Light(tilt=150, aperture=10, color=(1, 0.2, 0.1)))
    scene = make_scene(
        volume, transfer, *lights, parallel=False, step=2.0, clip=(ClipPlane((8, 8, 8), (1, 0.5, 0.2)),)
    )
    plain, compiled = (cone.render(scene, (10, 8), 5, 2.0, compiled=c) for c in (False, True))
    assert plain[..., 3].max() > 0.9
    np.testing.assert_allclose(compiled, plain, atol=1e-8)


@fast
@pytest.mark.parametrize("step", [0.5, 2.0])
def test_slab_has_the_opacity_of_its_thickness(make_slab: Make, make_scene: Make, step: float) -> None:
    volume, transfer = make_slab(0.2)
    picture = cone.render(make_scene(volume, transfer, step=step), (6, 6), 4)
    np.testing.assert_allclose(picture[..., 3], 1 - math.exp(-0.2 * 8), rtol=1e-5)


@fast
@pytest.mark.parametrize("tilt", [0.0, 37.0, 60.0])
@pytest.mark.parametrize("step", [0.25, 0.5, 1.0])
def test_opaque_facing_wall_is_its_own_colour(
    make_wall: Make, make_scene: Make, tilt: float, step: float
) -> None:
    volume, transfer = make_wall(24)
    picture = cone.render(make_scene(volume, transfer, Light(tilt=tilt), step=step), (6, 6), 128)
    np.testing.assert_allclose(picture[2:4, 2:4], 1, rtol=0.01)


@fast
@pytest.mark.parametrize(("tilt", "rear"), [(0.0, False), (50.0, False), (37.0, True)])
def test_slab_returns_the_slab_term(make_scene: Make, tilt: float, rear: bool) -> None:
    volume = Volume(np.ones((30, 2, 30), dtype=np.float32))
    transfer = TransferFunction.from_points([(1, (1, 1, 1), 1 - math.exp(-0.6))], unit_distance=1.0)
    light = Light(tilt=180 - tilt if rear else tilt, aperture=15)
    picture = cone.render(make_scene(volume, transfer, light), (15, 15), 256)
    expected = slab.secant_rule(tilt, 15).term(np.array(1.2), np.array(1.0), rear)
    assert picture[7, 7, 0] == pytest.approx(float(expected), rel=0.002)


@fast
@pytest.mark.parametrize("tilt", [37.0, 150.0])
def test_closed_box_has_no_light_inside(make_scene: Make, tilt: float) -> None:
    data = np.ones((20, 20, 20), dtype=np.float32)
    data[5:15, 5:15, 5:15] = 0
    transfer = TransferFunction.from_points([(0.4, (1, 1, 1), 0.0), (0.6, (1, 1, 1), 0.999)], 0.25)
    inside = Camera(position=(10, 8, 10), focal_point=(10, 12, 10), view_angle=90)
    picture = cone.render(make_scene(Volume(data), transfer, Light(tilt=tilt), camera=inside), (8, 8), 32)
    assert picture[..., 3].min() > 0.999
    assert picture[..., :3].max() < 1e-6


def occluder(make_scene: Make, light: Light, present: bool, step: float = 0.5) -> Scene:
    """A speck of 2 mm, 12 mm before a wall; 40 x 40 mm seen in 1 mm pixels."""
    data = np.zeros((40, 24, 40), dtype=np.float32)
    data[:, 19:, :] = 1
    if present:
        data[19:21, 6:8, 19:21] = 1
    transfer = TransferFunction.from_points([(0.4, (1, 1, 1), 0.0), (0.6, (1, 1, 1), 0.999)])
    volume = Volume(data)
    camera = Camera.fit(volume.corners(), "front", parallel_projection=True, fill=1.0)
    return make_scene(volume, transfer, light, camera=camera, step=step)


@fast
@pytest.mark.parametrize("rotation", [135])
def test_small_occluders_shadow_lies_at_the_sections_centroid(make_scene: Make, rotation: int) -> None:
    light = Light(tilt=37, aperture=20, rotation=rotation)
    bare, picture = (
        cone.render(occluder(make_scene, light, there), (40, 40), 200)[..., 0] for there in (False, True)
    )
    ticks = np.arange(40) - 19.5
    dark = np.maximum(bare - picture, 0)
    dark[16:24, 16:24] = 0
    found = np.array([(dark * ticks[None, :]).sum(), -(dark * ticks[:, None]).sum()]) / dark.sum()
    directions, weights = footprint.cone_quadrature(37, 20)
    # Each direction carries as much light: the shadow's centroid is the mean place where they meet the wall.
    distance = 12.0 * float(weights @ (directions[:, 0] / directions[:, 2]))
    phi = math.radians(rotation)
    np.testing.assert_allclose(found, [-distance * math.cos(phi), -distance * math.sin(phi)], atol=0.5)


@fast
def test_half_and_double_step_change_little(make_scene: Make) -> None:
    light = Light(tilt=37)
    fine, usual, coarse = (
        cone.render(occluder(make_scene, light, True, s), (20, 20), 64, light_step=s)[..., 0]
        for s in (0.25, 0.5, 1.0)
    )
    for other in (fine, coarse):
        assert abs(other - usual).mean() < 2 / 255
        assert other[1, 1] == pytest.approx(usual[1, 1], rel=0.03)


@fast
def test_more_directions_converge(lumpy: tuple, make_scene: Make) -> None:
    volume, transfer = lumpy
    pictures = [cone.render(make_scene(volume, transfer), (12, 12), k, 1.0) for k in (4, 32, 256)]
    few, some = (np.abs(p - pictures[2]).mean() for p in pictures[:2])
    assert some < few
    assert some < 1 / 255


@fast
def test_it_can_be_cancelled_between_batches(lumpy: tuple, make_scene: Make) -> None:
    volume, transfer = lumpy
    out = np.zeros((300, 30, 4))
    run = cone.passes(make_scene(volume, transfer), (30, 300), out, 1, 2.0)
    assert 0 < next(run) < 1
    run.close()
    assert not out[-20:].any()
