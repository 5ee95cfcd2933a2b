"""The passes of `extinction` (Schlegel2011, Algorithm 1): field, terms, light cache, ray casting."""

from __future__ import annotations

import functools
from collections.abc import Generator, Hashable, Iterator
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ...gpu import LAYERED, Device, Program, Variants
from ..frame import Frame
from ..light_cache import LightCache
from ..marcher import (
    BAKED,
    WORLD,
    Marcher,
    Material,
    Variant,
    bind_material,
    is_empty,
    prepare_material,
    set_view,
    visible_box,
)
from ..world_light import CellGrid, grid_over, place_uniforms
from .baked import Baker, greatest_light
from .field import Field, FieldMaker, draw_layers, lift, new_texture
from .lamps import Emitter, emitter
from .terms import TermMaker, densities

#: Cells along the longest side of an automatic cache, at least and at most.
AUTOMATIC = (64, 128)
#: Voxels to a cell of an automatic cache.
VOXELS_A_CELL = 2.0
#: Fewest cells along the longest side while the user drags.
FEWEST = 32
#: Radius of the automatic shells over the volume's longest side.
RADIUS = 0.08
#: Bytes of a cell's field: two tables of means and sums, and where light matters.
FIELD_BYTES = 50
#: Lamps that the ray caster knows one by one; the light of further ones is summed.
OWN_LAMPS = 4


class World:
    """The two textures that the ray caster reads."""

    def __init__(self, device: Device, size: tuple[int, int, int]) -> None:
        self.size = size
        self.world = new_texture(device, size, 4, "f2", linear=True)
        # As exact as lamp 0 in `world`, so that a lamp alone is lit as it is among others.
        self.lamps = new_texture(device, size, 4, "f2", linear=True)

    def release(self) -> None:
        """Free the textures."""
        self.world.release()
        self.lamps.release()


@dataclass(frozen=True)
class Plan:
    """What a frame's light consists of, by keys of what may be there already."""

    grid: CellGrid
    field: Hashable
    ambient: Hashable
    lamps: tuple[Emitter, ...]
    lamp_keys: tuple[Hashable, ...]
    world: Hashable


class ExtinctionPainter:
    """Extinction-based shading with a light cache."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.marcher = Marcher(device)
        self.fields = FieldMaker(device)
        self.terms = TermMaker(device)
        self.baker = Baker(device)
        folder = "techniques/extinction/"
        self._compose = Variants(device, folder + "compose.frag.glsl", *LAYERED)
        self._further = Variants(device, folder + "further.frag.glsl", *LAYERED)
        store = device.store
        self.kept_fields = LightCache(None, store=store, bytes_per_texel=FIELD_BYTES)
        self.kept_ambient = LightCache(
            lambda size: new_texture(device, size, 4, "nu2"), store=store, bytes_per_texel=8
        )
        self.kept_lamps = LightCache(
            lambda size: new_texture(device, size, 1, "nu2"), store=store, bytes_per_texel=2
        )
        self.kept_worlds = LightCache(lambda size: World(device, size), store=store, bytes_per_texel=16)

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        material = prepare_material(frame)
        box = visible_box(frame, material)
        if is_empty(box):
            self.marcher.clear(frame)
            yield 1.0
            return
        plan = self._plan(frame, material)
        world = yield from self._light(frame, material, plan)
        program = yield from self._program(frame, material, plan, world)
        self.marcher.begin(frame)
        for done in self.marcher.march(frame, program, (0, 1 << 24), box, True):
            yield 0.5 + 0.5 * done
        self.marcher.finish(frame)
        yield 1.0

    def forget(self) -> None:
        """Free all light that is kept: the next frame makes it anew."""
        for kept in (self.kept_worlds, self.kept_lamps, self.kept_ambient, self.kept_fields):
            kept.clear()
        self.baker.clear()

    # -- the light cache --------------------------------------------------------------------------
    def _plan(self, frame: Frame, material: Material) -> Plan:
        """Plan the light: at full resolution when asked for, or when nothing is missing at it."""
        plan = _plan(frame, material, longest_side(frame))
        if frame.quality.light <= 1 or self.kept_worlds.find(plan.world) is not None:
            return plan
        return _plan(frame, material, max(FEWEST, round(longest_side(frame) / frame.quality.light)))

    def _light(self, frame: Frame, material: Material, plan: Plan) -> Generator[float, None, World]:
        """Return the light cache, making what is not there yet; yields the share done of the frame."""
        kept: World | None = self.kept_worlds.find(plan.world)
        if kept is not None:
            return kept
        params, grid, size = frame.params, plan.grid, plan.grid.size
        radius, number = shell_radius(frame), len(plan.lamps)
        share = 0.5 / (number + 2)
        field = yield from self._field(frame, material, plan, share)
        ambient = None
        if plan.ambient is not None:
            make = functools.partial(self.terms.ambient, field, grid, params, radius)
            ambient = yield from self.kept_ambient.swept(plan.ambient, size, _part(make, share, share))
        lamps = []
        for k, (lamp, key) in enumerate(zip(plan.lamps, plan.lamp_keys, strict=True)):
            make_lamp = functools.partial(self.terms.lamp, field, grid, params, lamp)
            part = _part(make_lamp, share * (2 + k), share)
            lamps.append((yield from self.kept_lamps.swept(key, size, part, k)))
        compose = functools.partial(self._fill_world, frame, ambient, lamps)
        world: World = yield from self.kept_worlds.swept(plan.world, size, _part(compose, 0.5, 0.0))
        return world

    def _field(
        self, frame: Frame, material: Material, plan: Plan, share: float
    ) -> Generator[float, None, Field]:
        kept: Field | None = self.kept_fields.find(plan.field)
        if kept is not None:
            return kept
        old = self.kept_fields.make_room(plan.grid.size)
        if old is not None:
            old.release()
        field = Field(self.device, plan.grid.size, plan.ambient is not None, frame.volume.unit_distance)
        complete = False
        try:
            limits = densities(_longest_mm(frame), shell_radius(frame))
            for done in self.fields.make(frame, material, plan.grid, limits, field):
                yield share * done
            complete = True
        finally:
            if not complete:
                field.release()
        self.kept_fields.keep(plan.field, field)
        return field

    def _fill_world(
        self, frame: Frame, ambient: Any, lamps: list[Any], world: World
    ) -> Generator[float, None, None]:
        """Put the terms together."""
        own = min(len(lamps), OWN_LAMPS)
        program = self._compose.get((("AMBIENT", int(ambient is not None)), ("LAMPS", own)))
        if ambient is not None:
            program.bind(u_ambient=ambient)
        program.bind(**{f"u_lamp{k}": lamps[k] for k in range(own)})
        program.set(u_ambient_light=(frame.params.ambient,) * 3)
        yield from draw_layers(self.device, program, world.world, world.lamps)
        for light, lamp in zip(frame.scene.active_lights[own:], lamps[own:], strict=True):
            further = self._further.get(())
            further.bind(u_lamp=lamp)
            further.set(u_color=tuple((np.asarray(light.color) * light.intensity).tolist()))
            ctx = self.device.ctx
            ctx.enable(moderngl.BLEND)
            ctx.blend_func = moderngl.ONE, moderngl.ONE
            try:
                for _ in draw_layers(self.device, further, world.world):
                    pass
            finally:
                ctx.disable(moderngl.BLEND)

    # -- the ray caster ---------------------------------------------------------------------------
    def _program(
        self, frame: Frame, material: Material, plan: Plan, world: World
    ) -> Generator[float, None, Program]:
        """Return the ray caster's program, all set; yields the share done of the frame."""
        params, own = frame.params, min(len(frame.scene.active_lights), OWN_LAMPS)
        sloped = params.specular > 0 or params.facing > 0
        bind = functools.partial(self._bind_world, frame, plan.grid, world, own)
        if not sloped and self.baker.pays(frame, plan.grid.cell_mm, key := _baked_key(frame, material, plan)):
            volume = yield from self.baker.volume(frame, material, key, own, bind)
            program = self.marcher.program(Variant(shading=BAKED), material)
            bind_material(program, material, frame)
            program.bind(u_volume=volume)
            program.set(u_light_scale=greatest_light(frame))
        else:
            variant = Variant(
                shading=WORLD, lights=own, specular=params.specular > 0, facing=params.facing > 0
            )
            program = self.marcher.program(variant, material)
            bind_material(program, material, frame)
            bind(program)
        set_view(program, frame, None)
        return program

    def _bind_world(self, frame: Frame, grid: CellGrid, world: World, own: int, program: Program) -> None:
        """Let a program read the light cache (``world_light.glsl``)."""
        params = frame.params
        program.bind(u_world_light=world.world, u_world_lamps=world.lamps)
        program.set(
            u_facing=params.facing, u_specular=params.specular, u_shininess=params.shininess,
            **{**grid.uniforms, "u_world_lift": lift(grid, frame.volume.unit_distance)}, **place_uniforms(frame, own),
        )  # fmt: skip

    def release(self) -> None:
        """Free the GPU objects."""
        parts: tuple[Any, ...] = (
            self.marcher, self.fields, self.terms, self.baker, self._compose, self._further,
            self.kept_fields, self.kept_ambient, self.kept_lamps, self.kept_worlds,
        )  # fmt: skip
        for part in parts:
            part.release()


def _part(make: Any, start: float, share: float) -> Any:
    """Return a maker whose progress is a part of the frame's."""

    def made(texture: Any) -> Iterator[float]:
        for done in make(texture):
            yield start + share * done

    return made


def shell_radius(frame: Frame) -> float:
    """Return half the outermost shell's edge in mm."""
    if frame.params.radius is not None:
        return float(frame.params.radius)
    return RADIUS * _longest_mm(frame)


def _longest_mm(frame: Frame) -> float:
    return float(np.max(np.asarray(frame.volume.dims) * frame.volume.spacing))


def longest_side(frame: Frame) -> int:
    """Return the cells of the light cache along its longest side, as wished or as the volume and memory allow."""
    wished = frame.params.resolution
    if wished is None:
        wished = int(np.clip(round(max(frame.volume.dims) / VOXELS_A_CELL), *AUTOMATIC))
    # The tables, and what the second is made from, take two fifths of the memory at most.
    fitting = int((0.4 * frame.device.store.budget / (FIELD_BYTES + 16)) ** (1 / 3))
    return max(16, min(int(wished), frame.device.max_texture_3d, fitting))


def _plan(frame: Frame, material: Material, longest: int) -> Plan:
    params, scene = frame.params, frame.scene
    grid, radius = grid_over(frame, material, longest), shell_radius(frame)
    shelled = params.shells > 0 and params.ambient > 0 and not frame.unshadowed
    shown = (frame.volume.key, frame.transfer) if shelled and params.bleeding > 0 else material.opacity_key
    matter = (material.opacity_key, scene.clip, scene.crop, grid)
    field = (matter, (shown, params.bleeding, radius) if shelled else None)
    ambient = (field, params.shells, params.shell_strength) if shelled else None
    lamps = tuple(emitter(frame, grid, light) for light in scene.active_lights)
    cones = (params.strength, params.samples, params.growth, params.cones)
    lamp_keys = tuple((matter, lamp.key, cones) for lamp in lamps)
    further = tuple((light.color, light.intensity) for light in scene.active_lights[OWN_LAMPS:])
    world = (ambient, params.ambient, lamp_keys, further)
    return Plan(grid, field, ambient, lamps, lamp_keys, world)


def _baked_key(frame: Frame, material: Material, plan: Plan) -> Hashable:
    lamps = tuple((light.color, light.intensity) for light in frame.scene.active_lights)
    return plan.grid, plan.world, material.opacity_key, lamps
