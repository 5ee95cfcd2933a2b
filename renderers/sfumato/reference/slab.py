"""What a homogeneous slab returns of the light in a cone (methods.md, *Sampling distance*, (a)).

``x`` is extinction times thickness (tau d), ``v`` the secant of the view ray and ``s`` that of a direction of
light against the slab's normal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .footprint import cone_quadrature

#: Points of the quadrature over a cone's secants; 16 hold 2e-8 even at 80 deg / 9 deg.
NODES = 16


def front_term(x: np.ndarray, v: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the share of light from the slab's front that leaves to the viewer."""
    return np.asarray(-np.expm1(-x * (v + s)) * v / (v + s))


def rear_term(x: np.ndarray, v: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the share of light from the slab's back that leaves to the viewer.

    ``v (exp(-x v) - exp(-x s)) / (s - v)``, written so that neither s = v nor large x does harm.
    """
    y = x * np.abs(s - v)
    with np.errstate(invalid="ignore", divide="ignore"):
        quotient = np.where(y > 1e-9, -np.expm1(-y) / y, 1 - y / 2)
    return np.asarray(v * x * np.exp(-x * np.minimum(v, s)) * quotient)


@dataclass(frozen=True)
class SecantRule:
    """A Gauss rule over the secants of a cone's directions, uniform in solid angle.

    Attributes
    ----------
    secants, weights : ndarray
        Nodes and weights (sum 1).
    facing : float
        < 1 / (1 + s) >: what an opaque wall that faces the viewer returns; the unit of brightness.
    """

    secants: np.ndarray
    weights: np.ndarray
    facing: float

    @property
    def effective(self) -> float:
        """The one secant with which transmittance is attenuated: 1 / (1 + sec) = < 1 / (1 + s) >."""
        return 1 / self.facing - 1

    def term(self, x: np.ndarray, v: np.ndarray, rear: bool) -> np.ndarray:
        """Return F: the light that leaves a slab, 1 for an opaque wall that faces the viewer."""
        form = rear_term if rear else front_term
        total = np.zeros(np.broadcast_shapes(np.shape(x), np.shape(v)))
        for s, w in zip(self.secants, self.weights, strict=True):
            total += w * form(x, v, s)
        return total / self.facing


def secant_rule(tilt: float, aperture: float, nodes: int = NODES) -> SecantRule:
    """Return the rule of a cone; degrees; 0 <= tilt < 90 - aperture (behind the subject: 180 - tilt)."""
    directions, weights = cone_quadrature(tilt, aperture)
    secants = 1 / np.abs(directions[:, 2])
    facing = float(weights @ (1 / (1 + secants)))
    return SecantRule(*_gauss_rule(secants, weights, nodes), facing)


def _gauss_rule(points: np.ndarray, weights: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the Gauss rule of a discrete measure (Lanczos, then Golub and Welsch).

    The measure is moved to [-1, 1] first; the iteration ends early where the measure has no more points.
    """
    middle, half = (points.max() + points.min()) / 2, (points.max() - points.min()) / 2
    x = (points - middle) / max(half, 1e-300)
    diagonal, beside = [], []
    basis = [np.sqrt(weights / weights.sum())]
    while True:
        current = basis[-1]
        diagonal.append(float(current @ (x * current)))
        rest = x * current
        for vector in (*basis, *basis):  # twice: full orthogonality
            rest = rest - (rest @ vector) * vector
        norm = float(np.linalg.norm(rest))
        if len(diagonal) == count or norm < 1e-8:
            break
        beside.append(norm)
        basis.append(rest / norm)
    matrix = np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1)
    nodes, vectors = np.linalg.eigh(matrix)
    return middle + half * nodes, vectors[0] ** 2
