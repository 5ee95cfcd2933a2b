"""The one ray caster, which every fast technique shares.

It marches along view rays, front to back, in passes over a range of segments and a part of the picture,
so that each piece of GPU work is bounded. It skips empty space by a distance map, stops where nothing more
shows through, and classifies by pre-integration. `MarchPainter` is the ray caster by itself (`raycast`,
`slices` and their Phong forms); the occlusion methods give it layers of light to read.
"""

from __future__ import annotations

import math
import time
from collections.abc import Generator, Hashable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..gpu import Device, Program, Target, Variants
from ..gpu.tables import TransferTables, make_tables, occupied_blocks
from ..gpu.volume_texture import EmptySpace, VolumeTexture, map_empty_space, survey_volume, upload_volume
from ..scene import nearest_possible_tilt
from .frame import Frame
from .stack import Stack, View, clip_uniforms

#: Seconds that a piece of GPU work should take, so that a newer scene need not wait; pieces adapt to it.
PIECE_SECONDS = 0.04
#: Pixels of the first piece.
PIECE_PIXELS = 512 * 64
#: Gradient, in value range per voxel, at which a highlight has half its strength.
EDGE = 0.05
#: Thin segments are shaded together: so many at most, and no farther than so many voxels at full quality.
TOGETHER, TOGETHER_VOXELS = 4, 2.0
#: Transfer functions whose tables are kept: more than the presets that the window shows side by side.
FUNCTIONS_KEPT = 48
#: Depth of the layer below a solid cut face that stops light, in voxels; where light is worked out more coarsely, more.
SOLID_VOXELS = 1.5
_FAR = 1e30


@dataclass
class Material:
    """What the GPU holds of a scene's volume and transfer function.

    With ``packed`` that takes the volume's place, for volumes too large for the device.
    """

    volume: VolumeTexture
    tables: TransferTables
    empty: EmptySpace
    clipped: bool
    #: Whether there are cut faces, and they are solid.
    solid: bool
    #: Equal for materials that stop light alike, whatever their colours.
    opacity_key: Hashable
    packed: Packed | None = None


class Packed(Protocol):
    """A volume in another form than its voxels in one texture."""

    def bind(self, program: Program, frame: Frame) -> None:
        """Set what shaders need to read it."""
        ...


def prepare_material(frame: Frame, *, whole: bool = True) -> Material:
    """Return the volume and transfer function on the GPU, uploading what is not there yet.

    Without the `whole` volume its voxels stay where they are, and something `packed` has to take their place.
    """
    store, device, volume, transfer = frame.device.store, frame.device, frame.volume, frame.transfer
    texture = store.get(
        ("volume" if whole else "extremes", volume.key),
        lambda: upload_volume(device, volume) if whole else survey_volume(volume),
        lambda t: t.size,
    )
    key = (volume.key, transfer)
    tables = store.get(
        ("transfer function", *key), lambda: make_tables(device, volume, texture, transfer), lambda t: t.size,
        FUNCTIONS_KEPT,
    )  # fmt: skip
    empty = store.get(
        ("empty space", *key),
        lambda: map_empty_space(device, volume, occupied_blocks(texture, tables.visible)),
        lambda e: e.size,
        FUNCTIONS_KEPT,
    )
    scene = frame.scene
    return Material(texture, tables, empty, scene.is_clipped, scene.has_solid_cuts, _opacity_key(frame))


def _opacity_key(frame: Frame) -> Hashable:
    transfer, solid = frame.transfer, frame.scene.has_solid_cuts
    if transfer.regions:
        return frame.volume.key, solid, transfer
    return (
        frame.volume.key,
        solid,
        transfer.unit_distance,
        tuple((p.value, p.opacity) for p in transfer.points),
    )


def material_defines(material: Material) -> tuple[tuple[str, int], ...]:
    """Return the defines of a material's shader variant."""
    two = (("TRANSFER_2D", 1),) if material.tables.max_gradient > 0 else ()
    packed = (("PACKED", 1),) if material.packed is not None else ()
    solid = (("SOLID", 1),) if material.solid else ()
    return (("CLIPS", int(material.clipped)), *two, *packed, *solid)


def bind_material(program: Program, material: Material, frame: Frame) -> None:
    """Set what every shader needs to sample, classify, clip and skip."""
    volume, tables = frame.volume, material.tables
    if material.packed is None:
        program.bind(u_volume=material.volume.texture)
    else:
        material.packed.bind(program, frame)
    program.bind(
        u_distance=material.empty.texture,
        u_integral=tables.color, u_emission=tables.emission, u_extinction=tables.extinction,
        u_table2d=tables.color, u_emission2d=tables.emission,
    )  # fmt: skip
    dims = np.asarray(volume.dims)
    program.set(
        u_texture_from_world=tuple(volume.texture_from_world.T.ravel().tolist()),
        u_voxel=tuple((1 / dims).tolist()),
        u_blocks=tuple((dims / 8).tolist()),
        u_table_size=float(tables.color.size[0]),
        u_gradient_scale=1 / tables.max_gradient if tables.max_gradient > 0 else 1.0,
        u_solid=volume.diagonal,
        u_solid_layer=SOLID_VOXELS * volume.min_spacing,
        **clip_uniforms(frame.scene, volume),
    )


def visible_corners(frame: Frame, material: Material) -> np.ndarray | None:
    """Return the corners, in world space, of the box around all that is visible; None if nothing is."""
    bounds = material.empty.bounds
    if bounds is None:
        return None
    low = np.maximum(bounds[0], frame.scene.crop.low)
    high = np.minimum(bounds[1], frame.scene.crop.high)
    return frame.volume.corners(tuple(low), tuple(high)) if (low < high).all() else None


def blocks_along(view: View, frame: Frame, material: Material) -> tuple[np.ndarray, np.ndarray]:
    """Return centres and half extents, along a view's axes in mm, of the blocks in which something is visible."""
    empty, scene = material.empty, frame.scene
    shown = (
        (empty.centers + empty.half_block >= scene.crop.low)
        & (empty.centers - empty.half_block <= scene.crop.high)
    ).all(axis=1)
    matrix = frame.volume.world_from_texture
    centers = view.coordinates(empty.centers[shown] @ matrix[:3, :3].T + matrix[:3, 3])
    return centers, np.abs(view.axes @ matrix[:3, :3]) @ empty.half_block


#: How the march shader shades a sample.
UNLIT, SWEPT, PHONG, VOLUMES, WORLD, LOCAL, BAKED = 0, 1, 2, 3, 4, 5, 6


@dataclass(frozen=True)
class Variant:
    """What the march shader is compiled for."""

    slices: bool = False
    shading: int = UNLIT
    lights: int = 0
    literal: bool = False
    near: int = 0
    specular: bool = False
    facing: bool = False
    local: int = 0
    joined: bool = False
    resolved: bool = False
    adaptive: bool = False
    surface: bool = False
    geometry: bool = False


class Marcher:
    """Draws marching passes into a frame's target, through two pictures that take turns."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._programs = Variants(device, "techniques/march.frag.glsl")
        self._pair: tuple[Target, Target] | None = None
        self._piece = float(PIECE_PIXELS)

    def program(self, variant: Variant, material: Material) -> Program:
        """Return the program of a variant, compiling it when first asked for."""
        defines = (
            ("SLICES", int(variant.slices)), ("LIGHTS", variant.lights), ("LITERAL", int(variant.literal)),
            ("NEAR", variant.near), ("SHADING", variant.shading), ("SPECULAR", int(variant.specular)),
            ("FACING", int(variant.facing)), ("LOCAL", variant.local), ("JOINED", int(variant.joined)),
            ("RESOLVED", int(variant.resolved)), ("ADAPTIVE", int(variant.adaptive)),
            ("SURFACE", int(variant.surface)), ("GEOMETRY", int(variant.geometry)),
            ("EMISSION", int(material.tables.emits)),
            *material_defines(material),
        )  # fmt: skip
        return self._programs.get(defines)

    def begin(self, frame: Frame) -> None:
        """Make the two pictures for a frame's size."""
        if self._pair is None or self._pair[0].size != frame.size:
            self._release_pair()
            self._pair = (Target(self.device, frame.size), Target(self.device, frame.size))

    def march(
        self,
        frame: Frame,
        program: Program,
        segments: tuple[int, int],
        box: tuple[int, int, int, int],
        start: bool,
    ) -> Iterator[float]:
        """March a range of segments over a box of pixels (x0, y0, x1, y1), yielding the share done each time."""
        assert self._pair is not None
        source, target = self._pair
        program.set(u_first=segments[0], u_last=segments[1], u_start=start)
        program.bind(u_previous=source.texture)
        if start:
            source.clear()
            target.clear()
        x0, y, x1, y1 = box
        while y < y1:
            rows = min(max(1, int(self._piece) // (x1 - x0)), y1 - y)
            began = time.perf_counter()
            target.fbo.use()
            target.fbo.scissor = (x0, y, x1 - x0, rows)
            program.draw()
            self.device.wait()
            target.fbo.scissor = (0, 0, *target.size)
            self._adapt(rows * (x1 - x0), time.perf_counter() - began)
            y += rows
            yield (y - box[1]) / (y1 - box[1])
        self._pair = (target, source)

    def _adapt(self, pixels: int, seconds: float) -> None:
        """Make pieces smaller at once where they take too long, and larger by and by."""
        wanted = pixels * PIECE_SECONDS / max(seconds, 1e-6)
        self._piece = min(max(wanted, 256.0), self._piece * 2, 1e9)

    def blank(self) -> None:
        """Empty the picture, where there is nothing to march through."""
        assert self._pair is not None
        self._pair[0].clear()

    @property
    def picture(self) -> Any:
        """The texture of what was drawn so far: linear RGB, premultiplied, and opacity."""
        assert self._pair is not None
        return self._pair[0].texture

    def finish(self, frame: Frame) -> None:
        """Copy what was drawn to the frame's target."""
        assert self._pair is not None
        self.device.ctx.copy_framebuffer(frame.target.fbo, self._pair[0].fbo)

    def clear(self, frame: Frame) -> None:
        """Leave the frame's target empty."""
        frame.target.clear()

    def release(self) -> None:
        """Free programs and pictures."""
        self._programs.release()
        self._release_pair()

    def _release_pair(self) -> None:
        for target in self._pair or ():
            target.release()
        self._pair = None


def set_view(program: Program, frame: Frame, stack: Stack | None) -> None:
    """Set the camera's uniforms and the grid of samples."""
    camera, (width, height) = frame.camera, frame.whole_size
    basis = camera.basis()
    program.set(
        u_eye=camera.position, u_right=basis.right, u_up=basis.up, u_forward=basis.forward,
        u_half=camera.half_extent(width / height), u_center=camera.window_center, u_parallel=camera.parallel_projection,
        u_size=(float(width), float(height)), u_pixel_jitter=frame.pixel_jitter,
        u_corner=tuple(map(float, frame.corner)),
        u_step=frame.step, u_together=together(frame), u_z0=stack.z0 if stack else frame.jitter - 1,
        u_near=near_depth(frame), u_far=_FAR,
        u_edge=EDGE / frame.volume.min_spacing,
        u_unshadowed=float(frame.unshadowed),
    )  # fmt: skip


def together(frame: Frame) -> float:
    """Return the longest way, in mm of depth, that is shaded as one where it is thin."""
    longest = TOGETHER_VOXELS * frame.quality.light * frame.volume.min_spacing
    return min(TOGETHER * frame.step, longest) * (1 + 1e-6)


def near_depth(frame: Frame) -> float:
    """Return the depth in mm before which nothing is seen."""
    return -_FAR if frame.camera.parallel_projection else 1e-3 * frame.camera.distance


def max_secant(frame: Frame) -> float:
    """Return the largest secant of a view ray against the view axis."""
    if frame.camera.parallel_projection:
        return 1.0
    half = np.asarray(frame.camera.half_extent(frame.whole_size[0] / frame.whole_size[1]))
    across = (1 + np.abs(frame.camera.window_center)) * half
    return math.hypot(1.0, *across.tolist())


def pixel_box(frame: Frame, corners: np.ndarray) -> tuple[int, int, int, int]:
    """Return the pixels (x0, y0, x1, y1; y upwards) that a box given by its corners can cover."""
    width, height = frame.size
    whole = np.asarray(frame.whole_size)
    at = View.of(frame.camera).coordinates(corners)
    depth = at[:, 2:3]
    if not frame.camera.parallel_projection:
        if depth.min() <= near_depth(frame):
            return 0, 0, width, height
        at = at / depth
    half, center = (
        np.asarray(frame.camera.half_extent(whole[0] / whole[1])),
        np.asarray(frame.camera.window_center),
    )
    pixels = (at[:, :2] / half - center + 1) / 2 * whole - frame.corner
    low, high = np.floor(pixels.min(axis=0)) - 1, np.ceil(pixels.max(axis=0)) + 1
    x0, y0 = np.clip(low, 0, (width, height)).astype(int)
    x1, y1 = np.clip(high, 0, (width, height)).astype(int)
    return int(x0), int(y0), int(x1), int(y1)


def visible_box(frame: Frame, material: Material) -> tuple[int, int, int, int]:
    """Return the pixels (as `pixel_box`) that what is visible can cover; an empty box if nothing is."""
    corners = visible_corners(frame, material)
    return (0, 0, 0, 0) if corners is None else pixel_box(frame, corners)


def is_empty(box: tuple[int, int, int, int]) -> bool:
    """Tell whether a box of pixels holds none."""
    return box[0] >= box[2] or box[1] >= box[3]


def light_uniforms(frame: Frame, towards: list[np.ndarray]) -> dict[str, Any]:
    """Return colour times intensity, and the direction towards each active light."""
    colors, directions = np.zeros((4, 3), dtype=np.float32), np.zeros((4, 3), dtype=np.float32)
    for k, light in enumerate(frame.scene.active_lights):
        colors[k] = np.asarray(light.color) * light.intensity
        directions[k] = towards[k]
    return {"u_light_color": colors, "u_towards": directions}


def lights_towards(frame: Frame) -> list[np.ndarray]:
    """Return the unit vectors, world space, towards the active lights."""
    basis, center = frame.camera.basis(), frame.volume.center
    return [light.towards(basis, center) for light in frame.scene.active_lights]


#: Tilt and rotation of each lamp, in degrees, as the camera sees it.
Angles = tuple[tuple[float, float], ...]


def lamp_angles(frame: Frame) -> Angles:
    """Return the angles of the active lights.

    Within a degree of grazing a cone's section grows without bound: light stays that far away.
    """
    lights = frame.scene.active_lights
    return tuple(
        (nearest_possible_tilt(tilt, light.aperture), rotation)
        for light, (tilt, rotation) in zip(lights, frame.scene.light_angles(), strict=True)
    )


class MarchPainter:
    """Ray casting and slicing without shadows, unlit or Phong-shaded."""

    def __init__(self, device: Device, *, slices: bool, phong: bool) -> None:
        self.device = device
        self.slices = slices
        self.phong = phong
        self.marcher = Marcher(device)

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        material = prepare_material(frame)
        box = visible_box(frame, material)
        if is_empty(box):
            self.marcher.clear(frame)
            yield 1.0
            return
        lights = len(frame.scene.active_lights) if self.phong else 0
        shading = PHONG if self.phong else UNLIT
        program = self.marcher.program(Variant(self.slices, shading, lights), material)
        bind_material(program, material, frame)
        stack = (
            Stack.through(View.of(frame.camera), crop_corners(frame), frame.step, frame.jitter)
            if self.slices
            else None
        )
        set_view(program, frame, stack)
        if self.phong:
            p = frame.params
            program.set(
                u_ambient=p.ambient, u_diffuse=p.diffuse, u_specular=p.specular, u_shininess=p.shininess
            )
            program.set(**light_uniforms(frame, lights_towards(frame)))
        self.marcher.begin(frame)
        yield from self.marcher.march(frame, program, (0, 1 << 24), box, True)
        self.marcher.finish(frame)
        yield 1.0

    def release(self) -> None:
        """Free the GPU objects."""
        self.marcher.release()


def crop_corners(frame: Frame) -> np.ndarray:
    """Return the corners of the crop box in world space, mm; shape (8, 3)."""
    return frame.volume.corners(frame.scene.crop.low, frame.scene.crop.high)
