"""What lies under a place of the picture: the first surface along its ray, in float64 on the CPU.

Only the voxels along one ray are looked at, so that it takes milliseconds however large the volume is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .camera import Camera, Vec3
from .scene import Scene
from .volume import Volume

#: Distance between samples in the smallest spacing.
STEP_VOXELS = 0.5
#: Transmittance below which a ray has met a surface: half of what lies behind is hidden.
HALF_HIDDEN = 0.5
#: Least opacity of a ray in which a material is found.
LEAST_SEEN = 0.02
#: How far towards a light what a surface takes of it is counted as the surface's own.
SKIN_VOXELS = 4.0


def surface_under(scene: Scene, x: float, y: float, aspect: float) -> Vec3 | None:
    """Return the point at which the ray through a place of the picture has lost half its light.

    Parameters
    ----------
    x, y : float
        Place in half widths and half heights from the picture's centre, y up; -1 to 1.
    aspect : float
        The picture's width over its height.

    Returns
    -------
    (float, float, float) or None
        World mm; None where the ray meets too little, or there is no volume.
    """
    points, before, taken = ray_samples(scene, x, y, aspect)
    wanted = -np.log(HALF_HIDDEN)
    hit = int(np.searchsorted(before + taken, wanted))
    if hit == len(points):
        return None
    # Samples stand in the middle of their steps.
    along = points[1] - points[0] if len(points) > 1 else np.zeros(3)
    place = points[hit] + along * ((wanted - before[hit]) / taken[hit] - 0.5)
    return float(place[0]), float(place[1]), float(place[2])


@dataclass(frozen=True)
class Found:
    """The material that is seen at a place of the picture.

    Attributes
    ----------
    point : (float, float, float)
        Where it lies: half of what is seen there comes from before it, world mm.
    value : float
        Median of the values that are seen, weighted by how much of the picture they make; the volume's unit.
    opacity : float
        What the transfer function gives this value (and gradient), per unit distance; 0 to 1.
    gradient : float
        Gradient magnitude where the ray meets that value, value per mm.
    """

    point: Vec3
    value: float
    opacity: float
    gradient: float = 0.0


def material_under(scene: Scene, x: float, y: float, aspect: float) -> Found | None:
    """Return the material that is seen at a place of the picture (as in `surface_under`); None where nothing is."""
    points, before, taken = ray_samples(scene, x, y, aspect)
    seen = np.exp(-before) * -np.expm1(-taken)
    if scene.volume is None or scene.transfer is None or seen.sum() < LEAST_SEEN:
        return None
    values = _values_at(scene.volume, points)
    order = np.argsort(values)
    # One sample tells value and gradient: of two, the pair might lie beside what is seen.
    sample = order[_half_of(seen[order])]
    value, point = float(values[sample]), points[_half_of(seen)]
    steepness = np.linalg.norm(value_gradient(scene, points[sample : sample + 1]), axis=1)
    gradient = float(steepness[0])
    place = float(point[0]), float(point[1]), float(point[2])
    return Found(place, value, scene.transfer.opacity_of(value, gradient), gradient)


def _half_of(weights: np.ndarray) -> int:
    """Return where the sum of weights passes its half."""
    running = np.cumsum(weights)
    return int(np.searchsorted(running, running[-1] / 2))


def ray_samples(scene: Scene, x: float, y: float, aspect: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return samples on the ray through a place of the picture (as in `surface_under`), from the eye on.

    Returns
    -------
    points : ndarray, shape (n, 3)
        World mm; none where the ray meets nothing.
    before, taken : ndarray, shape (n,)
        Optical depth from the eye to each sample, and of the step around it.
    """
    volume, camera = scene.volume, scene.camera
    nothing = np.zeros((0, 3)), np.zeros(0), np.zeros(0)
    if volume is None or camera is None or scene.transfer is None:
        return nothing
    start, along = ray_through(camera, x, y, aspect)
    near, far = _shown_interval(scene, volume, start, along)
    if not camera.parallel_projection:
        near = max(near, 0.0)
    if not near < far:
        return nothing
    step = min(STEP_VOXELS * volume.min_spacing, far - near)
    count = max(1, round((far - near) / step))
    step = (far - near) / count
    points = start + along * (near + step * (np.arange(count) + 0.5))[:, None]
    taken = _extinction_at(scene, volume, points) * step
    if scene.has_solid_cuts:
        face = start + along * near
        if _is_cut_face(scene, volume, face, along):
            taken[0] = max(taken[0], float(_extinction_at(scene, volume, face[None])[0]) * volume.diagonal)
            points[0] = face
    return points, np.cumsum(taken) - taken, taken


def light_depths(scene: Scene, points: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Return the optical depth from each of some points (n, 3) towards a light, over the way that a skin is thick.

    What is farther away than `SKIN_VOXELS` is not asked: that casts a shadow, which is another question.
    """
    volume = scene.volume
    assert volume is not None
    step = STEP_VOXELS * volume.min_spacing
    ways = step * (np.arange(round(SKIN_VOXELS / STEP_VOXELS)) + 0.5)
    along = (points[:, None] + ways[:, None] * np.asarray(towards)).reshape(-1, 3)
    extinction = np.where(is_shown(scene, volume, along), _extinction_at(scene, volume, along), 0)
    return np.asarray(extinction.reshape(len(points), -1).sum(axis=1) * step)


def is_shown(scene: Scene, volume: Volume, points: np.ndarray) -> np.ndarray:
    """Tell of world points (n, 3) whether they are inside crop box and clip planes."""
    shown = np.ones(len(points), dtype=bool)
    for normal, least in _half_spaces(scene, volume):
        shown &= points @ normal >= least
    return shown


def ray_through(camera: Camera, x: float, y: float, aspect: float) -> tuple[np.ndarray, np.ndarray]:
    """Return start (mm) and unit direction of the ray through a place of the picture; places as above."""
    basis, half = camera.basis(), camera.half_extent(aspect)
    lateral = (x + camera.window_center[0]) * half[0] * np.asarray(basis.right) + (
        y + camera.window_center[1]
    ) * half[1] * np.asarray(basis.up)
    eye, forward = np.asarray(camera.position, dtype=float), np.asarray(basis.forward)
    if camera.parallel_projection:
        return eye + lateral, forward
    along = forward + lateral
    return eye, along / np.linalg.norm(along)


def _shown_interval(
    scene: Scene, volume: Volume, start: np.ndarray, along: np.ndarray
) -> tuple[float, float]:
    """Return the distances between which the ray is inside crop box and clip planes."""
    near, far = -np.inf, np.inf
    for normal, least in _half_spaces(scene, volume):
        rate, room = float(normal @ along), float(normal @ start) - least
        if abs(rate) < 1e-12 * float(np.linalg.norm(normal)):
            if room < 0:
                return 0.0, 0.0
        elif rate > 0:
            near = max(near, -room / rate)
        else:
            far = min(far, -room / rate)
    return near, far


def _is_cut_face(scene: Scene, volume: Volume, point: np.ndarray, along: np.ndarray) -> bool:
    """Tell whether a ray comes in at a point through a clip plane, or a side of the crop box that was moved in."""
    sides = [*(v > 0 for v in scene.crop.low), *(v < 1 for v in scene.crop.high)]
    cut = sides + [True] * sum(plane.enabled for plane in scene.clip)
    near = 1e-7 * volume.diagonal
    return any(
        is_cut and float(n @ along) > 0 and abs(float(n @ point) - least) < near * float(np.linalg.norm(n))
        for (n, least), is_cut in zip(_half_spaces(scene, volume), cut, strict=True)
    )


def _half_spaces(scene: Scene, volume: Volume) -> list[tuple[np.ndarray, float]]:
    """Return what is shown as half spaces of world points p, n . p >= c for each pair of n and c."""
    matrix = volume.texture_from_world
    spaces = [(matrix[i, :3], scene.crop.low[i] - matrix[i, 3]) for i in range(3)]
    spaces += [(-matrix[i, :3], matrix[i, 3] - scene.crop.high[i]) for i in range(3)]
    for plane in scene.clip:
        if plane.enabled:
            normal = np.asarray(plane.normal, dtype=float)
            spaces.append((normal, float(normal @ np.asarray(plane.point))))
    return spaces


def _extinction_at(scene: Scene, volume: Volume, points: np.ndarray) -> np.ndarray:
    """Return the extinction per mm at world points (n, 3)."""
    transfer = scene.transfer
    assert transfer is not None
    index = _index_of(volume, points)
    values = _trilinear(volume.data, index)
    if not transfer.regions:
        return transfer.extinction(transfer.evaluate(values)[:, 3], volume.unit_distance)
    # Central differences over two voxels, as the renderer takes them.
    slopes = [
        (_trilinear(volume.data, index + e) - _trilinear(volume.data, index - e)) / (2 * spacing)
        for e, spacing in zip(np.eye(3), volume.spacing, strict=True)
    ]
    gradient = np.sqrt(sum(s * s for s in slopes))
    return transfer.extinction(transfer.evaluate_2d(values, gradient)[:, 3], volume.unit_distance)


def _index_of(volume: Volume, points: np.ndarray) -> np.ndarray:
    """Return the voxel indices (x, y, z) of world points (n, 3)."""
    matrix = volume.texture_from_world
    return np.asarray((points @ matrix[:3, :3].T + matrix[:3, 3]) * np.array(volume.dims) - 0.5)


def _values_at(volume: Volume, points: np.ndarray) -> np.ndarray:
    """Return the volume's values at world points (n, 3)."""
    return _trilinear(volume.data, _index_of(volume, points))


def value_gradient(scene: Scene, points: np.ndarray) -> np.ndarray:
    """Return the gradient of the volume's value per mm at world points, shape (n, 3), as the renderer takes it."""
    volume = scene.volume
    assert volume is not None
    matrix, dims = volume.texture_from_world[:3], np.array(volume.dims)
    index = _index_of(volume, points)
    per_voxel = [
        (_trilinear(volume.data, index + e) - _trilinear(volume.data, index - e)) / 2 for e in np.eye(3)
    ]
    return np.asarray((np.stack(per_voxel, axis=-1) * dims) @ matrix[:, :3])


def transmittance_between(scene: Scene, start: np.ndarray, end: np.ndarray) -> float:
    """Return the share of light that passes from one world point to another through what is shown, 0 to 1."""
    volume = scene.volume
    assert volume is not None
    way = np.asarray(end, dtype=float) - start
    length = float(np.linalg.norm(way))
    if length <= 0:
        return 1.0
    near, far = _shown_interval(scene, volume, np.asarray(start, dtype=float), way / length)
    near, far = max(near, 0.0), min(far, length)
    if not near < far:
        return 1.0
    count = max(1, round((far - near) / (STEP_VOXELS * volume.min_spacing)))
    step = (far - near) / count
    points = start + way / length * (near + step * (np.arange(count) + 0.5))[:, None]
    return float(np.exp(-step * _extinction_at(scene, volume, points).sum()))


def _trilinear(data: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Return values at voxel indices (x, y, z), clamped at the edge; shape (n,)."""
    top = np.array(data.shape[::-1]) - 1
    index = np.clip(index, 0, top)
    low = np.minimum(index.astype(np.int64), np.maximum(top - 1, 0))
    part, high = index - low, np.minimum(low + 1, top)
    total = np.zeros(len(index))
    for corner in range(8):
        chosen = np.array([corner >> axis & 1 for axis in range(3)], dtype=bool)
        x, y, z = np.where(chosen, high, low).T
        total += data[z, y, x] * np.prod(np.where(chosen, part, 1 - part), axis=1)
    return total


__all__ = [
    "Found",
    "is_shown",
    "light_depths",
    "material_under",
    "ray_samples",
    "ray_through",
    "surface_under",
    "transmittance_between",
    "value_gradient",
]
