"""How much of each texel geometry covers, slab by slab of a lamp's lattice, hidden geometry too."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ...errors import GpuError
from ...gpu import Device, Variants
from ..stack import Lattice
from .surfels import Surfels

ATTRIBUTES = ("a_p", "a_facing", "a_diagonal", "a_mixed")
BYTES_PER_TEXEL = 2
#: Surfels that are drawn between two looks at whether a newer scene is there.
PIECE = 1 << 18


@dataclass(frozen=True)
class Atlas:
    """The layers of a lattice side by side in one picture."""

    size: tuple[int, int]
    slabs: int
    columns: int

    @staticmethod
    def of(device: Device, lattice: Lattice) -> Atlas:
        """Lay out a lattice's slabs.

        Raises
        ------
        GpuError
            If the device has no texture large enough.
        """
        limit, (width, height), slabs = device.max_texture_2d, lattice.size, lattice.stack.count
        columns = max(1, min(limit // width, math.ceil(math.sqrt(slabs * height / width))))
        atlas = Atlas((width, height), slabs, columns)
        if max(atlas.picture) > limit:
            raise GpuError(f"shadows of geometry on {atlas.picture[0]} x {atlas.picture[1]} texels",
                           f"{device.name} offers {limit}; lower the shadow resolution")  # fmt: skip
        return atlas

    @property
    def picture(self) -> tuple[int, int]:
        """Texels of the picture."""
        return self.columns * self.size[0], -(-self.slabs // self.columns) * self.size[1]


class CoverMaker:
    """Draws surfels into atlases."""

    def __init__(self, device: Device) -> None:
        self.device = device
        folder = "techniques/combined/"
        self._programs = Variants(device, folder + "cover.frag.glsl", folder + "cover.vert.glsl")

    def new_texture(self, atlas: Atlas) -> Any:
        """Make an atlas's texture."""
        width, height = atlas.picture
        with self.device.checked(f"{width * height * BYTES_PER_TEXEL >> 20} MiB for shadows of geometry"):
            texture = self.device.ctx.texture((width, height), 1, dtype="f2")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = False
        return texture

    def fill(
        self,
        lattice: Lattice,
        atlas: Atlas,
        towards: np.ndarray,
        casters: Sequence[Surfels],
        texture: Any,
    ) -> Iterator[float]:
        """Draw casters, yielding after each bounded piece."""
        program = self._programs.get(())
        # What a texel of a plane lets through of slanting light is narrower than the texel.
        texel_area = lattice.texel**2 * abs(float(towards @ lattice.stack.view.axes[2]))
        fbo = self.device.ctx.framebuffer([texture])
        self.device.clear(fbo)
        try:
            for surfels in casters:
                program.set(
                    u_lattice_from_world=_matrix(lattice, surfels.middle), u_towards=tuple(towards.tolist()),
                    u_closed=surfels.closed, u_lattice_size=tuple(map(float, atlas.size)), u_slabs=float(atlas.slabs),
                    u_columns=atlas.columns, u_picture=tuple(map(float, atlas.picture)),
                    u_texel_area=texel_area, u_shear=lattice.shear, u_rear=int(lattice.rear),
                )  # fmt: skip
                for first in range(0, surfels.count, PIECE):
                    self._draw(fbo, surfels, first, min(PIECE, surfels.count - first))
                    self.device.wait()
                    yield 0.0
        finally:
            fbo.release()

    def _draw(self, fbo: Any, surfels: Surfels, first: int, count: int) -> None:
        ctx = self.device.ctx
        fbo.use()
        ctx.enable(moderngl.BLEND)
        ctx.blend_func = moderngl.ONE, moderngl.ONE
        ctx.point_size = 2.0
        try:
            self._programs.get(()).draw_buffers(
                surfels.buffer, "3f4 3f4 3f4 3f4", ATTRIBUTES, None, first, count
            )
        finally:
            ctx.disable(moderngl.BLEND)

    def release(self) -> None:
        """Free the program."""
        self._programs.release()


def _matrix(lattice: Lattice, middle: np.ndarray) -> tuple[float, ...]:
    """Return the 4 x 4, column by column, from world mm about `middle` to texels at plane 0 and slabs."""
    stack, matrix = lattice.stack, np.eye(4)
    matrix[:3, :3] = stack.view.axes
    matrix[:3, 3] = stack.view.axes @ (middle - stack.view.eye)
    matrix[:2, 3] -= lattice.origin
    matrix[:2] /= lattice.texel
    matrix[2, 3] -= stack.z0
    matrix[2] /= stack.step
    return tuple(matrix.T.ravel().tolist())
