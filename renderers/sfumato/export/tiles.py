"""Pictures larger than a device draws at once: tiles that meet without a seam.

A tile's rays are those of the whole picture to the last bit (`Frame.corner`), and the occlusion methods carry
light on a grid in millimetres that does not know the picture's edges.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Generator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from ..renderer import Accumulation

#: Longest side of a tile in pixels: every OpenGL 3.3 device we know draws it.
TILE_SIDE = 4096
#: Pixels of a tile: about 256 MiB of float targets.
TILE_PIXELS = 1 << 22


class Guest(Protocol):
    """Somebody else who may need the renderer while a long picture is drawn."""

    def waiting(self) -> bool:
        """Tell whether the renderer is wanted; asked after each piece of work."""
        ...

    def serve(self) -> None:
        """Use the renderer; what was begun of the present frame is drawn anew after it."""
        ...


@dataclass(frozen=True)
class Tile:
    """A part of a picture in pixels; ``y`` counts from the top."""

    x: int
    y: int
    width: int
    height: int


def bands_of(
    size: tuple[int, int], side: int = TILE_SIDE, pixels: int = TILE_PIXELS
) -> tuple[tuple[Tile, ...], ...]:
    """Return the tiles of a picture, in bands from top to bottom, each from left to right.

    Parameters
    ----------
    size : (int, int)
        Width and height of the picture in pixels.
    side, pixels : int
        Longest side and largest area of a tile in pixels.
    """
    width, height = size
    columns = _edges(width, min(side, pixels))
    widest = columns[1]
    rows = _edges(height, max(1, min(side, pixels // widest)))
    return tuple(
        tuple(Tile(x, y, right - x, below - y) for x, right in itertools.pairwise(columns))
        for y, below in itertools.pairwise(rows)
    )


def _edges(length: int, longest: int) -> list[int]:
    """Return the edges that cut a length into equal parts, the last a little shorter."""
    part = math.ceil(length / math.ceil(length / longest))
    return [*range(0, length, part), length]


def accumulate(
    accumulation: Accumulation, frames: int, guest: Guest | None = None
) -> Generator[float, None, None]:
    """Draw frames until there are so many, yielding progress (0 to 1); stop iterating to cancel.

    Raises
    ------
    GpuError
        If the device fails.
    """
    while accumulation.frames < frames:
        pieces = accumulation.add_frame()
        try:
            for done in pieces:
                yield (accumulation.frames + done) / frames
                if guest is not None and guest.waiting():
                    break
        finally:
            pieces.close()
        if guest is not None and guest.waiting():
            guest.serve()
