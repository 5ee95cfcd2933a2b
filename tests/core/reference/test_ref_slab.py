"""What a slab returns, against integrating it in thin layers along every direction of the cone."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato.reference import footprint as fp
from sfumato.reference import slab


def brute_force(tau_d: float, v: float, tilt: float, aperture: float, rear: bool) -> float:
    """Sum over layers: emitted tau v ds, seen through what is before it, lit through what is beside it."""
    directions, weights = fp.cone_quadrature(tilt, aperture, 16, 32)
    s = 1 / directions[:, 2]
    layers = 20000
    depth = (np.arange(layers) + 0.5) / layers * tau_d
    total = 0.0
    for secant, weight in zip(s, weights, strict=True):
        way = tau_d - depth if rear else depth
        total += weight * np.sum(np.exp(-depth * v - way * secant)) * v * tau_d / layers
    return total / float(weights @ (1 / (1 + s)))


@pytest.mark.parametrize("rear", [False, True])
@pytest.mark.parametrize(("tilt", "aperture"), [(0, 20), (37, 20), (50, 25), (75, 9)])
@pytest.mark.parametrize(("tau_d", "v"), [(0.03, 1.0), (0.7, 1.2), (4.0, 1.0)])
def test_term_against_brute_force(tau_d: float, v: float, tilt: float, aperture: float, rear: bool) -> None:
    rule = slab.secant_rule(tilt, aperture)
    expected = brute_force(tau_d, v, tilt, aperture, rear)
    assert rule.term(np.array(tau_d), np.array(v), rear) == pytest.approx(expected, rel=1e-5)


def test_rear_term_where_both_secants_agree() -> None:
    x = np.array([0.01, 1.0, 30.0])
    limit = 1.3 * x * np.exp(-x * 1.3)
    np.testing.assert_allclose(slab.rear_term(x, np.array(1.3), np.array(1.3)), limit)
    np.testing.assert_allclose(slab.rear_term(x, np.array(1.3), np.array(1.3 + 1e-7)), limit, rtol=1e-4)
    assert np.isfinite(slab.rear_term(np.array(1e6), np.array(1.0), np.array(1.5)))


@pytest.mark.parametrize("tilt", [0, 37, 60, 80])
def test_opaque_facing_wall_has_its_own_colour(tilt: float) -> None:
    assert slab.secant_rule(tilt, 9).term(np.array(100.0), np.array(1.0), False) == pytest.approx(1)


def test_one_mean_secant_is_as_far_off_as_the_design_says() -> None:
    for tilt, aperture, off in ((50, 25, 0.036), (80, 9, 0.23)):
        directions, weights = fp.cone_quadrature(tilt, aperture)
        mean = float(weights @ (1 / directions[:, 2]))
        assert 1 - 1 / (1 + mean) / slab.secant_rule(tilt, aperture).facing == pytest.approx(off, abs=0.006)
