"""Plane slices through a volume, as radiologists look at them: axial, coronal, sagittal, with window and level.

::

    cuts     which planes, what is right and up in them, the patient's sides at their edges
    frame    the rectangle of a slice that is seen: from its pixels to the world and back
    sampling values of a volume on a frame
    light    how much light arrives at points of a slice, coarsely
    window   which values are shown as black and as white; the usual ones for Hounsfield units

Slices lie along the patient's axes, not the array's, so that they mean the same for every scan: a tilted or
mirrored array is resampled (linear interpolation, `scipy.ndimage`), in true proportions in mm. What is shown
is how a radiologist reads films: the axial slice as seen from the feet, the coronal one from the front, so
that the patient's right is on the viewer's left; the sagittal one from the patient's left.
"""

from .cuts import CUTS, Cut, cuts_of, first_point, step_along
from .frame import Frame, fitting_scale
from .light import ExtinctionGrid, extinction_grid, light_at
from .sampling import sample, value_at
from .window import NamedWindow, ValueWindow, windows_for

__all__ = [
    "CUTS",
    "Cut",
    "ExtinctionGrid",
    "Frame",
    "NamedWindow",
    "ValueWindow",
    "cuts_of",
    "extinction_grid",
    "first_point",
    "fitting_scale",
    "light_at",
    "sample",
    "step_along",
    "value_at",
    "windows_for",
]
