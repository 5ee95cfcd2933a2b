"""The float64 local occlusion against what is known without it (Hernell2007, Eq. 1-4)."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import Scene, TransferFunction, Volume
from sfumato.reference.local_occlusion import intensity

AXES = np.concatenate([np.eye(3), -np.eye(3)])
MIDDLE = np.array([[4.0, 4.0, 4.0]])


def cube(tau: float, emission: tuple[float, float, float] = (0, 0, 0), n: int = 8) -> Scene:
    """Return a homogeneous cube of 8 mm with an extinction per mm."""
    volume = Volume(np.ones((n, n, n), dtype=np.float32), spacing=(8 / n,) * 3)
    opacity = 1 - float(np.exp(-tau))
    transfer = TransferFunction.from_points([(1, (1, 1, 1), opacity, emission)], unit_distance=1.0)
    return Scene(volume=volume, transfer=transfer)


def test_empty_space_gives_one_and_the_bias() -> None:
    far = np.array([[100.0, 0.0, 0.0]])
    light = intensity(cube(6.9), far, AXES, radius=3, offset=0.5, samples=9, bias=0.25)
    np.testing.assert_allclose(light, 1.25)


@pytest.mark.parametrize("samples", [4, 16])
def test_inside_what_is_opaque_only_the_first_sample_counts(samples: int) -> None:
    light = intensity(cube(1000.0), MIDDLE, AXES, radius=3, offset=0, samples=samples, gamma=50.0)
    np.testing.assert_allclose(light, 1 / samples, rtol=1e-9)


def test_many_samples_converge_to_the_integral() -> None:
    tau, length = 0.4, 2.5
    light = intensity(cube(tau), MIDDLE, AXES, radius=3, offset=0.5, samples=4000)
    exact = (1 - np.exp(-tau * length)) / (tau * length)  # Eq. 1, a homogeneous medium
    np.testing.assert_allclose(light, exact, rtol=1e-3)


def test_gamma_is_an_exponent_on_what_is_let_through() -> None:
    twice = intensity(cube(0.2), MIDDLE, AXES, radius=3, offset=0.5, samples=8, gamma=2)
    np.testing.assert_allclose(twice, intensity(cube(0.4), MIDDLE, AXES, radius=3, offset=0.5, samples=8))


def test_emission_adds_to_each_sample_s_light() -> None:
    dark = intensity(cube(0.3), MIDDLE, AXES, radius=3, offset=0, samples=10)
    bright = intensity(cube(0.3, (2, 1, 0)), MIDDLE, AXES, radius=3, offset=0, samples=10)
    opacity = 1 - np.exp(-0.3)
    np.testing.assert_allclose(bright, dark * (1 + opacity * np.array([2, 1, 0])))


def test_weights_count() -> None:
    weights = np.array([1.0, 0, 0, 0, 0, 0])
    light = intensity(cube(0.3), MIDDLE, AXES, radius=1, offset=0, samples=4, weights=weights)
    alone = intensity(cube(0.3), MIDDLE, AXES[:1], radius=1, offset=0, samples=4)
    np.testing.assert_allclose(light, alone / 6)
