"""Geometry of a scene: tracts, streamlines and surfaces, where they come from and how they are shown.

`Geometry` holds the shape as it was read or traced; its other fields say how the mesh that is drawn is made
of it (`sfumato.geometry.mesh_of`). In JSON a shape is named by path and content hash, by how it was traced,
or, where it exists nowhere else, written out.
"""

from __future__ import annotations

import base64
import binascii
import dataclasses
import hashlib
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from ..errors import SceneError
from .params import Param, check, fields_of, from_json, to_json
from .shapes import Lines, Mesh, Surface
from .tracing import Seeds, Tracing

__all__ = ["Geometry", "Lines", "Mesh", "Roi", "Seeds", "Surface", "Tracing", "suggest_radius"]

Shape = Lines | Surface
Vec3 = tuple[float, float, float]

#: Shapes that exist in memory alone are written into the JSON up to this many bytes.
MAX_INLINE_BYTES = 8 << 20
_LENGTH = dict(unit="mm", ge=0, tab="view", level="more")


@dataclass(frozen=True)
class Roi:
    """A region that lines must touch, or must not.

    Parameters
    ----------
    kind : str
        ``sphere`` (``center``, ``size[0]`` as its radius) or ``box`` (``center``, half edges ``size``).
    keep : str
        ``inside``: lines that pass through stay; ``outside``: those go; ``ends``: lines that begin or end
        inside stay.
    """

    kind: Annotated[str, Param("Shape of the region", choices=("sphere", "box"))] = "sphere"
    center: Annotated[Vec3, Param("Middle, world space", unit="mm")] = (0.0, 0.0, 0.0)
    size: Annotated[Vec3, Param("Radius, or half edges of the box", unit="mm", gt=0)] = (10.0, 10.0, 10.0)
    keep: Annotated[str, Param("Which lines stay", choices=("inside", "outside", "ends"))] = "inside"

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Geometry:
    """Tracts, streamlines or a surface, and how they are shown.

    Parameters
    ----------
    shape : Lines or Surface
        As it was read or traced, world mm LPS.
    path : str
        The file it was read from, or empty.
    tracing : Tracing, optional
        How it was traced. To trace anew, use `sfumato.trace`.
    kind : str
        ``tracts``, ``streamlines`` or ``surface``; chosen by the shape if not given.
    name : str
        For lists.
    notices : tuple of str
        What the reader had to decide or leave out, with counts, one sentence each.
    radius : float
        In mm; 0 is replaced by one that suits the shape's size and number of lines.

    Raises
    ------
    SceneError
        With the field, the value and what is allowed.
    """

    shape: Lines | Surface
    path: str = ""
    tracing: Tracing | None = None
    kind: Annotated[str, Param("What it is", choices=("", "tracts", "streamlines", "surface"))] = ""
    space: Annotated[
        str, Param("Space of a file that does not name it; empty: LPS", choices=("", "LPS", "RAS"))
    ] = ""
    name: str = field(default="", compare=False)
    notices: tuple[str, ...] = field(default=(), compare=False)
    visible: Annotated[bool, Param("Whether it is drawn", label="Visible", tab="view")] = True
    clipped: Annotated[
        bool, Param("Whether clip planes and crop box cut it", label="Clipped", tab="view", level="more")
    ] = True
    radius: Annotated[
        float,
        Param("Radius of the tubes", label="Radius", unit="mm", ge=0, le=1000, soft=(0.05, 3), tab="view"),
    ] = 0.0
    radius_by: Annotated[
        str, Param("Scalar that thins the tubes where it is low; empty: one radius", label="Radius by")
    ] = ""
    thinnest: Annotated[
        float, Param("Radius at the scalar's lower end, as a part of the full one", ge=0.01, le=1)
    ] = 0.25
    sides: Annotated[int, Param("Sides of a tube; 0: by the number of lines", label="Sides", ge=0, le=64)] = 0
    smoothing: Annotated[
        int,
        Param(
            "Points a segment along the B-spline that smooths the lines; 0: as they are",
            label="Smoothing",
            ge=0,
            le=8,
            tab="view",
            level="more",
        ),
    ] = 0
    color_by: Annotated[
        str,
        Param(
            "One colour, the colours in the file, by direction (red left-right, green front-back, blue up-down), "
            "or by a scalar",
            label="Colour by",
            choices=("color", "file", "direction", "scalar"),
            tab="view",
        ),
    ] = "color"
    color: Annotated[Vec3, Param("Colour, linear RGB", label="Colour", ge=0, le=1)] = (0.8, 0.45, 0.2)
    scalar: Annotated[str, Param("Scalar that colours it", label="Scalar")] = ""
    colormap: Annotated[str, Param("Colour map of the scalar", label="Colour map")] = "viridis"
    scalar_range: tuple[float, float] | None = None
    min_length: Annotated[float, Param("Shorter lines are left out", label="Shortest", **_LENGTH)] = 0.0
    max_length: Annotated[
        float, Param("Longer lines are left out; 0: no limit", label="Longest", **_LENGTH)
    ] = 0.0
    fraction: Annotated[
        float,
        Param(
            "Part of the lines that is shown, at random",
            label="Part shown",
            gt=0,
            le=1,
            tab="view",
            level="more",
        ),
    ] = 1.0
    seed: Annotated[int, Param("Which random part", ge=0, le=2**31 - 1)] = 0
    rois: tuple[Roi, ...] = ()

    def __post_init__(self) -> None:
        check(self)
        lines = isinstance(self.shape, Lines)
        if not self.kind:
            object.__setattr__(self, "kind", _kind(self))
        if lines == (self.kind == "surface"):
            raise SceneError("kind", self.kind, "lines are tracts or streamlines, triangles are a surface")
        if self.radius == 0:
            object.__setattr__(self, "radius", suggest_radius(self.shape))
        self._check_scalars()

    def _check_scalars(self) -> None:
        names = self.scalar_names
        known = "one of " + ", ".join(names) if names else "this geometry has no scalars"
        for name in ("scalar", "radius_by"):
            if getattr(self, name) and getattr(self, name) not in names:
                raise SceneError(name, getattr(self, name), known)
        if self.color_by == "scalar" and not self.scalar:
            if not names:
                raise SceneError("color_by", "scalar", known)
            object.__setattr__(self, "scalar", names[0])
        if self.color_by == "file" and getattr(self.shape, "colors", None) is None:
            raise SceneError("color_by", "file", "the file has no colours")
        if self.scalar_range is not None and not self.scalar_range[0] < self.scalar_range[1]:
            raise SceneError("scalar_range", self.scalar_range, "the lower end first, the higher last")

    # -- what others ask ----------------------------------------------------------------------------
    @property
    def key(self) -> str:
        """Hash of the shape and of all that says how it is shown."""
        digest = hashlib.blake2b(digest_size=16)
        shown = {f.name: to_json(getattr(self, f.name)) for f in dataclasses.fields(self) if f.compare}
        shown["shape"] = self.shape.key
        digest.update(repr(shown).encode())
        return digest.hexdigest()

    @property
    def mesh_key(self) -> str:
        """Key of what `mesh_of` makes: not changed by what only the drawing heeds (visible, clipped)."""
        return dataclasses.replace(self, visible=True, clipped=True, path="", tracing=None).key

    @property
    def scalar_names(self) -> tuple[str, ...]:
        """Names of the scalars at its points."""
        return tuple(name for name, _ in self.shape.scalars)

    def scalar_values(self, name: str) -> np.ndarray:
        """Return a scalar's values at the shape's points."""
        return dict(self.shape.scalars)[name]

    def color_range(self) -> tuple[float, float]:
        """Return the values at both ends of the colour map: ``scalar_range``, or all of the scalar's."""
        if self.scalar_range is not None:
            return self.scalar_range
        return value_range(self.scalar_values(self.scalar))

    @property
    def bounds(self) -> np.ndarray:
        """Smallest and largest coordinates of the shape in mm, shape (2, 3)."""
        return self.shape.bounds

    def __repr__(self) -> str:
        return f"<Geometry {self.name or self.kind} {self.shape!r}>"

    # -- JSON ---------------------------------------------------------------------------------------
    def to_json(self) -> dict[str, Any]:
        """Return JSON data: where the shape comes from, and how it is shown."""
        data = {
            f.name: to_json(getattr(self, f.name))
            for f in dataclasses.fields(self)
            if f.name not in ("shape", "notices")
        }
        data["hash"] = self.shape.key
        if not self.path and self.tracing is None and self.shape.nbytes <= MAX_INLINE_BYTES:
            data["shape"] = _written_out(self.shape)
        return data

    @staticmethod
    def from_json(data: Any, shape: Shape | None = None, notices: tuple[str, ...] = ()) -> Geometry:
        """Build from JSON data, and the shape if the data only names it.

        Raises
        ------
        SceneError
            If a field is unknown, its value is not allowed, or there is no shape.
        """
        if not isinstance(data, dict):
            raise SceneError("geometry", data, "an object is needed here")
        known = fields_of(Geometry)
        values: dict[str, Any] = {"notices": notices}
        for name, value in data.items():
            if name in ("hash", "shape", "notices"):
                continue
            if name not in known:
                raise SceneError(name, value, "unknown field; known: " + ", ".join(known))
            values[name] = _field_from_json(name, value)
        if shape is None:
            shape = _read_back(data.get("shape"))
        return Geometry(shape, **values)


def _field_from_json(name: str, value: Any) -> Any:
    if name == "tracing" and value is not None:
        return from_json(Tracing, value, "tracing")
    if name == "rois":
        if not isinstance(value, list):
            raise SceneError("rois", value, "a list is needed here")
        return tuple(from_json(Roi, v, f"rois.{i}") for i, v in enumerate(value))
    return value


def _kind(geometry: Geometry) -> str:
    if isinstance(geometry.shape, Surface):
        return "surface"
    return "streamlines" if geometry.tracing is not None else "tracts"


def suggest_radius(shape: Shape) -> float:
    """Return a tube radius in mm: 1 % of the diagonal for one line, less the more lines there are."""
    diagonal = float(np.linalg.norm(shape.bounds[1] - shape.bounds[0]))
    count = shape.count if isinstance(shape, Lines) else 1
    return float(f"{min(max(0.01 * diagonal / count**0.2, 1e-6), 1000):.3g}")


def value_range(values: np.ndarray) -> tuple[float, float]:
    """Return the smallest and largest finite value, a little apart where they are one."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return 0.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    return (low, high) if high > low else (low, low + max(abs(low) * 1e-3, 1e-6))


# -- shapes written out ------------------------------------------------------------------------------
def _written_out(shape: Shape) -> dict[str, Any]:
    arrays = {"points": shape.points}
    if isinstance(shape, Lines):
        arrays["offsets"] = shape.offsets
    else:
        arrays["triangles"] = shape.triangles
        arrays |= {n: a for n, a in (("normals", shape.normals), ("colors", shape.colors)) if a is not None}
    coded: dict[str, Any] = {name: _coded(array) for name, array in arrays.items()}
    coded["scalars"] = [[name, _coded(values)] for name, values in shape.scalars]
    return coded


def _coded(array: np.ndarray) -> list[Any]:
    little = array.astype(array.dtype.newbyteorder("<"))
    return [little.dtype.str, list(array.shape), base64.b64encode(zlib.compress(little.tobytes())).decode()]


def _array(value: Any) -> np.ndarray:
    kind, shape, text = value
    dtype = np.dtype(kind)
    size = int(np.prod(shape)) * dtype.itemsize
    if dtype.kind not in "uif" or not 0 <= size <= MAX_INLINE_BYTES:
        raise ValueError("too large")
    unpacked = zlib.decompressobj().decompress(base64.b64decode(text, validate=True), size)
    return np.frombuffer(unpacked, dtype).reshape(shape)


def _read_back(data: Any) -> Shape:
    if not isinstance(data, dict):
        raise SceneError("shape", data, "the scene does not hold this geometry; open its file first")
    try:
        arrays = {name: _array(value) for name, value in data.items() if name != "scalars"}
        scalars = tuple((str(name), _array(value)) for name, value in data.get("scalars", []))
        made = Lines if "offsets" in arrays else Surface
        return made(**arrays, scalars=scalars)
    except (TypeError, ValueError, KeyError, zlib.error, binascii.Error):
        raise SceneError(
            "shape", "arrays", "points with offsets, or with triangles, are needed here"
        ) from None


def with_paths(data: Any, change: Callable[[str], str]) -> Any:
    """Return a geometry's JSON data in which each path of a file is changed: its own, its field's, its seeds'."""
    if not isinstance(data, dict):
        return data
    data = dict(data)
    if isinstance(data.get("path"), str) and data["path"]:
        data["path"] = change(data["path"])
    for name in ("tracing", "seeds"):
        if name in data:
            data[name] = with_paths(data[name], change)
    return data
