"""From a geometry to the mesh that is drawn: filter, smooth, thin out, sweep, colour."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Generator

import numpy as np

from ..scene.geometry import Geometry, value_range
from ..scene.shapes import Mesh, Surface
from .color import point_colors
from .polyline import Strand, smoothed, split, strand_of, thinned_out, without_repeats
from .tubes import Tubes, sweep, tangents_of

#: Level of detail: beyond so many triangles, tubes get fewer sides, then their axes fewer points. Lines are
#: never left out (that is what the filters are for), so millions of them may still take more.
BUDGET_TRIANGLES = 2_000_000
MOST_SIDES, FEWEST_SIDES = 12, 4
#: How far, in radii, a tube's axis may leave its line for the sake of fewer points: nothing that is seen.
TOLERANCE = 0.05
#: How far it may leave it, in radii, when there are too many points for the budget even with few sides.
COARSEST = 0.5
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
    key = geometry.mesh_key
    with _lock:
        if key in _cache:
            _cache.move_to_end(key)
            return _cache[key]
    work = build(geometry)
    while True:
        try:
            done = next(work)
        except StopIteration as stop:
            return _keep(key, stop.value)
        if progress is not None:
            progress(done, "Building tubes")


def build(geometry: Geometry) -> Generator[float, None, Mesh]:
    """Build a mesh in pieces: yields the progress, 0..1, and returns the mesh."""
    if isinstance(geometry.shape, Surface):
        yield 0.0
        return _surface_mesh(geometry, geometry.shape)
    return (yield from _tube_mesh(geometry))


def _keep(key: str, mesh: Mesh) -> Mesh:
    with _lock:
        _cache[key] = mesh
        while len(_cache) > 1 and sum(m.nbytes for m in _cache.values()) > CACHE_BYTES:
            _cache.popitem(last=False)
    return mesh


def _surface_mesh(geometry: Geometry, shape: Surface) -> Mesh:
    values = geometry.scalar_values(geometry.scalar) if geometry.color_by == "scalar" else None
    assert shape.normals is not None
    return Mesh(shape.points, shape.normals, shape.triangles, point_colors(geometry, shape.normals, values))


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
    sides = geometry.sides or automatic_sides(sum(len(p.points) for p in parts))
    if not geometry.sides:
        yield from _coarsened(parts, geometry.radius)
    swept, colors = [], []
    for i, part in enumerate(parts):
        tangents = tangents_of(part)
        tubes = sweep(part, tangents, _radius(geometry, part, names), max(sides, 3))
        values = part.values[:, names.index(geometry.scalar)] if geometry.color_by == "scalar" else None
        swept.append(tubes)
        colors.append(point_colors(geometry, tangents, values)[tubes.source])
        yield 0.4 + 0.5 * (i + 1) / len(parts)
    return _joined(swept, colors)


def _coarsened(parts: list[Strand], radius: float) -> Generator[float, None, None]:
    """Thin lines out further, in place, if they take more than the budget even with few sides."""
    if sum(len(p.points) for p in parts) * 2 * FEWEST_SIDES <= BUDGET_TRIANGLES:
        return
    for i, part in enumerate(parts):
        parts[i] = thinned_out(part, COARSEST * radius)
        yield 0.3 + 0.1 * (i + 1) / len(parts)


def _scalars_needed(geometry: Geometry) -> tuple[str, ...]:
    wanted = [geometry.scalar] if geometry.color_by == "scalar" else []
    return tuple(dict.fromkeys([*wanted, *filter(None, [geometry.radius_by])]))


def automatic_sides(points: int) -> int:
    """Return how many sides tubes with so many points in all get: 12, or fewer to stay in the budget."""
    return int(np.clip(BUDGET_TRIANGLES // max(2 * points, 1), FEWEST_SIDES, MOST_SIDES))


def _radius(geometry: Geometry, part: Strand, names: tuple[str, ...]) -> np.ndarray:
    if not geometry.radius_by:
        return np.full(len(part.points), geometry.radius, np.float32)
    low, high = value_range(geometry.scalar_values(geometry.radius_by))
    place = np.clip((part.values[:, names.index(geometry.radius_by)] - low) / (high - low), 0, 1)
    share = geometry.thinnest + (1 - geometry.thinnest) * np.nan_to_num(place)
    return np.asarray(geometry.radius * share, np.float32)


def _joined(swept: list[Tubes], colors: list[np.ndarray]) -> Mesh:
    if not swept:
        nothing = np.empty((0, 3), np.float32)
        return Mesh(nothing, nothing, nothing.astype(np.uint32), nothing)
    starts = np.cumsum([0] + [len(t.points) for t in swept[:-1]])
    arrays = (
        np.concatenate([t.points for t in swept]),
        np.concatenate([t.normals for t in swept]),
        np.concatenate([t.triangles + np.uint32(s) for t, s in zip(swept, starts, strict=True)]),
        np.concatenate(colors),
    )
    for array in arrays:
        array.flags.writeable = False  # a mesh takes them as they are, then, without a copy
    return Mesh(*arrays)
