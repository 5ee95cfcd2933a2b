"""Smoke, fog and wax: they fill what was empty, at the same depth in every volume, and leave the subject."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import TransferFunction, Volume
from sfumato.scene.presets import MEDIA, Medium, filled, presets_for

TRANSFER = TransferFunction.from_points([(10, (1, 0, 0), 0.0), (100, (1, 1, 1), 0.0), (150, (1, 1, 1), 0.9)])


def box(side: int, spacing: float) -> Volume:
    return Volume(np.zeros((side, side, side), np.uint8), spacing=(spacing,) * 3)


@pytest.mark.parametrize("medium", MEDIA, ids=lambda m: m.name)
@pytest.mark.parametrize(("side", "spacing"), [(32, 1.0), (64, 0.5), (20, 3.0)])
def test_its_depth_is_that_of_the_longest_side(medium: Medium, side: int, spacing: float) -> None:
    transfer = filled(TRANSFER, medium, box(side, spacing))
    opacity = transfer.evaluate(np.array([0.0, 50.0]))[:, 3]
    depth = -np.log1p(-opacity) / (transfer.unit_distance or spacing) * side * spacing
    np.testing.assert_allclose(depth, medium.depth, rtol=1e-6)


def test_the_subject_stays_as_it_is() -> None:
    for medium in MEDIA:
        transfer = filled(TRANSFER, medium, box(32, 1.0))
        assert transfer.points[-1] == TRANSFER.points[-1]
        assert transfer.points[0].color == medium.color
        assert transfer.name == medium.name


def test_they_are_among_the_presets_of_every_volume() -> None:
    data = np.zeros((20, 20, 20), np.uint8)
    data[5:15, 5:15, 5:15] = 200
    assert [p.name for p in presets_for(Volume(data))[-3:]] == ["Smoke", "Fog", "Wax"]
