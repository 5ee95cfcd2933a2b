"""The terms of the light: from all around by shells, from each lamp by cones (Schlegel2011, 3.2 and 3.3)."""

from __future__ import annotations

import functools
import math
from collections.abc import Generator
from typing import Any

import numpy as np

from ...gpu import Device, Variants
from ..world_light import CellGrid
from .field import Field, draw_layers, new_texture
from .lamps import Emitter
from .params import ExtinctionParams

#: How much finer the shells are near the point that they surround.
SHELL_GROWTH = 1.5
#: Optical depth of half the outermost shell's edge beyond which matter takes away no more light from all around.
#: The shells' sum stands for all directions at once: a dense thing to one side must not darken the other.
DEPTH_LIMIT = 2.0


#: Voxels by which light is carried on into the matter of a surface, and the most passes that it may take.
SPREAD, MOST_SPREADS = 2.0, 4
#: Optical depth of a hundredth of the volume's longest side from which matter counts as dense.
DENSE = 1.0


def densities(longest: float, radius: float) -> tuple[float, float]:
    """Return the extinction per mm from which matter is dense, and the most that counts for light from all around.

    Parameters
    ----------
    longest : float
        The volume's longest side in mm.
    radius : float
        Half the edge of the outermost shell in mm.
    """
    return DENSE / (0.01 * longest), DEPTH_LIMIT / radius


@functools.cache
def _sphere() -> np.ndarray:
    """Return directions spread evenly over the sphere, shape (4096, 3)."""
    count = 4096
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, k * math.pi * (3 - math.sqrt(5))
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)


def depth_of_box(half: np.ndarray) -> float:
    """Return the mean way in mm from a box's centre to its surface, over all directions.

    It is the integral of 1 / (4 pi r^2) over the box: the mean optical depth of a box of extinction 1 / mm.

    Parameters
    ----------
    half : ndarray, shape (3,)
        Half its edges in mm.
    """
    with np.errstate(divide="ignore"):
        return float((half / np.abs(_sphere())).min(axis=1).mean())


def lay_shells(grid: CellGrid, count: int, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the shells' boxes and what they count for.

    Parameters
    ----------
    count : int
        Shells wanted; of those that are alike in whole cells one is left.
    radius : float
        Half the edge of the outermost box, mm.

    Returns
    -------
    half : ndarray of int, shape (n, 3)
        Half sizes of the boxes in cells, beyond the cell itself.
    weight : ndarray, shape (n,)
        Mean optical depth for a sum of 1 of the cells' optical depths in a shell.
    """
    edges = np.asarray(grid.edges_mm)
    radii = radius * (np.arange(1, count + 1) / count) ** SHELL_GROWTH
    half = np.maximum(np.rint(radii[:, None] / edges - 0.5), 1).astype(int)
    half = np.unique(half, axis=0)
    depths = np.array([depth_of_box(edges / 2), *(depth_of_box((h + 0.5) * edges) for h in half)])
    cells = np.array([1.0, *np.prod(2 * half + 1, axis=1)])
    # A shell's mean extinction counts for its mean way; a sum over cells is of extinction times the cell's edge.
    weight = np.diff(depths) / np.diff(cells) / grid.cell_mm
    # Whole cells fall short of the radius, or exceed it, and the cell itself is left out: the whole is kept.
    weight *= depth_of_box(np.full(3, radius)) / (depths[-1] - depths[0])
    return half, weight


class TermMaker:
    """Fills textures with the light that reaches each cell; keeps its programs."""

    def __init__(self, device: Device) -> None:
        self.device = device
        folder = "techniques/extinction/"
        self._ambient = Variants(device, folder + "ambient.frag.glsl")
        self._lamp = Variants(device, folder + "lamp.frag.glsl")
        self._spread = Variants(device, folder + "spread.frag.glsl")

    def ambient(
        self,
        field: Field,
        grid: CellGrid,
        params: ExtinctionParams,
        radius: float,
        texture: Any,
        spread: bool = True,
    ) -> Generator[float, None, None]:
        """Fill a texture with light from all around, linear RGB, yielding the share done.

        Parameters
        ----------
        radius : float
            Half the edge of the outermost shell, mm.
        spread : bool
            Whether it is carried on into the cells of surfaces.
        """
        half, weight = lay_shells(grid, params.shells, radius)
        program = self._ambient.get((("SHELLS", len(half)),))
        assert field.dimming is not None
        field.dimming.bind(program)
        program.bind(u_near=field.near, u_means=field.dimming.cells)
        program.set(u_half=half, u_weight=weight.astype(np.float32), u_strength=params.shell_strength)
        if spread:
            yield from self._draw_and_spread(field, grid, program, texture)
        else:
            yield from draw_layers(self.device, program, texture)

    def lamp(
        self, field: Field, grid: CellGrid, params: ExtinctionParams, lamp: Emitter, texture: Any
    ) -> Generator[float, None, None]:
        """Fill a texture with the share of a lamp's light that reaches each cell, yielding the share done."""
        program = self._lamp.get((("POINTS", int(lamp.points)), ("CONES", params.cones)))
        field.matter.bind(program)
        program.bind(u_near=field.near)
        program.set(
            u_edge_mm=grid.edges_mm, u_cell_mm=grid.cell_mm, u_strength=params.strength,
            u_first=max(1.0, max(grid.size) / params.samples), u_growth=params.growth, **lamp.uniforms,
        )  # fmt: skip
        yield from self._draw_and_spread(field, grid, program, texture)

    def _draw_and_spread(
        self, field: Field, grid: CellGrid, program: Any, texture: Any
    ) -> Generator[float, None, None]:
        """Draw a term, and carry its light on to the cells of surfaces, as far at any resolution."""
        passes = int(np.clip(round(SPREAD * field.voxel / grid.cell_mm), 1, MOST_SPREADS))
        scratch = new_texture(self.device, texture.size, texture.components, "nu2")
        try:
            source, target = (scratch, texture) if passes % 2 else (texture, scratch)
            for done in draw_layers(self.device, program, source):
                yield 0.7 * done
            spread = self._spread.get(())
            spread.bind(u_matter=field.matter.cells, u_near=field.near)
            for number in range(passes):
                spread.bind(u_light=source)
                for done in draw_layers(self.device, spread, target):
                    yield 0.7 + 0.3 * (number + done) / passes
                source, target = target, source
        finally:
            scratch.release()

    def release(self) -> None:
        """Free the programs."""
        for programs in (self._ambient, self._lamp, self._spread):
            programs.release()
