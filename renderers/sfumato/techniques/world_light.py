"""Light that is kept in the volume's own space: where its textures lie, and what the ray caster needs to read them.

`extinction` and `local_occlusion` fill such textures; the march shader reads them at each sample
(``shaders/lib/world_light.glsl``), whatever technique they come from.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .frame import Frame
from .marcher import Material

#: Sides of a grid are multiples of this.
MULTIPLE = 4
#: Cells before a surface at which its light is looked up, where its slope is known.
LIFT = 1.0


@dataclass(frozen=True)
class CellGrid:
    """Cells over the box in which something is visible.

    Attributes
    ----------
    low : tuple of float
        The volume's texture coordinates of the corner of cell 0.
    edges : tuple of float
        A cell's edges in texture coordinates.
    edges_mm : tuple of float
        The same in mm.
    size : tuple of int
        Cells along the volume's axes.
    """

    low: tuple[float, float, float]
    edges: tuple[float, float, float]
    edges_mm: tuple[float, float, float]
    size: tuple[int, int, int]

    @property
    def cell_mm(self) -> float:
        """Mean edge of a cell, mm."""
        return float(np.prod(self.edges_mm) ** (1 / 3))

    @property
    def count(self) -> int:
        """Number of cells."""
        return int(np.prod(self.size))

    @property
    def uniforms(self) -> dict[str, Any]:
        """How the march shader finds its place in textures over these cells."""
        extent = np.asarray(self.edges) * self.size
        return {
            "u_world_scale": tuple((1 / extent).tolist()),
            "u_world_offset": tuple((-np.asarray(self.low) / extent).tolist()),
            "u_world_lift": LIFT * self.cell_mm,
        }


def grid_over(frame: Frame, material: Material, longest: int) -> CellGrid:
    """Lay cells, nearly cubes, over the visible box, so many along its longest side; material must be visible."""
    bounds = material.empty.bounds
    assert bounds is not None
    low = np.maximum(bounds[0], frame.scene.crop.low)
    high = np.minimum(bounds[1], frame.scene.crop.high)
    to_mm = np.asarray(frame.volume.dims) * frame.volume.spacing
    extent = np.maximum((high - low) * to_mm, 1e-3 * to_mm / frame.volume.dims)
    edge = float(extent.max()) / longest
    size = np.maximum(MULTIPLE, MULTIPLE * np.ceil(extent / edge / MULTIPLE - 1e-6)).astype(int)
    # The longest side is filled exactly; the others reach a little beyond the box, where nothing is.
    edges_mm = np.full(3, edge)
    edges_mm[extent.argmax()] = extent.max() / size[extent.argmax()]
    edges = edges_mm / to_mm
    return CellGrid(_triple(low), _triple(edges), _triple(edges_mm), tuple(size.tolist()))


def _triple(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in values)
    return x, y, z


def place_uniforms(frame: Frame, number: int) -> dict[str, Any]:
    """Return colour and place of the first lamps for the ray caster; see ``world_light.glsl``."""
    colors, places = np.zeros((4, 3), dtype=np.float32), np.zeros((4, 4), dtype=np.float32)
    basis, center = frame.camera.basis(), frame.volume.center
    for k, light in enumerate(frame.scene.active_lights[:number]):
        colors[k] = np.asarray(light.color) * light.intensity
        if light.kind == "directional":
            places[k, :3] = light.towards(basis, center)
        else:
            places[k] = (*light.position, 1.0)
    return {"u_light_color": colors, "u_lamp_place": places}
