"""Regions: edges that fade, curves, polygons; and pictures of functions that are the same in one dimension and two."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import sfumato
from sfumato import Region, Scene, TransferFunction, Volume

TRIANGLE = ((0.0, 0.0), (10.0, 0.0), (0.0, 10.0))
FUNCTION = TransferFunction.from_points(
    [
        (10, (1, 0.2, 0.1), 0.0),
        (60, (1, 0.2, 0.1), 0.5),
        (90, (0.2, 0.4, 1), 0.0, (1, 0, 0)),
        (200, (1, 1, 1), 0.9),
    ]
)
WHOLE = Region("curve", (-10, 300), (0, 200), opacity=1.0, feather=0.0)


@pytest.mark.parametrize("shape", ["rectangle", "trapezoid", "curve"])
def test_an_edge_at_gradient_zero_does_not_fade(shape: str) -> None:
    region = Region(shape, (0, 10), (0, 10), feather=0.5)
    assert region.coverage(np.array(5.0), np.array(0.0)) == 1
    assert region.coverage(np.array(5.0), np.array(9.9)) < 0.1
    assert region.coverage(np.array(5.0), np.array(-0.1)) == 0
    lifted = Region(shape, (0, 10), (1, 11), feather=0.5)
    assert lifted.coverage(np.array(5.0), np.array(1.0)) == 0


def test_a_polygon_fades_by_the_distance_from_its_edges() -> None:
    square = Region("polygon", points=((0, 10), (20, 10), (20, 14), (0, 14)), feather=0.5)
    at = square.coverage(np.array([10.0, 10.0, 10.0, 1.0, 30.0]), np.array([12.0, 10.5, 11.0, 12.0, 12.0]))
    np.testing.assert_allclose(at, [1, 0.5, 1, 0.2, 0], atol=0.05)
    grounded = Region("polygon", points=((0, 0), (20, 0), (20, 14), (0, 14)), feather=0.5)
    assert grounded.coverage(np.array(10.0), np.array(0.0)) == 1
    assert grounded.extent == ((0, 20), (0, 14))


def test_a_polygon_without_area_covers_nothing() -> None:
    line = Region("polygon", points=((0, 0), (5, 5), (10, 10)))
    assert line.coverage(np.linspace(0, 10, 21), np.linspace(0, 10, 21)).max() <= 1
    assert np.isfinite(line.coverage(np.linspace(0, 10, 21), np.linspace(0, 10, 21))).all()


def test_a_curve_shows_the_points_where_it_lies() -> None:
    two = TransferFunction(FUNCTION.points, None, (WHOLE,))
    values = np.linspace(0, 250, 101)
    np.testing.assert_allclose(two.evaluate_2d(values, np.array(0.0)), _seen(FUNCTION.evaluate(values)))
    np.testing.assert_allclose(two.evaluate_2d(values, np.array(150.0)), _seen(FUNCTION.evaluate(values)))
    steep = TransferFunction(
        FUNCTION.points, None, (Region("curve", (-10, 300), (50, 200), opacity=0.5, feather=0.1),)
    )
    assert not steep.evaluate_2d(values, np.array(40.0))[:, 3].any()
    np.testing.assert_allclose(
        steep.evaluate_2d(values, np.array(120.0))[:, 3], FUNCTION.evaluate(values)[:, 3] / 2
    )


def _seen(look: np.ndarray) -> np.ndarray:
    """Return looks, with no colour where nothing is seen."""
    return np.where(look[:, 3:4] > 0, look, 0)


def test_regions_move_along_the_values_with_the_points() -> None:
    both = TransferFunction(FUNCTION.points, None, (WHOLE, Region("polygon", points=TRIANGLE)))
    moved = both.rescaled(2, 10)
    assert moved.regions[0].value == (-10, 610)
    assert moved.regions[0].gradient == (0, 200), "how steep a boundary is, stays"
    assert moved.regions[1].points == ((10, 0), (30, 0), (10, 10))
    assert moved.points[0].value == 30


def test_the_most_opaque_gradient_tells_a_values_look() -> None:
    two = TransferFunction(regions=(Region(value=(0, 10), gradient=(4, 8), color=(1, 0, 0), feather=0),))
    look = two.most_opaque(np.array([5.0, 20.0]))
    assert look[:, 3].tolist() == [0.5, 0]
    np.testing.assert_allclose(FUNCTION.most_opaque(np.array([60.0])), FUNCTION.evaluate(np.array([60.0])))


def ball(size: int = 32) -> Volume:
    """Return a ball whose values grow evenly to its middle: 40 per mm everywhere but there."""
    z, y, x = np.mgrid[0:size, 0:size, 0:size] - (size - 1) / 2
    return Volume(((0.4 * size - np.sqrt(x * x + y * y + z * z)) * 40).astype(np.int16))


@pytest.mark.parametrize(("technique", "lowest"), [("raycast", 0.0), ("cone", 20.0)])
def test_a_curve_over_all_gradients_there_are_is_the_picture_of_the_points(
    technique: str, lowest: float
) -> None:
    scene = Scene(volume=ball(), transfer=FUNCTION, technique=technique)
    curve = replace(WHOLE, gradient=(lowest, 200.0), feather=0.01)
    two = scene.with_(transfer=TransferFunction(FUNCTION.points, None, (curve,)))
    one, other = (sfumato.render(s, (96, 96)).astype(float) for s in (scene, two))
    assert one[..., 3].max() > 100
    assert np.abs(one - other).mean() < 1.0
