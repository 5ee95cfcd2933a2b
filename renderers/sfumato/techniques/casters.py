"""What stands in a lamp's way in a sweep: the volume, and geometry as coverage of texels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .tiles import Blocks


@dataclass(frozen=True)
class Casters:
    """What else than the volume stands in a lamp's way, and whether the volume does.

    Attributes
    ----------
    cover : texture or None
        How much of each texel geometry covers, the slabs side by side (`combined.cover`).
    columns : int
        Slabs in a row of it.
    opacity : float
        What geometry that covers a texel takes away.
    blocks : tuple of (centres, half extents)
        Where geometry stands.
    volume : bool
        Whether the volume casts shadows.
    """

    cover: Any = None
    columns: int = 1
    opacity: float = 1.0
    blocks: tuple[Blocks, ...] = ()
    volume: bool = True


VOLUME_ALONE = Casters()


def cover_corners(
    slab: int, columns: int, size: tuple[int, int], *, back: int = -1, slabs: int = 1 << 30
) -> np.ndarray:
    """Return where in a picture of coverage a slab lies and the two that light met before; -1 where there is none.

    Parameters
    ----------
    back : int
        From a slab to the one that light met before.
    """
    corners = np.full((3, 2), -1, np.int32)
    for k in range(3):
        at = slab + back * k
        if 0 <= at < slabs:
            corners[k] = at % columns * size[0], at // columns * size[1]
    return corners
