"""The figures: one module a subject, one function a figure; samples are made when a figure is asked for."""

from __future__ import annotations

from collections.abc import Callable

from ..figure import Figure
from .bonsai import figure_14
from .cone import figure_8
from .fish import figure_9
from .hand import figure_1, figure_11
from .heart import figure_13
from .skull import figure_10
from .torso import figure_12

#: By number in the paper.
FIGURES: dict[int, Callable[[], Figure]] = {
    1: figure_1,
    8: figure_8,
    9: figure_9,
    10: figure_10,
    11: figure_11,
    12: figure_12,
    13: figure_13,
    14: figure_14,
}
