"""Edits of a transfer function's points, as numbers."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import TransferFunction, TransferPoint
from sfumato.scene import transfer_edit


@pytest.fixture
def ramp() -> TransferFunction:
    return TransferFunction.from_points(
        [(0, (0, 0, 0), 0.0), (10, (1, 0, 0), 0.2), (10, (0, 1, 0), 0.6), (20, (1, 1, 1), 1.0, (2, 0, 0))]
    )


def test_a_point_put_on_the_curve_changes_nothing(ramp: TransferFunction) -> None:
    values = np.linspace(-5, 25, 301)
    for value in (-3.0, 4.0, 15.0, 22.0):
        more, index = transfer_edit.with_point_added(ramp, transfer_edit.point_at(ramp, value))
        assert more.points[index].value == value
        assert len(more.points) == 5
        np.testing.assert_allclose(more.evaluate(values), ramp.evaluate(values), atol=1e-12)


def test_two_points_always_stay(ramp: TransferFunction) -> None:
    for expected in (3, 2, 2):
        ramp = transfer_edit.without_point(ramp, 0)
        assert len(ramp.points) == expected


@pytest.mark.parametrize(("value", "index"), [(5, 1), (15, 2), (30, 3), (-1, 0), (10, 1)])
def test_a_changed_point_is_found_again(ramp: TransferFunction, value: float, index: int) -> None:
    changed, found = transfer_edit.with_point_changed(ramp, 1, value=value, opacity=0.3)
    assert found == index
    assert changed.points[found] == TransferPoint(value, (1, 0, 0), 0.3)
    assert [p.value for p in changed.points] == sorted(p.value for p in changed.points)


def test_a_drag_stops_at_the_neighbours(ramp: TransferFunction) -> None:
    assert transfer_edit.between_neighbours(ramp, 1, -7) == 0
    assert transfer_edit.between_neighbours(ramp, 1, 99) == 10
    assert transfer_edit.between_neighbours(ramp, 0, -7) == -7
    assert transfer_edit.between_neighbours(ramp, 3, 99) == 99


def test_level_and_width(ramp: TransferFunction) -> None:
    assert transfer_edit.level_and_width(ramp) == (10, 20)
    changed = transfer_edit.scaled_about(ramp, 10, 2, 5)
    assert transfer_edit.level_and_width(changed) == (15, 40)
    values = np.array([3.0, 12.0])
    np.testing.assert_allclose(changed.evaluate((values - 10) * 2 + 15), ramp.evaluate(values))
