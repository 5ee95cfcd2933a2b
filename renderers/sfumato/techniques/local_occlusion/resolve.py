"""The light of packed blocks resolved into one texture in the volume's own space, for the ray caster.

Joining light between blocks takes up to eight look-ups of the index and nine of the map, for every sample of every
picture. Light changes only while it is gathered; so it is joined once a picture at most, for each cell of the finest
level, and each sample then takes one look-up. Sums are kept, not means: their weights count between cells, too.
"""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import numpy as np

from ...gpu import Device, LayerTarget, Program, Variants
from ..frame import Frame
from .blocks import Blocks, is_whole
from .gather import LightMap
from .packing import HIDDEN
from .pyramid import EDGE

#: Part of a device's budget that it may take; where it would be more, samples look into the packed blocks.
SHARE = 0.25


class ResolvedLight:
    """Mean over directions of light and weight, over the box of blocks that hold anything.

    Attributes
    ----------
    texture
        As a light map's, per direction.
    corner : ndarray, shape (3,)
        First block of the box along x, y and z.
    blocks : ndarray, shape (3,)
        Blocks of the box.
    """

    def __init__(self, device: Device, corner: np.ndarray, blocks: np.ndarray, colored: bool) -> None:
        self.corner, self.blocks = corner, blocks
        size = tuple((blocks * EDGE).tolist())
        channels = 4 if colored else 2
        self.size = resolved_bytes(blocks, colored)
        with device.checked(f"{self.size >> 20} MiB for light in the volume's space", "smaller volume"):
            self.texture = device.ctx.texture3d(size, channels, dtype="f2")
        self.texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        # Beyond the box are empty blocks alone: what is visible there belongs to the box's outermost cells.
        self.texture.repeat_x = self.texture.repeat_y = self.texture.repeat_z = False
        if not colored:
            self.texture.swizzle = "RRRG"
        self._source: LightMap | None = None
        self._state = (-1, -1)

    def shows(self, light: LightMap) -> bool:
        """Tell whether it is the resolved form of a map as that is now."""
        return self._source is light and self._state == (light.done, light.slab)

    def mark(self, light: LightMap) -> None:
        """Note of what it is now the resolved form."""
        self._source, self._state = light, (light.done, light.slab)

    def bind(self, program: Program, blocks_per_unit: np.ndarray) -> None:
        """Set what ``local_light.glsl`` needs to read it."""
        program.bind(u_map=self.texture)
        program.set(
            u_map_scale=tuple((blocks_per_unit / self.blocks).tolist()),
            u_map_offset=tuple((-self.corner / self.blocks).tolist()),
        )

    def release(self) -> None:
        """Free the texture."""
        self.texture.release()


class Resolver:
    """Brings light maps into the volume's space; keeps its programs."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._programs = Variants(device, "techniques/local_occlusion/resolve.frag.glsl")

    def resolved(self, frame: Frame, blocks: Blocks, light: LightMap) -> ResolvedLight | None:
        """Return the place for a map's resolved form; None where there is no room for it, or blocks are apart."""
        corner, size = held_box(blocks)
        wanted, store = resolved_bytes(size, light.colored), self.device.store
        if not frame.params.joined or not is_whole(frame) or wanted > SHARE * store.budget:
            return None
        if max(size) * EDGE > self.device.max_texture_3d:
            return None
        key = ("local light, resolved", *light.key)
        return store.get(
            key, lambda: ResolvedLight(self.device, corner, size, light.colored), lambda r: r.size
        )

    def resolve(
        self, frame: Frame, blocks: Blocks, light: LightMap, result: ResolvedLight
    ) -> Iterator[float]:
        """Bring it up to date if it is not, yielding the share done after each row of blocks."""
        if result.shows(light):
            return
        program = self._programs.get((("COLORED", int(light.colored)),))
        blocks.bind(program, frame)
        program.bind(u_map=light.texture)
        program.set(u_corner=tuple((result.corner * EDGE).tolist()), u_scale=1 / max(light.done, 1))
        target = LayerTarget(self.device, layers=1, size=result.texture.size[:2])
        rows = int(result.blocks[2])
        try:
            for row in range(rows):
                for layer in range(row * EDGE, (row + 1) * EDGE):
                    target.use(result.texture, layer)
                    program.set(u_layer=layer)
                    program.draw()
                self.device.wait()
                yield (row + 1) / rows
        finally:
            target.release()
        result.mark(light)

    def release(self) -> None:
        """Free the programs."""
        self._programs.release()


def held_box(blocks: Blocks) -> tuple[np.ndarray, np.ndarray]:
    """Return the first block and the number of blocks along x, y and z of the box of all that are not empty."""
    at = np.argwhere(blocks.packing.levels < HIDDEN)[:, ::-1]
    if len(at) == 0:
        return np.zeros(3, dtype=int), np.ones(3, dtype=int)
    return at.min(axis=0), np.ptp(at, axis=0) + 1


def resolved_bytes(blocks: np.ndarray, colored: bool) -> int:
    """Return the bytes of the resolved light of a box of blocks."""
    return int(np.prod(blocks)) * EDGE**3 * (8 if colored else 4)
