"""Shapes in world space: lines and surfaces as they were read or traced, and the mesh that is drawn.

All are read-only arrays, known by the hash of their content; millimetres, LPS. Nothing here needs VTK.
"""

from __future__ import annotations

import functools
import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import SceneError

Scalars = tuple[tuple[str, np.ndarray], ...]


class _Keyed:
    """Compared and hashed by the content of its arrays."""

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        raise NotImplementedError

    @functools.cached_property
    def key(self) -> str:
        """Hash of the content: the same shape has the same key, wherever it came from."""
        digest = hashlib.blake2b(type(self).__name__.encode(), digest_size=16)
        for name, _ in getattr(self, "scalars", ()):
            digest.update(name.encode() + b"\0")
        for array in self.arrays:
            digest.update(repr((array.shape, array.dtype.str)).encode())
            digest.update(array.data)
        return digest.hexdigest()

    @property
    def nbytes(self) -> int:
        """Bytes of all its arrays."""
        return sum(array.nbytes for array in self.arrays)

    def __eq__(self, other: object) -> bool:
        return self is other or (type(other) is type(self) and self.key == other.key)

    def __hash__(self) -> int:
        return hash(self.key)


def _bounds(points: np.ndarray) -> np.ndarray:
    return np.array([points.min(axis=0), points.max(axis=0)], dtype=np.float64)


@dataclass(frozen=True, eq=False)
class Lines(_Keyed):
    """Polylines: fibre tracts or streamlines.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        All lines' points one after the other, world mm LPS; kept as float32.
    offsets : ndarray, shape (k + 1,)
        Where each line begins in ``points``, and the end of the last; each has at least two points.
    scalars : sequence of (name, ndarray of shape (n,))
        Values at the points (a line's own value is repeated on them), float32.

    Raises
    ------
    SceneError
        If the arrays do not fit together, a point is not finite or there is no line.
    """

    points: np.ndarray
    offsets: np.ndarray
    scalars: Scalars = ()

    def __post_init__(self) -> None:
        points = frozen(self.points, np.float32, "geometry.points", 3)
        offsets = frozen(self.offsets, np.int64, "geometry.offsets")
        if len(offsets) < 2 or offsets[0] != 0 or offsets[-1] != len(points):
            raise SceneError(
                "geometry.offsets", f"{len(offsets)} offsets", "0 first, the number of points last"
            )
        if (np.diff(offsets) < 2).any():
            raise SceneError("geometry.offsets", "a line of one point", "each line needs at least two")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "offsets", offsets)
        object.__setattr__(self, "scalars", _scalars(self.scalars, len(points)))

    @staticmethod
    def of(lines: Any, scalars: Any = ()) -> Lines:
        """Build from a list of arrays of shape (points, 3), world mm.

        Parameters
        ----------
        scalars : sequence of (name, list of arrays of shape (points,))
            One array a line.
        """
        parts = [np.asarray(line, dtype=np.float32).reshape(-1, 3) for line in lines]
        if not parts:
            raise SceneError("geometry", "no lines", "at least one line is needed")
        offsets = np.concatenate([[0], np.cumsum([len(p) for p in parts])])
        joined = tuple((str(name), np.concatenate(list(values))) for name, values in scalars)
        return Lines(np.concatenate(parts), offsets, joined)

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """Everything that makes its content."""
        return (self.points, self.offsets, *(values for _, values in self.scalars))

    @property
    def count(self) -> int:
        """Number of lines."""
        return len(self.offsets) - 1

    @functools.cached_property
    def bounds(self) -> np.ndarray:
        """Smallest and largest coordinates in mm, shape (2, 3)."""
        return _bounds(self.points)

    @functools.cached_property
    def lengths(self) -> np.ndarray:
        """Length of each line in mm, shape (k,)."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps, dtype=np.float64)])
        first, last = self.offsets[:-1], self.offsets[1:] - 1
        return np.asarray(along[last] - along[first])

    @functools.cached_property
    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """Smallest and largest coordinates of each line in mm, each of shape (k, 3)."""
        first = self.offsets[:-1]
        return np.minimum.reduceat(self.points, first), np.maximum.reduceat(self.points, first)

    def __repr__(self) -> str:
        return f"<Lines {self.count} with {len(self.points)} points>"


@dataclass(frozen=True, eq=False)
class Surface(_Keyed):
    """A triangle mesh as it was read.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        World mm LPS; kept as float32.
    triangles : ndarray, shape (m, 3)
        Indices of points, counter-clockwise seen from outside.
    normals : ndarray, shape (n, 3), optional
        Unit normals; without them they are made from the triangles.
    scalars : sequence of (name, ndarray of shape (n,))
        Values at the points.
    colors : ndarray, shape (n, 3), optional
        The file's own colours, linear RGB.

    Raises
    ------
    SceneError
        If the arrays do not fit together, a point is not finite or there is no triangle.
    """

    points: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray | None = None
    scalars: Scalars = ()
    colors: np.ndarray | None = None

    def __post_init__(self) -> None:
        points = frozen(self.points, np.float32, "geometry.points", 3)
        triangles = _triangles(self.triangles, len(points))
        normals = self.normals if self.normals is not None else vertex_normals(points, triangles)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "triangles", triangles)
        object.__setattr__(self, "normals", frozen(normals, np.float32, "geometry.normals", 3, len(points)))
        if self.colors is not None:
            colors = frozen(self.colors, np.float32, "geometry.colors", 3, len(points))
            object.__setattr__(self, "colors", colors)
        object.__setattr__(self, "scalars", _scalars(self.scalars, len(points)))

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """Everything that makes its content."""
        own = [a for a in (self.normals, self.colors) if a is not None]
        return (self.points, self.triangles, *own, *(values for _, values in self.scalars))

    @property
    def count(self) -> int:
        """Number of triangles."""
        return len(self.triangles)

    @functools.cached_property
    def bounds(self) -> np.ndarray:
        """Smallest and largest coordinates in mm, shape (2, 3)."""
        return _bounds(self.points)

    def __repr__(self) -> str:
        return f"<Surface {self.count} triangles>"


@dataclass(frozen=True, eq=False)
class Mesh(_Keyed):
    """What is drawn: opaque triangles with normals and colours, ready for the graphics card.

    Parameters
    ----------
    points : ndarray, shape (n, 3), float32
        World mm LPS.
    normals : ndarray, shape (n, 3), float32
        Unit normals, outwards.
    triangles : ndarray, shape (m, 3), uint32
        Indices of points, counter-clockwise seen from outside; m may be 0 when every line is filtered away.
    colors : ndarray, shape (n, 3), float32
        Linear RGB.
    axes : ndarray, shape (k, 7), float32, optional
        Of tubes: begin, end and radius in mm of each straight piece.
    coarse : Mesh, optional
        The same with fewer triangles, for pictures while something moves; none if there are few as it is.
    shown : int
        Of tubes: how many lines there are; less than the filters leave if the budget has no room for more.
    """

    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    colors: np.ndarray
    axes: np.ndarray | None = None
    coarse: Mesh | None = None
    shown: int = 0

    def __post_init__(self) -> None:
        count = len(self.points)
        if self.axes is not None:
            object.__setattr__(self, "axes", frozen(self.axes, np.float32, "mesh.axes", 7, finite=False))
        for name in ("points", "normals", "colors"):
            array = frozen(getattr(self, name), np.float32, f"mesh.{name}", 3, count, finite=False)
            object.__setattr__(self, name, array)
        triangles = frozen(self.triangles, np.uint32, "mesh.triangles", 3, finite=False)
        object.__setattr__(self, "triangles", triangles)

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """Everything that makes its content."""
        more = self.coarse.arrays if self.coarse is not None else ()
        axes = (self.axes,) if self.axes is not None else ()
        return (self.points, self.normals, self.triangles, self.colors, *axes, *more)

    @functools.cached_property
    def bounds(self) -> np.ndarray:
        """Smallest and largest coordinates in mm, shape (2, 3); zeros where there is nothing."""
        return _bounds(self.points) if len(self.points) else np.zeros((2, 3))

    def __repr__(self) -> str:
        return f"<Mesh {len(self.triangles)} triangles, {len(self.points)} points>"


# -- checks ----------------------------------------------------------------------------------------
def frozen(
    value: Any, dtype: Any, path: str, columns: int = 0, rows: int | None = None, *, finite: bool = True
) -> np.ndarray:
    """Return an array of the wanted type that nobody can write to; checked for shape and finite numbers."""
    array = np.asarray(value)
    shape = (len(array) if rows is None else rows, columns) if columns else (len(array),)
    if array.shape != shape or array.dtype.kind not in "uif":
        raise SceneError(path, f"array of shape {array.shape}", f"a numeric array of shape {shape} is needed")
    if finite and array.dtype.kind == "f" and not np.isfinite(array).all():
        raise SceneError(path, "NaN or infinite", "finite numbers are needed")
    made = np.ascontiguousarray(array, dtype=dtype)
    if made.flags.writeable:
        made = made.copy() if made is value or made.base is not None else made
        made.flags.writeable = False
    return made


def _scalars(scalars: Any, count: int) -> Scalars:
    # NaN marks points without a value; they are drawn in the colour of missing values.
    return tuple(
        (str(name), frozen(values, np.float32, f"geometry.{name}", rows=count, finite=False))
        if np.shape(values) == (count,)
        else _refuse(name, values, count)
        for name, values in scalars
    )


def _refuse(name: str, values: Any, count: int) -> tuple[str, np.ndarray]:
    raise SceneError(
        f"geometry.{name}", f"array of shape {np.shape(values)}", f"one value for each of {count} points"
    )


def _triangles(value: Any, points: int) -> np.ndarray:
    array = np.asarray(value)
    if array.dtype.kind not in "ui" or array.ndim != 2 or array.shape[1:] != (3,) or not len(array):
        raise SceneError(
            "geometry.triangles", f"array of shape {array.shape}", "indices of shape (m, 3), m > 0"
        )
    if int(array.min()) < 0 or int(array.max()) >= points:
        raise SceneError("geometry.triangles", int(array.max()), f"indices from 0 to {points - 1}")
    return frozen(array, np.uint32, "geometry.triangles", 3)


def vertex_normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return unit normals at the points: the mean of their triangles' normals, weighted by area."""
    corners = points[triangles].astype(np.float64)
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    summed = np.zeros((len(points), 3))
    for axis in range(3):
        summed[:, axis] = np.bincount(
            triangles.ravel(), weights=np.repeat(faces[:, axis], 3), minlength=len(points)
        )
    length = np.linalg.norm(summed, axis=1, keepdims=True)
    flat = length[:, 0] == 0
    summed[flat], length[flat] = (0.0, 0.0, 1.0), 1.0
    return np.asarray(summed / length, dtype=np.float32)
