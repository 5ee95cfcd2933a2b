"""The light volumes of a frame's lamps, and what the ray caster needs to read them: shadows as in `cone`."""

from __future__ import annotations

import functools
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..gpu import Device, Program
from .footprint import effective_secant
from .frame import Frame
from .light_cache import LightCache
from .light_volume import LightGrid, LightSweeper, grid_for
from .marcher import Angles, Material, crop_corners, lamp_angles, set_view
from .near_field import Ways, lay_ways
from .slab_texture import SlabTexture
from .stack import Stack, View


@dataclass(frozen=True)
class Lamps:
    """The active lamps of a frame, each with its light volume.

    Attributes
    ----------
    angles : tuple
        Tilt and rotation of each in degrees.
    grids : list of LightGrid
        Where each one's texture lies.
    textures : list of texture
        Their light.
    ways : Ways
        From a sample to where each one's light is asked for.
    """

    angles: Angles
    grids: list[LightGrid]
    textures: list[Any]
    ways: Ways


class LampShadows:
    """Sweeps the lamps' light, keeps it, and gives it to the ray caster."""

    def __init__(self, device: Device) -> None:
        self.sweeper = LightSweeper(device)
        self.cache = LightCache(self.sweeper.new_texture, store=device.store)
        self._slab_term = SlabTexture(device)

    def prepare(self, frame: Frame, material: Material) -> Generator[float, None, Lamps]:
        """Sweep what is not kept, yielding progress up to half of the frame's; returns the lamps."""
        angles, grids, textures = lamp_angles(frame), list[LightGrid](), list[Any]()
        for light, angle in zip(frame.scene.active_lights, angles, strict=True):
            grid = grid_for(frame, material, angle, light.aperture)
            sweep = functools.partial(self._sweep, frame, material, grid, len(grids))
            textures.append((yield from self.cache.swept(grid.key, grid.size, sweep, len(grids))))
            grids.append(grid)
        return Lamps(angles, grids, textures, lay_ways(frame, [tilt for tilt, _ in angles], grids))

    def _sweep(
        self, frame: Frame, material: Material, grid: LightGrid, number: int, texture: Any
    ) -> Iterator[float]:
        """Sweep a lamp, yielding progress."""
        for done in self.sweeper.sweep(frame, material, grid, texture):
            yield 0.5 * (number + done) / len(frame.scene.active_lights)

    def bind(self, program: Program, frame: Frame, lamps: Lamps) -> None:
        """Set what ``light_volume.glsl`` and ``slab.glsl`` need, and the view by slices that they are made for."""
        stack = Stack.through(View.of(frame.camera), crop_corners(frame), frame.step, frame.jitter)
        set_view(program, frame, stack)
        bind_lamps(program, frame, lamps)
        apertures = [light.aperture for light in frame.scene.active_lights]
        self._slab_term.bind(program, frame, [tilt for tilt, _ in lamps.angles], apertures)

    def release(self) -> None:
        """Free the GPU objects."""
        self.sweeper.release()
        self.cache.release()
        self._slab_term.release()


def bind_lamps(program: Program, frame: Frame, lamps: Lamps) -> None:
    """Set where a shader finds each lamp's light, and its way there (``light_volume.glsl``)."""
    apertures = [light.aperture for light in frame.scene.active_lights]
    to_light, length = np.zeros((4, 3), dtype=np.float32), np.zeros(4, dtype=np.float32)
    matrices, rear = np.zeros((4, 4, 4), dtype=np.float32), np.zeros(4, dtype=np.int32)
    for k, (grid, (tilt, _), aperture) in enumerate(zip(lamps.grids, lamps.angles, apertures, strict=True)):
        way = float(lamps.ways.lengths[k])
        to_light[k] = frame.volume.texture_from_world[:3, :3] @ (-way * grid.lattice.stack.view.axes[2])
        # So that a solid surface that faces the viewer is as bright as the mean over the cone makes it.
        length[k] = way * effective_secant(tilt, aperture) * abs(np.cos(np.radians(tilt)))
        matrices[k] = (grid.texture_from_world @ frame.volume.world_from_texture).T
        rear[k] = tilt > 90
    program.set(
        u_to_light=to_light, u_near_length=length, u_light_from_texture=matrices, u_rear=rear,
        u_near_end=lamps.ways.ends.astype(np.float32).ravel(),
    )  # fmt: skip
    program.bind(**{f"u_light{k}": texture for k, texture in enumerate(lamps.textures)})
