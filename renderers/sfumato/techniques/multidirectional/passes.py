"""The passes of the occlusion methods: sweep each light through a batch of slabs, then march the batch.

Where there is room the whole stack is one batch, whose layers are the light prepass: they are kept, and as
long as lamps, view and opacity stay the same only the ray caster runs. Else batches keep memory bounded
whatever the number of slabs. A light from behind travels against the eye's order: with several batches it is
swept once from back to front, keeping its state at the edges of the batches, and each batch is swept again
from there when its turn comes.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Generator, Hashable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import moderngl
import numpy as np

from ...gpu import Device, Program
from ..frame import Frame
from ..light_cache import LightCache
from ..marcher import (
    SWEPT,
    Marcher,
    Material,
    Variant,
    bind_material,
    crop_corners,
    is_empty,
    lamp_angles,
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
#: Most bytes of the layers of a stack that is one batch.
WHOLE_BYTES = 192 << 20
BYTES_PER_TEXEL = 2
#: Sweep passes between two looks at whether a newer scene is there.
PASSES_PER_PIECE = 16


@dataclass(frozen=True)
class Beside:
    """Light of another technique that is drawn beside that of the lamps.

    Attributes
    ----------
    local : int
        How both are combined, as `Variant.local`.
    joined, resolved : bool
        As `Variant`'s.
    bind : callable
        Gives the program what it needs to read it.
    """

    local: int
    joined: bool
    resolved: bool
    bind: Callable[[Program], None]


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
    key: Hashable
    #: Layers of a light, and whether they hold the whole stack.
    per_light: int = LAYERS
    whole: bool = False
    kept: dict[tuple[int, int], Any] = field(default_factory=dict)

    def batches(self) -> list[tuple[int, int]]:
        """Return the ranges of slabs, front to back."""
        first, last = self.slabs
        size = last - first if self.whole else BATCH
        return [(k, min(k + size, last)) for k in range(first, last, size)]

    @property
    def layers_size(self) -> tuple[int, int, int]:
        """Size of the texture of all lights' layers."""
        width, height = self.lamps[0].lattice.size
        return width, height, self.per_light * len(self.lamps)

    def layer(self, light: int, slab: int) -> int:
        """Return the layer that holds what of a light reaches a slab."""
        return light * self.per_light + slab % self.per_light

    def fit(self, device: Device) -> None:
        """Make the stack one batch if its layers fit."""
        self.per_light, self.whole = self.slabs[1], True
        if (
            self.layers_size[2] > device.max_layers
            or math.prod(self.layers_size) * BYTES_PER_TEXEL > WHOLE_BYTES
        ):
            self.per_light, self.whole = LAYERS, False


class OcclusionPainter:
    """Multidirectional occlusion shading; with `headlamp`, its directional special case."""

    def __init__(self, device: Device, *, headlamp: bool = False) -> None:
        self.device = device
        self.headlamp = headlamp
        self.marcher = Marcher(device)
        self._sweepers: list[Sweeper] = []
        self._layers: Any = None
        self._cache = LightCache(self._new_layers, bytes_per_texel=BYTES_PER_TEXEL, store=device.store)
        self._slab_term = SlabTexture(device)

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        yield from self.draw(frame, prepare_material(frame))

    def draw(self, frame: Frame, material: Material, beside: Beside | None = None) -> Iterator[float]:
        """Draw a frame of a material, with light from elsewhere beside the lamps' if there is some."""
        corners = visible_corners(frame, material)
        box = (0, 0, 0, 0) if corners is None else pixel_box(frame, corners)
        if corners is None or is_empty(box):
            self.marcher.clear(frame)
            yield 1.0
            return
        plan = self._plan(frame, material, corners, box)
        program = self._prepare(frame, plan, beside)
        self.marcher.begin(frame)
        if plan.whole:
            layers = yield from self._whole(frame, plan)
            program.bind(u_layers=layers)
            for done in self.marcher.march(frame, program, plan.slabs, box, True):
                yield 0.5 + 0.5 * done
        else:
            yield from self._in_batches(frame, plan, program)
        self.marcher.finish(frame)
        yield 1.0

    def _whole(self, frame: Frame, plan: Plan) -> Generator[float, None, Any]:
        """Return the layers of the whole stack, sweeping the lights unless they are kept."""
        sweep = functools.partial(self._sweep_whole, frame, plan)
        return (yield from self._cache.swept(plan.key, plan.layers_size, sweep))

    def _sweep_whole(self, frame: Frame, plan: Plan, layers: Any) -> Iterator[float]:
        """Sweep the lights through the whole stack, yielding the share done of the frame."""
        self._set_up_sweeps(frame, plan)
        self._layers = layers
        try:
            for done in self._sweep_batch(plan, plan.slabs):
                yield 0.5 * done
        finally:
            self._layers = None

    def _in_batches(self, frame: Frame, plan: Plan, program: Program) -> Iterator[float]:
        """Sweep and march batch by batch."""
        rear = any(lamp.lattice.rear for lamp in plan.lamps)
        total = (plan.slabs[1] - plan.slabs[0]) * (2 if rear else 1)
        done = 0
        if plan.lamps:
            self._set_up_sweeps(frame, plan)
            self._layers = self._new_layers(plan.layers_size)
        try:
            if rear:
                for done in self._sweep_rear(plan):
                    yield done / total
            for number, batch in enumerate(plan.batches()):
                for _ in self._sweep_batch(plan, batch):
                    yield done / total
                if self._layers is not None:
                    program.bind(u_layers=self._layers)
                for _ in self.marcher.march(frame, program, batch, plan.box, number == 0):
                    yield done / total
                done += batch[1] - batch[0]
        finally:
            for kept in plan.kept.values():
                for texture in kept.color_attachments:
                    texture.release()
                kept.release()
            if self._layers is not None:
                self._layers.release()
            self._layers = None

    def _plan(
        self, frame: Frame, material: Material, corners: np.ndarray, box: tuple[int, int, int, int]
    ) -> Plan:
        view = View.of(frame.camera)
        stack = Stack.through(view, crop_corners(frame), frame.step, frame.jitter)
        depths = view.coordinates(corners)[:, 2]
        lights = frame.scene.active_lights
        angles = ((0.0, 0.0),) * len(lights) if self.headlamp else lamp_angles(frame)
        lamps = lamps_for(frame, material, stack, angles, [light.aperture for light in lights])
        slabs, near = stack.slabs_of(depths.min(), depths.max()), near_slabs(frame)
        key = _key(frame, material, stack, lamps, (slabs, near))
        plan = Plan(material, stack, slabs, lamps, angles, box, near, key)
        if lamps:
            plan.fit(self.device)
        return plan

    def _prepare(self, frame: Frame, plan: Plan, beside: Beside | None = None) -> Program:
        """Set up the march program, the sweepers and the textures."""
        params, lamps = frame.params, plan.lamps
        literal = params.occlusion != "extinction"
        variant = Variant(True, SWEPT, len(lamps), literal, plan.near, params.specular > 0)
        if beside is not None:
            variant = replace(variant, local=beside.local, joined=beside.joined, resolved=beside.resolved)
        program = self.marcher.program(variant, plan.material)
        bind_material(program, plan.material, frame)
        if beside is not None:
            beside.bind(program)
        set_view(program, frame, plan.stack)
        program.set(u_ambient=params.ambient, u_specular=params.specular, u_shininess=params.shininess)
        if not lamps:
            return program
        towards = (
            [np.asarray(frame.camera.basis().back)] * len(lamps) if self.headlamp else lights_towards(frame)
        )
        program.set(**light_uniforms(frame, towards), **_lattice_uniforms(frame, plan))
        apertures = [light.aperture for light in frame.scene.active_lights]
        self._slab_term.bind(program, frame, [tilt for tilt, _ in plan.angles], apertures)
        return program

    def _set_up_sweeps(self, frame: Frame, plan: Plan) -> None:
        while len(self._sweepers) < len(plan.lamps):
            self._sweepers.append(Sweeper(self.device))
        for sweeper, lamp in zip(self._sweepers, plan.lamps, strict=False):
            sweeper.prepare(frame, plan.material, lamp)

    def _new_layers(self, size: tuple[int, int, int]) -> Any:
        with self.device.checked(f"{math.prod(size) * BYTES_PER_TEXEL >> 20} MiB for the light's layers"):
            layers = self.device.ctx.texture_array(size, 1, dtype="nu2")
        layers.filter = (moderngl.LINEAR, moderngl.LINEAR)
        layers.repeat_x = layers.repeat_y = False
        return layers

    def _sweep_rear(self, plan: Plan) -> Iterator[int]:
        """Take the lights from behind through all slabs, keeping their state at the batches' far edges."""
        first, last = plan.slabs
        starts = {self._rear_start(plan, batch) for batch in plan.batches()}
        for index in range(last - 1, first - 1, -1):
            for number, (sweeper, lamp) in enumerate(zip(self._sweepers, plan.lamps, strict=False)):
                if lamp.lattice.rear:
                    if index in starts:
                        plan.kept[number, index] = sweeper.keep()
                    sweeper.slab(index, self._layers, plan.layer(number, index))
            if index % PASSES_PER_PIECE == 0:
                self.device.wait()
                yield last - index

    def _rear_start(self, plan: Plan, batch: tuple[int, int]) -> int:
        """Return the slab at which a batch is begun from behind: the ray caster reads a few beyond its end."""
        return min(batch[1] + plan.near, plan.slabs[1]) - 1

    def _sweep_batch(self, plan: Plan, batch: tuple[int, int]) -> Iterator[float]:
        """Take every light through the slabs of a batch, in its own order; yields the share done."""
        first, last = batch
        total = (last - first) * max(1, len(plan.lamps))
        for number, (sweeper, lamp) in enumerate(zip(self._sweepers, plan.lamps, strict=False)):
            order = range(first, last)
            if lamp.lattice.rear:
                start = self._rear_start(plan, batch)
                if not plan.whole:
                    sweeper.load(plan.kept[number, start])
                order = range(start, first - 1, -1)
            for count, index in enumerate(order, 1):
                sweeper.slab(index, self._layers, plan.layer(number, index))
                if count % PASSES_PER_PIECE == 0:
                    self.device.wait()
                    yield (number * (last - first) + count) / total

    def release(self) -> None:
        """Free the GPU objects."""
        self.marcher.release()
        for sweeper in self._sweepers:
            sweeper.release()
        self._slab_term.release()
        self._cache.release()


def _key(frame: Frame, material: Material, stack: Stack, lamps: tuple[Lamp, ...], more: Hashable) -> Hashable:
    """Return what the lights' layers depend on."""
    view = np.concatenate([stack.view.eye, stack.view.axes.ravel(), stack.low, stack.high])
    grids = tuple(
        (lamp.lattice.shear, lamp.lattice.offset, lamp.lattice.size, lamp.lattice.texel, lamp.lattice.rear,
         lamp.stencil, lamp.path, lamp.every)
        for lamp in lamps
    )  # fmt: skip
    return (
        material.opacity_key, frame.scene.clip, frame.scene.crop, frame.params.occlusion,
        np.round(view, 6).tobytes(), round(stack.z0, 6), stack.step, stack.count, grids, more,
    )  # fmt: skip


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
        "u_shear": shear, "u_lattice_origin": origin, "u_rear": rear, "u_layers_per_light": plan.per_light,
        "u_texel": lattice.texel, "u_lattice_size": tuple(map(float, lattice.size)),
        "u_to_light": along, "u_path": path, "u_swept": (plan.slabs[0], plan.slabs[1] - 1),
    }  # fmt: skip
