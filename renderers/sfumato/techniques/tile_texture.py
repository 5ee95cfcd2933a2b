"""The lists of tiles as a texture, from which the vertex shader places rectangles."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from ..gpu import Device
from .tiles import TileLists

#: Width of the texture: textures may be as wide everywhere.
TILES_PER_ROW = 1024


class TileTexture:
    """Holds the runs of tiles of one sweep (``shaders/tiles.vert.glsl``)."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.texture: Any = None

    def upload(self, lists: TileLists) -> None:
        """Put other lists in place of the present ones."""
        self.release()
        rows = max(1, -(-len(lists.tiles) // TILES_PER_ROW))
        data = np.zeros((rows * TILES_PER_ROW, 4), dtype=np.int16)
        data[: len(lists.tiles), :3] = lists.tiles
        self.texture = self.device.ctx.texture((TILES_PER_ROW, rows), 4, data, dtype="i2")
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)

    def release(self) -> None:
        """Free the texture."""
        if self.texture is not None:
            self.texture.release()
        self.texture = None
