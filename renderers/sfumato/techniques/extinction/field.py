"""The extinction of a volume on a grid of cells, and its summed-area table (Schlegel2011, 3.1).

The paper adds up by recursive doubling: log2(n) passes over all cells for each axis. Here each axis takes one
pass, layer by layer, four layers a draw; what a layer is turned by makes the next axis the first, so that one
shader serves all three (``docs/benchmark.md`` compares the two). Numbers are whole quanta in 32 bits, which wrap
around: sums over boxes are differences, and exact whatever the table's size.
"""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass, field
from typing import Any

import moderngl
import numpy as np

from ...gpu import LAYERED, Device, LayerTarget, Program, Target, Variants
from ..frame import Frame
from ..marcher import Material, bind_material, material_defines
from ..world_light import MULTIPLE, CellGrid

#: Largest sum that the table's quanta are chosen for.
LARGEST_SUM = 0.99 * (2**32 - 1)
#: Most samples along a cell's edge for its mean extinction.
MOST_SAMPLES = 4
#: Voxels within which a surface's opacity rises.
SURFACE = 1.5
#: Layers drawn before a newer scene is looked for.
LAYERS_PER_PIECE = 16


def lift(grid: CellGrid, voxel: float) -> float:
    """Return how far before a surface, in mm, its light is looked up.

    Far enough to leave the voxels in which its opacity rises: within them light is dimmed already, the more the
    finer the cells are, and a surface would be the darker the higher the resolution.

    Parameters
    ----------
    voxel : float
        The volume's mean spacing, mm.
    """
    return max(grid.cell_mm, SURFACE * voxel)


@dataclass
class Table:
    """Means of cells, and the sums over all cells up to each.

    Attributes
    ----------
    cells : texture
        Optical depth per cell, four kinds; see ``cells.frag.glsl``.
    sums : texture
        The same added up, in quanta.
    quantum : ndarray, shape (4,)
        What a quantum stands for, per channel.
    """

    cells: Any
    sums: Any = None
    quantum: np.ndarray = field(default_factory=lambda: np.ones(4, dtype=np.float32))

    def bind(self, program: Program) -> None:
        """Let a program read the sums (``sums.glsl``)."""
        program.bind(u_sums=self.sums)
        program.set(u_cells=self.sums.size, u_quantum=tuple(self.quantum.tolist()))

    def release(self) -> None:
        """Free the textures."""
        self.cells.release()
        if self.sums is not None:
            self.sums.release()


class Field:
    """The matter of a volume on a grid of cells.

    Attributes
    ----------
    matter : Table
        Thin matter, dense matter, share that is dense, surface of what is dense.
    dimming : Table or None
        What dims light from all around, of each colour, if there is such light.
    near : texture
        How open cells are to light that is carried on; 0 where light does not matter.
    voxel : float
        The volume's mean spacing, mm.
    reach : int
        Cells around what is visible in which light matters.
    """

    reach = 0

    def __init__(self, device: Device, size: tuple[int, int, int], ambient: bool, voxel: float) -> None:
        self.device, self.size, self.voxel = device, size, voxel
        self.matter = Table(new_texture(device, size, 4, "f2"))
        self.dimming = Table(new_texture(device, size, 4, "f2")) if ambient else None
        self.near = new_texture(device, size, 1, "f2")

    @property
    def tables(self) -> tuple[Table, ...]:
        """All tables."""
        return (self.matter,) if self.dimming is None else (self.matter, self.dimming)

    def release(self) -> None:
        """Free the textures."""
        for table in self.tables:
            table.release()
        self.near.release()


def new_texture(
    device: Device, size: tuple[int, int, int], channels: int, dtype: str, linear: bool = False
) -> Any:
    """Make a 3D texture that ends at its edges."""
    width = int(dtype[-1]) * channels
    with device.checked(f"{math.prod(size) * width >> 20} MiB for the light cache", "smaller volume"):
        texture = device.ctx.texture3d(size, channels, dtype=dtype)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR) if linear else (moderngl.NEAREST, moderngl.NEAREST)
    texture.repeat_x = texture.repeat_y = texture.repeat_z = False
    return texture


class FieldMaker:
    """Fills fields; keeps its programs."""

    def __init__(self, device: Device) -> None:
        self.device = device
        folder = "techniques/extinction/"
        self._cells = Variants(device, folder + "cells.frag.glsl", *LAYERED)
        self._total = Variants(device, folder + "total.frag.glsl")
        self._scan = Variants(device, folder + "scan.frag.glsl")
        self._edges = Variants(device, folder + "edges.frag.glsl", *LAYERED)
        self._near = Variants(device, folder + "near.frag.glsl", *LAYERED)

    def make(
        self, frame: Frame, material: Material, grid: CellGrid, densities: tuple[float, float], made: Field
    ) -> Generator[float, None, None]:
        """Fill a field, yielding the share done.

        Parameters
        ----------
        densities : (float, float)
            Extinction per mm from which matter counts as dense, and the largest one that counts for light from
            all around.
        """
        for done in self._fill_cells(frame, material, grid, densities, made):
            yield 0.6 * done
        share = 0.35 / len(made.tables)
        for number, table in enumerate(made.tables):
            # The largest quanta that keep the sum over all cells, and so over any box of them, within 32 bits.
            scale = np.minimum(LARGEST_SUM / np.maximum(self._totals(table), 1e-30), 2.0**24)
            table.quantum = (1 / scale).astype(np.float32)
            for done in self._add_up(table, scale):
                yield 0.6 + share * (number + done)
        near = self._near.get(())
        made.matter.bind(near)
        near.bind(u_matter=made.matter.cells)
        # Light is looked up as far from a surface as `lift` says, between cells, and carried on from one more.
        made.reach = 2 + math.ceil(lift(grid, made.voxel) / grid.cell_mm - 1e-6)
        near.set(u_reach=made.reach)
        for done in draw_layers(self.device, near, made.near):
            yield 0.95 + 0.05 * done

    def _fill_cells(
        self, frame: Frame, material: Material, grid: CellGrid, densities: tuple[float, float], made: Field
    ) -> Generator[float, None, None]:
        per_edge = np.max(np.asarray(grid.edges_mm) / frame.volume.spacing)
        samples = int(np.clip(round(per_edge), 2, MOST_SAMPLES))
        program = self._cells.get(
            (("SUB", samples), ("AMBIENT", len(made.tables) - 1), *material_defines(material))
        )
        bind_material(program, material, frame)
        dense, limit = densities
        program.set(
            u_first=grid.low, u_cell=grid.edges, u_length=grid.cell_mm, u_dense=dense, u_limit=limit,
            u_bleeding=frame.params.bleeding,
        )  # fmt: skip
        raw = new_texture(self.device, grid.size, 4, "f2")
        try:
            for done in draw_layers(self.device, program, raw, *(t.cells for t in made.tables[1:])):
                yield 0.9 * done
            edges = self._edges.get(())
            edges.bind(u_source=raw)
            for done in draw_layers(self.device, edges, made.matter.cells):
                yield 0.9 + 0.1 * done
        finally:
            raw.release()

    def _totals(self, table: Table) -> np.ndarray:
        """Return the sums over all cells."""
        target = Target(self.device, table.cells.size[:2])
        program = self._total.get(())
        program.bind(u_source=table.cells)
        target.fbo.use()
        program.draw()
        totals = target.read().astype(float).sum(axis=(0, 1))
        target.release()
        return np.asarray(totals)

    def _add_up(self, table: Table, scale: np.ndarray) -> Generator[float, None, None]:
        """Scan the three axes; a texture turned by one axis is scanned along its first into the next."""
        x, y, z = table.cells.size
        sizes = ((y, z, x), (z, x, y), (x, y, z))
        passes, done = sum(size[2] for size in sizes) // MULTIPLE, 0
        textures = [table.cells]
        try:
            for number, size in enumerate(sizes):
                textures.append(new_texture(self.device, size, 4, "u4"))
                for _ in self._scan_axis(textures[-2], textures[-1], scale if number == 0 else None):
                    done += 1
                    yield done / passes
                if number > 0:
                    textures.pop(-2).release()
            table.sums = textures.pop()
        finally:
            for texture in textures[1:]:
                texture.release()

    def _scan_axis(self, source: Any, result: Any, scale: np.ndarray | None) -> Generator[None, None, None]:
        size, channels = result.size, result.components
        program = self._scan.get((("QUANTISE", int(scale is not None)),))
        states = [self.device.ctx.texture(size[:2], channels, dtype="u4") for _ in range(2)]
        for state in states:
            state.filter = (moderngl.NEAREST, moderngl.NEAREST)
        targets = [LayerTarget(self.device, state, layers=MULTIPLE) for state in states]
        program.bind(u_source=source)
        if scale is not None:
            program.set(u_scale=tuple(scale.tolist()))
        try:
            for layer in range(0, size[2], MULTIPLE):
                number = layer // MULTIPLE
                program.bind(u_state=states[1 - number % 2])
                program.set(u_layer=layer, u_start=layer == 0)
                targets[number % 2].use(result, layer)
                program.draw()
                if number % LAYERS_PER_PIECE == LAYERS_PER_PIECE - 1:
                    self.device.wait()
                yield
        finally:
            for target in targets:
                target.release()
            for state in states:
                state.release()

    def release(self) -> None:
        """Free the programs."""
        for programs in (self._cells, self._edges, self._total, self._scan, self._near):
            programs.release()


def draw_layers(device: Device, program: Any, *textures: Any) -> Generator[float, None, None]:
    """Draw all layers of 3D textures of one size with a program of `LAYERED`, yielding the share done."""
    width, height, depth = textures[0].size
    target = LayerTarget(device, layers=len(textures), size=(width, height))
    try:
        for first in range(0, depth, LAYERS_PER_PIECE):
            count = min(LAYERS_PER_PIECE, depth - first)
            # Elsewhere something else may have been bound since the last piece.
            target.use_all(textures)
            program.draw_layers(first, count)
            device.wait()
            yield (first + count) / depth
    finally:
        target.release()
