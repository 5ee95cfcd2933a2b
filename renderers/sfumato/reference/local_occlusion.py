"""Local ambient occlusion in float64 (Hernell2007, Eq. 1-4), on the volume's own voxels: no blocks, one step."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError
from ..scene import Scene
from .medium import CELLS, Medium
from .rays import Region


def intensity(
    scene: Scene,
    points: np.ndarray,
    directions: np.ndarray,
    *,
    radius: float,
    offset: float,
    samples: int,
    weights: np.ndarray | None = None,
    gamma: float = 1.0,
    emission: bool = True,
    bias: float = 0.0,
) -> np.ndarray:
    """Return the light that arrives at points from their neighbourhood (Eq. 3).

    Parameters
    ----------
    scene : Scene
        With a volume and a one-dimensional transfer function.
    points : ndarray, shape (n, 3)
        World, mm.
    directions : ndarray, shape (K, 3)
        Unit vectors, world.
    radius, offset : float
        Length of the rays and where they begin, mm.
    samples : int
        M of Eq. 2, each in the middle of its part of the ray.
    weights : ndarray, shape (K,), optional
        Weights of the directions, 1 if not given.
    gamma : float
        Exponent on what each sample lets through (Eq. 5).
    emission : bool
        Whether tissue that gives off light lights its surroundings (Eq. 4).
    bias : float
        Least light.

    Returns
    -------
    ndarray, shape (n, 3)
        Linear RGB; 1 + bias where nothing is near and nothing shines.
    """
    if scene.has_solid_cuts:
        raise SceneError("solid_cuts", True, "this twin has open cut faces; `reference.cone` has solid ones")
    medium, region = Medium(scene), Region(scene)
    total = np.zeros((len(points), 3))
    weights = np.ones(len(directions)) if weights is None else weights
    for direction, weight in zip(directions, weights, strict=True):
        total += weight * along_ray(
            medium, region, points, direction, radius, offset, samples, gamma, emission
        )
    return np.asarray(bias + total / len(directions))


def along_ray(
    medium: Medium,
    region: Region,
    points: np.ndarray,
    direction: np.ndarray,
    radius: float,
    offset: float,
    samples: int,
    gamma: float = 1.0,
    emission: bool = True,
) -> np.ndarray:
    """Return the light from one direction (Eq. 2; with emission Eq. 4); shape (n, 3). Parameters as `intensity`."""
    step = (radius - offset) / samples
    through, light = np.ones(len(points)), np.zeros((len(points), 3))
    for m in range(samples):
        tau, shining = matter(medium, region, points + direction * (offset + (m + 0.5) * step))
        light += (through / samples)[:, None] * (1 + shining * emission)
        through *= np.exp(-tau * gamma * step)
    return light


def matter(medium: Medium, region: Region, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return extinction per mm, and emission times opacity at unit distance, at points; 0 where all is cut away."""
    inside = (points @ region.half_spaces[:, :3].T >= region.half_spaces[:, 3]).all(axis=1)
    nodes, values = np.arange(CELLS + 1) / CELLS, medium.value(points)
    tau = np.where(inside, np.interp(values, nodes, medium.tau), 0.0)
    emitted = [np.interp(values, nodes, medium.density[:, c]) for c in (4, 5, 6)]
    share = np.stack(emitted, axis=-1) / np.maximum(tau, 1e-30)[:, None] * (tau > 0)[:, None]
    return tau, share * (1 - np.exp(-tau * medium.unit_distance))[:, None]
