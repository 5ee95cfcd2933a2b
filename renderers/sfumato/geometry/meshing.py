"""From a geometry to the mesh that is drawn: filter, smooth, thin out, sweep, colour."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Generator
from dataclasses import replace

import numpy as np

from ..pieces import finished, spanned
from ..scene.geometry import Geometry, value_range
from ..scene.shapes import Mesh, Surface
from .color import point_colors
from .detail import FEWEST_SIDES, TOLERANCE, automatic_sides, clustered, fitted
from .polyline import Strand, smoothed, split, strand_of, thinned_out, without_repeats
from .tubes import Tubes, sweep, tangents_of

#: Level of detail (`detail`): most triangles of tubes, and of what is drawn while something moves.
BUDGET_TRIANGLES = 2_000_000
MOVING_TRIANGLES = 300_000
#: Meshes kept for geometries that come back (undo, other views).
CACHE_BYTES = 1 << 30
_CHUNK_POINTS = 100_000

Progress = Callable[[float, str], object]

_cache: OrderedDict[str, Mesh] = OrderedDict()
_lock = threading.Lock()


def mesh_of(geometry: Geometry, progress: Progress | None = None) -> Mesh:
    """Return the mesh that shows a geometry; kept, so that asking again costs nothing.

    Parameters
    ----------
    progress : callable (fraction, text), optional
        Told how far the work is between pieces of some 10 ms; may raise to cancel.

    Returns
    -------
    Mesh
        World mm LPS; empty if the filters leave no line. ``visible`` and ``clipped`` are the drawing's.

    Raises
    ------
    SceneError
        If the colour map is not known.
    """
    known = known_mesh(geometry)
    if known is not None:
        return known
    tell = None if progress is None else lambda done: progress(done, "Building tubes")
    return finished(build(geometry), tell)


def known_mesh(geometry: Geometry) -> Mesh | None:
    """Return the mesh that shows a geometry if it was built before."""
    key = geometry.mesh_key
    with _lock:
        if key in _cache:
            _cache.move_to_end(key)
        return _cache.get(key)


def build(geometry: Geometry) -> Generator[float, None, Mesh]:
    """Build a mesh in pieces, and keep it: yields the progress, 0..1, and returns the mesh."""
    if isinstance(geometry.shape, Surface):
        yield 0.0
        mesh = yield from _surface_mesh(geometry, geometry.shape)
    else:
        mesh = yield from _tube_mesh(geometry)
    return _keep(geometry.mesh_key, mesh)


def _keep(key: str, mesh: Mesh) -> Mesh:
    with _lock:
        _cache[key] = mesh
        while len(_cache) > 1 and sum(m.nbytes for m in _cache.values()) > CACHE_BYTES:
            _cache.popitem(last=False)
    return mesh


def _surface_mesh(geometry: Geometry, shape: Surface) -> Generator[float, None, Mesh]:
    values = geometry.scalar_values(geometry.scalar) if geometry.color_by == "scalar" else None
    assert shape.normals is not None
    mesh = Mesh(shape.points, shape.normals, shape.triangles, point_colors(geometry, shape.normals, values))
    yield 0.3
    if len(mesh.triangles) > 2 * MOVING_TRIANGLES:
        mesh = replace(mesh, coarse=clustered(mesh, MOVING_TRIANGLES))
    return mesh


def _tube_mesh(geometry: Geometry) -> Generator[float, None, Mesh]:
    yield 0.0
    names = _scalars_needed(geometry)
    strand = strand_of(geometry, names)
    yield 0.05
    parts = []
    pieces = split(strand, _CHUNK_POINTS)
    for i, piece in enumerate(pieces):
        run = smoothed(without_repeats(piece), geometry.smoothing)
        if len(run.points):
            parts.append(thinned_out(run, TOLERANCE * geometry.radius))
        yield 0.05 + 0.25 * (i + 1) / len(pieces)
    if not geometry.sides:
        parts = yield from spanned(fitted(parts, geometry.radius, BUDGET_TRIANGLES), 0.3, 0.6)
    sides = geometry.sides or automatic_sides(parts, BUDGET_TRIANGLES)
    mesh = yield from spanned(_swept(geometry, parts, names, max(sides, 3)), 0.6, 0.9)
    if len(mesh.triangles) <= 2 * MOVING_TRIANGLES:
        return mesh
    rough = yield from spanned(fitted(parts, geometry.radius, MOVING_TRIANGLES), 0.9, 0.97)
    coarse = yield from spanned(_swept(geometry, rough, names, FEWEST_SIDES), 0.97, 1.0)
    return replace(mesh, coarse=coarse)


def _swept(
    geometry: Geometry, parts: list[Strand], names: tuple[str, ...], sides: int
) -> Generator[float, None, Mesh]:
    """Sweep tubes along lines."""
    swept, colors, axes = [], [], []
    for i, part in enumerate(parts):
        tangents, radius = tangents_of(part), _radius(geometry, part, names)
        tubes = sweep(part, tangents, radius, sides)
        values = part.values[:, names.index(geometry.scalar)] if geometry.color_by == "scalar" else None
        swept.append(tubes)
        colors.append(point_colors(geometry, tangents, values)[tubes.source])
        axes.append(_axes(part, radius))
        yield (i + 1) / len(parts)
    lines = sum(len(p.points) - len(a) for p, a in zip(parts, axes, strict=True))
    return _joined(swept, colors, axes, lines)


def _axes(part: Strand, radius: np.ndarray) -> np.ndarray:
    joined = part.joined
    ends = part.points[:-1][joined], part.points[1:][joined]
    return np.column_stack([*ends, 0.5 * (radius[:-1] + radius[1:])[joined]])


def _scalars_needed(geometry: Geometry) -> tuple[str, ...]:
    wanted = [geometry.scalar] if geometry.color_by == "scalar" else []
    return tuple(dict.fromkeys([*wanted, *filter(None, [geometry.radius_by])]))


def _radius(geometry: Geometry, part: Strand, names: tuple[str, ...]) -> np.ndarray:
    if not geometry.radius_by:
        return np.full(len(part.points), geometry.radius, np.float32)
    low, high = value_range(geometry.scalar_values(geometry.radius_by))
    place = np.clip((part.values[:, names.index(geometry.radius_by)] - low) / (high - low), 0, 1)
    share = geometry.thinnest + (1 - geometry.thinnest) * np.nan_to_num(place)
    return np.asarray(geometry.radius * share, np.float32)


def _joined(swept: list[Tubes], colors: list[np.ndarray], axes: list[np.ndarray], lines: int) -> Mesh:
    if not swept:
        nothing = np.empty((0, 3), np.float32)
        return Mesh(nothing, nothing, nothing.astype(np.uint32), nothing)
    starts = np.cumsum([0] + [len(t.points) for t in swept[:-1]])
    arrays = (
        np.concatenate([t.points for t in swept]),
        np.concatenate([t.normals for t in swept]),
        np.concatenate([t.triangles + np.uint32(s) for t, s in zip(swept, starts, strict=True)]),
        np.concatenate(colors),
        np.concatenate(axes),
    )
    for array in arrays:
        array.flags.writeable = False  # a mesh takes them as they are, then, without a copy
    return Mesh(*arrays, shown=lines)
