"""The surfaces' picture (the paper's G-buffer), rasterised once for each view of them; wider than the frame."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from typing import Any

import numpy as np

from ...gpu import Device, Program, Variants
from ...gpu.surface_target import SurfaceTarget
from ...scene.vectors import box_corners
from ..frame import Frame
from ..marcher import near_depth
from .meshes import LAYOUT, MeshBuffers, Shown
from .surfels import cut_key, kept_uniforms

#: Indices that are drawn between two looks at whether a newer scene is there.
PIECE = 3 << 19
_FOLDER = "techniques/combined/"


class SurfacePainter:
    """Draws meshes into a `SurfaceTarget`."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._programs = Variants(device, _FOLDER + "surface.frag.glsl", _FOLDER + "surface.vert.glsl")
        self.target: SurfaceTarget | None = None
        #: What the target shows, whole; None while it is drawn.
        self._shown: Hashable = None

    def draw(
        self, frame: Frame, shown: tuple[Shown, ...], meshes: tuple[MeshBuffers, ...], margin: int
    ) -> Iterator[float]:
        """Draw what is shown, with `margin` pixels more on each side, yielding after each bounded piece.

        What is there already stays: a lamp that moves, or another transfer function, changes no surface.
        """
        target = self._target_of((frame.size[0] + 2 * margin, frame.size[1] + 2 * margin))
        wanted = _key(frame, shown, meshes, margin)
        if wanted == self._shown:
            return
        self.forget()
        target.clear()
        uniforms = _camera(frame, meshes, margin)
        for item, mesh in zip(shown, meshes, strict=True):
            program = self._programs.get((("CUT", int(item.clipped)), ("CLIPS", int(item.clipped))))
            program.set(**uniforms, **_place(frame, mesh))
            if item.clipped:
                matrix = frame.volume.texture_from_world.T.ravel().tolist()
                program.set(u_texture_from_world=tuple(matrix), **kept_uniforms(frame))
            for first in range(0, mesh.count, PIECE):
                self._piece(target, program, mesh, first)
                yield (first + PIECE) / mesh.count
        self._shown = wanted

    def forget(self) -> None:
        """Draw anew next time, whatever is there."""
        self._shown = None

    def _piece(self, target: SurfaceTarget, program: Program, mesh: MeshBuffers, first: int) -> None:
        target.begin()
        try:
            program.draw_buffers(
                mesh.vertices, LAYOUT, ("a_p", "a_normal", "a_color"), mesh.indices, first,
                min(PIECE, mesh.count - first),
            )  # fmt: skip
        finally:
            target.end()
        self.device.wait()

    def _target_of(self, size: tuple[int, int]) -> SurfaceTarget:
        if self.target is None or self.target.size != size:
            self._release_target()
            self.target = SurfaceTarget(self.device, size)
        return self.target

    def release(self) -> None:
        """Free the GPU objects."""
        self._programs.release()
        self._release_target()

    def _release_target(self) -> None:
        if self.target is not None:
            self.target.release()
        self.target = None
        self.forget()


def _key(frame: Frame, shown: tuple[Shown, ...], meshes: tuple[MeshBuffers, ...], margin: int) -> Hashable:
    """Return what the picture of surfaces depends on."""
    things = tuple((item.geometry.mesh_key, item.drawn is item.mesh, cut_key(frame, item)) for item in shown)
    view = frame.camera, frame.whole_size, frame.size, frame.corner, tuple(frame.pixel_jitter), margin
    return view, things, depth_range(frame, meshes)


def depth_range(frame: Frame, meshes: tuple[MeshBuffers, ...]) -> tuple[float, float]:
    """Return the nearest and farthest depth in mm that meshes can have before the camera."""
    basis = frame.camera.basis()
    depths = [(box_corners(m.bounds) - frame.camera.position) @ np.asarray(basis.forward) for m in meshes]
    low, high = (float(f(depths)) for f in (np.min, np.max))
    room = 1e-3 * max(high - low, abs(low), abs(high), 1e-3)  # flat things too have room in 32 bits
    low, high = max(low - room, near_depth(frame)), high + room
    return low, max(high, low + room)


def _camera(frame: Frame, meshes: tuple[MeshBuffers, ...], margin: int) -> dict[str, Any]:
    camera, (width, height) = frame.camera, frame.whole_size
    basis = camera.basis()
    return {
        "u_eye": camera.position, "u_forward": basis.forward,
        "u_half": camera.half_extent(width / height), "u_center": camera.window_center,
        "u_parallel": camera.parallel_projection, "u_size": (float(width), float(height)),
        "u_corner": (float(frame.corner[0] - margin), float(frame.corner[1] - margin)),
        "u_pixel_jitter": frame.pixel_jitter,
        "u_target": (float(frame.size[0] + 2 * margin), float(frame.size[1] + 2 * margin)),
        "u_depth_range": depth_range(frame, meshes),
    }  # fmt: skip


def _place(frame: Frame, mesh: MeshBuffers) -> dict[str, Any]:
    basis = frame.camera.basis()
    axes = np.array([basis.right, basis.up, basis.forward])
    return {
        "u_axes": tuple(axes.T.ravel().tolist()), "u_middle": tuple(mesh.middle.tolist()),
        "u_middle_from_eye": tuple((axes @ (mesh.middle - frame.camera.position)).tolist()),
    }  # fmt: skip
