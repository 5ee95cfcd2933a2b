"""The figures: one module a subject, one function a figure; samples are made when a figure is asked for."""

from __future__ import annotations

from collections.abc import Callable

from ..figure import Figure
from . import combined, extinction_places, extinction_scans, extinction_terms, local, local_scans
from .bonsai import figure_14
from .cone import figure_8
from .fish import figure_9
from .hand import figure_1, figure_11
from .heart import figure_13
from .skull import figure_10
from .torso import figure_12

#: By number in Soltesova2010, or by another paper's key and its number there.
FIGURES: dict[int | str, Callable[[], Figure]] = {
    1: figure_1,
    8: figure_8,
    9: figure_9,
    10: figure_10,
    11: figure_11,
    12: figure_12,
    13: figure_13,
    14: figure_14,
    "schlegel2011-1": extinction_places.figure_1,
    "schlegel2011-2": extinction_terms.figure_2,
    "schlegel2011-4": extinction_terms.figure_4,
    "schlegel2011-6": extinction_terms.figure_6,
    "schlegel2011-8": extinction_scans.figure_8,
    "schlegel2011-9": extinction_places.figure_9,
    "schlegel2011-10": extinction_scans.figure_10,
    "schlegel2011-11": extinction_scans.figure_11,
    "schlegel2011-12": extinction_scans.figure_12,
    "hernell2007-1": local.figure_1,
    "hernell2007-3": local.figure_3,
    "hernell2007-4": local.figure_4,
    "hernell2007-6": local_scans.figure_6,
    "hernell2007-7": local_scans.figure_7,
    "hernell2007-8": local_scans.figure_8,
    "hernell2007-9": local_scans.figure_9,
    "hernell2007-10": local.figure_10,
    "schott2012-1": combined.figure_1,
    "schott2012-2": combined.figure_2,
    "schott2012-5": combined.figure_5,
    "schott2012-6": combined.figure_6,
    "schott2012-7": combined.figure_7,
    "schott2012-8": combined.figure_8,
}
