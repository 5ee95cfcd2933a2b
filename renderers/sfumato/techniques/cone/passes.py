"""The passes of `cone`: each lamp's light into a texture of its own, then one ray casting that reads them."""

from __future__ import annotations

from collections.abc import Generator

from ...gpu import Device, Program
from ..frame import Frame
from ..lamp_shadows import Lamps, LampShadows
from ..marcher import (
    VOLUMES,
    Marcher,
    Material,
    Variant,
    bind_material,
    is_empty,
    light_uniforms,
    lights_towards,
    prepare_material,
    visible_box,
)


class ConePainter:
    """Cone-accurate shadows by the light prepass."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.marcher = Marcher(device)
        self.shadows = LampShadows(device)

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        material = prepare_material(frame)
        box = visible_box(frame, material)
        if is_empty(box):
            self.marcher.clear(frame)
            yield 1.0
            return
        lamps = yield from self.shadows.prepare(frame, material)
        program = self._program(frame, material, lamps)
        self.marcher.begin(frame)
        for done in self.marcher.march(frame, program, (0, 1 << 24), box, True):
            yield 0.5 + 0.5 * done
        self.marcher.finish(frame)
        yield 1.0

    def _program(self, frame: Frame, material: Material, lamps: Lamps) -> Program:
        """Set up the ray caster."""
        params = frame.params
        variant = Variant(True, VOLUMES, len(lamps.grids), False, lamps.ways.samples, params.specular > 0)
        program = self.marcher.program(variant, material)
        bind_material(program, material, frame)
        program.set(
            u_ambient=params.ambient, u_specular=params.specular, u_shininess=params.shininess,
            **light_uniforms(frame, lights_towards(frame)),
        )  # fmt: skip
        self.shadows.bind(program, frame, lamps)
        return program

    def release(self) -> None:
        """Free the GPU objects."""
        self.marcher.release()
        self.shadows.release()
