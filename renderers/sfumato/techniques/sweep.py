"""The occlusion sweep: one light's way through the slabs, from plane to plane.

At each slab the light that came through the slab before is filtered by the light's footprint (`footprint`)
on a lattice whose columns follow the footprint's centroid (`stack`), and what the slab absorbs along each
column is taken away. What arrives at a slab is written to a layer of a texture that the ray caster reads.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ..gpu import Device, LayerTarget, Program, Variants
from .casters import VOLUME_ALONE, Casters, cover_corners
from .footprint import Stencil, effective_secant, kernel_moments, stencil_for
from .frame import Frame
from .marcher import Material, bind_material, blocks_along, material_defines
from .stack import Lattice, Stack
from .tile_texture import TileTexture
from .tiles import TileLists, list_tiles

#: Most slabs that one filtering serves, and its largest variance in texels squared.
MAX_RHYTHM = 4
RHYTHM_VARIANCE = 0.1

#: Most slabs that are looked through close to a sample.
MAX_NEAR = 4

#: The forms of occlusion and their number in the shader.
FORMS = {"extinction": 0, "additive": 1, "multiplicative": 2}


@dataclass(frozen=True)
class Lamp:
    """What the sweep needs of one light.

    Attributes
    ----------
    path : float
        Length of the light's way through a slab over the slab's thickness.
    tiles : TileLists
        What has to be swept.
    every : int
        The footprint is applied at every so many slabs, with so many times its variance.
    """

    lattice: Lattice
    stencil: Stencil
    path: float
    tiles: TileLists
    every: int


def lamps_for(
    frame: Frame,
    material: Material,
    stack: Stack,
    angles: Sequence[tuple[float, float]],
    apertures: Sequence[float],
    casters: Casters = VOLUME_ALONE,
) -> tuple[Lamp, ...]:
    """Return lattice, stencil and tiles of each light, given by (tilt, rotation) and aperture in degrees."""
    texel = texel_of(frame)
    # The nominal step in place of one of the two: a drag with fewer slabs blurs as much as the full picture.
    area = stack.step * frame.nominal_step / texel**2
    moments = [
        kernel_moments(tilt, aperture, frame.params.falloff)
        for (tilt, _), aperture in zip(angles, apertures, strict=True)
    ]
    rhythm = [
        1 if FORMS[frame.params.occlusion] else filter_rhythm(max(m.along, m.across) * area) for m in moments
    ]
    stencils = [
        _stencil(m.along * area * every, m.across * area * every, rotation)
        for m, every, (_, rotation) in zip(moments, rhythm, angles, strict=True)
    ]
    # All lights share one size of grid, so that their layers can lie in one texture. Grazing light may reach
    # farther than the volume is wide: beyond that there is nothing, however far.
    widest = math.ceil(float((stack.high - stack.low).max()) / texel) + 1
    reach = min(widest, max((abs(c) for stencil in stencils for tap in stencil.taps for c in tap), default=0))
    # A slab's columns also begin texels away from those of the slab before: steep lights move by several.
    reach += min(widest, math.ceil(max((m.mean for m in moments), default=0.0) * stack.step / texel))
    # Whatever casts, all that is seen has to be reached.
    blocks = [*casters.blocks, blocks_along(stack.view, frame, material)]
    lamps = []
    for (tilt, rotation), aperture, m, stencil, every in zip(
        angles, apertures, moments, stencils, rhythm, strict=True
    ):
        lattice = Lattice.over(
            stack, texel, m.mean, rotation, tilt > 90, frame.lattice_jitter, reach, near_slabs(frame)
        )
        tiles = list_tiles(lattice, blocks, max(m.along, m.across) * area, near_slabs(frame))
        lamps.append(Lamp(lattice, stencil, effective_secant(tilt, aperture), tiles, every))
    return tuple(lamps)


def texel_of(frame: Frame) -> float:
    """Return the edge of the lattice's texels in mm."""
    return float(frame.volume.min_spacing / frame.params.resolution * frame.quality.light)


def near_slabs(frame: Frame) -> int:
    """Return in how many slabs before a sample the ray caster itself looks for occluders: those that a texel spans.

    The published forms do not do so.
    """
    if FORMS[frame.params.occlusion]:
        return 0
    return max(1, min(MAX_NEAR, math.ceil(texel_of(frame) / frame.step - 1e-6)))


def filter_rhythm(variance: float) -> int:
    """Return at how many slabs at a time to apply a footprint whose variance, in texels squared, is so small.

    Variances add, and columns carry the light exactly in between: filtering four slabs at once saves most of
    the fetches. Our own form does so; the published forms are kept literal.
    """
    every: int = 1
    while every < MAX_RHYTHM and 2 * every * variance <= RHYTHM_VARIANCE:
        every *= 2
    return every


def _stencil(along: float, across: float, rotation: float) -> Stencil:
    """Return the stencil of a footprint whose axis along the light is turned by `rotation` degrees."""
    c, s = math.cos(math.radians(rotation)), math.sin(math.radians(rotation))
    return stencil_for(
        along * c * c + across * s * s, (along - across) * c * s, along * s * s + across * c * c
    )


class Sweeper:
    """Carries one light's occlusion from slab to slab, through two states that take turns.

    Parameters
    ----------
    fills : bool
        Whether layers are written where nothing stands too, for surfaces that ask there.
    """

    def __init__(self, device: Device, *, fills: bool = False) -> None:
        self.device = device
        self.fills = fills
        self._programs = Variants(device, "techniques/sweep.frag.glsl", "shaders/tiles.vert.glsl")
        self._targets: list[LayerTarget] = []
        self._pairs: list[tuple[Program, Program]] = []
        self._tiles = TileTexture(device)
        self._clear = 1.0

    def prepare(self, frame: Frame, material: Material, lamp: Lamp, casters: Casters = VOLUME_ALONE) -> None:
        """Begin with a light, where no slab has taken any of it yet."""
        form = FORMS[frame.params.occlusion]
        size = lamp.lattice.size
        if not self._targets or self._targets[0].state.size != size:
            self._release_targets()
            self._targets = [LayerTarget(self.device, new_state(self.device, size)) for _ in range(2)]
        self._lamp, self._casters = lamp, casters
        covered = casters.cover is not None
        self._clear = 0.0 if form == FORMS["additive"] else 1.0
        self._to_texture = texture_from_view(frame, lamp.lattice.stack)
        self._tiles.upload(lamp.tiles)
        border = lamp.lattice.border - lamp.lattice.pad
        taps = np.clip(np.array(lamp.stencil.taps, dtype=np.int32), -border, border)
        self._farthest = border - int(np.abs(taps).max())
        self._pairs = []
        for filtering in (0, 1):
            kind = (("LITERAL", form), ("FILTER", filtering), ("SHEARED", 1))
            hollow = self._programs.get((*kind, ("HOLLOW", 1), ("VOLUME", 0), ("GEOMETRY", 0)))
            casting = (("HOLLOW", 0), ("VOLUME", int(casters.volume)), ("GEOMETRY", int(covered)))
            full = self._programs.get((*kind, *casting, *material_defines(material)))
            bind_material(full, material, frame)
            if covered:
                full.bind(u_cover=casters.cover)
                full.set(u_opacity=casters.opacity, u_cover_extent=size)
            self._pairs.append((hollow, full))
        for program in (program for pair in self._pairs for program in pair):
            program.set(
                u_extent=tuple(map(float, size)), u_thickness=frame.step, u_path=lamp.path,
                u_taps=taps,
                u_weights=(lamp.stencil.center, *lamp.stencil.weights),
                u_tile_size=lamp.tiles.tiling.edge, u_columns_low=lamp.tiles.low, u_inner=(border, border),
                u_outer=(size[0] - border, size[1] - border),
            )  # fmt: skip
        self.device.clear(self._targets[0].plain, self._clear, -1.0)

    def load(self, kept: Any) -> None:
        """Go on from a state that `keep` kept."""
        self.device.ctx.copy_framebuffer(self._targets[0].plain, kept)

    def keep(self) -> Any:
        """Return a framebuffer with a copy of the present state."""
        kept = self.device.ctx.framebuffer([new_state(self.device, self._lamp.lattice.size)])
        self.device.ctx.copy_framebuffer(kept, self._targets[0].plain)
        return kept

    def slab(self, index: int, layers: Any, layer: int) -> None:
        """Take the light through one slab; what reaches the slab is written to a layer."""
        source, target = self._targets
        self._targets = [target, source]
        lattice = self._lamp.lattice
        enter, leave, before = (
            (index + 1, index, index + 2) if lattice.rear else (index, index + 1, index - 1)
        )
        # Where no tile is drawn nothing stands in the light.
        self.device.clear(target.plain, self._clear, -1.0)
        full, hollow = self._lamp.tiles.of_slab(index)
        if full[1] + hollow[1] == 0 and not self.fills:
            return
        target.use(layers, layer)
        if self.fills:
            target.clear_layer(1.0)
        base = lattice.base(enter)
        # What lies farther away than the border is clear in any case.
        shift = tuple(np.clip(base - lattice.base(before), -self._farthest, self._farthest).tolist())
        pair = self._pairs[int(index % self._lamp.every == 0)]
        if self._casters.cover is not None:
            pair[1].set(**self._cover_uniforms(index, enter, base))
        for program, (first, count) in zip(pair, (hollow, full), strict=True):
            if count == 0:
                continue
            program.bind(u_state=source.state, u_tiles=self._tiles.texture)
            program.set(u_shift=shift, u_base=tuple(base.tolist()), u_tiles_first=first)
            if program is pair[1]:
                program.set(
                    u_enter=affine(self._to_texture, lattice.positions(enter, base)),
                    u_leave=affine(self._to_texture, lattice.positions(leave, base)),
                )
            program.draw_rects(count)

    def _cover_uniforms(self, index: int, enter: int, base: np.ndarray) -> dict[str, Any]:
        """Return where the coverage of this slab lies, and of the two that light met before."""
        lattice, back = self._lamp.lattice, 1 if self._lamp.lattice.rear else -1
        shifts = np.array([base - lattice.base(enter + back * k) for k in range(3)], dtype=np.int32)
        corners = cover_corners(
            index, self._casters.columns, lattice.size, back=back, slabs=lattice.stack.count
        )
        return {"u_cover_at": corners, "u_cover_shift": np.clip(shifts, -(1 << 14), 1 << 14)}

    def release(self) -> None:
        """Free programs and states."""
        self._programs.release()
        self._release_targets()
        self._tiles.release()

    def _release_targets(self) -> None:
        for target in self._targets:
            target.release()
            target.state.release()
        self._targets = []


def new_state(device: Device, size: tuple[int, int]) -> Any:
    """Make a state texture: transmittance (or occlusion) and the value on the slab's far plane."""
    state = device.ctx.texture(size, 2, dtype="f4")
    state.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return state


def affine(to_texture: np.ndarray, positions: np.ndarray) -> tuple[float, ...]:
    """Return the 3 x 3 from texels on a plane to texture coordinates, column by column."""
    matrix = to_texture[:3, :3] @ positions
    matrix[:, 2] += to_texture[:3, 3]
    return tuple(matrix.T.ravel().tolist())


def texture_from_view(frame: Frame, stack: Stack) -> np.ndarray:
    """Return the affine 4 x 4 from (lateral x, lateral y, depth) in mm to texture coordinates."""
    to_world = np.eye(4)
    to_world[:3, :3] = stack.view.axes.T
    to_world[:3, 3] = stack.view.eye
    return np.asarray(frame.volume.texture_from_world @ to_world)
