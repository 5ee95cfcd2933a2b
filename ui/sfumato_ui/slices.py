"""Grey pictures of slices for dialogs: computed in threads, so that nobody waits."""

from __future__ import annotations

import numpy as np
from qtpy.QtGui import QImage

#: Part of the values that is cut off at either end, so that single bright voxels do not darken all others.
CLIPPED = 0.005


def slice_image(plane: np.ndarray, spacing: tuple[float, float], longest: int) -> QImage:
    """Return a slice as a grey picture in its true proportions.

    Parameters
    ----------
    plane : ndarray, shape (rows, columns)
        Values in any unit.
    spacing : (float, float)
        Distance of columns and of rows in mm.
    longest : int
        Longer side of the picture in pixels.
    """
    height, width = plane.shape
    wide, tall = width * spacing[0], height * spacing[1]
    scale = longest / max(wide, tall)
    columns, rows = max(1, round(wide * scale)), max(1, round(tall * scale))
    y = np.minimum(np.arange(rows) * height // rows, height - 1)
    x = np.minimum(np.arange(columns) * width // columns, width - 1)
    grey = np.ascontiguousarray(_grey(plane[np.ix_(y, x)]))
    return QImage(grey.data, columns, rows, columns, QImage.Format.Format_Grayscale8).copy()


def _grey(values: np.ndarray) -> np.ndarray:
    finite = np.nan_to_num(values.astype(np.float64), posinf=0.0, neginf=0.0)
    low, high = np.quantile(finite, (CLIPPED, 1 - CLIPPED))
    if high <= low:
        low, high = float(finite.min()), float(finite.max())
    return np.asarray(np.clip((finite - low) / max(high - low, 1e-30), 0, 1) * 255).astype(np.uint8)
