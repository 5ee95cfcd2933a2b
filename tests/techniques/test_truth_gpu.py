"""What GPU pictures of the occlusion methods must be, known without another renderer."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import sfumato
from sfumato import Camera, ClipPlane, CropBox, Light, Scene, TransferFunction, Volume
from sfumato.reference import footprint
from sfumato.techniques import params_of
from sfumato.techniques.footprint import cone_directions
from sfumato.techniques.multidirectional.params import DirectionalParams, MultidirectionalParams

pytestmark = pytest.mark.gpu

FORMS = ("extinction", "additive", "multiplicative")
ALL = (*FORMS, "cone")
OURS = ("extinction", "cone")
WHITE_SOLID = TransferFunction.from_points([(0.0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.999)], 1.0)


def technique_of(name: str) -> Any:
    """Return parameters: a form of the published sweep, or another technique."""
    return MultidirectionalParams(occlusion=name) if name in FORMS else params_of(name)


def front(volume: Volume, parallel: bool = True, fill: float = 1.0) -> Camera:
    return Camera.fit(volume.corners(), "front", parallel_projection=parallel, fill=fill)


def picture(scene: Scene, width: int, height: int | None = None) -> np.ndarray:
    return sfumato.render(scene, (width, height or width), linear=True).astype(np.float64)


def lumps(seed: int = 7) -> Volume:
    """A soft asymmetric thing of 32 x 28 x 30 voxels, values 0 to about 2."""
    rng = np.random.default_rng(seed)
    z, y, x = np.indices((30, 28, 32)) - np.array([14.5, 13.5, 15.5])[:, None, None, None]
    data = np.zeros(x.shape)
    for _ in range(7):
        a, b, c = rng.uniform(-9, 9, 3)
        data += np.exp(-((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2) / rng.uniform(10, 40))
    return Volume(data.astype(np.float32))


LUMPY = TransferFunction.from_points(
    [(0.2, (0.9, 0.3, 0.1), 0.0), (0.6, (1, 0.9, 0.7), 0.5), (1.2, (0.2, 0.4, 1), 0.8)], 1.0
)


def ball_and_wall(light: Light, ball: bool = True, **more: Any) -> Scene:
    """A ball of radius 2 mm, 14 mm before a wall's face; 40 x 40 mm."""
    z, y, x = np.indices((40, 24, 40))
    data = np.clip(0.5 + y - 19, 0, 1)
    if ball:
        away = np.sqrt((x - 19.5) ** 2 + (y - 5) ** 2 + (z - 19.5) ** 2)
        data = np.maximum(data, np.clip(2.5 - away, 0, 1))
    volume = Volume(data.astype(np.float32))
    return Scene(volume=volume, transfer=WHITE_SOLID, camera=front(volume), lights=(light,), **more)


@pytest.mark.parametrize("technique", [*ALL, "slices", "raycast"])
@pytest.mark.parametrize("step", [0.5, 1.0, 2.7])
def test_slab_has_the_opacity_of_its_thickness(technique: str, step: float) -> None:
    volume = Volume(np.ones((8, 8, 8), dtype=np.float32))
    transfer = TransferFunction.from_points([(1, (0.8, 0.6, 0.4), 1 - math.exp(-0.2))], unit_distance=1.0)
    shown = picture(
        Scene(
            volume=volume,
            transfer=transfer,
            camera=front(volume),
            technique=technique_of(technique),
            step=step,
        ),
        16,
    )
    np.testing.assert_allclose(shown[..., 3], 1 - math.exp(-0.2 * 8), atol=2e-4)


@pytest.mark.parametrize("step", [0.25, 0.5, 1.0])
@pytest.mark.parametrize("tilt", [0.0, 37.0, 50.0])
@pytest.mark.parametrize("form", OURS)
def test_opaque_facing_wall_is_its_own_colour(form: str, tilt: float, step: float) -> None:
    light = Light(tilt=tilt, intensity=0.7)
    shown = picture(ball_and_wall(light, ball=False, step=step, technique=technique_of(form)), 20)
    # The cone's way to the light crosses a skin in fewer steps than there are slabs.
    near = 0.03 if form == "cone" else 0.015
    np.testing.assert_allclose(shown[8:12, 8:12], np.broadcast_to([0.7, 0.7, 0.7, 1], (4, 4, 4)), rtol=near)


@pytest.mark.parametrize("form", ALL)
@pytest.mark.parametrize("parallel", [True, False])
def test_mirrored_scene_gives_the_mirrored_picture(form: str, parallel: bool) -> None:
    volume, light, params = lumps(), Light(rotation=135), technique_of(form)
    scene = Scene(
        volume=volume, transfer=LUMPY, camera=front(volume, parallel), lights=(light,), technique=params
    )
    mirrored = replace(
        scene, volume=Volume(volume.data[:, :, ::-1].copy()), lights=(replace(light, rotation=45),)
    )
    one, other = picture(scene, 32)[:, ::-1], picture(mirrored, 32)
    # The spiral on which the cone's sixteen directions lie has no mirror symmetry: single pixels differ.
    np.testing.assert_allclose(one, other, atol=0.06 if form == "cone" else 4e-3)
    assert np.sqrt(np.mean((one - other) ** 2)) < 0.006


@pytest.mark.parametrize("form", FORMS)
def test_tilt_zero_is_directional(form: str) -> None:
    volume = lumps()
    scene = Scene(volume=volume, transfer=LUMPY, camera=front(volume, False), lights=(Light(tilt=0),))
    flat = picture(replace(scene, technique=MultidirectionalParams(occlusion=form)), 32)
    head = replace(scene, technique=DirectionalParams(occlusion=form), lights=(Light(tilt=50),))
    np.testing.assert_allclose(flat, picture(head, 32), atol=2e-3)


def centroid(form: str, tilt: float, aperture: float) -> float:
    """Return how far, over the distance, the middle of a shadow lies from its caster."""
    if form != "cone":
        return float(footprint.moments(tilt, aperture)[0])
    along, _, towards = cone_directions(tilt, aperture, 4096).T
    return float(np.mean(along / towards))


@pytest.mark.parametrize("rotation", range(0, 360, 45))
@pytest.mark.parametrize("form", OURS)
def test_balls_shadow_lies_at_distance_times_the_kernels_centroid(form: str, rotation: int) -> None:
    technique = technique_of(form)
    light = Light(tilt=37, aperture=20, rotation=rotation)
    ticks = np.arange(40) - 19.5
    bare, shaded = (picture(ball_and_wall(light, ball, technique=technique), 40) for ball in (False, True))
    dark = np.maximum((bare - shaded)[..., 0], 0)
    dark[np.hypot(ticks[:, None], ticks[None, :]) < 4] = 0
    found = np.array([(dark * ticks[None, :]).sum(), -(dark * ticks[:, None]).sum()]) / dark.sum()
    phi = math.radians(rotation)
    away = -14 * centroid(form, 37, 20)
    expected = away * np.array([math.cos(phi), math.sin(phi)])
    assert np.abs(found - expected).max() < 1


@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize("tilt", [37.0, 150.0])
@pytest.mark.parametrize("form", OURS)
def test_crop_of_a_picture_is_the_picture_of_the_crop(form: str, parallel: bool, tilt: float) -> None:
    volume, light = lumps(), Light(tilt=tilt)
    scene = Scene(volume=volume, transfer=LUMPY, camera=front(volume, parallel), lights=(light,))
    scene = replace(scene, technique=technique_of(form))
    whole = picture(scene, 64)
    assert scene.camera is not None
    part = picture(replace(scene, camera=scene.camera.cropped(0.25, 0.5, 0.75, 1.0)), 32)
    assert np.abs(part - whole[:32, 16:48]).mean() < 1 / 255


@pytest.mark.parametrize("cut", ["plane", "box"])
@pytest.mark.parametrize("form", OURS)
def test_what_is_cut_away_casts_no_shadow(form: str, cut: str) -> None:
    away: dict[str, Any] = {"clip": (ClipPlane((0, 10, 0), (0, 1, 0)),)}
    if cut == "box":
        away = {"crop": CropBox((0, 10 / 24, 0), (1, 1, 1))}
    light, away["technique"] = Light(tilt=37), technique_of(form)
    with_ball, without = (picture(ball_and_wall(light, ball, **away), 40) for ball in (True, False))
    np.testing.assert_allclose(with_ball, without, atol=1e-3)


@pytest.mark.parametrize("form", OURS)
def test_half_and_double_step_change_little(form: str) -> None:
    light, ours = Light(tilt=37), technique_of(form)
    fine, usual, coarse = (
        picture(ball_and_wall(light, step=s, technique=ours), 40) for s in (0.25, 0.5, 1.0)
    )
    bare = picture(ball_and_wall(light, False, step=0.25, technique=ours), 40)
    outside = (bare[..., 0] - fine[..., 0] < 0.02) & (fine[..., 3] > 0.5)
    assert 0.5 < outside.mean() < 0.99
    for other in (fine, coarse):
        assert np.abs(other[outside] - usual[outside]).mean() < 2 / 255
        assert other[2:6, 2:6, 0].mean() == pytest.approx(usual[2:6, 2:6, 0].mean(), rel=0.03)


@pytest.mark.parametrize("technique", ["cone", "multidirectional", "slices", "raycast"])
def test_alpha_counts_once_over_a_chequered_background(technique: str) -> None:
    volume = Volume(np.ones((8, 8, 8), dtype=np.float32))
    transfer = TransferFunction.from_points([(1, (0.5, 0.5, 0.5), 1 - math.exp(-0.1))], unit_distance=1.0)
    clear = Scene(volume=volume, transfer=transfer, camera=front(volume), technique=technique)
    bare = picture(clear, 16)
    for shade in (0.0, 1.0):
        over = picture(replace(clear, background=(shade, shade, shade, 1.0)), 16)
        np.testing.assert_allclose(over[..., :3], bare[..., :3] + (1 - bare[..., 3:]) * shade, atol=2e-3)
        np.testing.assert_allclose(over[..., 3], 1, atol=1e-3)


@pytest.mark.parametrize("form", OURS)
def test_lights_add_up_in_any_order(form: str) -> None:
    volume = lumps()
    a, b, c = (
        Light(rotation=20, color=(1, 0.5, 0.2)),
        Light(tilt=150, rotation=200, color=(0.1, 0.3, 1)),
        Light(tilt=10, aperture=40, intensity=0.3),
    )
    scene = Scene(volume=volume, transfer=LUMPY, camera=front(volume, False), lights=(a, b, c))
    scene = replace(scene, technique=technique_of(form))
    together = picture(scene, 32)
    np.testing.assert_allclose(together, picture(replace(scene, lights=(c, a, b)), 32), atol=2e-3)
    alone = sum(picture(replace(scene, lights=(light,)), 32)[..., :3] for light in (a, b, c))
    np.testing.assert_allclose(together[..., :3], alone, atol=6e-3)


@pytest.mark.parametrize("form", ALL)
@pytest.mark.parametrize("tilt", [37.0, 150.0])
def test_closed_box_has_no_light_inside(form: str, tilt: float) -> None:
    data = np.ones((20, 20, 20), dtype=np.float32)
    data[5:15, 5:15, 5:15] = 0
    transfer = TransferFunction.from_points([(0.4, (1, 1, 1), 0.0), (0.6, (1, 1, 1), 0.999)], 0.25)
    inside = Camera(position=(10, 8, 10), focal_point=(10, 12, 10), view_angle=90)
    params = technique_of(form)
    scene = Scene(
        volume=Volume(data), transfer=transfer, camera=inside, lights=(Light(tilt=tilt),), technique=params
    )
    shown = picture(scene, 24)
    assert shown[..., 3].min() > 0.99
    # Additive occlusion never darkens to nothing (13): 1 / (1 + O) after the slabs of a 5 mm wall.
    assert shown[..., :3].max() < (0.12 if form == "additive" else 2e-3)


@pytest.mark.parametrize("form", OURS)
def test_light_from_behind_does_not_reach_an_opaque_wall(form: str) -> None:
    shown = picture(ball_and_wall(Light(tilt=150), ball=False, technique=technique_of(form)), 20)
    assert shown[6:14, 6:14, :3].max() < 2e-3
