"""Level of detail by count: how many sides and points tubes get, so that a budget of triangles holds.

Tubes get fewer sides, then their axes fewer points where they bend least, and if that is not enough, lines
are left out evenly: displaced by more than a few radii they would no longer be where the file has them.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from ..scene.shapes import Mesh, vertex_normals
from .polyline import Strand, thinned_out

MOST_SIDES, FEWEST_SIDES = 12, 3
#: How far, in radii, a tube's axis may leave its line for the sake of fewer points: nothing that is seen.
TOLERANCE = 0.05
#: The same, and the sides of the tubes, when there are too many points for a budget: one after the other.
COARSER = ((0.5, 4), (1.0, 3), (2.0, 3), (4.0, 3))
#: How far values may bend between points, as a part of their range, for each radius of tolerance.
BEND = 0.02
_GOLDEN = 0.6180339887498949


def triangles_of(parts: list[Strand], sides: int) -> int:
    """Return how many triangles tubes about these lines have, their ends included."""
    points = sum(len(p.points) for p in parts)
    lines = sum(len(p.points) - int(p.joined.sum()) for p in parts)
    return 2 * sides * (points - lines) + 2 * lines * (sides - 2)


def automatic_sides(parts: list[Strand], budget: int) -> int:
    """Return how many sides tubes get: 12, or fewer to stay in a budget."""
    sides = MOST_SIDES
    while sides > FEWEST_SIDES and triangles_of(parts, sides) > budget:
        sides -= 1
    return sides


def fitted(parts: list[Strand], radius: float, budget: int) -> Generator[float, None, list[Strand]]:
    """Thin lines out further if they take more than a budget; yields the share done.

    Parameters
    ----------
    radius : float
        Of the tubes in mm.
    budget : int
        Triangles.
    """
    for k, (tolerance, sides) in enumerate(COARSER):
        if triangles_of(parts, sides) <= budget:
            return parts
        coarser = []
        for i, part in enumerate(parts):
            coarser.append(thinned_out(part, tolerance * radius, bend=max(0.01, BEND * tolerance)))
            yield (k + (i + 1) / len(parts)) / len(COARSER)
        parts = coarser
    share = budget / max(triangles_of(parts, FEWEST_SIDES), 1)
    return parts if share >= 1 else [p for p in (_some_lines(p, share) for p in parts) if len(p.points)]


def _some_lines(strand: Strand, share: float) -> Strand:
    """Leave out lines evenly: a larger share holds all lines of a smaller one."""
    lines, number = np.unique(strand.line, return_inverse=True)
    rank = (lines * _GOLDEN) % 1.0
    return strand.taken((rank <= np.quantile(rank, share))[number])


def clustered(mesh: Mesh, budget: int) -> Mesh:
    """Return a mesh of about so many triangles: the points of each cell of space become their mean."""
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    # A flat piece of a cell's size has two triangles; a bent one lies in more cells.
    cell = max((3 * area / budget) ** 0.5, 1e-9)
    at = np.floor((mesh.points - mesh.bounds[0]) / cell).astype(np.int64)
    dims = at.max(axis=0) + 1
    _, number = np.unique((at[:, 2] * dims[1] + at[:, 1]) * dims[0] + at[:, 0], return_inverse=True)
    count = np.bincount(number)
    points, colors = (
        np.stack([np.bincount(number, weights=values[:, k]) / count for k in range(3)], axis=1).astype(
            np.float32
        )
        for values in (mesh.points, mesh.colors)
    )
    triangles = number[mesh.triangles]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)].astype(np.uint32)
    return Mesh(points, vertex_normals(points, triangles), triangles, colors)
