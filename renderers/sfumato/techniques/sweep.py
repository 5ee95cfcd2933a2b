"""The occlusion sweep: one light's way through the slabs, from plane to plane.

At each slab the light that came through the slab before is filtered by the light's footprint (`footprint`)
on a lattice whose columns follow the footprint's centroid (`stack`), and what the slab absorbs along each
column is taken away. What arrives at a slab is written to a layer of a texture that the ray caster reads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ..gpu import Device, LayerTarget, Program, ShaderSource
from ..gpu.program import RECT_VERTEX
from .footprint import Stencil, effective_secant, kernel_moments, stencil_for
from .frame import Frame
from .marcher import Material, bind_material, material_defines
from .stack import Lattice, Stack

#: Texels around what is visible that are swept too: what the footprint's tail carries out may come back.
MARGIN = 4

#: The forms of occlusion and their number in the shader.
FORMS = {"extinction": 0, "additive": 1, "multiplicative": 2}


@dataclass(frozen=True)
class Lamp:
    """What the sweep needs of one light.

    Attributes
    ----------
    path : float
        Length of the light's way through a slab over the slab's thickness.
    rects : ndarray of int, shape (slabs, 4)
        Texels to sweep: x0, y0, x1, y1.
    """

    lattice: Lattice
    stencil: Stencil
    path: float
    rects: np.ndarray


def lamp_for(frame: Frame, stack: Stack, corners: np.ndarray, angles: tuple[float, float], aperture: float) -> Lamp:
    """Return lattice, stencil and rectangles of a light given by (tilt, rotation) and aperture in degrees."""
    tilt, rotation = angles
    moments = kernel_moments(tilt, aperture, frame.params.falloff)
    texel = frame.volume.min_spacing / frame.params.resolution * frame.quality.light
    lattice = Lattice.over(stack, texel, moments.mean, rotation, tilt > 90)
    # The nominal step in place of one of the two: a drag with fewer slabs blurs as much as the full picture.
    area = stack.step * frame.nominal_step / texel**2
    c, s = math.cos(math.radians(rotation)), math.sin(math.radians(rotation))
    along, across = moments.along * area, moments.across * area
    stencil = stencil_for(along * c * c + across * s * s, (along - across) * c * s, along * s * s + across * c * c)
    return Lamp(lattice, stencil, effective_secant(tilt, aperture), lattice.rects(corners, MARGIN))


class Sweeper:
    """Carries one light's occlusion from slab to slab, through two states that take turns."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._programs: dict[tuple[tuple[str, int], ...], Program] = {}
        self._targets: list[LayerTarget] = []
        self._frame: Frame | None = None
        self._clear = 1.0

    def prepare(self, frame: Frame, material: Material, lamp: Lamp) -> None:
        """Begin with a light, where no slab has taken any of it yet."""
        form = FORMS[frame.params.occlusion]
        defines = (("LITERAL", form), *material_defines(material))
        if defines not in self._programs:
            source = ShaderSource("techniques/sweep.frag.glsl", defines)
            self._programs[defines] = Program(self.device, source, RECT_VERTEX)
        size = lamp.lattice.size
        if not self._targets or self._targets[0].state.size != size:
            self._release_targets()
            self._targets = [LayerTarget(self.device, new_state(self.device, size)) for _ in range(2)]
        self._program, self._lamp = self._programs[defines], lamp
        self._clear = 0.0 if form == FORMS["additive"] else 1.0
        bind_material(self._program, material, frame)
        taps = np.array(lamp.stencil.taps, dtype=np.int32)
        self._program.set(
            u_extent=tuple(map(float, size)), u_thickness=frame.step, u_path=lamp.path, u_taps=taps,
            u_weights=(lamp.stencil.center, *lamp.stencil.weights),
        )  # fmt: skip
        self._to_texture = _texture_from_view(frame, lamp.lattice.stack)
        self._targets[0].fbo.clear(self._clear, -1.0)

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
        enter, leave, before = (index + 1, index, index + 2) if lattice.rear else (index, index + 1, index - 1)
        target.use(layers, layer)
        # Beyond the rectangle nothing stands in the light.
        target.fbo.clear(self._clear, -1.0)
        x0, y0, x1, y1 = (int(v) for v in self._lamp.rects[index])
        if x0 >= x1 or y0 >= y1:
            return
        base = lattice.base(enter)
        self._program.bind(u_state=source.state)
        self._program.set(
            u_shift=tuple((base - lattice.base(before)).tolist()),
            u_enter=self._affine(lattice.positions(enter, base)),
            u_leave=self._affine(lattice.positions(leave, base)),
        )
        width, height = lattice.size
        self._program.draw(rect=(2 * x0 / width - 1, 2 * y0 / height - 1, 2 * x1 / width - 1, 2 * y1 / height - 1))

    def _affine(self, positions: np.ndarray) -> tuple[float, ...]:
        """Return the 3 x 3 from texels to texture coordinates, column by column."""
        matrix = self._to_texture[:3, :3] @ positions
        matrix[:, 2] += self._to_texture[:3, 3]
        return tuple(matrix.T.ravel().tolist())

    def release(self) -> None:
        """Free programs and states."""
        for program in self._programs.values():
            program.release()
        self._programs.clear()
        self._release_targets()

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


def _texture_from_view(frame: Frame, stack: Stack) -> np.ndarray:
    """Return the affine 4 x 4 from (lateral x, lateral y, depth) in mm to texture coordinates."""
    to_world = np.eye(4)
    to_world[:3, :3] = stack.view.axes.T
    to_world[:3, 3] = stack.view.eye
    return np.asarray(frame.volume.texture_from_world @ to_world)
