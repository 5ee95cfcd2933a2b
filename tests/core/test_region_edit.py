"""Edits of regions: handles, order, extents, freehand outlines, and the way from one dimension to two."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sfumato import Region, SceneError, TransferFunction, Volume
from sfumato.scene import region_edit as edit

BOX = Region("rectangle", (10, 30), (4, 8))
DRAWN = Region("polygon", points=((0, 0), (10, 0), (10, 10), (0, 10)))
TWO = TransferFunction(regions=(BOX, DRAWN))
LEAST = (1.0, 0.5)


def test_every_handle_of_a_box_moves_its_own_sides() -> None:
    places = edit.handles(BOX)
    assert places["upper right"] == (30, 8)
    assert places["left"] == (10, 6)
    for name in places:
        assert edit.with_handle_at(BOX, name, places[name], LEAST) == BOX, "where it is, nothing changes"
    corner = edit.with_handle_at(BOX, "upper left", (12, 20), LEAST)
    assert (corner.value, corner.gradient) == ((12, 30), (4, 20))
    assert edit.with_handle_at(BOX, "lower", (99, 5), LEAST).value == (10, 30)


def test_a_box_stays_open_and_above_gradient_zero() -> None:
    closed = edit.with_handle_at(BOX, "lower left", (50, 50), LEAST)
    assert (closed.value, closed.gradient) == ((29, 30), (7.5, 8))
    assert edit.with_handle_at(BOX, "lower", (20, -5), LEAST).gradient == (0, 8)
    assert edit.moved(BOX, 5, -100).gradient == (0, 4)
    below = Region(value=(0, 1), gradient=(-5, 30))
    assert edit.moved(below, 0, -1).gradient == (-5, 30), "what reaches below zero is not pushed up"


def test_corners_and_the_middle_of_a_polygon() -> None:
    pulled = edit.with_handle_at(DRAWN, "corner 3", (20, 30), LEAST)
    assert pulled.points == ((0, 0), (10, 0), (20, 30), (0, 10))
    assert edit.with_handle_at(DRAWN, "middle", (7, 9), LEAST).extent == ((2, 12), (4, 14))
    assert edit.with_extent(DRAWN, (5, 6), (1, 3)).extent == ((5, 6), (1, 3))
    for region in (BOX, DRAWN):
        with pytest.raises(SceneError):
            edit.with_extent(region, (6, 5), (1, 3))


def test_adding_removing_and_order() -> None:
    more, at = edit.with_region_added(TWO, BOX)
    assert at == 2
    less = edit.without_region(edit.without_region(more, 0), 0)
    assert less.regions == (BOX,)
    assert edit.without_region(less, 0) == less, "the last one stays"
    raised, at = edit.reordered(TWO, 0, 1)
    assert (raised.regions, at) == ((DRAWN, BOX), 1)
    assert edit.reordered(raised, 1, 1) == (raised, 1)


def test_the_topmost_region_is_met_unless_one_is_preferred() -> None:
    under = Region("ellipse", (0, 40), (0, 12))
    regions = (under, BOX)
    assert edit.topmost(regions, 20, 6) == 1
    assert edit.topmost(regions, 20, 6, preferred=0) == 0
    assert edit.topmost(regions, 20, 10) == 0
    assert edit.topmost(regions, 1, 1) == -1, "the ellipse's corner is empty"


@pytest.mark.parametrize("shape", ["rectangle", "ellipse", "trapezoid"])
def test_the_outline_is_where_coverage_ends(shape: str) -> None:
    region = Region(shape, (10, 30), (4, 8), feather=0.0)
    middle = np.array(edit.handles(region)["middle"])
    for corner in edit.outline(region):
        inside, outside = (middle + (corner - middle) * part for part in (0.98, 1.02))
        assert region.coverage(*inside) == 1
        assert region.coverage(*outside) == 0


def test_a_drawn_circle_keeps_few_corners() -> None:
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * 50
    kept = edit.simplified(circle, 1.5)
    assert 8 <= len(kept) <= edit.MOST_CORNERS
    scribble = np.random.default_rng(2).normal(size=(500, 2))
    assert len(edit.simplified(scribble, 1e-6)) <= edit.MOST_CORNERS
    assert len(edit.simplified(np.zeros((5, 2)), 1.0)) == 2, "a click draws nothing"


def test_there_and_back_again() -> None:
    volume = Volume(np.arange(27).reshape(3, 3, 3).astype(np.int16))
    one = TransferFunction.from_points([(5, (1, 0, 0), 0.0), (20, (1, 1, 0), 0.7)], 2.0, "mine")
    two = edit.two_dimensional(one, volume)
    (curve,) = two.regions
    assert curve.coverage(np.array([0.0, 26.0]), np.array([[0.0], [14.0]])).min() == 1
    values = np.linspace(0, 26, 30)
    np.testing.assert_allclose(two.evaluate_2d(values, np.array(3.0))[:, 3], one.evaluate(values)[:, 3])
    assert edit.one_dimensional(two, TransferFunction()) == one
    assert edit.two_dimensional(one, volume, (BOX,)).regions == (BOX,), "what was there before comes back"
    made_of_regions = TransferFunction(regions=(BOX,))
    assert edit.one_dimensional(made_of_regions, one).points == one.points
    flat = Volume(np.ones((2, 2, 2)))
    assert edit.two_dimensional(replace(one), flat).regions[0].value[0] < 1
