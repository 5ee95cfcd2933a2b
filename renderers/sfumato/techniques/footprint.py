"""The footprint of a light's cone on a slice, and the stencil that applies it.

An incremental filter is run some hundred times, so only its first two moments matter: the mean says where
the shadow falls, the covariance how fast it softens. Both are taken from the published kernel exactly.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

#: Standard deviation of the Gaussian fall-off in units of k (Soltesova2010, Fig. 7b; ``methods.md``).
GAUSSIAN_SIGMA = 1 / 3


@dataclass(frozen=True)
class Moments:
    """Moments of the kernel for slices one unit apart.

    Attributes
    ----------
    mean : float
        Distance of the centroid from the foot of the perpendicular, towards the light's projection L'.
    along, across : float
        Variance along L' and perpendicular to it.
    """

    mean: float
    along: float
    across: float


@functools.lru_cache(maxsize=256)
def kernel_moments(tilt: float, aperture: float, falloff: str = "linear") -> Moments:
    """Return the moments of the elliptical kernel of Soltesova2010, Eq. 2-11.

    Parameters
    ----------
    tilt : float
        Degrees; a light from behind counts as its mirror image before the slices.
    aperture : float
        Half angle of the cone in degrees.
    falloff : str
        ``linear`` (Eq. 10) or ``gaussian`` (Fig. 7b).
    """
    alpha, theta = math.radians(180 - tilt if tilt > 90 else tilt), math.radians(aperture)
    a1 = math.tan(alpha) - math.tan(alpha - theta)  # (3)
    a2 = math.tan(alpha + theta) - math.tan(alpha)  # (4)
    a, oc = (a1 + a2) / 2, (a2 - a1) / 2  # (5)
    radius = math.tan(theta) / math.cos(alpha)  # (2)
    d_prime = oc * math.sin(alpha)  # (6)
    r_prime = radius + d_prime * math.tan(theta)  # (7, 8)
    b = math.sqrt(max(r_prime**2 - oc**2 + d_prime**2, 0.0))  # (9)
    # Curves of equal k are ellipses k times the rim's, whose centre moves from O (k = 0) to C (k = 1) (11).
    k = (np.arange(256) + 0.5)[:, None] / 256
    phi = (np.arange(256) + 0.5)[None, :] * (2 * np.pi / 256)
    x = oc * k - k * a * np.cos(phi)  # towards the light, from O
    y = k * b * np.sin(phi)
    area = k * b * (a - oc * np.cos(phi))  # Jacobian of (k, phi) -> (x, y)
    weight = area * (1 - k if falloff == "linear" else np.exp(-(k**2) / (2 * GAUSSIAN_SIGMA**2)))
    weight /= weight.sum()
    mean = float((weight * x).sum())
    return Moments(
        math.tan(alpha) + mean, float((weight * (x - mean) ** 2).sum()), float((weight * y**2).sum())
    )


@dataclass(frozen=True)
class Stencil:
    """Whole-texel offsets and weights: ``center`` for the texel itself, ``weights[k]`` for each of +-``taps[k]``."""

    center: float
    taps: tuple[tuple[int, int], ...]
    weights: tuple[float, ...]


def stencil_for(xx: float, xy: float, yy: float) -> Stencil:
    """Return a non-negative stencil with mean zero and exactly a given covariance, in texels squared.

    Selling's decomposition (Selling1874) writes any positive definite form as a sum of three squares of
    whole-number directions with non-negative weights: six texels and the centre, fetched without any
    interpolation, which would add blur of its own.
    """
    scale = max(1, math.ceil(math.sqrt(max(xx + yy, 1e-12))))
    while True:
        stencil = _selling(xx / scale**2, xy / scale**2, yy / scale**2)
        if stencil.center >= 0.0:
            return Stencil(
                stencil.center, tuple((x * scale, y * scale) for x, y in stencil.taps), stencil.weights
            )
        scale += 1


def _selling(xx: float, xy: float, yy: float) -> Stencil:
    tiny = 1e-9 * max(xx, yy, 1e-12)
    matrix = np.array([[xx + tiny, xy], [xy, yy + tiny]])
    base = [np.array([1, 0]), np.array([0, 1]), np.array([-1, -1])]
    # To an obtuse superbase: every pair's product is <= 0. A thin ellipse takes as many steps as it is long.
    for _ in range(40_000):
        for i, j in ((0, 1), (1, 2), (0, 2)):
            if base[i] @ matrix @ base[j] > 1e-12 * max(xx, yy):
                base = [-base[i], base[j], base[i] - base[j]]
                break
        else:
            break
    taps, weights = [], []
    for i, j, k in ((0, 1, 2), (1, 2, 0), (0, 2, 1)):
        rho = max(0.0, float(-(base[i] @ matrix @ base[j])))
        taps.append((int(-base[k][1]), int(base[k][0])))  # perpendicular to the third vector
        weights.append(rho / 2)
    return Stencil(1 - 2 * sum(weights), tuple(taps), tuple(weights))


def cone_directions(tilt: float, aperture: float, count: int) -> np.ndarray:
    """Return directions uniform in solid angle in a cone; shape (count, 3): along L', across, towards the eye."""
    theta, alpha = math.radians(aperture), math.radians(tilt)
    k = np.arange(count) + 0.5
    z = 1 - k / count * (1 - math.cos(theta))
    phi = k * math.pi * (3 - math.sqrt(5))
    r = np.sqrt(np.maximum(0, 1 - z**2))
    x, y = r * np.cos(phi), r * np.sin(phi)
    return np.stack(
        [x * math.cos(alpha) + z * math.sin(alpha), y, -x * math.sin(alpha) + z * math.cos(alpha)], axis=1
    )


#: Directions over which secants are averaged; more change nothing at four digits.
SECANT_DIRECTIONS = 256


@functools.lru_cache(maxsize=256)
def secants(tilt: float, aperture: float) -> np.ndarray:
    """Return the secants, without sign, of a cone's directions against the slices' normal."""
    cosines = np.abs(cone_directions(tilt, aperture, SECANT_DIRECTIONS)[:, 2])
    result = 1 / np.maximum(cosines, 1e-3)
    result.flags.writeable = False
    return np.asarray(result)


def lit_surface(tilt: float, aperture: float) -> float:
    """Return what a solid surface that faces the viewer sends back of a light, not normalised: <1 / (1 + s)>."""
    return float(np.mean(1 / (1 + secants(tilt, aperture))))


def effective_secant(tilt: float, aperture: float) -> float:
    """Return the secant with which slabs attenuate the light.

    Chosen so that a solid surface is equally bright however finely it is cut: 1 / (1 + s) = <1 / (1 + s_k)>.
    """
    return 1 / lit_surface(tilt, aperture) - 1


#: Entries of the slab table over 1 - exp(-optical depth) and over the view ray's secant.
SLAB_DEPTHS, SLAB_SECANTS = 256, 8


def slab_table(lights: tuple[tuple[float, float], ...], secant_max: float) -> np.ndarray:
    """Return what a slab sends back of each light that reaches it (``methods.md``, open point 3a).

    Parameters
    ----------
    lights : tuple of (tilt, aperture)
        In degrees, up to four.
    secant_max : float
        Largest secant of a view ray.

    Returns
    -------
    ndarray, float32, shape (SLAB_SECANTS, SLAB_DEPTHS, 4)
        Over secants from 1 to `secant_max` and 1 - exp(-tau d) from 0 to 1; one light a channel.
    """
    table = np.zeros((SLAB_SECANTS, SLAB_DEPTHS, 4), dtype=np.float32)
    opacity = np.minimum(np.linspace(0, 1, SLAB_DEPTHS), 1 - 1e-7)
    depth = -np.log1p(-opacity)[:, None]
    for row, v in enumerate(np.linspace(1, max(secant_max, 1.0), SLAB_SECANTS)):
        for channel, (tilt, aperture) in enumerate(lights):
            s = secants(tilt, aperture)[None, :]
            if tilt < 90:
                term = -np.expm1(-depth * (v + s)) * v / (v + s)
            else:
                gap = np.where(np.abs(s - v) < 1e-6, 1e-6, s - v)
                term = v * np.exp(-depth * v) * -np.expm1(-depth * gap) / gap
            table[row, :, channel] = term.mean(axis=1) / lit_surface(tilt, aperture)
    return table
