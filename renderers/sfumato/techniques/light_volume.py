"""The light prepass: one lamp's visibility, swept through the volume in the lamp's own space into a 3D texture.

A lamp's cone is taken apart into directions, uniform in solid angle. Each carries a transmittance over a
grid of planes that face the lamp, from plane to plane, one fetch a direction (*swept directions*,
``methods.md``): the penumbra comes from the spread of the directions, so it grows with distance as the
cone does, and occluders stay correlated along each ray. The mean over the directions is what the texture
holds, one layer a plane.

The grid belongs to the lamp and not to the camera: every tilt is alike, from before or behind; nothing
depends on the picture's size, its projection or the number of slices; and while lamp and material stay the
same, the texture can be kept.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ..gpu import Device, LayerTarget, Program, Variants
from .casters import VOLUME_ALONE, Casters, cover_corners
from .frame import Frame
from .marcher import Material, bind_material, blocks_along, material_defines, visible_corners
from .stack import Lattice, Stack, View
from .sweep import affine, texture_from_view
from .tile_texture import TileTexture
from .tiles import TileLists, list_cone_tiles

#: Directions of a cone: one fetch each a texel and plane. A multiple of 4, at most 24: four to a draw buffer, of 8.
DIRECTIONS = 16
#: Most texels of a light volume (four bytes each); what would be larger is coarser.
MAX_TEXELS = 24 << 20
#: Passes between two looks at whether a newer scene is there.
PASSES_PER_PIECE = 16
#: Largest step of a direction from plane to plane, in texels: beyond it nothing is resolved.
MAX_OFFSET = 12.0
#: How far towards the light from a sample, in texels, its texture is asked; the ray caster looks through the way there.
NEAR_TEXELS = 1.75
#: The same for the steepest light.
MAX_NEAR_TEXELS = 6.0
#: Half angles in degrees up to which a lamp's texels are SHARP_TEXELS voxels wide, and from which SOFT_TEXELS.
SHARP_APERTURE, SOFT_APERTURE = 8.0, 26.0
SHARP_TEXELS, SOFT_TEXELS = 0.91, 1.25
#: Slabs of which one takes its directions between texels.
EXACT_EVERY = 2
_GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))


def directions_of_cone(aperture: float, count: int, index: int) -> tuple[np.ndarray, np.ndarray]:
    """Return directions uniform in solid angle in a cone about its axis.

    Parameters
    ----------
    aperture : float
        Half angle in degrees.
    index : int
        Number of the frame: each has a set of its own, turned and moved, so that their mean converges.

    Returns
    -------
    offsets : ndarray, shape (count, 2)
        Tangents: lateral way for each millimetre along the axis.
    secants : ndarray, shape (count,)
        Length of the way for each millimetre along the axis.
    """
    place = (np.arange(count) + (0.5 + index * 0.6180339887498949) % 1.0) / count
    cosine = 1 - place * (1 - math.cos(math.radians(min(aperture, 89.0))))
    turn = np.arange(count) * _GOLDEN_ANGLE + index * 2.399963 * 0.7548776662466927
    tangent = np.sqrt(np.maximum(0.0, 1 - cosine**2)) / cosine
    return np.stack([tangent * np.cos(turn), tangent * np.sin(turn)], axis=1), 1 / cosine


def view_of_light(frame: Frame, tilt: float, rotation: float) -> View:
    """Return the axes of a lamp's space: two across, and the way of its light. They turn smoothly with the lamp."""
    basis, alpha, phi = frame.camera.basis(), math.radians(tilt), math.radians(rotation)
    right, up, back = (np.asarray(v, dtype=float) for v in (basis.right, basis.up, basis.back))
    outwards = math.cos(phi) * right + math.sin(phi) * up
    across = math.cos(phi) * up - math.sin(phi) * right
    inwards = math.cos(alpha) * outwards - math.sin(alpha) * back
    towards = math.sin(alpha) * outwards + math.cos(alpha) * back
    return View(np.asarray(frame.volume.center), np.array([inwards, across, -towards]))


def shares_of(view: View, frame: Frame, offsets: np.ndarray, secants: np.ndarray) -> np.ndarray:
    """Return the share of each direction in what a solid surface that faces the viewer sends back.

    That is 1 / (1 + s) with a direction's secant s against the view axis (``methods.md``, open point 3a).
    """
    towards = offsets @ view.axes[:2] - view.axes[2]
    cosines = np.abs(towards @ np.asarray(frame.camera.basis().back)) / secants
    weights = cosines / (1 + cosines)
    return np.asarray(weights / weights.sum())


@dataclass(frozen=True)
class LightGrid:
    """Where a lamp's texture lies, and the steps of its directions.

    Attributes
    ----------
    offsets : ndarray, shape (K, 2)
        Steps of the directions towards the light from plane to plane, in texels.
    secants : ndarray, shape (K,)
        Length of their ways through a slab over its thickness.
    shares : ndarray, shape (K,)
        What each counts for: a solid surface that faces the viewer returns less of grazing light.
    key : hashable
        Two sweeps with one key have one result.
    """

    lattice: Lattice
    offsets: np.ndarray
    secants: np.ndarray
    shares: np.ndarray
    key: Hashable

    @property
    def size(self) -> tuple[int, int, int]:
        """Texels of the texture; its layer j holds what reaches plane j."""
        return (*self.lattice.size, self.lattice.stack.count + 1)

    @property
    def texture_from_world(self) -> np.ndarray:
        """Affine 4 x 4 from world space to the texture's coordinates."""
        stack, size = self.lattice.stack, np.asarray(self.size, dtype=float)
        matrix = np.eye(4)
        matrix[:3, :3] = stack.view.axes
        matrix[:3, 3] = -stack.view.axes @ stack.view.eye
        matrix[:2] -= np.outer(self.lattice.origin, [0, 0, 0, 1])
        matrix[:2] /= self.lattice.texel
        matrix[2, 3] -= stack.z0
        matrix[2] /= stack.step
        matrix[2, 3] += (
            1.0  # layer 0 lies half a slab before the first plane, the others in the middle of slabs
        )
        return np.asarray(matrix / np.append(size, 1)[:, None])

    @functools.cached_property
    def steps(self) -> np.ndarray:
        """Steps to take at each slab in texels, float32, shape (slabs, K, 2).

        A step between texels is interpolated, and spreads light a little; over many slabs that would let
        shadows grow. Most steps are therefore whole texels, and every few slabs, each direction in its turn,
        one makes up for the rest.
        """
        count, directions = self.lattice.stack.count, len(self.offsets)
        steps, behind = np.empty((count, directions, 2), dtype=np.float32), np.zeros((directions, 2))
        turn = np.arange(directions) % EXACT_EVERY
        for slab in range(count):
            behind += self.offsets
            exact = np.equal(turn, slab % EXACT_EVERY)
            steps[slab] = np.where(exact[:, None], behind, np.round(behind))
            behind -= steps[slab]
        return steps

    def tiles(self, frame: Frame, material: Material, casters: Casters = VOLUME_ALONE) -> TileLists:
        """Return what has to be swept."""
        volume = [blocks_along(self.lattice.stack.view, frame, material)] if casters.volume else []
        slope = float(np.hypot(*self.offsets.T).max())
        return list_cone_tiles(self.lattice, volume, casters.blocks, slope, math.ceil(MAX_NEAR_TEXELS) + 1)


def texel_of(frame: Frame, aperture: float) -> float:
    """Return the edge of a lamp's texels in mm: fine shadows of wide cones are close by, where it is not asked."""
    share = (aperture - SHARP_APERTURE) / (SOFT_APERTURE - SHARP_APERTURE)
    width = SHARP_TEXELS + (SOFT_TEXELS - SHARP_TEXELS) * min(1.0, max(0.0, share))
    resolution = getattr(frame.params, "resolution", 1.0)  # techniques that borrow these shadows have none
    return float(frame.volume.min_spacing / resolution * width * frame.quality.light)


def grid_for(
    frame: Frame,
    material: Material,
    angles: tuple[float, float],
    aperture: float,
    corners: np.ndarray | None = None,
    more: Hashable = None,
) -> LightGrid:
    """Plan the sweep of a lamp at (tilt, rotation) in degrees as the camera sees it.

    Parameters
    ----------
    corners : ndarray, shape (n, 3), optional
        World mm; what the grid reaches over, instead of what is visible of the volume.
    more : hashable
        What the result depends on besides, for its key.
    """
    view = view_of_light(frame, *angles)
    if corners is None:
        corners = visible_corners(frame, material)
    assert corners is not None
    extent = np.ptp(view.coordinates(corners), axis=0)
    longest = frame.device.max_texture_3d - 64  # less what the border may take
    fitting = max(float(np.prod(extent) / MAX_TEXELS) ** (1 / 3), float(extent.max()) / longest)
    texel = max(texel_of(frame, aperture), fitting)
    stack = Stack.through(view, corners, texel, frame.jitter)
    offsets, secants = directions_of_cone(aperture, DIRECTIONS, frame.index)
    shares = shares_of(view, frame, offsets, secants)
    offsets = np.clip(offsets, -MAX_OFFSET, MAX_OFFSET)
    reach = math.ceil(float(np.abs(offsets).max())) + 2
    lattice = Lattice.over(stack, texel, 0.0, 0.0, False, frame.lattice_jitter, reach)
    key = (
        material.opacity_key, frame.scene.clip, frame.scene.crop, np.round(view.axes, 9).tobytes(),
        aperture, texel, frame.index, np.round(shares, 9).tobytes(), more,
    )  # fmt: skip
    return LightGrid(lattice, offsets, secants, shares, key)


def secant_uniforms(secants: np.ndarray) -> dict[str, Any]:
    """Return three secants, and the weights with which exp(-tau secant) follows from theirs for each direction."""
    low, high = float(secants.min()), max(float(secants.max()), float(secants.min()) + 1e-4)
    nodes = np.array([low, (low + high) / 2, high])
    weights = [
        np.prod([(secants - nodes[j]) / (nodes[i] - nodes[j]) for j in range(3) if j != i], axis=0)
        for i in range(3)
    ]
    packed = {f"u_weight{i}": w.astype(np.float32).reshape(-1, 4) for i, w in enumerate(weights)}
    return {"u_secants": tuple(nodes.tolist()), **packed}


class LightSweeper:
    """Sweeps lamps; keeps its programs and the two states that take turns."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._programs = Variants(device, "techniques/light_sweep.frag.glsl", "shaders/tiles.vert.glsl")
        self._targets: list[LayerTarget] = []
        self._tiles = TileTexture(device)
        self._lists: Any = None

    def new_texture(self, size: tuple[int, int, int]) -> Any:
        """Make the texture of a light volume."""
        with self.device.checked(f"{math.prod(size) * 4 >> 20} MiB for a lamp's light"):
            texture = self.device.ctx.texture3d(size, 2, dtype="nu2")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = texture.repeat_z = False
        return texture

    def sweep(
        self,
        frame: Frame,
        material: Material,
        grid: LightGrid,
        texture: Any,
        casters: Casters = VOLUME_ALONE,
    ) -> Iterator[float]:
        """Fill a lamp's texture, yielding the share done after each bounded piece."""
        self._make_states(grid.lattice.size)
        programs = self._prepare(frame, material, grid, casters)
        self._targets[0].use(texture, 0)
        self._targets[0].fbo.clear(1.0, 1.0, 1.0, 1.0)
        for slab in range(grid.lattice.stack.count):
            source, target = self._targets
            self._targets = [target, source]
            target.use(texture, slab + 1)
            # Where no tile is drawn the light is clear. Tiles change with each group of slabs: both states begin anew.
            if slab % self._lists.tiling.group < 2:
                target.fbo.clear(1.0, 1.0, 1.0, 1.0)
            else:
                target.clear_layer(1.0)
            if casters.cover is not None:
                programs[-1].set(u_cover_at=cover_corners(slab, casters.columns, grid.lattice.size))
            for program, span in zip(programs, self._lists.of_slab(slab), strict=True):
                self._draw(program, source, grid, slab, span)
            if slab % PASSES_PER_PIECE == 0:
                self.device.wait()
                yield slab / grid.lattice.stack.count

    def _draw(
        self, program: Program, source: LayerTarget, grid: LightGrid, slab: int, span: tuple[int, int]
    ) -> None:
        first, count = span
        if count == 0:
            return
        program.bind(u_tiles=self._tiles.texture, **{f"u_state{k}": s for k, s in enumerate(source.states)})
        base, lattice = np.zeros(2, dtype=int), grid.lattice
        program.set(
            u_tiles_first=first,
            u_offset=grid.steps[slab],
            u_enter=affine(self._to_texture, lattice.positions(slab, base)),
            u_leave=affine(self._to_texture, lattice.positions(slab + 1, base)),
        )
        program.draw_rects(count)

    def _prepare(self, frame: Frame, material: Material, grid: LightGrid, casters: Casters) -> list[Program]:
        """Set up the programs of full and of hollow tiles, and of those in which geometry stands."""
        lattice = grid.lattice
        self._lists = grid.tiles(frame, material, casters)
        self._tiles.upload(self._lists)
        self._to_texture = texture_from_view(frame, lattice.stack)
        number = (("DIRECTIONS", DIRECTIONS), ("LAST", DIRECTIONS // 4), ("SHEARED", 0))
        kinds = [
            (0, 0, int(casters.volume)),
            (1, 0, 0),
            (0, int(casters.cover is not None), int(casters.volume)),
        ]
        programs = []
        for hollow, covered, volume in kinds:
            kind = (("HOLLOW", hollow), ("GEOMETRY", covered), ("VOLUME", volume))
            program = self._programs.get((*number, *kind, *(() if hollow else material_defines(material))))
            if not hollow:
                bind_material(program, material, frame)
            if covered:
                program.bind(u_cover=casters.cover)
                program.set(u_opacity=casters.opacity)
            programs.append(program)
        inner, size = lattice.border - lattice.pad, lattice.size
        for program in programs:
            program.set(
                u_extent=tuple(map(float, size)), u_tile_size=self._lists.tiling.edge,
                u_columns_low=self._lists.low, u_base=(0, 0),
                u_inner=(inner, inner), u_outer=(size[0] - inner, size[1] - inner),
                u_share=grid.shares.astype(np.float32).reshape(-1, 4),
                **secant_uniforms(grid.secants),
                u_texel_size=(1 / size[0], 1 / size[1]), u_thickness=lattice.stack.step,
            )  # fmt: skip
        return programs

    def _make_states(self, size: tuple[int, int]) -> None:
        if self._targets and self._targets[0].state.size == size:
            return
        self._release_targets()
        for _ in range(2):
            states = []
            for _ in range(DIRECTIONS // 4):
                with self.device.checked("the state of a light sweep"):
                    state = self.device.ctx.texture(size, 4, dtype="nu2")
                state.filter = (moderngl.LINEAR, moderngl.LINEAR)
                state.repeat_x = state.repeat_y = False
                states.append(state)
            self._targets.append(LayerTarget(self.device, *states))

    def release(self) -> None:
        """Free programs and states."""
        self._programs.release()
        self._release_targets()
        self._tiles.release()

    def _release_targets(self) -> None:
        for target in self._targets:
            target.release()
            for state in target.states:
                state.release()
        self._targets = []
