"""Colour bars: round values within the ends, and only where a scalar colours what is seen."""

import numpy as np
import pytest

from sfumato import Geometry, Lines, Scene
from sfumato.geometry import color_bar, color_bars, mesh_of
from sfumato.geometry.color_bar import round_ticks

LINE = Lines.of([[[0, 0, 0], [5, 0, 0], [10, 0, 0]]], [("fa", [[0.0, 0.4, 1.0]])])


@pytest.mark.parametrize(
    ("low", "high", "texts"),
    [
        (0, 1, ["0", "0.25", "0.5", "0.75", "1"]),
        (-3, 3, ["-2", "0", "2"]),
        (0.013, 0.094, ["0.02", "0.04", "0.06", "0.08"]),
        (12000, 99000, ["20000", "40000", "60000", "80000"]),
    ],
)
def test_ticks(low, high, texts):
    assert [text for _, text in round_ticks(low, high)] == texts


@pytest.mark.parametrize("scale", 10.0 ** np.arange(-6, 7, 1.3))
def test_a_few_ticks_at_any_scale(scale):
    for low, width in ((0, 1), (-7.3, 1.9), (2.2, 4.44)):
        ticks = round_ticks(low * scale, (low + width) * scale)
        assert 3 <= len(ticks) <= 6
        assert all(low * scale - 1e-9 * scale <= v <= (low + width) * scale * (1 + 1e-9) for v, _ in ticks)


def test_bars_of_a_scene():
    colored = Geometry(LINE, color_by="scalar", colormap="magma")
    bar = color_bar(colored)
    assert bar is not None
    assert (bar.title, bar.low, bar.high) == ("fa", 0, 1)
    mesh = mesh_of(colored)
    middle = mesh.colors[np.isclose(mesh.points[:, 0], 5)][0]
    assert np.allclose(middle, bar.colors[round(0.4 * 1023)], atol=0.01), (
        "the bar tells the colours that are drawn"
    )
    others = (Geometry(LINE), Geometry(LINE, color_by="scalar", visible=False), colored)
    assert len(color_bars(Scene(geometry=(colored, *others)))) == 1
