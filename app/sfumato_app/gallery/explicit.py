"""Light from all around by a look at each cell around each cell, beside shells (Schlegel2011, Fig. 2)."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import numpy as np

import sfumato
from sfumato.gpu import LAYERED, Device, Variants
from sfumato.techniques.extinction.field import Field
from sfumato.techniques.extinction.params import ExtinctionParams
from sfumato.techniques.extinction.passes import ExtinctionPainter
from sfumato.techniques.extinction.terms import TermMaker, depth_of_box
from sfumato.techniques.world_light import CellGrid


class LookingTerms(TermMaker):
    """The terms of `extinction`, but that from all around without shells."""

    def __init__(self, device: Device) -> None:
        super().__init__(device)
        self._looking = Variants(device, "techniques/extinction/neighbourhood.frag.glsl", *LAYERED)

    def ambient(
        self,
        field: Field,
        grid: CellGrid,
        params: ExtinctionParams,
        radius: float,
        texture: Any,
        spread: bool = True,
    ) -> Generator[float, None, None]:
        """Fill a texture with light from all around, as far as cubes of a half edge reach in the mean."""
        reach = round(depth_of_box(np.full(3, radius)) / grid.cell_mm - 0.5)
        program = self._looking.get((("RADIUS", reach), ("WEIGHED", int(spread))))
        assert field.dimming is not None
        program.bind(u_source=field.dimming.cells, u_near=field.near)
        program.set(u_edge_mm=grid.cell_mm, u_strength=params.shell_strength)
        yield from self._finish(field, grid, program, texture, spread)

    def release(self) -> None:
        """Free the programs."""
        self._looking.release()
        super().release()


def draw_explicit(scene: sfumato.Scene, size: tuple[int, int]) -> np.ndarray:
    """Draw a scene of `extinction` in this way; uint8, shape (height, width, 3)."""
    renderer = sfumato.Renderer()
    try:
        painter = renderer.painter(scene)
        assert isinstance(painter, ExtinctionPainter)
        painter.terms.release()
        painter.terms = LookingTerms(renderer.device)
        accumulation = renderer.begin(scene, size)
        for _ in range(scene.frames):
            for _ in accumulation.add_frame():
                pass
        picture = accumulation.picture()
        accumulation.release()
    finally:
        renderer.close()
    return np.ascontiguousarray(picture[..., :3])
