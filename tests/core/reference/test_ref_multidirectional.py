"""The float64 twin against what is known without it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sfumato import Camera, ClipPlane, CropBox, Light, Scene, SceneError, TransferFunction, Volume
from sfumato.reference import footprint, slab
from sfumato.reference.multidirectional import render
from sfumato.techniques.multidirectional.params import DirectionalParams, MultidirectionalParams

FORMS = ["extinction", "additive", "multiplicative"]
Make = Callable[..., Any]


def lit(form: str = "extinction", **more: Any) -> MultidirectionalParams:
    return MultidirectionalParams(occlusion=form, **more)


@pytest.mark.parametrize("technique", [*[lit(f) for f in FORMS], "slices"])
@pytest.mark.parametrize("step", [0.5, 1.0, 2.7])
def test_slab_has_the_opacity_of_its_thickness(
    make_slab: Make, make_scene: Make, technique: Any, step: float
) -> None:
    volume, transfer = make_slab(0.2)
    picture = render(make_scene(volume, transfer, technique=technique, step=step), (8, 8))
    np.testing.assert_allclose(picture[..., 3], 1 - math.exp(-0.2 * 8), rtol=1e-9)


def test_unlit_slab_has_its_own_colour(make_slab: Make, make_scene: Make) -> None:
    volume, transfer = make_slab(0.2)
    picture = render(make_scene(volume, transfer, technique="slices"), (8, 8))
    np.testing.assert_allclose(
        picture[..., :3] / picture[..., 3:], np.broadcast_to([0.8, 0.6, 0.4], (8, 8, 3)), rtol=1e-9
    )


@pytest.mark.parametrize("parallel", [True, False])
def test_opacity_follows_the_rays_length(make_slab: Make, make_scene: Make, parallel: bool) -> None:
    volume, transfer = make_slab(0.2)
    scene = make_scene(volume, transfer, parallel=parallel, technique="slices")
    tangent = np.tan(np.radians(15)) * (1 / 8)  # the middle pixels are half a pixel off the axis
    secant = 1.0 if parallel else math.sqrt(1 + 2 * tangent**2)
    assert render(scene, (8, 8))[4, 4, 3] == pytest.approx(1 - math.exp(-0.2 * 8 * secant), rel=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 37.0, 60.0])
@pytest.mark.parametrize("step", [0.5, 1.0])
def test_opaque_facing_wall_is_its_own_colour(
    make_wall: Make, make_scene: Make, tilt: float, step: float
) -> None:
    volume, transfer = make_wall(24)
    picture = render(make_scene(volume, transfer, Light(tilt=tilt, intensity=0.7), step=step), (12, 12))
    np.testing.assert_allclose(picture[5:7, 5:7], np.broadcast_to([0.7, 0.7, 0.7, 1], (2, 2, 4)), rtol=0.01)


@pytest.mark.parametrize("step", [0.25, 0.5, 1.0, 2.0])
@pytest.mark.parametrize(("tilt", "rear"), [(0.0, False), (37.0, False), (37.0, True)])
def test_slab_returns_the_slab_term(make_scene: Make, step: float, tilt: float, rear: bool) -> None:
    volume = Volume(np.ones((30, 2, 30), dtype=np.float32))
    transfer = TransferFunction.from_points([(1, (1, 1, 1), 1 - math.exp(-0.6))], unit_distance=1.0)
    light = Light(tilt=180 - tilt if rear else tilt, aperture=15)
    picture = render(make_scene(volume, transfer, light, step=step), (15, 15))
    expected = slab.secant_rule(tilt, 15).term(np.array(1.2), np.array(1.0), rear)
    assert picture[7, 7, 0] == pytest.approx(float(expected), rel=0.005)


def test_light_from_behind_does_not_reach_an_opaque_wall(make_wall: Make, make_scene: Make) -> None:
    volume, transfer = make_wall(16)
    picture = render(make_scene(volume, transfer, Light(tilt=150)), (16, 16))
    assert picture[4:12, 4:12, :3].max() < 1e-4


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("tilt", [37.0, 150.0])
def test_closed_box_has_no_light_inside(make_scene: Make, form: str, tilt: float) -> None:
    data = np.ones((20, 20, 20), dtype=np.float32)
    data[5:15, 5:15, 5:15] = 0
    transfer = TransferFunction.from_points([(0.4, (1, 1, 1), 0.0), (0.6, (1, 1, 1), 0.999)], 0.25)
    inside = Camera(position=(10, 8, 10), focal_point=(10, 12, 10), view_angle=90)
    picture = render(
        make_scene(Volume(data), transfer, Light(tilt=tilt), camera=inside, technique=lit(form)), (12, 12)
    )
    assert picture[..., 3].min() > 0.999
    # Additive occlusion never darkens to nothing (13): 1 / (1 + O) after 20 opaque slabs of a 5 mm wall.
    assert picture[..., :3].max() < (0.12 if form == "additive" else 1e-3)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("rotation", [135.0, 20.0])
def test_mirrored_scene_gives_the_mirrored_picture(
    lumpy: tuple, make_scene: Make, form: str, rotation: float
) -> None:
    volume, transfer = lumpy
    light = Light(rotation=rotation)
    picture = render(make_scene(volume, transfer, light, technique=lit(form)), (20, 20))
    mirrored = Volume(volume.data[:, :, ::-1].copy())
    other = render(
        make_scene(mirrored, transfer, replace(light, rotation=180 - rotation), technique=lit(form)), (20, 20)
    )
    # The mirrored lattice has the same texels but for the rim, where it begins a texel earlier or later.
    np.testing.assert_allclose(picture[:, ::-1], other, atol=1e-3)


@pytest.mark.parametrize("form", FORMS)
def test_tilt_zero_is_directional(lumpy: tuple, make_scene: Make, form: str) -> None:
    volume, transfer = lumpy
    flat = render(make_scene(volume, transfer, Light(tilt=0), technique=lit(form)), (20, 20))
    head = render(
        make_scene(volume, transfer, Light(tilt=50), technique=DirectionalParams(occlusion=form)), (20, 20)
    )
    np.testing.assert_allclose(flat, head, atol=1e-9)


def additive_brightness(d: float, jitter: float, depth: float = 12.0) -> float:
    """Eq. 13 and 14 for an endless homogeneous surface of tau = 1/mm, by hand."""
    occlusion, seen, through, z = 0.0, 0.0, 1.0, (jitter - 1) * d
    while z < depth:
        alpha = 1 - math.exp(-(z + d - max(z, 0)))
        seen += through * alpha / (1 + occlusion)
        occlusion, through, z = occlusion + alpha, through * (1 - alpha), z + d
    return seen


@pytest.mark.parametrize(("d", "brightness"), [(1.0, 0.83), (0.5, 0.73), (0.25, 0.67)])
def test_additive_form_depends_on_the_sampling_as_published(
    make_scene: Make, d: float, brightness: float
) -> None:
    assert additive_brightness(d, 1.0) == pytest.approx(brightness, abs=0.006)
    volume = Volume(np.ones((24, 12, 24), dtype=np.float32))
    transfer = TransferFunction.from_points([(1, (1, 1, 1), 1 - math.exp(-1))], unit_distance=1.0)
    scene = make_scene(volume, transfer, Light(tilt=0, aperture=5), technique=lit("additive"), step=d)
    assert render(scene, (12, 12))[6, 6, 0] == pytest.approx(additive_brightness(d, 0.5), abs=1e-3)


def shadow_scene(make_scene: Make, light: Light, ball: bool = True, **more: Any) -> Scene:
    """A ball of radius 2 mm whose centre is 14 mm before a wall's face; 40 x 40 mm seen in 1 mm pixels."""
    z, y, x = np.indices((40, 24, 40))
    data = np.clip(0.5 + y - 19, 0, 1)
    if ball:
        away = np.sqrt((x - 19.5) ** 2 + (y - 5) ** 2 + (z - 19.5) ** 2)
        data = np.maximum(data, np.clip(2.5 - away, 0, 1))
    transfer = TransferFunction.from_points([(0.0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.999)])
    volume = Volume(data.astype(np.float32))
    camera = Camera.fit(volume.corners(), "front", parallel_projection=True, fill=1.0)
    return make_scene(volume, transfer, light, camera=camera, **more)


def shadow_centroid(bare: np.ndarray, picture: np.ndarray) -> np.ndarray:
    """Centroid of what a ball in the middle darkens, in pixels right and up of the middle."""
    ticks = np.arange(40) - 19.5
    dark = np.maximum(bare[..., 0] - picture[..., 0], 0)
    dark[np.hypot(ticks[:, None], ticks[None, :]) < 4] = 0
    return np.array([(dark * ticks[None, :]).sum(), -(dark * ticks[:, None]).sum()]) / dark.sum()


@pytest.mark.parametrize("rotation", range(0, 360, 45))
def test_balls_shadow_lies_at_distance_times_the_kernels_centroid(make_scene: Make, rotation: int) -> None:
    light = Light(tilt=37, aperture=20, rotation=rotation)
    bare, picture = (
        render(shadow_scene(make_scene, light, ball, step=1.0), (40, 40)) for ball in (False, True)
    )
    phi = math.radians(rotation)
    expected = -14 * footprint.moments(37, 20)[0] * np.array([math.cos(phi), math.sin(phi)])
    assert np.abs(shadow_centroid(bare, picture) - expected).max() < 1


@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize("tilt", [37.0, 150.0])
def test_crop_of_a_picture_is_the_picture_of_the_crop(
    lumpy: tuple, make_scene: Make, parallel: bool, tilt: float
) -> None:
    volume, transfer = lumpy
    scene = make_scene(volume, transfer, Light(tilt=tilt), parallel=parallel)
    whole = render(scene, (32, 32))
    part = render(scene.with_(camera=scene.camera.cropped(0.25, 0.5, 0.75, 1.0)), (16, 16))
    np.testing.assert_allclose(part, whole[:16, 8:24], atol=1e-9)


@pytest.mark.parametrize("what", ["plane", "box"])
def test_what_is_cut_away_casts_no_shadow(make_scene: Make, what: str) -> None:
    cut = (
        {"clip": (ClipPlane((0, 10, 0), (0, 1, 0)),)}
        if what == "plane"
        else {"crop": CropBox((0, 10 / 24, 0), (1, 1, 1))}
    )
    light, cut = Light(tilt=37), {**cut, "step": 1.0}
    with_ball = render(shadow_scene(make_scene, light, True, **cut), (40, 40))
    without = render(shadow_scene(make_scene, light, False, **cut), (40, 40))
    np.testing.assert_allclose(with_ball, without, atol=1e-6)


def test_lights_add_up_in_any_order(lumpy: tuple, make_scene: Make) -> None:
    volume, transfer = lumpy
    a, b = Light(rotation=20, color=(1, 0.5, 0.2)), Light(tilt=150, rotation=200, color=(0.1, 0.3, 1))
    both = render(make_scene(volume, transfer, a, b), (16, 16))
    np.testing.assert_allclose(both, render(make_scene(volume, transfer, b, a), (16, 16)), atol=1e-12)
    single = [render(make_scene(volume, transfer, light), (16, 16))[..., :3] for light in (a, b)]
    np.testing.assert_allclose(both[..., :3], single[0] + single[1], atol=1e-12)


def test_half_and_double_step_change_little(make_scene: Make) -> None:
    light = Light(tilt=37)
    fine, usual, coarse = (
        render(shadow_scene(make_scene, light, step=s), (40, 40)) for s in (0.25, 0.5, 1.0)
    )
    wide = render(shadow_scene(make_scene, replace(light, aperture=21.0), False, step=0.25), (40, 40))
    unshaded = (wide[..., 0] - fine[..., 0] < 0.02) & (fine[..., 3] > 0.5)
    for other in (fine, coarse):
        assert abs(other[unshaded].mean() - usual[unshaded].mean()) < 2 / 255
        assert other[2:6, 2:6, 0].mean() == pytest.approx(usual[2:6, 2:6, 0].mean(), rel=0.03)


def test_frames_differ_by_their_jitter_only(lumpy: tuple, make_scene: Make) -> None:
    volume, transfer = lumpy
    scene = make_scene(volume, transfer)
    first, second = render(scene, (16, 16), 0), render(scene, (16, 16), 1)
    assert 0 < np.abs(first - second).mean() < 0.06


def test_what_the_twin_does_not_know_is_refused(lumpy: tuple, make_scene: Make) -> None:
    volume, transfer = lumpy
    with pytest.raises(SceneError, match="technique"):
        render(make_scene(volume, transfer, technique="half-angle"), (4, 4))
    with pytest.raises(SceneError, match="specular"):
        render(make_scene(volume, transfer, technique=lit(specular=0.5)), (4, 4))
