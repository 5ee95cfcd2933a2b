"""What extinction-based light costs by itself: its tables and caches, and its shells beside explicit sampling."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import sfumato
from sfumato.gpu import LAYERED, Variants
from sfumato.renderer import FULL
from sfumato.techniques.extinction.field import Field, FieldMaker, draw_layers, new_texture
from sfumato.techniques.extinction.params import ExtinctionParams
from sfumato.techniques.extinction.passes import ExtinctionPainter
from sfumato.techniques.extinction.terms import TermMaker, densities
from sfumato.techniques.frame import Frame
from sfumato.techniques.marcher import prepare_material
from sfumato.techniques.world_light import CellGrid, grid_over

from .contender import Unavailable
from .ours import Ours
from .setting import Setting

#: Pixels along a side of the picture that is drawn beside what is measured: next to nothing.
SPECK = 8
#: Cells along a side, and the radius in cells, at which shells and explicit sampling are compared.
CELLS, RADIUS = 64, 7
SHELLS = 3


class Building(Ours):
    """The whole light of `extinction` made anew at each draw: cells, table, shells, cones and light cache.

    Parameters
    ----------
    cells : int
        Along the cache's longest side; with fewer voxels than that it takes no part.
    """

    def __init__(self, renderer: sfumato.Renderer, setting: Setting, cells: int) -> None:
        if cells > setting.size:
            raise Unavailable(f"the volume has but {setting.size} voxels along a side")
        super().__init__(renderer, setting, "extinction", changes={"technique.resolution": cells})
        self._whole = self._size

    def draw(self) -> None:
        """Make the light, and draw a speck of a picture by it."""
        painter = self._renderer.painter(self._scene)
        assert isinstance(painter, ExtinctionPainter)
        self._renderer.device.make_current()
        painter.forget()
        self._size = self._whole if self._keep else (SPECK, SPECK)
        super().draw()


class Neighbourhood:
    """The light from all around alone: by shells, or by a look at each cell of a ball around each cell."""

    def __init__(self, renderer: sfumato.Renderer, setting: Setting, explicit: bool) -> None:
        self._device = renderer.device
        self._device.make_current()
        technique = ExtinctionParams(shells=SHELLS)
        self._frame, self._grid, self._field = _field(renderer, setting.scene("extinction"), technique)
        self._radius = (RADIUS + 0.5) * self._grid.cell_mm
        self._texture = new_texture(self._device, self._grid.size, 4, "nu2")
        self._terms = TermMaker(self._device)
        folder = "techniques/extinction/"
        self._looking = (
            Variants(self._device, folder + "neighbourhood.frag.glsl", *LAYERED) if explicit else None
        )

    def settle(self) -> None:
        """Draw once: textures are in memory and shaders at hand, as those of all other rows."""
        self.draw()

    def draw(self) -> None:
        """Fill the texture."""
        self._device.make_current()
        for _ in self._passes():
            pass
        self._device.wait()

    def _passes(self) -> Iterator[float]:
        field, grid, params = self._field, self._grid, self._frame.params
        if self._looking is None:
            return self._terms.ambient(field, grid, params, self._radius, self._texture, spread=False)
        program = self._looking.get((("RADIUS", RADIUS), ("WEIGHED", 0)))
        assert field.dimming is not None
        program.bind(u_source=field.dimming.cells, u_near=field.near)
        program.set(u_edge_mm=grid.cell_mm, u_strength=params.shell_strength)
        return draw_layers(self._device, program, self._texture)

    def cells(self) -> np.ndarray:
        """Draw, and return the light of each cell, shape (z, y, x, 3)."""
        self.draw()
        shape = (*self._grid.size[::-1], 4)
        return np.frombuffer(self._texture.read(), dtype=np.uint16).reshape(shape)[..., :3] / 65535

    def light(self) -> np.ndarray:
        """Return a slice through the middle."""
        cells = self.cells()
        return np.asarray(cells[len(cells) // 2], dtype=np.float32)


def _field(renderer: sfumato.Renderer, scene: sfumato.Scene, technique: Any) -> tuple[Frame, CellGrid, Field]:
    """Return the matter of a scene on `CELLS` cells along the longest side."""
    device, lit = renderer.device, scene.with_(technique=technique)
    frame = Frame(device, lit, (SPECK, SPECK), None, FULL)  # type: ignore[arg-type]
    material = prepare_material(frame)
    grid = grid_over(frame, material, CELLS)
    field = Field(device, grid.size, True, frame.volume.unit_distance)
    longest = float(np.max(np.asarray(frame.volume.dims) * frame.volume.spacing))
    maker = FieldMaker(device)
    for _ in maker.make(frame, material, grid, densities(longest, RADIUS * grid.cell_mm), field):
        pass
    maker.release()
    return frame, grid, field
