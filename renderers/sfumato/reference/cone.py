"""The ray-traced cone integral: emission and absorption along each view ray, light by brute force.

Each slab of a view ray is lit by the mean, over directions uniform in solid angle within the light's cone,
of exp(-optical depth) to the volume's edge, times that direction's own slab term (methods.md, *What
`reference` is*). There is no grid, no filter and no spread by repetition, so this is what the other
techniques approximate. With Numba, 64 x 64 pixels of a 64^3 volume take seconds; without, minutes.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import repeat
from types import ModuleType

import numpy as np

from ..scene import Scene
from .footprint import cone_directions
from .medium import Medium
from .multidirectional import Stack, jitter, pixel_jitter
from .rays import Frame, Rays, Region, view_rays, visible_interval
from .slab import front_term, rear_term, secant_rule

#: A view ray ends where less than this is left of it.
OPAQUE = 1e-6
#: Optical depth beyond which no light is left (2e-9).
DARK = 20.0
#: Pixels between two yields, as far as they make whole rows.
BATCH = 2048


@dataclass(frozen=True)
class Cone:
    """One light as a bundle of directions.

    Attributes
    ----------
    directions : ndarray, shape (K, 3)
        Towards the light, world space.
    secants : ndarray, shape (K,)
        Against the slabs' normal.
    radiance : ndarray, shape (3,)
        Colour times intensity, divided by what an opaque facing wall returns.
    facing : float
        What an opaque facing wall returns.
    """

    directions: np.ndarray
    secants: np.ndarray
    radiance: np.ndarray
    rear: bool
    facing: float


@dataclass(frozen=True)
class Task:
    """All that the integral over one picture needs."""

    medium: Medium
    region: Region
    rays: Rays
    z_in: np.ndarray
    z_out: np.ndarray
    stack: Stack
    cones: tuple[Cone, ...]
    ambient: float
    light_step: float


def cones(scene: Scene, count: int) -> tuple[Cone, ...]:
    """Return the active lights of a scene as bundles of ``count`` directions."""
    assert scene.camera is not None
    frame, made = Frame.of(scene.camera), []
    for light, (tilt, rotation) in zip(scene.active_lights, scene.light_angles(), strict=True):
        tilt = 0.0 if scene.technique_id == "directional" else tilt
        local = cone_directions(tilt, light.aperture, rotation, count)
        world = local @ np.stack([frame.right, frame.up, -frame.forward])
        facing = secant_rule(min(tilt, 180 - tilt), light.aperture).facing
        radiance = np.asarray(light.color, dtype=np.float64) * light.intensity / facing
        made.append(Cone(world, 1 / np.abs(local[:, 2]), radiance, tilt > 90, facing))
    return tuple(made)


def prepare(
    scene: Scene,
    size: tuple[int, int],
    directions: int,
    light_step: float,
    frame_index: int,
    unshadowed: bool = False,
) -> Task:
    """Collect what the integral over a picture needs.

    Raises
    ------
    SceneError
        If there is no volume, or the transfer function is two-dimensional.
    """
    medium, region = Medium(scene), Region(scene)
    assert scene.camera is not None
    assert scene.volume is not None
    rays = view_rays(scene.camera, size, pixel_jitter(frame_index))
    z_in, z_out = visible_interval(scene, rays, region)
    return Task(
        medium,
        region,
        rays,
        z_in,
        z_out,
        Stack.of(scene, jitter(frame_index)),
        cones(scene, directions),
        1.0 if unshadowed else float(getattr(scene.technique, "ambient", 0.0)),
        light_step * scene.volume.min_spacing,
    )


def passes(
    scene: Scene,
    size: tuple[int, int],
    out: np.ndarray,
    directions: int = 64,
    light_step: float = 0.5,
    frame_index: int = 0,
    compiled: bool | None = None,
    unshadowed: bool = False,
) -> Iterator[float]:
    """Draw into an array some rows at a time, yielding progress (0 to 1) after each; close it to cancel.

    Parameters
    ----------
    out : ndarray, float64, shape (height, width, 4)
        Filled from the top.
    compiled : bool, optional
        Whether to use Numba; by default wherever it can be imported.
    unshadowed : bool
        Whether all light arrives, whatever is in its way.

    Raises
    ------
    ImportError
        If Numba is asked for and missing.
    """
    task = prepare(scene, size, directions, light_step, frame_index, unshadowed)
    loops = _compiled() if compiled is None else (_compiled(required=True) if compiled else None)
    if loops:
        loops.empty_distance(task.medium)  # once, before the threads ask for it
    run = loops.integrate if loops else _integrate
    flat = out.reshape(-1, 4)
    count = max(1, BATCH // size[0]) * size[0]
    workers = os.cpu_count() or 1
    with ThreadPoolExecutor(workers) as pool:
        for first in range(0, len(flat), count):
            # Threads of our own: Numba's would abort the program if two renderers ran at a time.
            pixels = np.arange(first, min(first + count, len(flat)))
            parts = [part for part in np.array_split(pixels, 4 * workers) if len(part)]
            for part, values in zip(parts, pool.map(run, repeat(task), parts), strict=False):
                flat[part] = values
            yield (pixels[-1] + 1) / len(flat)


def render(
    scene: Scene,
    size: tuple[int, int],
    directions: int = 64,
    light_step: float = 0.5,
    frame_index: int = 0,
    compiled: bool | None = None,
) -> np.ndarray:
    """Return the picture of the cone integral.

    Parameters
    ----------
    scene : Scene
        With any technique; the lights' angles, apertures and colours and the technique's ``ambient`` count.
    size : (int, int)
        Width and height in pixels.
    directions : int
        Directions in each light's cone.
    light_step : float
        Sampling distance towards the light in voxels (of the smallest spacing).

    Returns
    -------
    ndarray, float64, shape (height, width, 4)
        Linear, premultiplied; row 0 on top.
    """
    out = np.zeros((size[1], size[0], 4))
    for _ in passes(scene, size, out, directions, light_step, frame_index, compiled):
        pass
    return out


def _compiled(required: bool = False) -> ModuleType | None:
    try:
        from . import cone_numba
    except ImportError:
        if required:
            raise
        return None
    return cone_numba


# -- plain NumPy: all pixels of a batch at a time --------------------------------------------------------


def _integrate(task: Task, pixels: np.ndarray) -> np.ndarray:
    """Return premultiplied colour and opacity of some pixels; shape (n, 4)."""
    result = np.zeros((len(pixels), 4))
    start, slope = task.rays.start[pixels], task.rays.slope[pixels]
    secant = np.linalg.norm(slope, axis=-1)
    for i in range(task.stack.n):
        za = np.maximum(task.stack.plane(i), task.z_in[pixels])
        zb = np.minimum(task.stack.plane(i + 1), task.z_out[pixels])
        hit = np.flatnonzero((zb > za) & (1 - result[:, 3] > OPAQUE))
        a, b = (start[hit] + slope[hit] * z[hit, None] for z in (za, zb))
        s_a, s_b = task.medium.value(a), task.medium.value(b)
        face = (za[hit] == task.z_in[pixels][hit]) & task.region.on_solid_face(a, slope[hit], inwards=True)
        tau, color, emission = task.medium.between(s_a, np.where(face, s_a, s_b))
        x = np.where(face, task.region.solid_depth(tau), tau * (zb - za)[hit])
        solid = tau > 0
        hit, a, b, x = hit[solid], a[solid], b[solid], x[solid]
        alpha = -np.expm1(-x * secant[hit])
        light = np.zeros((len(hit), 3))
        for cone in task.cones:
            lit = _lit(task, cone, b if cone.rear else a, x, secant[hit])
            light += ((1 - task.ambient) * lit + task.ambient * cone.facing * alpha)[:, None] * cone.radiance
        share = (1 - result[hit, 3])[:, None]
        result[hit, :3] += share * (color[solid] * light + emission[solid] * alpha[:, None])
        result[hit, 3] += share[:, 0] * alpha
    return result


def _lit(task: Task, cone: Cone, p_world: np.ndarray, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the mean over a cone's directions of transmittance times slab term."""
    form = rear_term if cone.rear else front_term
    total = np.zeros(len(x))
    for towards, s in zip(cone.directions, cone.secants, strict=True):
        total += np.exp(-optical_depth(task, p_world, towards)) * form(x, v, s)
    return total / len(cone.directions)


def optical_depth(task: Task, p_world: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Return the optical depth from points (n, 3) to the edge of the clipped box along a unit vector."""
    length = np.maximum(task.region.interval(p_world, towards)[1], 0)
    depth = np.zeros(len(p_world))
    step = task.light_step
    near = task.medium.value(p_world)
    for k in range(math.ceil(float(length.max(initial=0.0)) / step)):
        end = np.minimum((k + 1) * step, length)
        far = task.medium.value(p_world + towards * end[:, None])
        depth += task.medium.extinction_between(near, far) * np.maximum(end - k * step, 0)
        near = far
    return depth + _solid_faces(task, p_world, towards, length) if task.region.solid.any() else depth


def _solid_faces(task: Task, p_world: np.ndarray, towards: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Return the optical depth of the solid faces that ways (n,) begin under or end at."""
    depth = np.zeros(len(p_world))
    ends = p_world + towards * length[:, None]
    inside = (
        length > 1e-7 * task.region.diagonal
    )  # a way that leaves at once begins on the face, not under it
    begins = inside & task.region.on_solid_face(p_world, towards, inwards=True)
    leaves = inside & task.region.on_solid_face(ends, towards, inwards=False)
    for there, points in ((begins, p_world), (leaves, ends)):
        value = task.medium.value(points[there])
        depth[there] += task.region.solid_depth(task.medium.extinction_between(value, value))
    return depth
