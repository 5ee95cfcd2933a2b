"""What VTK's own view shows: cells are lines of the geometry, few enough points, nothing where nothing is left."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import Geometry, Lines
from sfumato.geometry import preview


def arcs(count: int, points: int = 50) -> Lines:
    """Return arcs of a circle, one above the other."""
    t = np.linspace(0, 3, points)
    return Lines.of(
        [np.stack([10 * np.cos(t), 10 * np.sin(t), np.full(points, i)], axis=1) for i in range(count)]
    )


def test_cells_are_lines_of_the_geometry() -> None:
    shown = preview.preview_of(Geometry(arcs(10), radius=0.1, fraction=0.5, color_by="direction"))
    poly, numbers = shown.poly, shown.numbers
    assert poly.GetNumberOfLines() == len(numbers) > 2
    for cell, number in enumerate(numbers):
        assert poly.GetCell(cell).GetBounds()[4:] == (number, number)


def test_many_lines_are_thinned_out_evenly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(preview, "MOST_POINTS", 500)
    shown = preview.preview_of(Geometry(arcs(400), radius=0.001))
    poly, numbers = shown.poly, shown.numbers
    assert 0 < poly.GetNumberOfPoints() <= 500
    assert np.ptp(np.diff(numbers)) == 0


def test_less_is_shown_while_something_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(preview, "MOVING_POINTS", 300)
    shown = preview.preview_of(Geometry(arcs(40), radius=0.001))
    assert shown.poly.GetNumberOfLines() == 40
    assert 0 < shown.moving.GetNumberOfPoints() <= 300


def test_nothing_left_is_empty() -> None:
    shown = preview.preview_of(Geometry(arcs(3), min_length=1000))
    poly, numbers = shown.poly, shown.numbers
    assert poly.GetNumberOfPoints() == len(numbers) == 0
