"""Whole transfer functions: colours of a map, mirror, and the peaks to which points snap."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import SceneError, TransferFunction, Volume
from sfumato.scene import Region
from sfumato.scene.peaks import peaks_of
from sfumato.scene.transfer_whole import CLOSE, COLOR_MAPS, colored, inverted, map_colors, seen_range

FUNCTION = TransferFunction.from_points(
    [(-1000, (0, 0, 0), 0.0), (100, (1, 0, 0), 0.0), (300, (1, 0, 0), 0.6), (900, (0, 1, 0), 0.9)]
)


@pytest.mark.parametrize("name", COLOR_MAPS.values())
def test_colours_are_those_of_the_map_and_opacities_stay(name: str) -> None:
    painted = colored(FUNCTION, name)
    assert seen_range(FUNCTION) == (100, 900)
    values = np.linspace(-1200, 1200, 500)
    was, now = FUNCTION.evaluate(values), painted.evaluate(values)
    np.testing.assert_allclose(now[:, 3], was[:, 3], atol=1e-6)
    shown = (values >= 100) & (values <= 900)
    wanted = map_colors(name, (values[shown] - 100) / 800)
    assert np.abs(now[shown, :3] - wanted).max() < 0.13, "between points, too, and in the mean far less"
    assert np.abs(now[shown, :3] - wanted).mean() < 0.02
    gaps = np.diff([p.value for p in painted.points if 100 <= p.value <= 900])
    assert gaps.max() <= CLOSE * 800 + 1e-9
    assert colored(painted, name) == painted, "a second time nothing changes"


def test_a_map_that_is_none_is_refused() -> None:
    with pytest.raises(SceneError, match="colormap"):
        colored(FUNCTION, "no such map")


def test_a_function_that_shows_nothing_is_coloured_as_a_whole() -> None:
    nothing = TransferFunction.from_points([(0, (0, 0, 0), 0.0), (8, (0, 0, 0), 0.0)])
    painted = colored(nothing, "matlab:gray")
    assert painted.points[-1].color == pytest.approx((1, 1, 1))


def test_the_mirror_of_the_mirror_is_the_function() -> None:
    shapes = (
        Region("rectangle", (100.0, 300.0), (5.0, 9.0)),
        Region("polygon", points=((0.0, 1.0), (50.0, 2.0), (10.0, 8.0))),
    )
    function = TransferFunction(FUNCTION.points, regions=shapes)
    there = inverted(function)
    assert [p.value for p in there.points] == [-1000, -400, -200, 900]
    assert there.points[0].opacity == 0.9
    values = np.linspace(-1000, 900, 77)
    np.testing.assert_allclose(
        there.evaluate_2d(values, np.full(77, 6.0)),
        function.evaluate_2d(-100 - values, np.full(77, 6.0)),
        atol=1e-6,
    )
    assert inverted(there) == function


def test_peaks_are_the_tissues_values() -> None:
    random = np.random.default_rng(3)
    tissues = [(0.0, 9.0, 60_000), (100.0, 8.0, 20_000), (180.0, 6.0, 4_000)]
    values = np.concatenate([random.normal(mean, spread, count) for mean, spread, count in tissues])
    data = np.resize(values, (40, 40, 52)).astype(np.float32)
    found = peaks_of(Volume(data))
    assert len(found) == 3
    np.testing.assert_allclose(found, [0, 100, 180], atol=3)


def test_peaks_of_few_bits_and_of_one_value() -> None:
    steps = np.repeat(np.arange(32) * 60, np.r_[900:260:-20])  # ever fewer: one peak, the first value
    assert len(peaks_of(Volume(np.resize(steps, (20, 20, 40)).astype(np.int16)))) <= 2
    assert len(peaks_of(Volume(np.zeros((4, 4, 4), np.uint8)))) <= 1
