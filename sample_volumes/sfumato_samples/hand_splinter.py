"""The hand with a splinter of metal in the ball of the thumb: a bright body under a veil of tissue."""

from __future__ import annotations

import numpy as np

from .hand import GRID, finished, tissues
from .sdf import capsule, inside

#: Ends of the splinter in mm, from outside the skin to near the bones.
TIP, END = (-8.0, -10.0, 60.0), (-24.0, -38.0, 36.0)
METAL = 3000.0


def generate() -> np.ndarray:
    """Return the hand with the splinter, Hounsfield units, int16."""
    values, _ = tissues(GRID)
    low, high = np.minimum(TIP, END) - 4, np.maximum(TIP, END) + 4
    window, axes = GRID.window(low, high)
    share = inside(capsule(axes, TIP, END, 0.6, 1.9), 1.6)
    values[window] += share * (np.float32(METAL) - values[window])
    return finished(values)
