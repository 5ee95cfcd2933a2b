"""How light is seen: its luminance, and CIELAB, in which distances are differences to the eye."""

from __future__ import annotations

import numpy as np

#: Luminance of linear sRGB (IEC 61966-2-1), float32.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], dtype=np.float32)
#: Linear sRGB to CIE XYZ relative to its white (D65); rows X, Y, Z.
_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_XYZ /= _XYZ.sum(axis=1, keepdims=True)


def cielab(linear: np.ndarray) -> np.ndarray:
    """Return L*, a*, b* under D65 of linear sRGB, shape (..., 3), in its own precision."""
    xyz = np.clip(linear, 0, None) @ _XYZ.T.astype(linear.dtype)
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    x, y, z = np.moveaxis(f, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


__all__ = ["LUMINANCE", "cielab"]
