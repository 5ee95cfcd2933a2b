"""GPU pictures against the float64 twin, which was written from the scheme alone (at least 45 dB)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import sfumato
from sfumato import Camera, ClipPlane, CropBox, Light, Scene, TransferFunction, Volume
from sfumato.reference import multidirectional as twin
from sfumato.techniques.multidirectional.params import DirectionalParams, MultidirectionalParams

pytestmark = pytest.mark.gpu

SIZE = (56, 48)
#: Peak signal-to-noise ratio, peak 1, over the pixels that show something.
LEAST_DB = 45.0
FORMS = ("extinction", "additive", "multiplicative")
FOUR = (
    Light(tilt=37, aperture=20, rotation=135),
    Light(tilt=20, aperture=30, rotation=20, color=(1, 0.4, 0.1), intensity=0.4),
    Light(tilt=150, aperture=20, rotation=250, color=(0.2, 0.5, 1)),
    Light(tilt=60, aperture=5, rotation=300, color=(0.1, 1, 0.3), intensity=0.5),
)


def shapes(seed: int = 3) -> Volume:
    """A ball, a bar and a wall with soft edges, none symmetric: 36 x 32 x 28 voxels."""
    z, y, x = np.indices((28, 32, 36)).astype(float)
    ball = 7 - np.sqrt((x - 15) ** 2 + (y - 9) ** 2 + (z - 16) ** 2)
    bar = 2.5 - np.sqrt((x - 24 - 0.2 * z) ** 2 + (y - 14) ** 2)
    wall = y - 25 + 0.1 * x
    soft = np.clip(np.maximum(np.maximum(ball, bar), wall) / 4 + 0.5, 0, 1)
    noise = np.random.default_rng(seed).uniform(0, 0.1, soft.shape)
    return Volume((soft * 900 + noise * 300).astype(np.int16), spacing=(1.0, 1.1, 0.9))


@pytest.fixture(scope="module")
def volume() -> Volume:
    return shapes()


TRANSFER = TransferFunction.from_points(
    [(200, (0.9, 0.4, 0.2), 0.0), (450, (1.0, 0.8, 0.6), 0.25), (900, (0.6, 0.8, 1.0), 0.7)],
    unit_distance=1.0,
)


def scene_of(volume: Volume, parallel: bool, *lights: Light, **more: Any) -> Scene:
    camera = Camera.fit(volume.corners(), "front", parallel_projection=parallel, fill=1.1, view_angle=40)
    back = np.subtract(camera.position, camera.focal_point) + np.array([0.5, 0.0, 0.3]) * camera.distance
    place = tuple(camera.focal_point + back / np.linalg.norm(back) * camera.distance)
    camera = Camera(place, camera.focal_point, (0, 0, 1), 40.0, parallel, camera.parallel_scale)
    values = {"technique": "multidirectional", "transfer": TRANSFER, "camera": camera, **more}
    return Scene(volume=volume, lights=lights or (Light(),), **values)


def decibels(picture: np.ndarray, expected: np.ndarray) -> float:
    """Return the PSNR over covered pixels."""
    covered = expected[..., 3] > 0
    assert covered.mean() > 0.2
    return -10 * math.log10(float(np.mean((picture[covered] - expected[covered]) ** 2)))


def agree(scene: Scene) -> None:
    picture = sfumato.render(scene, SIZE, linear=True)
    assert decibels(picture.astype(np.float64), twin.render(scene, SIZE)) >= LEAST_DB


@pytest.mark.parametrize("parallel", [True, False])
def test_unlit_slices(volume: Volume, parallel: bool) -> None:
    agree(scene_of(volume, parallel, technique="slices"))


@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize(
    ("tilt", "aperture", "rotation"),
    [
        (0, 20, 0), (37, 20, 135), (150, 20, 200),
        *(pytest.param(*angles, marks=pytest.mark.slow) for angles in ((20, 5, 45), (55, 20, 300), (37, 30, 20))),
    ],
)  # fmt: skip
def test_angles_and_cameras(
    volume: Volume, tilt: float, aperture: float, rotation: float, parallel: bool
) -> None:
    agree(scene_of(volume, parallel, Light(tilt=tilt, aperture=aperture, rotation=rotation)))


@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(
    "lights", [FOUR[:1], pytest.param(FOUR, marks=pytest.mark.slow)], ids=["one", "four"]
)
def test_forms_and_numbers_of_lights(
    volume: Volume, form: str, lights: tuple[Light, ...], parallel: bool
) -> None:
    agree(scene_of(volume, parallel, *lights, technique=MultidirectionalParams(occlusion=form)))


@pytest.mark.parametrize("form", FORMS)
def test_headlamp(volume: Volume, form: str) -> None:
    agree(scene_of(volume, False, technique=DirectionalParams(occlusion=form)))


@pytest.mark.parametrize("form", FORMS)
def test_clipped_and_cropped(volume: Volume, form: str) -> None:
    cut = (ClipPlane((18, 6, 14), (0.3, 1, -0.2)), ClipPlane((30, 0, 0), (-1, 0, 0.1)))
    crop = CropBox((0.05, 0.1, 0.2), (0.9, 0.95, 1.0))
    technique = MultidirectionalParams(occlusion=form, ambient=0.1)
    agree(scene_of(volume, False, *FOUR[:3:2], clip=cut, crop=crop, technique=technique))


@pytest.mark.parametrize(
    "changes",
    [
        {"technique.falloff": "gaussian"},
        {"technique.resolution": 2.0},
        {"technique.resolution": 0.5},
        {"step": 1.0},
    ],
    ids=str,
)
def test_settings(volume: Volume, changes: dict[str, Any]) -> None:
    agree(scene_of(volume, False, Light()).with_(changes))


def test_emission(volume: Volume) -> None:
    glowing = TransferFunction.from_points(
        [(200, (1, 1, 1), 0.0), (900, (1, 0.5, 0.5), 0.6, (0.1, 0.3, 0.6))], 1.0
    )
    agree(scene_of(volume, True).with_(transfer=glowing))
