"""VTK poly data and surface meshes: VTP, legacy VTK, STL, PLY, OBJ."""

from __future__ import annotations

import mmap
import re
from typing import Any

import numpy as np

from ..io.reading import Task, check_claim, need
from ..io.vtk import run
from .cleaning import RawLines, RawSurface, to_lps
from .color import linear

#: Facets that meet at a sharper angle keep their edge; below, they are shaded as one round surface.
EDGE_DEGREES = 40.0
_READERS = {
    ".vtp": ("vtkmodules.vtkIOXML", "vtkXMLPolyDataReader"),
    ".vtk": ("vtkmodules.vtkIOLegacy", "vtkPolyDataReader"),
    ".stl": ("vtkmodules.vtkIOGeometry", "vtkSTLReader"),
    ".ply": ("vtkmodules.vtkIOPLY", "vtkPLYReader"),
    ".obj": ("vtkmodules.vtkIOGeometry", "vtkOBJReader"),
}
#: What a text announces: pattern of the counts, and the fewest bytes that one takes in the file.
_CLAIMS = {
    ".vtk": (rb"^(?:POINTS|LINES|POLYGONS|VERTICES|TRIANGLE_STRIPS)[ \t]+(\d+)", 2),
    ".ply": (rb"^element[ \t]+\w+[ \t]+(\d+)", 1),
}


def read(task: Task) -> RawLines | RawSurface:
    """Read poly data; lines win where a file has lines and polygons."""
    suffix = task.path.suffix.lower()
    _check_claims(task, suffix)
    module, name = _READERS[suffix]
    poly = run(getattr(need(module, task), name)(), task)
    task.step(0.4, "Reading")
    space = _space(task, poly)
    if poly.GetNumberOfLines():
        return _lines(poly, task, space)
    if poly.GetNumberOfPolys() or poly.GetNumberOfStrips():
        return _surface(poly, task, space)
    raise task.error("it holds points, but no lines or polygons", "export lines or a surface")


def _check_claims(task: Task, suffix: str) -> None:
    """Refuse counts that the file cannot hold: VTK would take memory for them before it reads."""
    if suffix not in _CLAIMS:
        return
    pattern, least = _CLAIMS[suffix]
    size = task.path.stat().st_size
    if not size:
        raise task.error("it is empty", "copy or export it again")
    with task.path.open("rb") as stream, mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data:
        for found in re.finditer(pattern, data, re.MULTILINE):
            check_claim(task, int(found.group(1)) * least, size)


def _space(task: Task, poly: Any) -> str:
    """Return the space that the file names as 3D Slicer does, or nothing."""
    field = poly.GetFieldData().GetAbstractArray("SPACE")
    if field is not None and field.GetNumberOfValues():
        return str(field.GetValue(0)).upper()[:3]
    with task.path.open("rb") as stream:
        head = stream.read(1024)
    named = re.search(rb"SPACE=(LPS|RAS)", head)
    return named.group(1).decode() if named else ""


def _array(vtk_array: Any, task: Task) -> np.ndarray:
    support = need("vtkmodules.util.numpy_support", task)
    return np.asarray(support.vtk_to_numpy(vtk_array))


def _points(poly: Any, task: Task, space: str) -> np.ndarray:
    points = _array(poly.GetPoints().GetData(), task).astype(np.float32)
    return to_lps(points) if space == "RAS" else points


def _values(attributes: Any, task: Task, rows: slice = slice(None)) -> dict[str, np.ndarray]:
    found = {}
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetArray(i)
        if array is not None and array is not attributes.GetNormals():
            found[attributes.GetArrayName(i) or f"values {i + 1}"] = _array(array, task)[rows]
    return found


# -- lines -----------------------------------------------------------------------------------------
def _lines(poly: Any, task: Task, space: str) -> RawLines:
    cells = poly.GetLines()
    connectivity = _array(cells.GetConnectivityArray(), task).astype(np.int64)
    offsets = _array(cells.GetOffsetsArray(), task).astype(np.int64)
    points = _points(poly, task, space)
    if len(connectivity) and not 0 <= int(connectivity.min()) <= int(connectivity.max()) < len(points):
        raise task.error("its lines name points that it does not have", "it is damaged: export it again")
    lengths = np.diff(offsets)
    # Cells are numbered vertices first, then lines, then polygons.
    first = poly.GetNumberOfVerts()
    raw = RawLines(
        points[connectivity],
        lengths,
        {name: values[connectivity] for name, values in _values(poly.GetPointData(), task).items()},
        _values(poly.GetCellData(), task, slice(first, first + len(lengths))),
        space=space,
    )
    others = poly.GetNumberOfPolys() + poly.GetNumberOfStrips()
    if others:
        raw.notices.append(f"Shown are its lines; its {others} polygons are left out.")
    return raw


# -- surfaces --------------------------------------------------------------------------------------
def _surface(poly: Any, task: Task, space: str) -> RawSurface:
    poly = _triangulated(poly, task)
    task.step(0.6, "Shading")
    if poly.GetPointData().GetNormals() is None:
        poly = _with_normals(poly, task)
    count = poly.GetNumberOfPolys()
    connectivity = _array(poly.GetPolys().GetConnectivityArray(), task)
    points = _points(poly, task, space)
    if (
        not count
        or len(connectivity) != 3 * count
        or not 0 <= connectivity.min() <= connectivity.max() < len(points)
    ):
        raise task.error("its polygons name points that it does not have", "it is damaged: export it again")
    normals = poly.GetPointData().GetNormals()
    values = _values(poly.GetPointData(), task)
    colors = _colors(values)
    made = _array(normals, task).astype(np.float32) if normals is not None else None
    if made is not None and space == "RAS":
        made = to_lps(made)
    return RawSurface(points, connectivity.reshape(-1, 3).astype(np.int64), made, values, colors, space=space)


def _triangulated(poly: Any, task: Task) -> Any:
    triangles = need("vtkmodules.vtkFiltersCore", task).vtkTriangleFilter()
    triangles.SetInputData(poly)
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.Update()
    return triangles.GetOutput()


def _with_normals(poly: Any, task: Task) -> Any:
    """Return the surface with normals of its own: facets turned to one side, outwards if it is closed."""
    normals = need("vtkmodules.vtkFiltersCore", task).vtkPolyDataNormals()
    normals.SetInputData(poly)
    normals.SetFeatureAngle(EDGE_DEGREES)
    normals.ConsistencyOn()
    normals.AutoOrientNormalsOn()
    normals.Update()
    return normals.GetOutput()


def _colors(values: dict[str, np.ndarray]) -> np.ndarray | None:
    """Take the file's own colours (8-bit sRGB, as PLY has them) out of its values, as linear RGB."""
    for name, array in values.items():
        if array.dtype == np.uint8 and array.ndim == 2 and array.shape[1] in (3, 4):
            del values[name]
            return linear(array[:, :3] / 255.0).astype(np.float32)
    return None
