"""The Poisson disc of the vicinity term."""

from __future__ import annotations

import functools

import numpy as np

#: As many points as Schott2012 takes at most.
POINTS = 118
_CANDIDATES = 2400


@functools.cache
def poisson_disc() -> np.ndarray:
    """Return points spread evenly over the unit disc, shape (118, 2): any first few of them are so too."""
    random = np.random.default_rng(118)
    radius, turn = np.sqrt(random.uniform(0, 1, _CANDIDATES)), random.uniform(0, 2 * np.pi, _CANDIDATES)
    candidates = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    chosen = np.empty((POINTS, 2))
    # The next point is the candidate farthest from all before, and from the rim by half of that.
    away = 2 * (1 - radius)
    for k in range(POINTS):
        chosen[k] = candidates[int(np.argmax(away))]
        away = np.minimum(away, np.linalg.norm(candidates - chosen[k], axis=1))
    chosen.flags.writeable = False
    return chosen


def turned_disc(angle: float) -> np.ndarray:
    """Return the disc turned by an angle in radians, float32."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(poisson_disc() @ np.array([[c, s], [-s, c]]), dtype=np.float32)
