"""Each lamp's light past volume and geometry, kept as long as neither changes."""

from __future__ import annotations

import functools
from collections.abc import Generator, Hashable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...gpu import Device
from ...scene.vectors import box_corners
from ..casters import Casters
from ..frame import Frame
from ..light_cache import LightCache
from ..light_volume import LightGrid, LightSweeper, grid_for
from .cover import BYTES_PER_TEXEL, Atlas, CoverMaker
from .meshes import MeshBuffers, Shown
from .surfels import cell_of, cut_key, make_surfels

if TYPE_CHECKING:
    from .passes import Stage

#: Bytes a texel of a lamp's light and of the geometry in its way.
BYTES = 4 + BYTES_PER_TEXEL


class Textures:
    """A lamp's light volume, and beside it the coverage by geometry, if any casts."""

    def __init__(self, light: Any, size: tuple[int, int, int]) -> None:
        self.size = size
        self.light = light
        self.cover: Any = None

    def release(self) -> None:
        """Free the textures."""
        self.light.release()
        self.drop_cover()

    def drop_cover(self) -> None:
        """Free the coverage."""
        if self.cover is not None:
            self.cover.release()
        self.cover = None


@dataclass(frozen=True)
class Lit:
    """A lamp's textures, and where they lie."""

    grid: LightGrid
    atlas: Atlas
    textures: Textures

    @property
    def light(self) -> Any:
        """The light volume."""
        return self.textures.light

    @property
    def cover(self) -> Any:
        """The coverage by geometry, or None."""
        return self.textures.cover


def corners_of(visible: np.ndarray | None, meshes: tuple[MeshBuffers, ...]) -> np.ndarray | None:
    """Return corners in world mm of boxes around all that is seen; None if nothing is."""
    boxes = [] if visible is None else [visible]
    boxes += [box_corners(mesh.bounds) for mesh in meshes]
    return np.concatenate(boxes) if boxes else None


class LampMaker:
    """Sweeps lamps past volume and geometry."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self.sweeper = LightSweeper(device)
        self.cover = CoverMaker(device)
        self.cache = LightCache(self._new_textures, store=device.store, bytes_per_texel=BYTES)

    def _new_textures(self, size: tuple[int, int, int]) -> Textures:
        return Textures(self.sweeper.new_texture(size), size)

    def lit(
        self, frame: Frame, stage: Stage, volume: bool, geometry: bool
    ) -> Generator[float, None, list[Lit]]:
        """Return each lamp's light past the volume, if it casts, and geometry, if that does."""
        lamps: list[Lit] = []
        lights = frame.scene.active_lights
        casting = stage.shown if geometry and frame.params.geometry_opacity > 0 else ()
        more = (volume, geometry_key(frame, casting))
        for light, angle in zip(lights, stage.angles, strict=True):
            grid = grid_for(frame, stage.material, angle, light.aperture, stage.corners, more)
            atlas = Atlas.of(self.device, grid.lattice)
            sweep = functools.partial(self._sweep, frame, stage, grid, atlas, volume, casting)
            # Both kinds of receivers may need their own: the newest of a frame are left alone.
            textures = yield from self.cache.swept(grid.key, grid.size, sweep, 2 * len(lights))
            lamps.append(Lit(grid, atlas, textures))
        return lamps

    def _sweep(
        self, frame: Frame, stage: Stage, grid: LightGrid, atlas: Atlas, volume: bool, casting: tuple[Shown, ...],
        textures: Textures,
    ) -> Iterator[float]:  # fmt: skip
        """Draw what geometry covers, then sweep."""
        surfels = yield from make_surfels(frame, casting)
        textures.drop_cover()
        blocks: tuple[Any, ...] = ()
        if surfels:
            textures.cover = self.cover.new_texture(atlas)
            view = grid.lattice.stack.view
            for _ in self.cover.fill(grid.lattice, atlas, -view.axes[2], surfels, textures.cover):
                yield 0.1
            blocks = tuple(s.blocks_along(view) for s in surfels)
        casters = Casters(textures.cover, atlas.columns, frame.params.geometry_opacity, blocks, volume)
        for done in self.sweeper.sweep(frame, stage.material, grid, textures.light, casters):
            yield 0.1 + 0.35 * done

    def release(self) -> None:
        """Free the GPU objects."""
        self.sweeper.release()
        self.cover.release()
        self.cache.release()


def geometry_key(frame: Frame, casting: tuple[Shown, ...]) -> Hashable:
    """Return what geometry's shadows depend on besides the lamp."""
    if not casting:
        return None
    keys = tuple((item.key, cut_key(frame, item)) for item in casting)
    return keys, frame.params.geometry_opacity, cell_of(frame)


__all__ = ["LampMaker", "Lit", "Textures", "corners_of", "geometry_key"]
