"""The passes of half-angle slicing: each slice is drawn into the picture, then into the light's buffer.

Per slice, the picture reads what light has come through the slices before; only then is the slice's own
share taken away. Soft shadows spread that light over the lamp's aperture on its way (two buffers that take
turns, since no pass may read what it writes); hard ones multiply a single buffer in place.
"""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ...gpu import Device, Program, Target, Variants
from ..footprint import kernel_moments, stencil_for
from ..frame import Frame
from ..marcher import (
    Material,
    bind_material,
    crop_corners,
    lights_towards,
    material_defines,
    near_depth,
    prepare_material,
    set_view,
    visible_corners,
)
from .slices import VERTICES, LightGrid, Slices, half_vector

FOLDER = "techniques/half_angle/"
#: Slices drawn between two looks at whether a newer scene is there.
SLICES_PER_PIECE = 16
#: Blending of premultiplied colours: over what lies behind, and under what lies before.
OVER = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
UNDER = moderngl.ONE_MINUS_DST_ALPHA, moderngl.ONE


@dataclass
class Plan:
    """All that is decided before the first slice of a frame.

    Attributes
    ----------
    secant : float
        Of the light against the slices' normal.
    reverse : bool
        Whether the light stands behind the subject.
    """

    material: Material
    slices: Slices
    grid: LightGrid
    secant: float
    reverse: bool
    soft: bool


class HalfAnglePainter:
    """Half-angle slicing for the first active light."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._eye = Variants(device, FOLDER + "eye.frag.glsl", FOLDER + "slice.vert.glsl")
        self._hard = Variants(device, FOLDER + "light.frag.glsl", FOLDER + "slice.vert.glsl")
        self._soft = Variants(device, FOLDER + "light.frag.glsl")
        self._buffers: list[Target] = []

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        frame.target.clear()
        material = prepare_material(frame)
        corners = visible_corners(frame, material)
        plan = None if corners is None else plan_slices(frame, material, corners)
        if corners is None or plan is None or plan.slices.count == 0:
            yield 1.0
            return
        triangles = self.device.ctx.buffer(plan.slices.triangles(corners).tobytes())
        try:
            eye = self._prepare_eye(frame, plan, triangles)
            light = self._prepare_light(frame, plan, triangles)
            count = plan.slices.count
            for first in range(0, count, SLICES_PER_PIECE):
                last = min(first + SLICES_PER_PIECE, count)
                for number in range(first, last):
                    self._draw_to_eye(frame, eye, plan, number)
                    self._draw_to_light(light, plan, number)
                self.device.wait()
                yield last / count
        finally:
            triangles.release()

    def _prepare_eye(self, frame: Frame, plan: Plan, triangles: Any) -> Program:
        """Set up the program that draws slices into the picture."""
        lights = frame.scene.active_lights[:1]
        color = np.asarray(lights[0].color) * lights[0].intensity if lights else np.zeros(3)
        emits = plan.material.tables.emits
        program = self._eye.get(
            (("REVERSE", int(plan.reverse)), ("EMISSION", int(emits)), *material_defines(plan.material))
        )
        bind_material(program, plan.material, frame)
        set_view(program, frame, None)
        program.load_mesh(triangles, "in_world")
        half_way = plan.grid.towards * (plan.secant * plan.slices.spacing / 2)
        program.set(
            u_light_half=tuple((frame.volume.texture_from_world[:3, :3] @ half_way).tolist()),
            u_picture_from_world=_column_by_column(picture_from_world(frame)),
            u_light_from_world=_column_by_column(plan.grid.coordinates_from_world),
            u_axis=tuple(plan.slices.axis.tolist()), u_spacing=plan.slices.spacing,
            u_light_secant=plan.secant, u_light_color=tuple(color.tolist()),
            u_facing=1 / facing_surface(frame),
        )  # fmt: skip
        return program

    def _prepare_light(self, frame: Frame, plan: Plan, triangles: Any) -> Program:
        """Set up the program that draws slices into the light buffer, and fill the buffer with light."""
        self._make_buffers(plan)
        variants = self._soft if plan.soft else self._hard
        program = variants.get((("SOFT", int(plan.soft)), *material_defines(plan.material)))
        bind_material(program, plan.material, frame)
        column, slope = plan.grid.columns(plan.slices.axis)
        to_texture = frame.volume.texture_from_world
        column = to_texture[:3, :3] @ column
        column[:, 2] += to_texture[:3, 3]
        program.set(
            u_column=_column_by_column(column), u_along=tuple((to_texture[:3, :3] @ slope).tolist()),
            u_spacing=plan.slices.spacing, u_light_secant=plan.secant,
        )  # fmt: skip
        if not plan.soft:
            program.load_mesh(triangles, "in_world")
            program.set(u_picture_from_world=_column_by_column(_drawn_over(plan.grid.coordinates_from_world)))
            return program
        aperture = frame.scene.active_lights[0].aperture
        # The nominal step in place of one of the two: a drag with fewer slices blurs as much as the picture.
        area = frame.step * frame.nominal_step * (plan.secant / plan.grid.texel) ** 2
        variance = kernel_moments(0.0, aperture).across * area
        stencil = stencil_for(variance, 0.0, variance)
        taps = np.array(stencil.taps, dtype=np.int32)
        program.set(u_taps=taps, u_weights=(stencil.center, *stencil.weights))
        return program

    def _draw_to_eye(self, frame: Frame, program: Program, plan: Plan, number: int) -> None:
        ctx = self.device.ctx
        frame.target.fbo.use()
        program.bind(u_light=self._buffers[0].texture)
        program.set(u_height=float(plan.slices.heights[number]))
        ctx.enable(moderngl.BLEND)
        ctx.blend_func = OVER if plan.reverse else UNDER
        program.draw_mesh(number * VERTICES, VERTICES)
        ctx.disable(moderngl.BLEND)

    def _draw_to_light(self, program: Program, plan: Plan, number: int) -> None:
        ctx = self.device.ctx
        program.set(u_height=float(plan.slices.heights[number]))
        if plan.soft:
            source, target = self._buffers
            target.fbo.use()
            program.bind(u_light=source.texture)
            program.draw()
            self._buffers = [target, source]
            return
        self._buffers[0].fbo.use()
        ctx.enable(moderngl.BLEND)
        ctx.blend_func = moderngl.ZERO, moderngl.SRC_COLOR
        program.draw_mesh(number * VERTICES, VERTICES)
        ctx.disable(moderngl.BLEND)

    def _make_buffers(self, plan: Plan) -> None:
        wanted = 2 if plan.soft else 1
        if len(self._buffers) < wanted or self._buffers[0].size != plan.grid.size:
            self._release_buffers()
            self._buffers = [Target(self.device, plan.grid.size, components=1) for _ in range(wanted)]
            for buffer in self._buffers:
                buffer.texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self._buffers[0].clear(1.0)

    def release(self) -> None:
        """Free the GPU objects."""
        for variants in (self._eye, self._hard, self._soft):
            variants.release()
        self._release_buffers()

    def _release_buffers(self) -> None:
        for buffer in self._buffers:
            buffer.release()
        self._buffers = []


def plan_slices(frame: Frame, material: Material, corners: np.ndarray) -> Plan:
    """Return the slices through what is visible, given by its box's corners, and the light's grid over it."""
    basis = frame.camera.basis()
    back = np.asarray(basis.back)
    lit = bool(frame.scene.active_lights)
    towards = lights_towards(frame)[0] if lit else back
    axis, reverse = half_vector(back, towards)
    slices = Slices.through(axis, crop_corners(frame), corners, frame.step, frame.jitter)
    upright = np.array([basis.right, basis.up, -back if reverse else back])
    texel = frame.volume.min_spacing / frame.params.resolution * frame.quality.light
    grid = LightGrid.over(corners, towards, upright, texel, frame.lattice_jitter)
    return Plan(material, slices, grid, 1 / float(axis @ towards), reverse, lit and frame.params.softness)


def facing_surface(frame: Frame) -> float:
    """Return what a solid surface that faces the viewer sends back of parallel light: 1 / (1 + s)."""
    tilt = frame.scene.light_angles()[0][0] if frame.scene.active_lights else 0.0
    return 1 / (1 + 1 / max(abs(math.cos(math.radians(tilt))), 1e-3))


def picture_from_world(frame: Frame) -> np.ndarray:
    """Return the 4 x 4 from world mm to clip space that belongs to the jittered rays of ``ray.glsl``."""
    basis, (width, height) = frame.camera.basis(), frame.whole_size
    to_view = np.eye(4)
    to_view[:3, :3] = [basis.right, basis.up, basis.forward]
    to_view[:3, 3] = -to_view[:3, :3] @ np.asarray(frame.camera.position)
    half = frame.camera.half_extent(width / height)
    shift = np.asarray(frame.camera.window_center) + 2 * np.asarray(frame.pixel_jitter) / (width, height)
    clip = np.zeros((4, 4))
    clip[0, 0], clip[1, 1] = 1 / half[0], 1 / half[1]
    if frame.camera.parallel_projection:
        clip[:2, 3], clip[3, 3] = -shift, 1.0
    else:
        clip[:2, 2], clip[3, 2] = -shift, 1.0
        # -w <= z exactly where the depth is beyond the near plane; there is no far plane.
        clip[2, 2], clip[2, 3] = 1.0, -2 * near_depth(frame)
    part = np.eye(4)
    for axis in (0, 1):
        share = frame.size[axis] / frame.whole_size[axis]
        part[axis, axis] = 1 / share
        part[axis, 3] = (1 - 2 * frame.corner[axis] / frame.whole_size[axis]) / share - 1
    return np.asarray(part @ clip @ to_view)


def _drawn_over(coordinates: np.ndarray) -> np.ndarray:
    """Return the 4 x 4 to clip space that belongs to an affine 2 x 4 to [0, 1]^2."""
    clip = np.zeros((4, 4))
    clip[:2] = 2 * coordinates
    clip[:2, 3] -= 1
    clip[3, 3] = 1
    return clip


def _column_by_column(matrix: np.ndarray) -> tuple[float, ...]:
    return tuple(matrix.T.ravel().tolist())
