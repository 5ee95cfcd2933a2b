"""How much light arrives at points within a volume: a coarse look for slices, on the CPU, whatever the technique.

1. The extinction of what is shown (crop box and clip planes cut away) is averaged over blocks of voxels, so that
   thin layers keep the light that they take.
2. From each point, a few rays that fill the lamp's cone are followed to the lamp, or out of the volume; the mean of
   what passes is the lamp's visibility (the cone integral of `reference.cone`, with few rays and long steps).
3. Times what the lamp sends there (`scene.lamps`): its colour, intensity, beam and distance.

Geometry casts no shadow here, and surfaces have no shading: this is light on its way, not what is reflected.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ..scene import lamps
from ..scene.light import Light
from ..scene.picking import is_shown
from ..scene.presets.values import thinned
from ..scene.scene import Scene
from ..scene.transfer import TransferFunction
from ..scene.vectors import vec3
from ..scene.volume import Volume

#: Most blocks along an axis, and most voxels that are looked at for them.
BLOCKS, LOOKED_AT = 96, 288
#: Rays to each lamp.
RAYS = 7
#: Steps of a value's range for which the extinction is worked out.
_TABLE = 4096
#: Widest half angle in degrees of a bundle of rays: beyond, the tangent would send them all sideways.
_WIDEST = 75.0


@dataclass(frozen=True)
class ExtinctionGrid:
    """Extinction per mm in blocks of a volume.

    Attributes
    ----------
    blocks : ndarray of float32, shape (z, y, x)
        Mean extinction per mm.
    index_from_world : ndarray, shape (4, 4)
        From world mm to indices (x, y, z) of block centres.
    step : float
        Length in mm of a step along a ray: the shortest side of a block.
    reach : float
        Diagonal of the volume in mm: no ray is longer.
    """

    blocks: np.ndarray
    index_from_world: np.ndarray
    step: float
    reach: float


def extinction_grid(scene: Scene) -> ExtinctionGrid:
    """Return what a scene's volume takes of light on its way, in blocks."""
    volume, transfer = scene.volume, scene.transfer
    assert volume is not None
    assert transfer is not None
    voxels = thinned(volume, LOOKED_AT)
    factors = tuple(-(-n // BLOCKS) for n in voxels.shape)
    fine = _extinction(transfer, volume, voxels)
    # What is left at the end is as its last voxel: blocks of one size have one place each.
    fine = np.pad(fine, [(0, -n % f) for n, f in zip(fine.shape, factors, strict=True)], mode="edge")
    shape = [side for n, f in zip(fine.shape, factors, strict=True) for side in (n // f, f)]
    blocks = fine.reshape(shape).mean(axis=(1, 3, 5))
    # In texture coordinates the blocks fill a little more than the volume, by the padding and what thinning left.
    strides = [max(1, n // LOOKED_AT) for n in volume.data.shape]
    sides = np.array([f * s for f, s in zip(factors, strides, strict=True)])[::-1] / np.array(volume.dims)
    matrix = np.eye(4)
    matrix[:3] = volume.texture_from_world[:3] / sides[:, None]
    matrix[:3, 3] -= 0.5
    grid = ExtinctionGrid(
        blocks.astype(np.float32), matrix,
        float(min(sides * volume.dims * volume.spacing)),
        float(np.linalg.norm(np.ptp(volume.corners(), axis=0))),
    )  # fmt: skip
    return _cut(scene, volume, grid)


def _extinction(transfer: TransferFunction, volume: Volume, voxels: np.ndarray) -> np.ndarray:
    """Return the extinction per mm of voxels, float32."""
    if transfer.regions:
        sides = np.array(volume.spacing[::-1]) * np.array(volume.data.shape) / np.array(voxels.shape)
        thick = [n > 1 for n in voxels.shape]
        slopes = [
            np.gradient(voxels.astype(np.float32), side, axis=axis)
            for axis, side in enumerate(sides) if thick[axis]
        ]  # fmt: skip
        steepness = np.sqrt(sum((slope**2 for slope in slopes), np.zeros(voxels.shape, np.float32)))
        opacity = transfer.evaluate_2d(voxels.astype(np.float64), steepness)[..., 3]
        return transfer.extinction(opacity, volume.unit_distance).astype(np.float32)
    low, high = volume.value_range
    span = max(high - low, 1e-30)
    values = low + span * np.arange(_TABLE) / (_TABLE - 1)
    table = transfer.extinction(transfer.evaluate(values)[:, 3], volume.unit_distance).astype(np.float32)
    scaled = (voxels.astype(np.float32) - np.float32(low)) * np.float32((_TABLE - 1) / span)
    return np.asarray(table[np.clip(np.rint(scaled), 0, _TABLE - 1).astype(np.int16)])


def _cut(scene: Scene, volume: Volume, grid: ExtinctionGrid) -> ExtinctionGrid:
    """Return the grid without the blocks whose centres crop box and clip planes cut away."""
    z, y, x = np.indices(grid.blocks.shape).reshape(3, -1)
    back = np.linalg.inv(grid.index_from_world)
    centres = np.stack([x, y, z], axis=-1) @ back[:3, :3].T + back[:3, 3]
    shown = is_shown(scene, volume, centres).reshape(grid.blocks.shape)
    return ExtinctionGrid(np.where(shown, grid.blocks, 0), grid.index_from_world, grid.step, grid.reach)


# -- light ---------------------------------------------------------------------------------------------
def light_at(scene: Scene, grid: ExtinctionGrid, points: np.ndarray, rays: int = RAYS) -> np.ndarray:
    """Return the light that arrives at world points from all active lamps.

    Parameters
    ----------
    scene : Scene
        With a camera, with which lamps of the viewer move.
    grid : ExtinctionGrid
        Of this scene.
    points : ndarray, shape (n, 3)
        World mm.
    rays : int
        To each lamp; one leads to its middle.

    Returns
    -------
    ndarray, shape (n, 3)
        Linear RGB; 1 is what a lamp of intensity 1 gives where nothing is in its way.
    """
    total = np.zeros((len(points), 3))
    for light in scene.active_lights:
        sent = lamps.arriving(light, points) * light.intensity
        reached = np.flatnonzero(sent > 1e-4)
        seen = visibility(scene, grid, light, points[reached], rays)
        total[reached] += (sent[reached] * seen)[:, None] * np.asarray(light.color)
    return total


def visibility(
    scene: Scene, grid: ExtinctionGrid, light: Light, points: np.ndarray, rays: int = RAYS
) -> np.ndarray:
    """Return the share of a lamp's cone that is free, for world points (n, 3); 0 to 1, shape (n,)."""
    assert scene.camera is not None
    assert scene.volume is not None
    middle = vec3(np.asarray(scene.volume.center))
    towards = lamps.directions_towards(light, points, scene.camera.basis(), middle)
    wide = np.tan(np.radians(np.minimum(lamps.half_angles(light, points), _WIDEST)))
    far = lamps.distances(light, points) if light.placed else np.full(len(points), grid.reach)
    side = np.cross(towards, np.eye(3)[np.argmin(np.abs(towards), axis=1)])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(towards, side)
    passed = np.zeros(len(points))
    for x, y in _disc(rays):
        way = towards + wide[:, None] * (x * side + y * up)
        way /= np.linalg.norm(way, axis=1, keepdims=True)
        passed += np.exp(-optical_depth(grid, points, way, np.minimum(far, grid.reach)))
    return passed / rays


def optical_depth(grid: ExtinctionGrid, points: np.ndarray, ways: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Return the optical depth from points (n, 3) along unit vectors (n, 3) over ways in mm (n,)."""
    matrix = grid.index_from_world
    start, way = points @ matrix[:3, :3].T + matrix[:3, 3], ways @ matrix[:3, :3].T
    top = np.array(grid.blocks.shape[::-1]) - 0.5
    # Only as far as the ray is inside: from where it leaves, nothing is in its way.
    with np.errstate(divide="ignore", invalid="ignore"):
        out = np.where(way > 0, (top - start) / way, np.where(way < 0, (-0.5 - start) / way, np.inf))
    length = np.maximum(np.minimum(far, np.nan_to_num(out, nan=0.0).min(axis=1)), 0.0)
    depth = np.zeros(len(points))
    for k in range(int(np.ceil(length.max(initial=0.0) / grid.step))):
        # The last step of a ray is as short as it has to be.
        part = np.clip(length - k * grid.step, 0.0, grid.step)
        still = np.flatnonzero(part > 0)
        places = start[still] + way[still] * (k * grid.step + part[still] / 2)[:, None]
        taken = ndimage.map_coordinates(grid.blocks, places.T[::-1], order=1, mode="nearest")
        depth[still] += taken * part[still]
    return depth


def _disc(count: int) -> np.ndarray:
    """Return places on the unit disc: its middle, and the others evenly around it, shape (count, 2)."""
    if count == 1:
        return np.zeros((1, 2))
    # On a circle of this radius, with one in the middle, the mean of r² is the disc's: 1/2.
    radius = np.sqrt(0.5 * count / (count - 1))
    turn = 2 * np.pi * np.arange(count - 1) / (count - 1)
    return np.concatenate([np.zeros((1, 2)), radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)])


__all__ = ["ExtinctionGrid", "extinction_grid", "light_at", "optical_depth", "visibility"]
