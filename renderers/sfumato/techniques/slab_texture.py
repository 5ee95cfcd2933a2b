"""What a slab returns of each light, as a texture (``methods.md``, open point 3a; `footprint.slab_table`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import moderngl

from ..gpu import Device, Program
from .footprint import slab_table
from .frame import Frame
from .marcher import max_secant


class SlabTexture:
    """The table of the present lamps."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._key: Any = None
        self._texture: Any = None

    def bind(
        self, program: Program, frame: Frame, tilts: Sequence[float], apertures: Sequence[float]
    ) -> None:
        """Give a ray caster the table of lamps with these tilts and apertures in degrees."""
        cones, secant = tuple(zip(tilts, apertures, strict=True)), max_secant(frame)
        if self._key != (cones, secant):
            self.release()
            table = slab_table(cones, secant)
            self._texture = self.device.ctx.texture((table.shape[1], table.shape[0]), 4, table, dtype="f4")
            self._texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self._texture.repeat_x = self._texture.repeat_y = False
            self._key = (cones, secant)
        program.set(u_slab_secant_max=secant)
        program.bind(u_slab_term=self._texture)

    def release(self) -> None:
        """Free the texture."""
        if self._texture is not None:
            self._texture.release()
        self._texture = self._key = None
