"""The terms of the light: from all around by shells, from each lamp by cones (Schlegel2011, 3.2 and 3.3)."""

from __future__ import annotations

import functools
import math
from collections.abc import Generator
from typing import Any

import numpy as np

from ...gpu import LAYERED, Device, Program, Variants
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
DENSE = 0.3


#: Half size in cells from which a shell counts as far.
FAR_SHELL = 4
#: Parts of the way to a lamp, and of the shells; see ``lamp.frag.glsl`` and ``ambient.frag.glsl``.
WHOLE, FAR, NEAR = 0, 1, 2
#: Layers of cells that are near, at least and at most: up to where the lamp's cone is as wide as two cells. What is far
#: of a wider one changes so little from cell to cell that it is worked out for 2^3 cells at once.
NEAR_LAYERS = (4, 12)


def split_of(params: ExtinctionParams, lamp: Emitter) -> int | None:
    """Return the layers of cells that are near a cell on its way to a lamp; None if the way is not split."""
    split = max(NEAR_LAYERS[0], math.ceil(1 / max(lamp.tangent, 1e-6)))
    return split if params.cones > 1 and split <= NEAR_LAYERS[1] else None


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


def number_close(half: np.ndarray) -> int:
    """Return how many of the shells are close by; those farther out are added up for 2^3 cells at once."""
    return max(1, int((half.max(axis=1) < FAR_SHELL).sum()))


def _fewer_cells(inner: np.ndarray, outer: np.ndarray) -> np.ndarray:
    """Return the cells of shells around a cell's middle over those of shells around the middle of 2^3 cells."""
    boxes = np.vstack([inner, outer])
    odd, even = (np.diff(np.prod(2 * boxes + extra, axis=1).astype(float)) for extra in (1, 0))
    return np.asarray(odd / even)


def _halved(grid: CellGrid) -> tuple[int, int, int]:
    x, y, z = grid.size
    return x // 2, y // 2, z // 2


class TermMaker:
    """Fills textures with the light that reaches each cell; keeps its programs."""

    def __init__(self, device: Device) -> None:
        self.device = device
        folder = "techniques/extinction/"
        self._ambient = Variants(device, folder + "ambient.frag.glsl", *LAYERED)
        self._lamp = Variants(device, folder + "lamp.frag.glsl", *LAYERED)
        self._spread = Variants(device, folder + "spread.frag.glsl", *LAYERED)

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
        close = number_close(half)
        if close == len(half):
            program = self._shells(field, half, weight, params.shell_strength, WHOLE, spread)
            yield from self._finish(field, grid, program, texture, spread)
            return
        far = new_texture(self.device, _halved(grid), 4, "f2", linear=True)
        try:
            inner, outer = half[close - 1], half[close:]
            program = self._shells(
                field, outer, weight[close:] * _fewer_cells(inner, outer), params.shell_strength, FAR, False
            )
            program.set(u_inner=tuple(inner.tolist()))
            for done in draw_layers(self.device, program, far):
                yield 0.3 * done
            program = self._shells(field, half[:close], weight[:close], params.shell_strength, NEAR, spread)
            program.bind(u_far=far)
            for done in self._finish(field, grid, program, texture, spread):
                yield 0.3 + 0.7 * done
        finally:
            far.release()

    def _shells(
        self, field: Field, half: np.ndarray, weight: np.ndarray, strength: float, part: int, spread: bool
    ) -> Program:
        """Return the program of some of the shells."""
        defines = (("SHELLS", len(half)), ("PART", part), ("WEIGHED", int(spread)))
        program = self._ambient.get(defines)
        assert field.dimming is not None
        field.dimming.bind(program)
        program.bind(u_near=field.near, u_means=field.dimming.cells)
        program.set(u_half=half, u_weight=weight.astype(np.float32), u_strength=strength)
        return program

    def _finish(
        self, field: Field, grid: CellGrid, program: Program, texture: Any, spread: bool
    ) -> Generator[float, None, None]:
        if spread:
            yield from self._draw_and_spread(field, grid, program, texture)
        else:
            yield from draw_layers(self.device, program, texture)

    def lamp(
        self, field: Field, grid: CellGrid, params: ExtinctionParams, lamp: Emitter, texture: Any
    ) -> Generator[float, None, None]:
        """Fill a texture with the share of a lamp's light that reaches each cell, yielding the share done."""
        split = split_of(params, lamp)
        if split is None:
            program = self._cones(field, grid, params, lamp, WHOLE)
            yield from self._draw_and_spread(field, grid, program, texture)
            return
        far = new_texture(self.device, _halved(grid), 1, "nu2", linear=True)
        try:
            program = self._cones(field, grid, params, lamp, FAR)
            # What is interpolated from 2^3 cells reaches two cells farther.
            program.set(u_split=split, u_around=field.reach + 2)
            for done in draw_layers(self.device, program, far):
                yield 0.5 * done
            program = self._cones(field, grid, params, lamp, NEAR)
            program.bind(u_far=far, u_matter=field.matter.cells)
            program.set(u_split=split)
            for done in self._draw_and_spread(field, grid, program, texture):
                yield 0.5 + 0.5 * done
        finally:
            far.release()

    def _cones(
        self, field: Field, grid: CellGrid, params: ExtinctionParams, lamp: Emitter, part: int
    ) -> Program:
        """Return the program of a part of the way to a lamp, all set but for where the parts meet."""
        cones = len(lamp.near["u_disc"]) if part == NEAR else params.cones
        program = self._lamp.get((("POINTS", int(lamp.points)), ("CONES", cones), ("PART", part)))
        field.matter.bind(program)
        program.bind(u_near=field.near)
        program.set(
            u_edge_mm=grid.edges_mm, u_cell_mm=grid.cell_mm, u_strength=params.strength,
            u_first=max(1.0, max(grid.size) / params.samples), u_growth=params.growth,
            **(lamp.uniforms | lamp.near if part == NEAR else lamp.uniforms),
        )  # fmt: skip
        return program

    def _draw_and_spread(
        self, field: Field, grid: CellGrid, program: Any, texture: Any
    ) -> Generator[float, None, None]:
        """Draw a term, and carry its light on to the cells of surfaces, as far at any resolution."""
        passes = int(np.clip(round(SPREAD * field.voxel / grid.cell_mm), 1, MOST_SPREADS))
        colors = 1 if texture.components == 1 else 3
        # Light times openness, and openness: as small as that may be, half floats hold it.
        states = [
            new_texture(self.device, texture.size, colors + 1, "f2", linear=True)
            for _ in range(min(passes, 2))
        ]
        try:
            for done in draw_layers(self.device, program, states[0]):
                yield 0.7 * done
            for number in range(passes):
                last = number == passes - 1
                spread = self._spread.get((("COLORS", colors), ("LAST", int(last))))
                spread.bind(u_near=field.near, u_light=states[number % 2])
                target = texture if last else states[1 - number % 2]
                for done in draw_layers(self.device, spread, target):
                    yield 0.7 + 0.3 * (number + done) / passes
        finally:
            for state in states:
                state.release()

    def release(self) -> None:
        """Free the programs."""
        for programs in (self._ambient, self._lamp, self._spread):
            programs.release()
