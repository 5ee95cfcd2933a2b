"""The passes of the occlusion methods: sweep each light through a batch of slabs, then march the batch.

Batches keep memory bounded whatever the number of slabs, and pieces of GPU work short. A light from behind
travels against the eye's order: it is swept once from back to front, keeping its state at the edges of the
batches, and each batch is swept again from there when its turn comes.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass, field
from typing import Any

import moderngl
import numpy as np

from ...gpu import Device, Program
from ...scene import nearest_possible_tilt
from ..frame import Frame
from ..marcher import (
    SWEPT,
    Marcher,
    Material,
    Variant,
    bind_material,
    crop_corners,
    is_empty,
    light_uniforms,
    lights_towards,
    pixel_box,
    prepare_material,
    set_view,
    visible_corners,
)
from ..slab_texture import SlabTexture
from ..stack import Stack, View
from ..sweep import MAX_NEAR, Lamp, Sweeper, lamps_for, near_slabs

#: Slabs of a batch: their light lies in the layers of one texture.
BATCH = 64
#: Layers of a light: slab i's is layer i mod LAYERS, so that a batch can still read the slabs just before it.
LAYERS = BATCH + MAX_NEAR
#: Sweep passes between two looks at whether a newer scene is there.
PASSES_PER_PIECE = 16


@dataclass
class Plan:
    """All that is decided before the first pass of a frame."""

    material: Material
    stack: Stack
    slabs: tuple[int, int]
    lamps: tuple[Lamp, ...]
    angles: tuple[tuple[float, float], ...]
    box: tuple[int, int, int, int]
    near: int
    kept: dict[tuple[int, int], Any] = field(default_factory=dict)

    def batches(self) -> list[tuple[int, int]]:
        """Return the ranges of slabs, front to back."""
        first, last = self.slabs
        return [(k, min(k + BATCH, last)) for k in range(first, last, BATCH)]


class OcclusionPainter:
    """Multidirectional occlusion shading; with `headlamp`, its directional special case."""

    def __init__(self, device: Device, *, headlamp: bool = False) -> None:
        self.device = device
        self.headlamp = headlamp
        self.marcher = Marcher(device)
        self._sweepers: list[Sweeper] = []
        self._layers: Any = None
        self._slab_term = SlabTexture(device)

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        material = prepare_material(frame)
        corners = visible_corners(frame, material)
        box = (0, 0, 0, 0) if corners is None else pixel_box(frame, corners)
        if corners is None or is_empty(box):
            self.marcher.clear(frame)
            yield 1.0
            return
        plan = self._plan(frame, material, corners, box)
        program = self._prepare(frame, plan)
        batches = plan.batches()
        rear = any(lamp.lattice.rear for lamp in plan.lamps)
        total = (plan.slabs[1] - plan.slabs[0]) * (2 if rear else 1)
        done = 0
        try:
            if rear:
                for done in self._sweep_rear(plan):
                    yield done / total
            self.marcher.begin(frame)
            for number, batch in enumerate(batches):
                for _ in self._sweep_batch(plan, batch):
                    yield done / total
                if self._layers is not None:
                    program.bind(u_layers=self._layers)
                for _ in self.marcher.march(frame, program, batch, box, number == 0):
                    yield done / total
                done += batch[1] - batch[0]
            self.marcher.finish(frame)
        finally:
            for kept in plan.kept.values():
                for texture in kept.color_attachments:
                    texture.release()
                kept.release()
        yield 1.0

    def _plan(
        self, frame: Frame, material: Material, corners: np.ndarray, box: tuple[int, int, int, int]
    ) -> Plan:
        view = View.of(frame.camera)
        stack = Stack.through(view, crop_corners(frame), frame.step, frame.jitter)
        depths = view.coordinates(corners)[:, 2]
        lights = frame.scene.active_lights
        # Within a degree of grazing the cone's section grows without bound: light stays that far away.
        angles = tuple(
            (0.0, 0.0) if self.headlamp else (nearest_possible_tilt(tilt, light.aperture), rotation)
            for light, (tilt, rotation) in zip(lights, frame.scene.light_angles(), strict=True)
        )
        lamps = lamps_for(frame, material, stack, angles, [light.aperture for light in lights])
        return Plan(
            material, stack, stack.slabs_of(depths.min(), depths.max()), lamps, angles, box, near_slabs(frame)
        )

    def _prepare(self, frame: Frame, plan: Plan) -> Program:
        """Set up the march program, the sweepers and the textures."""
        params, lamps = frame.params, plan.lamps
        literal = params.occlusion != "extinction"
        program = self.marcher.program(
            Variant(True, SWEPT, len(lamps), literal, plan.near, params.specular > 0), plan.material
        )
        bind_material(program, plan.material, frame)
        set_view(program, frame, plan.stack)
        program.set(u_ambient=params.ambient, u_specular=params.specular, u_shininess=params.shininess)
        if not lamps:
            return program
        self._make_layers(lamps)
        while len(self._sweepers) < len(lamps):
            self._sweepers.append(Sweeper(self.device))
        for sweeper, lamp in zip(self._sweepers, lamps, strict=False):
            sweeper.prepare(frame, plan.material, lamp)
        towards = (
            [np.asarray(frame.camera.basis().back)] * len(lamps) if self.headlamp else lights_towards(frame)
        )
        program.set(**light_uniforms(frame, towards), **_lattice_uniforms(frame, plan))
        apertures = [light.aperture for light in frame.scene.active_lights]
        self._slab_term.bind(program, frame, [tilt for tilt, _ in plan.angles], apertures)
        return program

    def _make_layers(self, lamps: tuple[Lamp, ...]) -> None:
        width, height = lamps[0].lattice.size
        wanted = (width, height, LAYERS * len(lamps))
        if self._layers is None or self._layers.size != wanted:
            if self._layers is not None:
                self._layers.release()
            with self.device.checked(f"{math.prod(wanted) * 2 >> 20} MiB for the light's layers"):
                self._layers = self.device.ctx.texture_array(wanted, 1, dtype="nu2")
            self._layers.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self._layers.repeat_x = self._layers.repeat_y = False

    def _sweep_rear(self, plan: Plan) -> Iterator[int]:
        """Take the lights from behind through all slabs, keeping their state at the batches' far edges."""
        first, last = plan.slabs
        starts = {self._rear_start(plan, batch) for batch in plan.batches()}
        for index in range(last - 1, first - 1, -1):
            for number, (sweeper, lamp) in enumerate(zip(self._sweepers, plan.lamps, strict=False)):
                if lamp.lattice.rear:
                    if index in starts:
                        plan.kept[number, index] = sweeper.keep()
                    sweeper.slab(index, self._layers, _layer(number, index))
            if index % PASSES_PER_PIECE == 0:
                self.device.wait()
                yield last - index

    def _rear_start(self, plan: Plan, batch: tuple[int, int]) -> int:
        """Return the slab at which a batch is begun from behind: the ray caster reads a few beyond its end."""
        return min(batch[1] + plan.near, plan.slabs[1]) - 1

    def _sweep_batch(self, plan: Plan, batch: tuple[int, int]) -> Iterator[None]:
        """Take every light through the slabs of a batch, in its own order."""
        first, last = batch
        for number, (sweeper, lamp) in enumerate(zip(self._sweepers, plan.lamps, strict=False)):
            order = range(first, last)
            if lamp.lattice.rear:
                start = self._rear_start(plan, batch)
                sweeper.load(plan.kept[number, start])
                order = range(start, first - 1, -1)
            for count, index in enumerate(order, 1):
                sweeper.slab(index, self._layers, _layer(number, index))
                if count % PASSES_PER_PIECE == 0:
                    self.device.wait()
                    yield

    def release(self) -> None:
        """Free the GPU objects."""
        self.marcher.release()
        for sweeper in self._sweepers:
            sweeper.release()
        self._slab_term.release()
        if self._layers is not None:
            self._layers.release()


def _layer(light: int, slab: int) -> int:
    """Return the layer that holds what of a light reaches a slab."""
    return light * LAYERS + slab % LAYERS


def _lattice_uniforms(frame: Frame, plan: Plan) -> dict[str, Any]:
    """Return where the ray caster finds each light's visibility, and its own way towards each light."""
    shear, origin, rear = (
        np.zeros((4, 2), dtype=np.int32),
        np.zeros((4, 2), dtype=np.float32),
        np.zeros(4, dtype=np.int32),
    )
    along, path = np.zeros((4, 3), dtype=np.float32), np.zeros(4, dtype=np.float32)
    to_texture = frame.volume.texture_from_world[:3, :3]
    for k, lamp in enumerate(plan.lamps):
        lattice = lamp.lattice
        shear[k], origin[k], rear[k], path[k] = lattice.shear, lattice.origin, int(lattice.rear), lamp.path
        along[k] = to_texture @ lattice.stack.view.axes.T @ lattice.to_light()
    lattice = plan.lamps[0].lattice
    return {
        "u_shear": shear, "u_lattice_origin": origin, "u_rear": rear, "u_layers_per_light": LAYERS,
        "u_texel": lattice.texel, "u_lattice_size": tuple(map(float, lattice.size)),
        "u_to_light": along, "u_path": path, "u_swept": (plan.slabs[0], plan.slabs[1] - 1),
    }  # fmt: skip
