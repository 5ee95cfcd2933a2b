"""The tables of local occlusion: errors are small and as the paper's, coarser is quicker."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato_app.bench.blocks import DIRECTIONS, REDUCTIONS, colour_error, measure_blocks
from sfumato_app.bench.setting import Setting


def test_a_colour_error_is_over_the_subject_alone() -> None:
    truth = np.zeros((2, 2, 3))
    truth[0, 0] = 1
    grey = np.where(truth > 0, 0.184187, 0.0)  # L* = 50
    assert colour_error(truth, truth) == 0
    assert colour_error(grey, truth) == pytest.approx(50, abs=0.01)


@pytest.mark.gpu
@pytest.mark.slow
def test_errors_and_times_of_a_small_chest() -> None:
    report = measure_blocks(Setting(size=64, viewport=64))
    assert [step.wanted for step in report.steps] == list(REDUCTIONS)
    assert all(step.reduction >= 0.95 * step.wanted for step in report.steps)
    assert np.diff([step.texels for step in report.steps]).max() < 0
    assert [count for count, _, _ in report.directions] == list(DIRECTIONS)
    for count, error, paper in report.directions:
        assert error <= paper + 0.05, count
    assert "a direction" in report.text()
