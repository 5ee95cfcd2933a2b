"""The passes of `local-occlusion`: blocks, some more directions of light, ray casting."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator
from dataclasses import replace

import numpy as np

from ...gpu import Device, Program
from ...pieces import spanned
from ..frame import Frame
from ..lamp_shadows import Lamps, LampShadows
from ..marcher import (
    LOCAL,
    VOLUMES,
    Marcher,
    Material,
    Variant,
    bind_material,
    is_empty,
    light_uniforms,
    lights_towards,
    prepare_material,
    set_view,
    visible_box,
)
from ..multidirectional.params import MultidirectionalParams
from ..multidirectional.passes import Beside, OcclusionPainter
from .blocks import Blocks, is_whole, prepare_blocks
from .gather import Gatherer, LightMap
from .pyramid import EDGE
from .resolve import ResolvedLight, Resolver

#: Directions without which no picture is shown.
LEAST = 4
#: Seconds of gathering before a picture that is to come soon; or as long as the drawing of the last one took.
SECONDS = 0.1
#: Progress of a frame when its light is gathered, resolved, and the lamps' is swept.
GATHERED, RESOLVED, SWEPT = 0.4, 0.5, 0.7
#: How the lamps are combined with the light from all around (``local_light.glsl``).
PRODUCT, MIX = 1, 2


class LocalOcclusionPainter:
    """Local ambient occlusion; gathers light while pictures are drawn."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.marcher = Marcher(device)
        self.gatherer = Gatherer(device)
        self.resolver = Resolver(device)
        self.shadows = LampShadows(device)
        self.swept = OcclusionPainter(device)
        self._drawing = SECONDS

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        whole = is_whole(frame)
        material = prepare_material(frame, whole=whole)
        box = visible_box(frame, material)
        if is_empty(box):
            self.marcher.clear(frame)
            yield 1.0
            return
        blocks = prepare_blocks(frame, material)
        material = material if whole else replace(material, packed=blocks)
        yield 0.0
        light = self.gatherer.light_map(frame, material, blocks)
        least, seconds = (LEAST, max(SECONDS, self._drawing)) if frame.quality.progressive else (1 << 20, 0.0)
        if not frame.unshadowed:
            for done in self.gatherer.gather(frame, material, blocks, light, least, seconds):
                yield GATHERED * done
        frame.light = light.share
        began = time.perf_counter()
        resolved = self.resolver.resolved(frame, blocks, light)
        if resolved is not None:
            for done in self.resolver.resolve(frame, blocks, light, resolved):
                yield GATHERED + (RESOLVED - GATHERED) * done
        if frame.params.lamps == "multidirectional" and frame.scene.active_lights:
            yield from self._draw_swept(frame, material, blocks, resolved or light)
            self._drawing = time.perf_counter() - began
            return
        program = yield from self._program(frame, material, blocks, resolved or light)
        self.marcher.begin(frame)
        for done in self.marcher.march(frame, program, (0, 1 << 24), box, True):
            yield SWEPT + (1 - SWEPT) * done
        self.marcher.finish(frame)
        self._drawing = time.perf_counter() - began
        yield 1.0

    def _program(
        self, frame: Frame, material: Material, blocks: Blocks, light: LightMap | ResolvedLight
    ) -> Generator[float, None, Program]:
        """Set up the ray caster; sweeps lamps that cast shadows, if they have to be."""
        params, active = frame.params, len(frame.scene.active_lights)
        variant = Variant(
            shading=LOCAL, local=combination(frame), joined=params.joined, adaptive=params.adaptive,
            resolved=isinstance(light, ResolvedLight),
        )  # fmt: skip
        lamps = None
        if params.lamps == "diffuse":
            variant = replace(variant, lights=active)
        elif params.lamps == "shadows" and active:
            lamps = yield from spanned(
                # A sweep by itself is the first half of a frame.
                self.shadows.prepare(frame, material),
                RESOLVED,
                2 * SWEPT - RESOLVED,
            )
            variant = replace(
                variant, slices=True, shading=VOLUMES, lights=active, near=lamps.ways.samples, adaptive=False
            )
        program = self.marcher.program(variant, shown_emission(frame, material))
        bind_material(program, material, frame)
        self._bind_lamps(program, frame, lamps)
        bind_light(program, frame, blocks, light)
        return program

    def _draw_swept(
        self, frame: Frame, material: Material, blocks: Blocks, light: LightMap | ResolvedLight
    ) -> Iterator[float]:
        """Draw a frame with the lamps of `multidirectional` beside the light around."""
        beside = Beside(
            combination(frame), frame.params.joined, isinstance(light, ResolvedLight),
            lambda program: bind_light(program, frame, blocks, light),
        )  # fmt: skip
        swept = replace(frame, scene=frame.scene.with_(technique=MultidirectionalParams()))
        for done in self.swept.draw(swept, shown_emission(frame, material), beside):
            yield RESOLVED + (1 - RESOLVED) * done

    def _bind_lamps(self, program: Program, frame: Frame, lamps: Lamps | None) -> None:
        """Set the lamps and the view."""
        program.set(u_ambient=0.0, **light_uniforms(frame, lights_towards(frame)))
        if lamps is None:
            set_view(program, frame, None)
        else:
            self.shadows.bind(program, frame, lamps)

    def release(self) -> None:
        """Free the GPU objects."""
        self.marcher.release()
        self.gatherer.release()
        self.resolver.release()
        self.shadows.release()
        self.swept.release()


def combination(frame: Frame) -> int:
    """Return how lamps and the light around are combined, as `Variant.local`."""
    return PRODUCT if frame.params.mode == "product" else MIX


def shown_emission(frame: Frame, material: Material) -> Material:
    """Return the material as the ray caster is to see it: what shines may do so on its surroundings alone."""
    emits = material.tables.emits and frame.params.emission in ("both", "casting")
    return replace(material, tables=replace(material.tables, emits=emits))


def bind_light(program: Program, frame: Frame, blocks: Blocks, light: LightMap | ResolvedLight) -> None:
    """Set what ``local_light.glsl`` needs."""
    params = frame.params
    blocks.bind(program, frame)
    if isinstance(light, ResolvedLight):
        light.bind(program, np.asarray(frame.volume.dims) / EDGE)
    else:
        program.bind(u_map=light.texture)
    program.set(
        u_brightness=params.brightness, u_bias=params.bias, u_share=params.share, u_facing=params.facing,
    )  # fmt: skip
