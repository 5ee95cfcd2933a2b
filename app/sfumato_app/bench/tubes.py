"""Tubes among tissue: what geometry costs beside the volume alone, by its number of triangles."""

from __future__ import annotations

import functools

import numpy as np

from sfumato.scene import Geometry, Lines

from .phantom import EDGE_MM

#: Triangles as in Schott2012's Table 1 (137k, 720k, 7.9M), and one between.
TRIANGLES = {"130k": 130_000, "720k": 720_000, "2M": 2_000_000, "8M": 8_000_000}
SIDES, POINTS = 6, 120
_SEED = 2012


@functools.lru_cache(maxsize=2)
def tubes(triangles: int) -> Geometry:
    """Return bundles of fibres in the benchmark's chest, from its skin to its spine, of about so many triangles.

    They keep within the trunk as a tract does within a brain: what they cost is not that of a larger picture.
    The more lines there are, the thinner they are, as in a tractogram.
    """
    count = max(1, round(triangles / (2 * SIDES * (POINTS - 1) + 2 * (SIDES - 2))))
    random = np.random.default_rng(_SEED)
    t = np.linspace(0, 1, POINTS)
    turn = random.uniform(0, 2 * np.pi, (count, 1))
    # From below to above, winding about the trunk, each in a shell of its own; waves keep all points needed.
    shell, wave = random.uniform(0.08, 0.3, (count, 1)), random.uniform(0, 2 * np.pi, (count, 3, 1))
    angle = turn + 2.5 * t * random.choice([-1, 1], (count, 1))
    lines = np.stack(
        [shell * np.cos(angle), 0.7 * shell * np.sin(angle), 0.64 * (t - 0.5) + 0 * angle], axis=1
    )
    lines += 0.02 * np.sin(60 * t + wave)
    places = (0.5 + lines.transpose(0, 2, 1)) * EDGE_MM
    radius = 0.6 * (TRIANGLES["130k"] / triangles) ** 0.25
    return Geometry(Lines.of(list(places)), radius=radius, sides=SIDES, color_by="direction")
