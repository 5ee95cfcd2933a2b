"""The footprint that a tilted cone of light leaves on a plane (Soltesova2010, section 3.2 and 3.3).

Lengths are in units of the slice distance d. Along the plane, ``p`` runs along L' (the light's projection)
from the foot of the perpendicular, ``q`` across it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

#: Standard deviation of the Gaussian fall-off in units of the rim's k.
GAUSSIAN_SIGMA = 1.0 / 3.0


@dataclass(frozen=True)
class Ellipse:
    """Section of a cone with the plane at distance 1.

    Attributes
    ----------
    a1, a2 : float
        From O, where the cone's axis meets the plane, to the near and the far vertex (Eq. 3, 4).
    A, B : float
        Semi-axes along and across L' (Eq. 5, 9).
    OC : float
        Distance from O to the centre C.
    O, C : float
        Places of O and C along L'.
    """

    a1: float
    a2: float
    A: float
    B: float
    OC: float
    O: float  # noqa: E741 - the paper's name
    C: float


def ellipse(tilt: float, aperture: float) -> Ellipse:
    """Return the section of a cone; angles in degrees, 0 <= tilt < 90 - aperture."""
    alpha, theta = math.radians(tilt), math.radians(aperture)
    radius = math.tan(theta) / math.cos(alpha)  # (2)
    a1 = radius * math.cos(theta) / math.cos(theta - alpha)  # (3)
    a2 = radius * math.cos(theta) / math.cos(theta + alpha)  # (4)
    half, offset = (a1 + a2) / 2, (a2 - a1) / 2  # (5)
    depth = offset * math.sin(alpha)  # (6)
    outer = radius + depth * math.tan(theta)  # (7, 8)
    across = math.sqrt(outer**2 - offset**2 + depth**2)  # (9)
    axis = math.tan(alpha)
    return Ellipse(a1, a2, half, across, offset, axis, axis + offset)


def falloff_weight(k: np.ndarray, falloff: str) -> np.ndarray:
    """Return the weight at ``k`` (0 at O, 1 on the rim), not normalised; ``falloff``: linear or gaussian."""
    weight = 1 - k if falloff == "linear" else np.exp(-(k**2) / (2 * GAUSSIAN_SIGMA**2))
    return np.where((k >= 0) & (k <= 1), weight, 0.0)


def larger_root(p: np.ndarray, q: np.ndarray, shape: Ellipse) -> np.ndarray:
    """Return k of points of the plane: the larger root of Eq. 11, at most 1 within the ellipse."""
    x = shape.C - p  # from C, positive towards O
    # (x - OC + k OC)^2 / A^2 + y^2 / B^2 = k^2, a quadratic in k.
    a = shape.OC**2 / shape.A**2 - 1
    b = 2 * (x - shape.OC) * shape.OC / shape.A**2
    c = (x - shape.OC) ** 2 / shape.A**2 + q**2 / shape.B**2
    root = np.sqrt(np.maximum(b * b - 4 * a * c, 0))
    return np.asarray(np.maximum((-b + root) / (2 * a), (-b - root) / (2 * a)))


def weights_on_grid(
    tilt: float, aperture: float, rotation: float, falloff: str = "linear", size: int = 128
) -> tuple[np.ndarray, float]:
    """Return the kernel as a picture, as in Fig. 7, and half its width in units of d.

    Returns
    -------
    weights : ndarray, shape (size, size)
        Sum 1; row 0 on top; the ellipse's centre in the middle.
    half : float
        The picture spans +- half about C.
    """
    shape = ellipse(tilt, aperture)
    half = max(shape.A, shape.B)
    ticks = (np.arange(size) + 0.5) / size * 2 - 1
    right, up = np.meshgrid(ticks * half, -ticks * half)
    phi = math.radians(rotation)
    p = right * math.cos(phi) + up * math.sin(phi) + shape.C
    q = -right * math.sin(phi) + up * math.cos(phi)
    weights = falloff_weight(larger_root(p, q, shape), falloff)
    return weights / weights.sum(), half


def kernel_points(
    tilt: float, aperture: float, falloff: str, rings: int = 24, spokes: int = 64
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points p, q and weights (sum 1) that integrate smooth functions over the kernel.

    The level sets of k are ellipses: p = C - ((1 - k) OC + k A cos t), q = k B sin t, with the area
    element k B (A - OC cos t) dk dt. Gauss-Legendre in k, the trapezoidal rule in t.
    """
    shape = ellipse(tilt, aperture)
    nodes, gauss = np.polynomial.legendre.leggauss(rings)
    k = (nodes[:, None] + 1) / 2
    t = 2 * np.pi * (np.arange(spokes)[None, :] + 0.5) / spokes
    p = shape.C - ((1 - k) * shape.OC + k * shape.A * np.cos(t))
    q = k * shape.B * np.sin(t)
    weight = falloff_weight(k, falloff) * gauss[:, None] * k * (shape.A - shape.OC * np.cos(t))
    return p.ravel(), q.ravel(), (weight / weight.sum()).ravel()


def moments(tilt: float, aperture: float, falloff: str = "linear") -> tuple[float, float, float]:
    """Return the kernel's mean along L' and its variances along and across it, for d = 1.

    Parameters
    ----------
    tilt, aperture : float
        Degrees; 0 <= tilt < 90 - aperture.
    falloff : str
        ``linear`` (Eq. 10) or ``gaussian`` (Fig. 7b).
    """
    p, q, weight = kernel_points(tilt, aperture, falloff)
    mean = float(weight @ p)
    return mean, float(weight @ (p - mean) ** 2), float(weight @ q**2)


def characteristic_function(
    kx: np.ndarray, ky: np.ndarray, tilt: float, aperture: float, rotation: float, falloff: str, scale: float
) -> np.ndarray:
    """Return sum_o w(o) exp(i k . o) of the kernel centred on its centroid.

    Multiplying the Fourier transform of T by it gives that of ``sum_o w(o) T(x + o)``: what a point sees of
    the slice nearer to the light.

    Parameters
    ----------
    kx, ky : ndarray
        Angular frequencies to the right and up, per unit of length; broadcast together.
    scale : float
        Slice distance in the same unit of length.
    """
    p, q, weight = kernel_points(tilt, aperture, falloff, rings=12, spokes=32)
    p = p - weight @ p
    phi = math.radians(rotation)
    right = (p * math.cos(phi) - q * math.sin(phi)) * scale
    up = (p * math.sin(phi) + q * math.cos(phi)) * scale
    kx, ky = np.broadcast_arrays(kx, ky)
    total = np.zeros(kx.shape, dtype=complex)
    for x, y, w in zip(right, up, weight, strict=True):
        total += w * np.exp(1j * (kx * x + ky * y))
    return total


def cone_directions(tilt: float, aperture: float, rotation: float, count: int) -> np.ndarray:
    """Return unit vectors towards the light, uniform in solid angle within its cone: a golden spiral.

    Parameters
    ----------
    tilt, aperture, rotation : float
        Degrees.

    Returns
    -------
    ndarray, shape (count, 3)
        In the camera's (right, up, back).
    """
    index = np.arange(count)
    cosine = 1 - (index + 0.5) / count * (1 - math.cos(math.radians(aperture)))
    return _about_axis(cosine, index * math.pi * (3 - math.sqrt(5)), tilt, rotation)


def cone_quadrature(
    tilt: float, aperture: float, nodes: int = 32, spokes: int = 128
) -> tuple[np.ndarray, np.ndarray]:
    """Return directions (n, 3) and weights (sum 1) that integrate over a cone at rotation 0."""
    gauss_nodes, gauss = np.polynomial.legendre.leggauss(nodes)
    low = math.cos(math.radians(aperture))
    cosine = np.repeat(low + (1 - low) * (gauss_nodes + 1) / 2, spokes)
    angle = np.tile(2 * np.pi * (np.arange(spokes) + 0.5) / spokes, nodes)
    return _about_axis(cosine, angle, tilt, 0.0), np.repeat(gauss / gauss.sum() / spokes, spokes)


def _about_axis(cosine: np.ndarray, angle: np.ndarray, tilt: float, rotation: float) -> np.ndarray:
    """Return directions at an angle (by cosine) from the light's axis, and at an angle about it."""
    alpha, phi = math.radians(tilt), math.radians(rotation)
    axis = np.array([math.sin(alpha) * math.cos(phi), math.sin(alpha) * math.sin(phi), math.cos(alpha)])
    side = np.array([-math.sin(phi), math.cos(phi), 0.0])
    other = np.cross(axis, side)
    sine = np.sqrt(np.maximum(1 - cosine**2, 0))
    about = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * other
    return np.asarray(cosine[:, None] * axis + sine[:, None] * about)
