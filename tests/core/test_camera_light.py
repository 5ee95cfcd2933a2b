"""Cameras as VTK has them, and where lights shine from."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfumato import Camera, Light, SceneError
from sfumato.scene import STANDARD_VIEWS, nearest_possible_tilt, tilt_is_possible

BOX = np.array([[0, 0, 0], [40, 60, 80]], float)
TARGET = (0.0, 0.0, 0.0)
angle = st.floats(0, 360)


def project(camera: Camera, points: np.ndarray, aspect: float = 1.0) -> np.ndarray:
    """Return normalised device coordinates."""
    basis = camera.basis()
    at = (points - np.asarray(camera.position)) @ np.array([basis.right, basis.up, basis.forward]).T
    scale = 1.0 if camera.parallel_projection else at[:, 2:]
    return np.asarray(at[:, :2] / scale / camera.half_extent(aspect) - camera.window_center)


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("view", list(STANDARD_VIEWS))
@pytest.mark.parametrize("aspect", [0.5, 1.0, 2.0])
def test_fit_fills_the_picture_and_no_more(view: str, parallel: bool, aspect: float) -> None:
    corners = np.array([[BOX[i, 0], BOX[j, 1], BOX[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    camera = Camera.fit(BOX, view, aspect=aspect, fill=0.8, parallel_projection=parallel)
    assert np.abs(project(camera, corners, aspect)).max() == pytest.approx(0.8, abs=1e-6)
    assert camera.focal_point == pytest.approx((20, 30, 40))


def test_front_is_anterior_and_left_is_the_patients() -> None:
    front, left, top = (Camera.fit(BOX, v).basis() for v in ("front", "left", "top"))
    assert front.back == (0, -1, 0)
    assert front.up == (0, 0, 1)
    assert front.right == pytest.approx((1, 0, 0)), "the patient's left is on the right of the picture"
    assert left.back == (1, 0, 0)
    assert top.back == (0, 0, 1)
    assert top.up == pytest.approx((0, -1, 0))


@given(st.tuples(*[st.floats(-100, 100)] * 3), st.tuples(*[st.floats(-1, 1)] * 3))
@settings(max_examples=50, deadline=None)
def test_basis_is_orthonormal_and_right_handed(position: tuple[float, ...], up: tuple[float, ...]) -> None:
    try:
        basis = Camera(position, (1, 2, 3), up).basis()  # type: ignore[arg-type]
    except SceneError:
        return
    m = np.array([basis.right, basis.up, basis.back])
    np.testing.assert_allclose(m @ m.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(m) == pytest.approx(1)


@pytest.mark.parametrize("parallel", [False, True])
def test_a_crop_shows_what_the_part_of_the_picture_shows(parallel: bool) -> None:
    camera = Camera((0, -100, 0), parallel_projection=parallel, parallel_scale=30, window_center=(0.1, 0.2))
    points = np.random.default_rng(1).uniform(-20, 20, (20, 3))
    whole = project(camera, points, 2.0)
    left, bottom, right, top = 0.25, 0.5, 0.75, 0.75
    part = project(camera.cropped(left, bottom, right, top), points, 2.0 * (right - left) / (top - bottom))
    in_whole = (part + 1) / 2 * (right - left, top - bottom) + (left, bottom)
    np.testing.assert_allclose(in_whole, (whole + 1) / 2, atol=1e-9)


@pytest.mark.parametrize(
    "bad",
    [
        {"focal_point": (0, -1000, 0)},
        {"view_up": (0, 1, 0)},
        {"view_up": (0, 0, 0)},
        {"view_angle": 0},
        {"parallel_scale": 0},
    ],
)
def test_impossible_cameras(bad: dict[str, object]) -> None:
    with pytest.raises(SceneError) as caught:
        Camera(**bad)  # type: ignore[arg-type]
    assert caught.value.path in bad or caught.value.path == "focal_point"


def test_unknown_view() -> None:
    with pytest.raises(SceneError, match="front"):
        Camera.fit(BOX, "above")


@pytest.mark.parametrize(
    ("tilt", "rotation", "expected"),
    [
        (0, 0, (0, -1, 0)),
        (60, 0, (math.sqrt(3) / 2, -0.5, 0)),
        (60, 90, (0, -0.5, math.sqrt(3) / 2)),
        (180, 0, (0, 1, 0)),
    ],
)
def test_where_light_comes_from_in_the_front_view(
    tilt: float, rotation: float, expected: tuple[float, ...]
) -> None:
    light = Light(tilt=tilt, rotation=rotation, aperture=10)
    basis = Camera((0, -10, 0)).basis()
    np.testing.assert_allclose(light.towards(basis, TARGET), expected, atol=1e-12)
    np.testing.assert_allclose(
        Light(tilt=tilt, rotation=rotation, aperture=10, attached="patient").towards(basis, TARGET),
        expected,
        atol=1e-12,
    )


def test_a_patients_light_stays_when_the_camera_turns() -> None:
    light = Light(tilt=40, rotation=90, attached="patient")
    side = Camera((10, 0, 0)).basis()
    np.testing.assert_allclose(
        light.towards(side, TARGET), light.towards(Camera((0, -10, 0)).basis(), TARGET)
    )
    assert light.angles(Camera((0, -10, 0)).basis(), TARGET) == pytest.approx((40, 90))
    tilt, rotation = light.angles(side, TARGET)
    assert tilt_is_possible(tilt, light.aperture)
    towards = light.towards(side, TARGET)
    across = np.array([towards @ side.right, towards @ side.up])
    assert rotation == pytest.approx(math.degrees(math.atan2(across[1], across[0])) % 360)


@given(st.floats(0, 180), st.floats(0.5, 85))
@settings(max_examples=80, deadline=None)
def test_the_nearest_possible_tilt_is_possible_and_near(tilt: float, aperture: float) -> None:
    near = nearest_possible_tilt(tilt, aperture)
    assert tilt_is_possible(near, aperture)
    if tilt_is_possible(tilt, aperture + 1):
        assert near == tilt
    assert abs(near - tilt) <= aperture + 1 + 1e-9 or aperture > 88


@given(st.floats(0, 180), st.floats(0.5, 89))
@settings(max_examples=60, deadline=None)
def test_a_cone_that_touches_the_slices_is_refused(tilt: float, aperture: float) -> None:
    if tilt_is_possible(tilt, aperture):
        assert Light(tilt=tilt, aperture=aperture).tilt == tilt
    else:
        with pytest.raises(SceneError, match="before the subject") as caught:
            Light(tilt=tilt, aperture=aperture)
        assert caught.value.path == "tilt"


def test_a_lamp_with_a_place_shines_from_there() -> None:
    basis = Camera((0, -10, 0)).basis()
    lamp = Light(kind="point", position=(3, 0, 4))
    np.testing.assert_allclose(lamp.towards(basis, TARGET), (0.6, 0, 0.8))
    (
        np.testing.assert_allclose(Light(kind="point").towards(basis, TARGET), basis.back),
        "in the middle: from the viewer",
    )
    with pytest.raises(SceneError, match="direction"):
        Light(kind="spot", direction=(0, 0, 0))
