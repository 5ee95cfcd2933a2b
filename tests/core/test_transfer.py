"""Transfer functions: opacity, extinction, regions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfumato import Region, SceneError, TransferFunction, TransferPoint
from sfumato.scene import MAX_OPACITY

RAMP = TransferFunction.from_points([(0, (0, 0, 0), 0.0), (100, (1, 0.5, 0), 0.8, (0, 0, 2))])


def test_piecewise_linear_and_clamped() -> None:
    at = RAMP.evaluate(np.array([-50, 0, 25, 100, 900]))
    np.testing.assert_allclose(at[:, 3], [0, 0, 0.2, 0.8, 0.8])
    np.testing.assert_allclose(at[2], [0.25, 0.125, 0, 0.2, 0, 0, 0.5])


def test_points_are_sorted_and_may_make_steps() -> None:
    made = TransferFunction.from_points([(10, (1, 1, 1), 1), (0, (0, 0, 0), 0), (10, (1, 1, 1), 0.5)])
    assert [p.value for p in made.points] == [0, 10, 10]
    assert made.evaluate(np.array([10.1]))[0, 3] in (0.5, 1.0)


@given(st.floats(0, 1), st.floats(0.05, 20), st.integers(1, 50))
@settings(max_examples=60, deadline=None)
def test_opacity_of_a_unit_distance_does_not_depend_on_the_steps(
    alpha: float, unit: float, steps: int
) -> None:
    tau = float(RAMP.extinction(np.array(alpha), unit))
    together = 1 - np.exp(-tau * unit / steps) ** steps
    assert together == pytest.approx(min(alpha, MAX_OPACITY), abs=1e-9)


def test_the_own_unit_distance_comes_first() -> None:
    own = TransferFunction(RAMP.points, unit_distance=2.0)
    assert own.extinction(np.array(0.5), 7.0) == pytest.approx(np.log(2) / 2)
    assert RAMP.extinction(np.array(0.5), 7.0) == pytest.approx(np.log(2) / 7)


def test_rescaled() -> None:
    moved = RAMP.rescaled(2, 10)
    np.testing.assert_allclose(moved.evaluate(np.array([60.0])), RAMP.evaluate(np.array([25.0])))


@pytest.mark.parametrize(
    ("points", "path"),
    [
        ([(0, (0, 0, 0), 1.5)], "transfer.points.0.opacity"),
        ([(0, (0, 0, 0), 0), (1, (0, 2, 0), 0)], "transfer.points.1.color"),
        ([(0, (0, 0), 0)], "transfer.points.0.color"),
        ([(float("nan"), (0, 0, 0), 0)], "transfer.points.0.value"),
        ([(0, (0, 0, 0), 0, (0, 0, 0), 5)], "transfer.points.0"),
    ],
)
def test_bad_points_are_named(points: Any, path: str) -> None:
    with pytest.raises(SceneError) as caught:
        TransferFunction.from_points(points)
    assert caught.value.path.startswith(path)


def test_no_points() -> None:
    with pytest.raises(SceneError, match="at least one"):
        TransferFunction(())
    with pytest.raises(SceneError):
        TransferFunction(unit_distance=0)


@pytest.mark.parametrize("shape", ["rectangle", "ellipse", "trapezoid"])
def test_regions_are_full_inside_and_nothing_outside(shape: str) -> None:
    region = Region(shape=shape, value=(10, 20), gradient=(0, 8), feather=0.2)
    assert region.coverage(np.array(15.0), np.array(4.0)) == 1
    outside = [(9.9, 4), (20.1, 4), (15, -0.1), (15, 8.1)]
    assert all(region.coverage(np.array(v), np.array(g)) == 0 for v, g in outside)


def test_a_trapezoid_is_narrow_at_its_low_gradient_end() -> None:
    region = Region(shape="trapezoid", value=(0, 10), gradient=(0, 10), feather=0.01)
    assert region.coverage(np.array(1.0), np.array(9.0)) > 0
    assert region.coverage(np.array(1.0), np.array(1.0)) == 0


def test_polygon() -> None:
    triangle = Region(shape="polygon", points=((0, 0), (10, 0), (0, 10)))
    assert triangle.coverage(np.array([2.0, 8.0]), np.array([2.0, 8.0])).tolist() == [1, 0]
    with pytest.raises(SceneError, match="three corners"):
        Region(shape="polygon", points=((0, 0), (1, 1)))


def test_regions_are_laid_over_each_other() -> None:
    red = Region(value=(0, 10), gradient=(0, 10), color=(1, 0, 0), opacity=0.5, feather=0)
    blue = Region(value=(0, 10), gradient=(0, 10), color=(0, 0, 1), opacity=0.5, feather=0)
    at = TransferFunction(regions=(red, blue)).evaluate_2d(np.array([[5.0]]), np.array([[5.0]]))[0, 0]
    assert at[3] == pytest.approx(0.75)
    np.testing.assert_allclose(at[:3], [1 / 3, 0, 2 / 3])


def test_equal_functions_are_one_key() -> None:
    assert hash(TransferFunction((TransferPoint(),))) == hash(TransferFunction((TransferPoint(),)))
    assert RAMP.rescaled(1, 1) != RAMP
