"""The published way of the light (Schott2012, Alg. 3): blurred from slice to slice by each lamp's footprint.

The paper's lamp is the viewer's, and its footprint a disc. Here it is the tilted ellipse of Soltesova2010, on the
lattices of `sweep`; geometry covers their texels slab by slab, hidden geometry too, where the paper has one layer.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Generator, Hashable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np

from ...gpu import Device, Program
from ..casters import Casters
from ..frame import Frame
from ..light_cache import LightCache
from ..light_volume import view_of_light
from ..marcher import Material, crop_corners, lights_towards
from ..multidirectional.passes import WHOLE_BYTES
from ..stack import Stack, View
from ..sweep import Lamp, Sweeper, lamps_for, near_slabs
from .cover import BYTES_PER_TEXEL, Atlas, CoverMaker
from .lamps import geometry_key
from .surfels import Surfels, make_surfels

if TYPE_CHECKING:
    from .passes import Stage

#: Sweep passes between two looks at whether a newer scene is there.
PASSES_PER_PIECE = 16
#: How much coarser slices and texels become at a time where the device has no room.
COARSER = 1.26


class Textures:
    """The layers of all lamps, and the coverage by geometry for each, if any casts."""

    def __init__(self, layers: Any, size: tuple[int, int, int]) -> None:
        self.size = size
        self.layers = layers
        self.covers: list[Any] = []

    def release(self) -> None:
        """Free the textures."""
        self.layers.release()
        self.drop_covers()

    def drop_covers(self) -> None:
        """Free the coverage."""
        for cover in self.covers:
            cover.release()
        self.covers = []


@dataclass(frozen=True)
class Sliced:
    """The light of all lamps in the layers of one texture, and where they lie."""

    stack: Stack
    lamps: tuple[Lamp, ...]
    textures: Textures
    near: int

    @property
    def covered(self) -> bool:
        """Whether geometry casts."""
        return bool(self.textures.covers)

    @property
    def ways(self) -> list[float]:
        """Length in mm of each lamp's way from a sample to where its light is asked for."""
        return [self.near * float(np.linalg.norm(lamp.lattice.to_light())) for lamp in self.lamps]

    @property
    def texel(self) -> float:
        """Edge of a texel in mm."""
        return self.lamps[0].lattice.texel if self.lamps else 1.0


class SliceMaker:
    """Sweeps all lamps through the slices of the view."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.cover = CoverMaker(device)
        self._sweepers: list[Sweeper] = []
        self.cache = LightCache(self._new_textures, store=device.store, bytes_per_texel=2 + BYTES_PER_TEXEL)

    def _new_textures(self, size: tuple[int, int, int]) -> Textures:
        with self.device.checked(f"{math.prod(size) * 2 >> 20} MiB for the light's layers"):
            layers = self.device.ctx.texture_array(size, 1, dtype="nu2")
        layers.filter = (moderngl.LINEAR, moderngl.LINEAR)
        layers.repeat_x = layers.repeat_y = False
        return Textures(layers, size)

    def fitting(self, frame: Frame, stage: Stage) -> Frame:
        """Return the frame with slices and texels as coarse as the device needs them to hold all layers."""
        while True:
            stack = _stack(frame, stage)
            lamps = self._lamps(frame, stage, stack, Casters())
            if not lamps:
                return frame
            width, height = lamps[0].lattice.size
            layers = stack.count * len(lamps)
            if layers <= self.device.max_layers and width * height * layers * 2 <= WHOLE_BYTES:
                return frame
            quality = frame.quality
            quality = dataclasses.replace(quality, step=quality.step * COARSER, light=quality.light * COARSER)
            frame = dataclasses.replace(frame, quality=quality)

    def _lamps(self, frame: Frame, stage: Stage, stack: Stack, casters: Casters) -> tuple[Lamp, ...]:
        apertures = [light.aperture for light in frame.scene.active_lights]
        return lamps_for(frame, stage.material, stack, stage.angles, apertures, casters)

    def lit(self, frame: Frame, stage: Stage, volume: bool, geometry: bool) -> Generator[float, None, Sliced]:
        """Return the lamps' light past the volume, if it casts, and geometry, if that does."""
        casting = stage.shown if geometry and frame.params.geometry_opacity > 0 else ()
        seen = yield from make_surfels(frame, stage.shown)
        surfels = seen if casting else ()
        stack = _stack(frame, stage)
        blocks = tuple(s.blocks_along(stack.view) for s in seen)
        casters = Casters(None, 1, frame.params.geometry_opacity, blocks, volume)
        lamps = self._lamps(frame, stage, stack, casters)
        near = near_slabs(frame)
        if not lamps:
            return Sliced(stack, (), Textures(None, (1, 1, 1)), near)
        size = (*lamps[0].lattice.size, stack.count * len(lamps))
        sweep = functools.partial(self._sweep, frame, stage.material, lamps, casters, surfels)
        key = _key(frame, stage.material, stack, lamps, (volume, geometry_key(frame, casting), near))
        textures = yield from self.cache.swept(key, size, sweep, 2)
        return Sliced(stack, lamps, textures, near)

    def _sweep(
        self, frame: Frame, material: Material, lamps: tuple[Lamp, ...], casters: Casters,
        surfels: tuple[Surfels, ...], textures: Textures,
    ) -> Iterator[float]:  # fmt: skip
        """Draw what geometry covers, then sweep all lamps."""
        textures.drop_covers()
        while len(self._sweepers) < len(lamps):
            self._sweepers.append(Sweeper(self.device, fills=True))
        count = lamps[0].lattice.stack.count
        for number, (sweeper, lamp) in enumerate(zip(self._sweepers, lamps, strict=False)):
            if surfels:
                atlas = Atlas.of(self.device, lamp.lattice)
                textures.covers.append(self.cover.new_texture(atlas))
                towards = _towards(frame, number)
                for _ in self.cover.fill(lamp.lattice, atlas, towards, surfels, textures.covers[-1]):
                    yield 0.1
                casters = dataclasses.replace(casters, cover=textures.covers[-1], columns=atlas.columns)
            sweeper.prepare(frame, material, lamp, casters)
            order = range(count - 1, -1, -1) if lamp.lattice.rear else range(count)
            for done, index in enumerate(order):
                sweeper.slab(index, textures.layers, number * count + index)
                if done % PASSES_PER_PIECE == 0:
                    self.device.wait()
                    yield 0.1 + 0.35 * (number + done / count) / len(lamps)

    def release(self) -> None:
        """Free the GPU objects."""
        for sweeper in self._sweepers:
            sweeper.release()
        self.cover.release()
        self.cache.release()


def bind_slices(program: Program, frame: Frame, sliced: Sliced, volume: bool) -> None:
    """Set where a shader finds each lamp's light in the layers (``occlusion.glsl``); `volume`: near by it casts too."""
    shear, rear, columns = np.zeros((4, 2), np.int32), np.zeros(4, np.int32), np.ones(4, np.int32)
    origin, path = np.zeros((4, 2), np.float32), np.zeros(4, np.float32)
    along, along_view = np.zeros((4, 3), np.float32), np.zeros((4, 3), np.float32)
    to_texture = frame.volume.texture_from_world[:3, :3]
    for k, lamp in enumerate(sliced.lamps):
        lattice = lamp.lattice
        shear[k], origin[k], rear[k] = lattice.shear, lattice.origin, int(lattice.rear)
        path[k] = lamp.path if volume else 0.0
        along_view[k] = lattice.to_light()
        along[k] = to_texture @ lattice.stack.view.axes.T @ along_view[k]
    program.set(
        u_shear=shear, u_lattice_origin=origin, u_rear=rear, u_path=path, u_to_light=along,
        u_to_light_view=along_view, u_texel=sliced.texel, u_layers_per_light=sliced.stack.count,
        u_swept=(0, sliced.stack.count - 1),
    )  # fmt: skip
    if not sliced.lamps:
        return
    program.bind(u_layers=sliced.textures.layers)
    program.set(u_lattice_size=tuple(map(float, sliced.lamps[0].lattice.size)))
    for k, cover in enumerate(sliced.textures.covers):
        columns[k] = cover.size[0] // sliced.lamps[0].lattice.size[0]
        program.bind(**{f"u_cover{k}": cover})
    program.set(u_cover_columns=columns, u_cover_opacity=frame.params.geometry_opacity)


def lamp_axes(frame: Frame, stage: Stage) -> np.ndarray:
    """Return two unit vectors across each lamp's axis, shape (8, 3)."""
    axes = np.zeros((8, 3), np.float32)
    for k, angles in enumerate(stage.angles):
        axes[2 * k : 2 * k + 2] = view_of_light(frame, *angles).axes[:2]
    return axes


def _towards(frame: Frame, number: int) -> np.ndarray:
    return np.asarray(lights_towards(frame)[number])


def _stack(frame: Frame, stage: Stage) -> Stack:
    corners = np.concatenate([crop_corners(frame), stage.corners])
    return Stack.through(View.of(frame.camera), corners, frame.step, frame.jitter)


def _key(frame: Frame, material: Material, stack: Stack, lamps: tuple[Lamp, ...], more: Hashable) -> Hashable:
    view = np.concatenate([stack.view.eye, stack.view.axes.ravel(), stack.low, stack.high])
    grids = tuple(
        (
            m.lattice.shear,
            m.lattice.offset,
            m.lattice.size,
            m.lattice.texel,
            m.lattice.rear,
            m.stencil,
            m.path,
            m.every,
        )
        for m in lamps
    )
    return (
        material.opacity_key, frame.scene.clip, frame.scene.crop, frame.params.occlusion, frame.params.falloff,
        np.round(view, 6).tobytes(), round(stack.z0, 6), stack.step, stack.count, grids, more,
    )  # fmt: skip


__all__ = ["SliceMaker", "Sliced", "bind_slices", "lamp_axes"]
