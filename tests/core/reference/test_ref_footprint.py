"""The elliptical footprint against directions on the cone and against the paper's figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sfumato.reference import footprint as fp

ANGLES = [(0, 20), (5, 40), (37, 10), (37, 20), (37, 40), (55, 30), (80, 9)]


def rim(tilt: float, aperture: float, rotation: float = 0.0, count: int = 7200) -> np.ndarray:
    """Where the cone's outermost directions meet the plane at distance 1."""
    t, a = math.radians(tilt), math.radians(aperture)
    axis = np.array([math.sin(t), 0, math.cos(t)])
    side, other = np.array([0, 1.0, 0]), np.array([math.cos(t), 0, -math.sin(t)])
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)[:, None]
    w = math.cos(a) * axis + math.sin(a) * (np.cos(turn) * side + np.sin(turn) * other)
    points = w[:, :2] / w[:, 2:]
    phi = math.radians(rotation)
    return points @ np.array([[math.cos(phi), math.sin(phi)], [-math.sin(phi), math.cos(phi)]])


@pytest.mark.parametrize(("tilt", "aperture"), ANGLES)
def test_axes_and_centre_are_those_of_the_cone(tilt: float, aperture: float) -> None:
    shape, points = fp.ellipse(tilt, aperture), rim(tilt, aperture)
    far, near, across = points[:, 0].max(), points[:, 0].min(), points[:, 1].max()
    assert (far - near) / 2 == pytest.approx(shape.A, rel=1e-4)
    assert (far + near) / 2 == pytest.approx(shape.C, rel=1e-4, abs=1e-6)
    assert across == pytest.approx(shape.B, rel=1e-4)
    assert math.tan(math.radians(tilt)) == pytest.approx(shape.O)


@pytest.mark.parametrize(("tilt", "aperture"), ANGLES)
def test_k_is_one_on_the_rim_and_zero_on_the_axis(tilt: float, aperture: float) -> None:
    shape, points = fp.ellipse(tilt, aperture), rim(tilt, aperture, count=60)
    np.testing.assert_allclose(fp.larger_root(points[:, 0], points[:, 1], shape), 1, atol=1e-9)
    assert fp.larger_root(np.array(shape.O), np.array(0.0), shape) == pytest.approx(0, abs=1e-7)


def test_numbers_of_the_design() -> None:
    mean, _, _ = fp.moments(37, 20)
    assert mean == pytest.approx(0.881, abs=6e-4)
    axis = fp.ellipse(37, 20).O
    assert axis == pytest.approx(0.754, abs=6e-4)
    directions, weights = fp.cone_quadrature(37, 20)
    assert weights @ (directions[:, 0] / directions[:, 2]) == pytest.approx(0.793, abs=6e-4)


@pytest.mark.parametrize("falloff", ["linear", "gaussian"])
@pytest.mark.parametrize(("tilt", "aperture"), [(0, 20), (37, 20), (55, 30)])
def test_moments_are_those_of_the_kernel_on_a_grid(tilt: float, aperture: float, falloff: str) -> None:
    size = 400
    weights, half = fp.weights_on_grid(tilt, aperture, 0, falloff, size)
    assert weights.sum() == pytest.approx(1)
    ticks = ((np.arange(size) + 0.5) / size * 2 - 1) * half
    mean = weights.sum(axis=0) @ ticks
    expected = fp.moments(tilt, aperture, falloff)
    assert mean + fp.ellipse(tilt, aperture).C == pytest.approx(expected[0], abs=1e-3)
    assert weights.sum(axis=0) @ (ticks - mean) ** 2 == pytest.approx(expected[1], rel=3e-3)
    assert weights.sum(axis=1) @ ticks**2 == pytest.approx(expected[2], rel=3e-3)


@pytest.mark.parametrize("rotation", [0, 45, 135, 250])
def test_kernel_points_towards_the_light(rotation: float) -> None:
    weights, half = fp.weights_on_grid(37, 20, rotation, size=200)
    ticks = ((np.arange(200) + 0.5) / 200 * 2 - 1) * half
    row, column = np.unravel_index(weights.argmax(), weights.shape)
    # The heaviest weight is at O, which lies from C away from the light.
    offset = np.array([ticks[column], -ticks[row]])
    phi = math.radians(rotation)
    np.testing.assert_allclose(
        offset, -fp.ellipse(37, 20).OC * np.array([math.cos(phi), math.sin(phi)]), atol=0.02
    )


@pytest.mark.parametrize("falloff", ["linear", "gaussian"])
def test_characteristic_function_has_the_kernels_moments(falloff: str) -> None:
    scale, eps = 1.7, 1e-3
    k = np.array([0.0, eps])
    along = fp.characteristic_function(k, np.zeros(2), 37, 20, 0, falloff, scale)
    across = fp.characteristic_function(k, np.zeros(2), 37, 20, 90, falloff, scale)
    _, parallel, perpendicular = fp.moments(37, 20, falloff)
    assert along[0] == pytest.approx(1)
    assert along[1].imag == pytest.approx(0, abs=1e-8)  # centred
    assert (1 - along[1].real) * 2 / eps**2 == pytest.approx(parallel * scale**2, rel=1e-4)
    assert (1 - across[1].real) * 2 / eps**2 == pytest.approx(perpendicular * scale**2, rel=1e-4)


@pytest.mark.parametrize(("tilt", "rotation"), [(0, 0), (37, 135), (150, 300)])
def test_cone_directions_are_uniform_in_solid_angle(tilt: float, rotation: float) -> None:
    directions = fp.cone_directions(tilt, 20, rotation, 2000)
    t, phi = math.radians(tilt), math.radians(rotation)
    axis = np.array([math.sin(t) * math.cos(phi), math.sin(t) * math.sin(phi), math.cos(t)])
    cosines = directions @ axis
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    assert cosines.min() > math.cos(math.radians(20))
    assert cosines.mean() == pytest.approx((1 + math.cos(math.radians(20))) / 2, abs=1e-5)
    np.testing.assert_allclose(directions.mean(axis=0), axis * cosines.mean(), atol=2e-3)
