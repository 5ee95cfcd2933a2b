"""The passes of `combined`: surfaces, lamps' light past volume and geometry, the volume, and all of it put together."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Generator, Iterator
from typing import Any

import numpy as np

from ...gpu import Device, Program, Variants
from ...gpu.surface_target import NOTHING
from ..frame import Frame
from ..lamp_shadows import Lamps, bind_lamps
from ..marcher import (
    PIECE_PIXELS,
    SWEPT,
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
    material_defines,
    pixel_box,
    prepare_material,
    set_view,
    visible_corners,
)
from ..near_field import Ways, lay_ways
from ..slab_texture import SlabTexture
from ..stack import Stack, View
from .disc import turned_disc
from .lamps import LampMaker, Lit, corners_of
from .meshes import MeshBuffers, Shown, shown_geometry, upload_meshes
from .slices import Sliced, SliceMaker, bind_slices, lamp_axes
from .stand_in import with_volume
from .surfaces import SurfacePainter, depth_range

#: Most pixels that the surfaces' picture is wider on each side, for contact shadows of what stands beside the frame.
MAX_MARGIN = 64
#: Contact shadows look so far, in texels of the coarsest light volume: there it begins to know.
CONTACT_TEXELS = 3.0
_TERMS = {"occlusion": 1, "partial": 2, "vicinity": 3}


@dataclasses.dataclass
class Stage:
    """What a frame is drawn from."""

    material: Material
    angles: Angles
    shown: tuple[Shown, ...]
    meshes: tuple[MeshBuffers, ...]
    #: The part of the picture that the volume can cover, and its corners; none where it is not seen.
    box: tuple[int, int, int, int]
    corners: np.ndarray


class CombinedPainter:
    """Geometry and volume under one light."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.marcher = Marcher(device)
        self.surfaces = SurfacePainter(device)
        self.lamps = LampMaker(device)
        self.slices = SliceMaker(device)
        self._slab_term = SlabTexture(device)
        self._compose = Variants(device, "techniques/combined/compose.frag.glsl")

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw a frame, yielding progress after each bounded piece."""
        shown = yield from shown_geometry(frame)
        frame = with_volume(frame, _bounds(shown))
        stage = yield from self._stage(frame, shown)
        if stage is None:
            self.marcher.clear(frame)
            yield 1.0
            return
        params = frame.params
        if params.light != "cone":
            frame = self.slices.fitting(frame, stage)
        maker = self.lamps if params.light == "cone" else self.slices
        on_volume = (params.volume_on_volume, params.geometry_on_volume)
        on_surfaces = (params.volume_on_geometry, params.geometry_on_geometry)
        self.marcher.begin(frame)
        self.marcher.blank()
        surfaces = bool(stage.shown) and params.show != "volume"
        margin = self._margin(frame, stage) if surfaces else 0
        if surfaces:
            for _ in self.surfaces.draw(frame, stage.shown, stage.meshes, margin):
                yield 0.02
        if not is_empty(stage.box):
            lamps = yield from maker.lit(frame, stage, *on_volume)
            program = self._march_program(frame, stage, lamps, surfaces, margin)
            for done in self.marcher.march(frame, program, (0, 1 << 24), stage.box, True):
                yield 0.5 + 0.4 * done
        if surfaces:
            lamps = yield from maker.lit(frame, stage, *on_surfaces)
            yield from self._put_together(frame, stage, lamps, margin)
        else:
            self.marcher.finish(frame)
        yield 1.0

    def _stage(self, frame: Frame, shown: tuple[Shown, ...]) -> Generator[float, None, Stage | None]:
        """Upload what is not there yet; None if nothing is to be seen."""
        material = prepare_material(frame)
        meshes = yield from upload_meshes(frame, shown)
        visible = visible_corners(frame, material)
        corners = corners_of(visible, meshes)
        if corners is None:
            return None
        hidden = visible is None or frame.params.show not in ("picture", "volume")
        box = (0, 0, 0, 0) if hidden or visible is None else pixel_box(frame, visible)
        return Stage(material, lamp_angles(frame), shown, meshes, box, corners)

    def _margin(self, frame: Frame, stage: Stage) -> int:
        """Return by how many pixels the surfaces' picture must be wider than the frame on each side."""
        near = depth_range(frame, stage.meshes)[0]
        half = frame.camera.half_extent(frame.whole_size[0] / frame.whole_size[1])[1]
        pixel = (
            2 * half * (1.0 if frame.camera.parallel_projection else max(near, 1e-9)) / frame.whole_size[1]
        )
        return int(min(MAX_MARGIN, math.ceil(contact_way(frame) / pixel) + 1))

    # -- the volume ---------------------------------------------------------------------------------
    def _march_program(
        self, frame: Frame, stage: Stage, lamps: list[Lit] | Sliced, surfaces: bool, margin: int
    ) -> Program:
        """Set up the ray caster."""
        params, count = frame.params, len(frame.scene.active_lights)
        if isinstance(lamps, Sliced):
            covered, shading, near, stack = lamps.covered, SWEPT, lamps.near, lamps.stack
        else:
            covered, shading = any(lit.cover is not None for lit in lamps), VOLUMES
            near = _ways(frame, stage, lamps).samples
            stack = Stack.through(View.of(frame.camera), crop_corners(frame), frame.step, frame.jitter)
        literal = isinstance(lamps, Sliced) and params.occlusion != "extinction"
        variant = Variant(
            True, shading, count, literal, near, params.specular > 0, surface=surfaces, geometry=covered
        )
        program = self.marcher.program(variant, stage.material)
        bind_material(program, stage.material, frame)
        set_view(program, frame, stack)
        program.set(
            u_ambient=params.ambient, u_specular=params.specular, u_shininess=params.shininess, u_margin=margin,
            **light_uniforms(frame, lights_towards(frame)),
        )  # fmt: skip
        self._bind_light(program, frame, stage, lamps)
        if surfaces and self.surfaces.target is not None:
            program.bind(u_surface=self.surfaces.target.shape)
        apertures = [light.aperture for light in frame.scene.active_lights]
        self._slab_term.bind(program, frame, [tilt for tilt, _ in stage.angles], apertures)
        return program

    def _bind_light(self, program: Program, frame: Frame, stage: Stage, lamps: list[Lit] | Sliced) -> None:
        """Set where the ray caster finds each lamp's light."""
        if isinstance(lamps, Sliced):
            bind_slices(program, frame, lamps, frame.params.volume_on_volume)
            return
        ways = _ways(frame, stage, lamps)
        self._bind_lamps(program, frame, stage, lamps, ways)
        if not frame.params.volume_on_volume:
            program.set(u_near_length=np.zeros(4, np.float32))
        if any(lit.cover is not None for lit in lamps):
            program.set(u_cover_opacity=frame.params.geometry_opacity, **_cover_uniforms(lamps, ways))
            program.bind(**{f"u_cover{k}": lit.cover for k, lit in enumerate(lamps)})

    def _bind_lamps(self, program: Program, frame: Frame, stage: Stage, lamps: list[Lit], ways: Ways) -> None:
        swept = Lamps(stage.angles, [lit.grid for lit in lamps], [lit.light for lit in lamps], ways)
        bind_lamps(program, frame, swept)

    # -- surfaces, and the volume over them ---------------------------------------------------------
    def _put_together(
        self, frame: Frame, stage: Stage, lamps: list[Lit] | Sliced, margin: int
    ) -> Iterator[float]:
        """Shade the surfaces into the frame's target, below what the ray caster saw."""
        program = self._compose_program(frame, stage, lamps, margin)
        width, height = frame.size
        rows = max(1, PIECE_PIXELS // width)
        for y in range(0, height, rows):
            frame.target.fbo.use()
            frame.target.fbo.scissor = (0, y, width, min(rows, height - y))
            program.draw()
            self.device.wait()
            frame.target.fbo.scissor = (0, 0, width, height)
            yield 0.9 + 0.1 * y / height

    def _compose_program(self, frame: Frame, stage: Stage, lamps: list[Lit] | Sliced, margin: int) -> Program:
        params, target = frame.params, self.surfaces.target
        assert target is not None
        sliced = isinstance(lamps, Sliced)
        near = lamps.near if isinstance(lamps, Sliced) else _ways(frame, stage, lamps).samples
        program = self._compose.get(
            (
                ("LIGHTS", len(frame.scene.active_lights)), ("SLICED", int(sliced)), ("NEAR", near),
                ("GEOMETRY", 0), *material_defines(stage.material),
            )
        )  # fmt: skip
        bind_material(program, stage.material, frame)
        set_view(program, frame, lamps.stack if isinstance(lamps, Sliced) else None)
        if isinstance(lamps, Sliced):
            bind_slices(program, frame, lamps, params.volume_on_geometry)
            program.set(**_lift(frame, [lamps.texel] * len(lamps.lamps), lamps.ways))
        else:
            ways = _ways(frame, stage, lamps)
            self._bind_lamps(program, frame, stage, lamps, ways)
            texels = [lit.grid.lattice.texel for lit in lamps]
            program.set(**_lift(frame, texels, ways.lengths.tolist()))
            program.set(u_near_length=_near_length(frame, lamps, ways))
        program.bind(u_over=self.marcher.picture, u_surface=target.shape, u_surface_color=target.color)
        program.set(**light_uniforms(frame, lights_towards(frame)))
        program.set(
            u_margin=margin, u_nothing=0.5 * NOTHING, u_ambient=params.ambient, u_show=_TERMS.get(params.show, 0),
            u_surface_ambient=params.surface_ambient, u_surface_diffuse=params.surface_diffuse,
            u_surface_specular=params.surface_specular, u_surface_shininess=params.surface_shininess,
            **_vicinity(frame, stage),
        )  # fmt: skip
        return program

    def release(self) -> None:
        """Free the GPU objects."""
        parts: tuple[Any, ...] = (
            self.marcher, self.surfaces, self.lamps, self.slices, self._slab_term, self._compose,
        )  # fmt: skip
        for part in parts:
            part.release()


def _bounds(shown: tuple[Shown, ...]) -> np.ndarray:
    if not shown:
        return np.array([[0.0, 0, 0], [1, 1, 1]])
    bounds = np.array([item.mesh.bounds for item in shown])
    return np.array([bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)])


def _ways(frame: Frame, stage: Stage, lamps: list[Lit]) -> Ways:
    return lay_ways(frame, [tilt for tilt, _ in stage.angles], [lit.grid for lit in lamps])


def contact_way(frame: Frame) -> float:
    """Return how far in mm contact shadows look."""
    if frame.params.vicinity_distance is not None:
        return float(frame.params.vicinity_distance)
    return float(CONTACT_TEXELS * frame.volume.min_spacing / frame.params.resolution)


def _lift(frame: Frame, texels: list[float], ways: list[float]) -> dict[str, np.ndarray]:
    """Return how far off a surface its light is asked for: in mm, and as a part of the way there."""
    lift, share = np.zeros(4, np.float32), np.zeros(4, np.float32)
    if frame.params.geometry_on_geometry:
        lift[: len(texels)] = texels
        share[: len(texels)] = [t / max(w, 1e-9) for t, w in zip(texels, ways, strict=False)]
    return {"u_lift": lift, "u_lift_share": share}


def _near_length(frame: Frame, lamps: list[Lit], ways: Ways) -> np.ndarray:
    """Return what the way from a surface to where its light is asked for counts as, in mm of the volume."""
    length = np.zeros(4, np.float32)
    for k, lit in enumerate(lamps):
        if frame.params.volume_on_geometry:
            length[k] = ways.lengths[k] * float(np.mean(lit.grid.secants))
    return length


def _vicinity(frame: Frame, stage: Stage) -> dict[str, Any]:
    """Return what the vicinity term needs."""
    params, way = frame.params, contact_way(frame)
    cosines = np.ones(4, np.float32)
    for k, light in enumerate(frame.scene.active_lights):
        cosines[k] = math.cos(math.radians(light.aperture))
    strength = params.vicinity * params.geometry_opacity if params.geometry_on_geometry else 0.0
    return {
        "u_vicinity": strength, "u_vicinity_samples": params.vicinity_samples, "u_vicinity_way": way,
        "u_vicinity_bias": params.vicinity_bias * way, "u_cone_axes": lamp_axes(frame, stage), "u_cone_cosine": cosines,
        "u_disc": turned_disc(frame.index * 2.399963), "u_step_offset": (0.5 + frame.index * 0.7548776662466927) % 1.0,
    }  # fmt: skip


def _cover_uniforms(lamps: list[Lit], ways: Ways) -> dict[str, Any]:
    """Return where the ray caster finds geometry close to a sample."""
    size, columns = np.ones((4, 2), np.int32), np.ones(4, np.int32)
    slabs, way = np.ones(4, np.float32), np.zeros(4, np.float32)
    for k, lit in enumerate(lamps):
        size[k], columns[k], slabs[k] = lit.atlas.size, lit.atlas.columns, lit.atlas.slabs
        way[k] = ways.lengths[k] / lit.grid.lattice.stack.step
    return {"u_cover_size": size, "u_cover_columns": columns, "u_cover_slabs": slabs, "u_cover_way": way}


__all__ = ["CombinedPainter", "Stage", "contact_way"]
