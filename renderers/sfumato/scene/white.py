"""Colour temperatures: of lamps, and of the light that a picture shows as white.

A black body's chromaticity comes from the cubic approximation of Kim et al. 2002 (US patent 7024034; 1667 to 25000 K,
within 0.001 of Planck's law); light of one temperature becomes white by Bradford's adaptation (CIE 159:2004).
6504 K, the temperature of the standard illuminant D65, is white as it is.
"""

from __future__ import annotations

import functools

import numpy as np

Vec3 = tuple[float, float, float]

#: Temperature in K whose light is (1, 1, 1); the lowest and highest that the approximation holds for.
WHITE, LOWEST, HIGHEST = 6504.0, 1667.0, 25000.0
#: A lamp's colour counts as that of a temperature if no channel of it, the largest being 1, is farther off than this.
NEAR = 0.004
_XYZ_FROM_RGB = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
_BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
#: From linear sRGB to the cones' responses that are scaled.
_CONES = _BRADFORD @ _XYZ_FROM_RGB


def chromaticity(kelvin: float) -> tuple[float, float]:
    """Return CIE 1931 x and y of a black body."""
    t = 1e3 / min(HIGHEST, max(LOWEST, kelvin))
    if kelvin <= 4000:
        x = -0.2661239 * t**3 - 0.2343589 * t**2 + 0.8776956 * t + 0.179910
    else:
        x = -3.0258469 * t**3 + 2.1070379 * t**2 + 0.2226347 * t + 0.240390
    if kelvin <= 2222:
        y = -1.1063814 * x**3 - 1.34811020 * x**2 + 2.18555832 * x - 0.20219683
    elif kelvin <= 4000:
        y = -0.9549476 * x**3 - 1.37418593 * x**2 + 2.09137015 * x - 0.16748867
    else:
        y = 3.0817580 * x**3 - 5.87338670 * x**2 + 3.75112997 * x - 0.37001483
    return x, y


def _cones(kelvin: float) -> np.ndarray:
    x, y = chromaticity(kelvin)
    return np.asarray(_BRADFORD @ np.array([x / y, 1.0, (1 - x - y) / y]))


@functools.lru_cache(maxsize=64)
def balance_matrix(kelvin: float) -> np.ndarray:
    """Return what makes light of a temperature white: linear sRGB to linear sRGB, shape (3, 3)."""
    if kelvin == WHITE:
        return np.eye(3)
    scale = _cones(WHITE) / _cones(kelvin)
    return np.asarray(np.linalg.solve(_CONES, scale[:, None] * _CONES))


def lamp_color(kelvin: float) -> Vec3:
    """Return the linear RGB of a lamp of a temperature, its largest channel 1; `balance_matrix` makes it grey."""
    rgb = np.maximum(np.linalg.solve(balance_matrix(kelvin), np.ones(3)), 0)
    r, g, b = (float(c) for c in rgb / rgb.max())
    return r, g, b


def lamp_temperature(color: Vec3) -> float | None:
    """Return the temperature in K of a lamp's linear RGB; None for a colour that no temperature has."""
    largest = max(color)
    if largest <= 0:
        return None
    wanted = np.asarray(color) / largest
    mired, colors = _table()
    best = int(np.abs(colors - wanted).max(axis=1).argmin())
    # Between its neighbours, so that a temperature that was chosen comes back.
    finer = np.linspace(mired[max(0, best - 1)], mired[min(len(mired) - 1, best + 1)], 101)
    off = [float(np.abs(np.asarray(lamp_color(1e6 / m)) - wanted).max()) for m in finer]
    best = int(np.argmin(off))
    return round(float(1e6 / finer[best])) if off[best] <= NEAR else None


@functools.lru_cache(maxsize=1)
def _table() -> tuple[np.ndarray, np.ndarray]:
    """Return temperatures in mired, evenly spaced as they look, and their colours."""
    mired = np.linspace(1e6 / HIGHEST, 1e6 / LOWEST, 400)
    return mired, np.array([lamp_color(1e6 / m) for m in mired])


__all__ = ["HIGHEST", "LOWEST", "WHITE", "balance_matrix", "chromaticity", "lamp_color", "lamp_temperature"]
