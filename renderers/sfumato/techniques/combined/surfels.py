"""Surfels: what geometry takes from light, in a form that does not depend on where the lamp stands.

A triangle of area A with unit normal n blocks A max(n.L, 0) of a parallel light from L. Triangles are much
finer than the texels of a light volume, and there may be millions; so all that lie in one cell of space are
put together to one surfel, which keeps the sums of A, A n and A n n^T. For light from any direction L then

    sum A |n.L|  ~  sqrt(sum A * L^T (sum A n n^T) L)

exact where the normals are alike, 11 % too much for a tube and 15 % for a ball; and the area that faces the
light is half of that and (sum A n).L. Moving a lamp costs one point a surfel, however many triangles there are.

Thin tubes are put together from their axes: a piece of length s and radius r along t has A = 2 pi r s, A n = 0 and
A n n^T = pi r s (1 - t t^T), here times 0.90 so that a tube across the light blocks exactly its diameter.
"""

from __future__ import annotations

from collections.abc import Generator, Hashable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...scene.shapes import Mesh
from ..frame import Frame
from ..stack import View, clip_uniforms
from .meshes import Shown

#: Edge of a surfel's cell in texels of the light volume.
CELL_TEXELS = 0.5
#: Edge in texels of the blocks that tell a sweep where geometry stands.
BLOCK_TEXELS = 8.0
#: Triangles, and samples of them, that are worked on at a time.
CHUNK, CHUNK_SAMPLES = 1 << 16, 1 << 18
#: Samples in place of one, of triangles larger than a cell.
DENSER = 2
#: Most samples of a mesh; larger ones are taken apart less finely.
MAX_SAMPLES = 24_000_000
#: The same of tubes' axes.
MAX_AXIS_SAMPLES = 3_000_000
#: Tubes up to this radius, in cells, are put together from their axes.
THIN = 1.0
#: What the sums of a tube are multiplied by.
_TUBE = 4 / (np.sqrt(2) * np.pi)
#: Columns while summing: A, A p, A n, A n n^T (xx, yy, zz, xy, xz, yz).
_COLUMNS = 13


@dataclass
class Surfels:
    """The surfels of one mesh.

    Attributes
    ----------
    buffer : buffer
        Each: place (mm, from `middle`), A n, A n n^T as above; 12 float32.
    blocks : ndarray, shape (n, 3)
        Centres of blocks of space that hold any, world mm.
    half : float
        Half a block's edge in mm.
    closed : bool
        Whether what turns away from a lamp always hides behind what faces it: tubes, and watertight meshes
        that nothing cuts.
    """

    buffer: Any
    count: int
    middle: np.ndarray
    blocks: np.ndarray
    half: float
    closed: bool

    @property
    def size(self) -> int:
        """Bytes on the GPU."""
        return int(self.buffer.size)

    def release(self) -> None:
        """Free the buffer."""
        self.buffer.release()

    def blocks_along(self, view: View) -> tuple[np.ndarray, np.ndarray]:
        """Return centres and half extents of the blocks along a view's axes in mm."""
        return view.coordinates(self.blocks), np.abs(view.axes).sum(axis=1) * self.half


def cell_of(frame: Frame) -> float:
    """Return the edge of a surfel's cell in mm."""
    return float(CELL_TEXELS * frame.volume.min_spacing / frame.params.resolution)


def kept_uniforms(frame: Frame) -> dict[str, Any]:
    """Return clip planes and crop box for geometry: a side of the box that is not moved in cuts nothing."""
    uniforms: dict[str, Any] = clip_uniforms(frame.scene, frame.volume)
    low, high = frame.scene.crop.low, frame.scene.crop.high
    uniforms["u_low"] = tuple(v if v > 0 else -1e9 for v in low)
    uniforms["u_high"] = tuple(v if v < 1 else 1e9 for v in high)
    return uniforms


def cut_key(frame: Frame, item: Shown) -> Hashable:
    """Return what a mesh's cuts depend on."""
    if not item.clipped:
        return None
    return frame.scene.clip, frame.scene.crop, frame.volume.texture_from_world.tobytes()


def make_surfels(frame: Frame, shown: tuple[Shown, ...]) -> Generator[float, None, tuple[Surfels, ...]]:
    """Return the surfels of what is drawn, making what is not there yet."""
    store, made = frame.device.store, []
    for item in shown:
        cell = cell_of(frame)
        key = ("shadow casters", item.geometry.mesh_key, cut_key(frame, item), cell)
        rows = None if store.holds(key) else (yield from _gather(frame, item, cell))
        made.append(store.get(key, lambda i=item, r=rows, c=cell: _upload(frame, i, r, c), lambda s: s.size))  # type: ignore[misc]
    return tuple(item for item in made if item.count)


def _gather(frame: Frame, item: Shown, cell: float) -> Generator[float, None, np.ndarray]:
    """Return the sums of each cell, shape (n, 13)."""
    mesh, rows = item.mesh, []
    middle, low = mesh.bounds.mean(axis=0), mesh.bounds[0] - cell
    dims = np.ceil((mesh.bounds[1] + cell - low) / cell).astype(np.int64) + 1
    thin = mesh.axes is not None and float(mesh.axes[:, 6].max(initial=0)) <= THIN * cell
    pieces = mesh.axes if thin and mesh.axes is not None else mesh.triangles
    longest = _longest_piece(mesh.axes, cell) if thin and mesh.axes is not None else cell
    for first in range(0, len(pieces), CHUNK):
        if thin:
            parts: Iterator[np.ndarray] = _axis_samples(pieces[first : first + CHUNK], middle, longest)
        else:
            parts = _samples((mesh.points[pieces[first : first + CHUNK]] - middle).astype(np.float32), cell)
        for part in parts:
            part = _kept(frame, part, mesh) if item.clipped else part
            rows.append(_by_cell(part, low - middle, dims, cell, summed=thin))
            yield 0.0
    return (yield from _merged(np.concatenate(rows), low - middle, dims, cell))


def _longest_piece(axes: np.ndarray, cell: float) -> float:
    """Return how long the pieces may be into which tubes are taken apart, in mm."""
    total = float(np.linalg.norm(axes[:, 3:6] - axes[:, :3], axis=1).sum())
    return max(cell, total / MAX_AXIS_SAMPLES)


def _axis_samples(axes: np.ndarray, middle: np.ndarray, cell: float) -> Iterator[np.ndarray]:
    """Take tubes, shape (n, 7), apart into pieces as long as cells at most: rows of all 13 sums."""
    begin, way, radius = axes[:, :3] - middle.astype(np.float32), axes[:, 3:6] - axes[:, :3], axes[:, 6]
    length = np.linalg.norm(way, axis=1)
    count = np.clip(np.ceil(length / cell), 1, MAX_SAMPLES).astype(np.int64)
    ends = np.cumsum(count)
    for first in range(0, int(ends[-1]), CHUNK_SAMPLES):
        sample = np.arange(first, min(first + CHUNK_SAMPLES, int(ends[-1])))
        tube = np.searchsorted(ends, sample, side="right")
        along = (sample - (ends[tube] - count[tube]) + 0.5) / count[tube]
        rows = np.zeros((len(sample), _COLUMNS), np.float32)
        rows[:, 0] = (2 * np.pi * _TUBE) * radius[tube] * length[tube] / count[tube]
        rows[:, 1:4] = (begin[tube] + along[:, None] * way[tube]) * rows[:, :1]
        x, y, z = way[tube].T / np.maximum(length[tube], 1e-30)
        half = rows[:, 0] / 2
        rows[:, 7:] = (
            np.stack([1 - x * x, 1 - y * y, 1 - z * z, -x * y, -x * z, -y * z], axis=1) * half[:, None]
        )
        yield rows[rows[:, 0] > 0]


def _samples(corners: np.ndarray, cell: float) -> Generator[np.ndarray, None, None]:
    """Take triangles, shape (n, 3, 3), apart into samples as large as cells at most: rows of (A, A p, A n)."""
    edges = corners[:, (1, 2, 0)] - corners
    # The third edge is the shortest, so that samples follow each other evenly along the longer ones.
    turn = (np.argmin((edges**2).sum(axis=2), axis=1)[:, None] + np.array([1, 2, 3])) % 3
    corners, edges = (np.take_along_axis(a, turn[:, :, None], axis=1) for a in (corners, edges))
    normal = 0.5 * np.cross(edges[:, 0], -edges[:, 2])
    area = np.linalg.norm(normal, axis=1)
    longest = np.sqrt((edges**2).sum(axis=2).max(axis=1))
    good = np.isfinite(area) & (area > 0)
    corners, edges, normal, area, longest = (a[good] for a in (corners, edges, normal, area, longest))
    if not len(area):
        return
    count = np.ceil(np.maximum(area / cell**2, longest / cell)).astype(np.int64)
    count = np.clip(np.where(count > 1, DENSER * count, 1), 1, MAX_SAMPLES)
    ends = np.cumsum(count)
    while count.sum() > MAX_SAMPLES:
        count = np.maximum(1, count // 2)
        ends = np.cumsum(count)
    for first in range(0, int(ends[-1]), CHUNK_SAMPLES):
        last = min(first + CHUNK_SAMPLES, int(ends[-1]))
        sample = np.arange(first, last)
        triangle = np.searchsorted(ends, sample, side="right")
        number = sample - (ends[triangle] - count[triangle])
        u, v = (number + 0.5) / count[triangle], (0.5 + number * 0.6180339887498949) % 1.0
        alone = count[triangle] == 1
        u, v = np.where(alone, 1 / 3, u), np.where(alone, 1 / 3, v)
        over = u + v > 1
        u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
        place = corners[triangle, 0] + u[:, None] * edges[triangle, 0] - v[:, None] * edges[triangle, 2]
        share = 1.0 / count[triangle]
        rows = np.empty((len(sample), 7), np.float32)
        rows[:, 0] = area[triangle] * share
        rows[:, 1:4] = place * rows[:, :1]
        rows[:, 4:7] = normal[triangle] * share[:, None]
        yield rows


def _kept(frame: Frame, rows: np.ndarray, mesh: Mesh) -> np.ndarray:
    """Leave out what clip planes and crop box cut away."""
    world = rows[:, 1:4] / rows[:, :1] + mesh.bounds.mean(axis=0)
    matrix, cuts = frame.volume.texture_from_world, kept_uniforms(frame)
    t = world @ matrix[:3, :3].T + matrix[:3, 3]
    kept = ((t >= cuts["u_low"]) & (t <= cuts["u_high"])).all(axis=1)
    for plane in cuts["u_clip"][: cuts["u_clips"]]:
        kept &= t @ plane[:3] + plane[3] >= 0
    return np.asarray(rows[kept])


def _cell_numbers(rows: np.ndarray, low: np.ndarray, dims: np.ndarray, cell: float) -> np.ndarray:
    """Return the number of the cell in which each row lies."""
    at = np.clip(np.floor((rows[:, 1:4] / rows[:, :1] - low) / cell).astype(np.int64), 0, dims - 1)
    return np.asarray((at[:, 2] * dims[1] + at[:, 1]) * dims[0] + at[:, 0])


def _begins(keys: np.ndarray) -> np.ndarray:
    return np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))


def _by_cell(rows: np.ndarray, low: np.ndarray, dims: np.ndarray, cell: float, *, summed: bool) -> np.ndarray:
    """Sum rows of samples (or of sums) that lie in one cell."""
    if not len(rows):
        return np.empty((0, _COLUMNS), np.float32)
    keys = _cell_numbers(rows, low, dims, cell)
    order = np.argsort(keys, kind="stable")
    rows, starts = np.take(rows, order, axis=0), _begins(keys[order])
    if not summed:
        n = rows[:, 4:7]
        x, y, z = n.T / np.maximum(rows[:, 0], 1e-30) ** 0.5
        rows = np.column_stack([rows, x * x, y * y, z * z, x * y, x * z, y * z])
    return np.add.reduceat(rows, starts, axis=0, dtype=np.float64).astype(np.float32)


def _merged(
    rows: np.ndarray, low: np.ndarray, dims: np.ndarray, cell: float
) -> Generator[float, None, np.ndarray]:
    """Sum rows of sums that lie in one cell, piece by piece: the window's thread is to have its turn."""
    if not len(rows):
        return np.empty((0, _COLUMNS), np.float32)
    keys = _cell_numbers(rows, low, dims, cell)
    order = np.argsort(keys)
    starts, merged = _begins(keys[order]), []
    yield 0.0
    ends = np.append(starts[1:], len(rows))
    first = 0
    while first < len(starts):
        last = max(first + 1, int(np.searchsorted(ends, starts[first] + CHUNK_SAMPLES, side="right")))
        begin, end = int(starts[first]), int(ends[last - 1])
        part = np.take(rows, order[begin:end], axis=0)
        merged.append(
            np.add.reduceat(part, starts[first:last] - begin, axis=0, dtype=np.float64).astype(np.float32)
        )
        first = last
        yield 0.0
    return np.concatenate(merged)


def _upload(frame: Frame, item: Shown, rows: np.ndarray, cell: float) -> Surfels:
    mesh = item.mesh
    data = np.concatenate([rows[:, 1:4] / np.maximum(rows[:, :1], 1e-30), rows[:, 4:]], axis=1)
    middle, edge = mesh.bounds.mean(axis=0), cell / CELL_TEXELS * BLOCK_TEXELS
    blocks = _distinct(np.floor(data[:, :3] / edge).astype(np.int64))
    with frame.device.checked(f"{len(data)} shadow casters"):
        buffer = frame.device.ctx.buffer(np.ascontiguousarray(data, np.float32) if len(data) else b"\0" * 48)
    return Surfels(buffer, len(data), middle, (blocks + 0.5) * edge + middle, edge / 2, _closed(item))


def _distinct(cells: np.ndarray) -> np.ndarray:
    """Return each row of integers, shape (n, 3), once."""
    if not len(cells):
        return cells
    low = cells.min(axis=0)
    dims = cells.max(axis=0) - low + 1
    at = cells - low
    keys = np.unique((at[:, 2] * dims[1] + at[:, 1]) * dims[0] + at[:, 0])
    places = np.stack([keys % dims[0], keys // dims[0] % dims[1], keys // (dims[0] * dims[1])], axis=1)
    return np.asarray(places + low)


def _closed(item: Shown) -> bool:
    """Tell whether a mesh's triangles all face outwards without a gap: each edge is there once in either direction."""
    if item.tubes or item.clipped:
        return item.tubes
    triangles = item.mesh.triangles.astype(np.int64)
    # Points at one place are one: files often repeat them for each triangle.
    _, same = np.unique(item.mesh.points, axis=0, return_inverse=True)
    triangles = same.ravel()[triangles]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    a, b = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    count = int(triangles.max(initial=0)) + 1
    there, back = np.sort(a * count + b), np.sort(b * count + a)
    if not (np.array_equal(there, back) and (np.diff(there) > 0).all()):
        return False
    p = item.mesh.points[item.mesh.triangles].astype(np.float64) - item.mesh.bounds.mean(axis=0)
    return bool(np.einsum("ni,ni->n", p[:, 0], np.cross(p[:, 1], p[:, 2])).sum() > 0)
