"""The passes of `cone`: each lamp's light into a texture of its own, then one ray casting that reads them."""

from __future__ import annotations

import functools
from collections.abc import Generator, Iterator
from typing import Any

import numpy as np

from ...gpu import Device, Program
from ..footprint import effective_secant
from ..frame import Frame
from ..light_cache import LightCache
from ..light_volume import LightGrid, LightSweeper, grid_for
from ..marcher import (
    VOLUMES,
    Angles,
    Marcher,
    Material,
    Variant,
    bind_material,
    crop_corners,
    is_empty,
    lamp_angles,
    light_uniforms,
    lights_towards,
    prepare_material,
    set_view,
    visible_box,
)
from ..near_field import Ways, lay_ways
from ..slab_texture import SlabTexture
from ..stack import Stack, View


class ConePainter:
    """Cone-accurate shadows by the light prepass."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.marcher = Marcher(device)
        self.sweeper = LightSweeper(device)
        self.cache = LightCache(self.sweeper.new_texture, store=device.store)
        self._slab_term = SlabTexture(device)

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        material = prepare_material(frame)
        box = visible_box(frame, material)
        if is_empty(box):
            self.marcher.clear(frame)
            yield 1.0
            return
        angles = lamp_angles(frame)
        lamps: list[tuple[LightGrid, Any]] = []
        for light, angle in zip(frame.scene.active_lights, angles, strict=True):
            grid = grid_for(frame, material, angle, light.aperture)
            sweep = functools.partial(self._sweep, frame, material, grid, len(lamps))
            texture = yield from self.cache.swept(grid.key, grid.size, sweep, len(lamps))
            lamps.append((grid, texture))
        program = self._program(frame, material, angles, lamps)
        self.marcher.begin(frame)
        for done in self.marcher.march(frame, program, (0, 1 << 24), box, True):
            yield 0.5 + 0.5 * done
        self.marcher.finish(frame)
        yield 1.0

    def _sweep(
        self, frame: Frame, material: Material, grid: LightGrid, number: int, texture: Any
    ) -> Iterator[float]:
        """Sweep a lamp, yielding the share done of the frame."""
        for done in self.sweeper.sweep(frame, material, grid, texture):
            yield 0.5 * (number + done) / len(frame.scene.active_lights)

    def _program(
        self,
        frame: Frame,
        material: Material,
        angles: Angles,
        lamps: list[tuple[LightGrid, Any]],
    ) -> Program:
        """Set up the ray caster."""
        params, lights = frame.params, frame.scene.active_lights
        apertures = [light.aperture for light in lights]
        ways = lay_ways(frame, [tilt for tilt, _ in angles], [grid for grid, _ in lamps])
        variant = Variant(True, VOLUMES, len(lights), False, ways.samples, params.specular > 0)
        program = self.marcher.program(variant, material)
        bind_material(program, material, frame)
        set_view(
            program,
            frame,
            Stack.through(View.of(frame.camera), crop_corners(frame), frame.step, frame.jitter),
        )
        program.set(
            u_ambient=params.ambient, u_specular=params.specular, u_shininess=params.shininess,
            **light_uniforms(frame, lights_towards(frame)),
        )  # fmt: skip
        program.set(**_lamp_uniforms(frame, angles, apertures, [grid for grid, _ in lamps], ways))
        program.bind(**{f"u_light{k}": texture for k, (_, texture) in enumerate(lamps)})
        self._slab_term.bind(program, frame, [tilt for tilt, _ in angles], apertures)
        return program

    def release(self) -> None:
        """Free the GPU objects."""
        self.marcher.release()
        self.sweeper.release()
        self.cache.release()
        self._slab_term.release()


def _lamp_uniforms(
    frame: Frame, angles: Angles, apertures: list[float], grids: list[LightGrid], ways: Ways
) -> dict[str, Any]:
    """Return where the ray caster finds each lamp's light, and its way there."""
    to_light, length = np.zeros((4, 3), dtype=np.float32), np.zeros(4, dtype=np.float32)
    matrices, rear = np.zeros((4, 4, 4), dtype=np.float32), np.zeros(4, dtype=np.int32)
    for k, (grid, (tilt, _), aperture) in enumerate(zip(grids, angles, apertures, strict=True)):
        way = float(ways.lengths[k])
        to_light[k] = frame.volume.texture_from_world[:3, :3] @ (-way * grid.lattice.stack.view.axes[2])
        # So that a solid surface that faces the viewer is as bright as the mean over the cone makes it.
        length[k] = way * effective_secant(tilt, aperture) * abs(np.cos(np.radians(tilt)))
        matrices[k] = (grid.texture_from_world @ frame.volume.world_from_texture).T
        rear[k] = tilt > 90
    return {
        "u_to_light": to_light, "u_near_length": length, "u_light_from_texture": matrices, "u_rear": rear,
        "u_near_end": ways.ends.astype(np.float32).ravel(),
    }  # fmt: skip
