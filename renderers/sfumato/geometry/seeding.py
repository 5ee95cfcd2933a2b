"""Where seeds lie: places in world mm for each kind of `Seeds`, the same every time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import LoadError
from ..io.reading import Task, need
from ..scene.shapes import Surface
from ..scene.tracing import Seeds

if TYPE_CHECKING:
    from .field import VectorField

#: Steps of the R2 sequence (Roberts 2018): evenly spread in the square for any number of points.
_R2 = np.array([0.7548776662466927, 0.5698402909980532])


def seed_points(seeds: Seeds, surface: Surface | None = None) -> np.ndarray:
    """Return the places, shape (n, 3), world mm.

    Parameters
    ----------
    surface : Surface, optional
        For ``kind="surface"``: the places lie on it, as many for each square millimetre.
    """
    if seeds.kind == "points":
        return np.asarray(seeds.places, dtype=float)
    if seeds.kind == "line":
        t = np.linspace(0, 1, seeds.count)[:, None] if seeds.count > 1 else np.array([[0.5]])
        return np.asarray(np.asarray(seeds.start) * (1 - t) + np.asarray(seeds.end) * t)
    if seeds.kind == "plane":
        u, v = ((0.5 + np.arange(1, seeds.count + 1)[:, None] * _R2) % 1 - 0.5).T
        return np.asarray(
            seeds.center + u[:, None] * np.asarray(seeds.edge_u) + v[:, None] * np.asarray(seeds.edge_v)
        )
    if seeds.kind == "surface":
        assert surface is not None
        return _on_surface(surface, seeds)
    return _in_ball(seeds)


def suggest_seeds(field: VectorField, count: int = 200) -> Seeds:
    """Return seeds for a first picture: places in the whole field, more of them where it is faster.

    Raises
    ------
    LoadError
        If the field is at rest everywhere.
    """
    from .field import SPEED

    support = need("vtkmodules.util.numpy_support", Task(Path(field.path or "vectors")))
    speed = support.vtk_to_numpy(field.dataset.GetPointData().GetArray(SPEED)).astype(float)
    if not speed.sum() > 0:
        raise LoadError(field.path or "vectors", "all vectors are zero", "choose another field")
    chosen = np.random.default_rng(0).choice(len(speed), count, p=speed / speed.sum())
    places = (field.dataset.GetPoint(int(i)) for i in np.unique(chosen))
    return Seeds(kind="points", places=tuple((float(x), float(y), float(z)) for x, y, z in places))


def _in_ball(seeds: Seeds) -> np.ndarray:
    rng = np.random.default_rng(seeds.seed)
    away = rng.normal(size=(seeds.count, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    return np.asarray(seeds.center + seeds.radius * np.cbrt(rng.random((seeds.count, 1))) * away)


def _on_surface(surface: Surface, seeds: Seeds) -> np.ndarray:
    rng = np.random.default_rng(seeds.seed)
    a, b, c = (surface.points[surface.triangles[:, k]].astype(float) for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    chosen = rng.choice(len(area), seeds.count, p=area / area.sum())
    u, v = rng.random((2, seeds.count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return np.asarray(a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen])
