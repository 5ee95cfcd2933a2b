"""Vector fields to trace in: an array on a regular grid, a VTK file with vectors, or a sample's flow."""

from __future__ import annotations

import hashlib
import importlib
import mmap
import os
import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LoadError, SceneError
from ..io import guarded
from ..io import load as load_volume
from ..io.reading import Task, check_claim, need
from ..io.vtk import run
from ..scene.volume import Volume
from .cleaning import plural
from .directions import direction_file, read_directions

_XML = {"ImageData": "vtkXMLImageDataReader", "RectilinearGrid": "vtkXMLRectilinearGridReader"}
_LEGACY = {
    "STRUCTURED_POINTS": "vtkStructuredPointsReader",
    "RECTILINEAR_GRID": "vtkRectilinearGridReader",
    "STRUCTURED_GRID": "vtkStructuredGridReader",
    "UNSTRUCTURED_GRID": "vtkUnstructuredGridReader",
}
#: What a file with vectors says in its text, whether its numbers are text or not.
_SAYS_VECTORS = re.compile(
    rb"^(?:VECTORS|NORMALS)[ \t]|^\w+ 3 \d+ (?:float|double)|NumberOfComponents=[\"']3[\"']", re.MULTILINE
)
#: Name under which the vectors lie on the data set.
VECTORS = "vectors"
#: Name of the scalar that is the vectors' length.
SPEED = "speed"


@dataclass(frozen=True)
class VectorField:
    """Vectors on the points of a VTK data set, world mm LPS.

    Parameters
    ----------
    dataset : vtkDataSet
        With a point array `VECTORS` (float32, finite) and `SPEED`.
    path : str
        Where it was read from, or empty.
    key : str
        Hash of the vectors and the grid's bounds.
    notices : tuple of str
        What was done to it.
    axial : bool
        Whether they are directions without a sign (of tensors).
    """

    dataset: Any
    path: str = ""
    key: str = ""
    notices: tuple[str, ...] = field(default=())
    axial: bool = False

    @staticmethod
    def from_array(vectors: np.ndarray, grid: Volume, path: str = "") -> VectorField:
        """Build from an array on a volume's voxels.

        Parameters
        ----------
        vectors : ndarray, shape (z, y, x, 3)
            World components; NaN or masked entries are places without a value.
        grid : Volume
            Says where the voxels are.
        """
        array = np.ma.filled(np.ma.asarray(vectors, dtype=np.float32), np.nan)
        if array.shape != (*grid.data.shape, 3):
            raise SceneError(
                "vectors", f"array of shape {array.shape}", f"shape {(*grid.data.shape, 3)} is needed"
            )
        image = _module("vtkmodules.vtkCommonDataModel").vtkImageData()
        image.SetDimensions(*grid.dims)
        image.SetSpacing(*grid.spacing)
        image.SetOrigin(*(grid.origin or (0.0, 0.0, 0.0)))
        image.SetDirectionMatrix(*np.asarray(grid.direction, dtype=float).ravel())
        _attach(image, "value", grid.data.ravel())
        return _finished(image, array.reshape(-1, 3), path)

    @property
    def bounds(self) -> np.ndarray:
        """Smallest and largest coordinates in mm, shape (2, 3)."""
        return np.asarray(self.dataset.GetBounds()).reshape(3, 2).T


def _module(name: str) -> Any:
    return need(name, Task(Path("vectors")))


def load_field(path: str | os.PathLike[str], array: str = "") -> VectorField:
    """Read a vector field: VTI, VTR or legacy VTK with vectors, main directions in NIfTI, or ``sample:pipe``.

    Parameters
    ----------
    array : str
        Which array, where the file holds several with three components; of NIfTI: ``world`` if its components
        are along the world's axes (RAS) instead of the voxels'.

    Raises
    ------
    LoadError
        If the file cannot be read or holds no vectors.
    """
    text = os.fspath(path)
    if text.startswith("sample:"):
        volume = load_volume(text)
        vectors = importlib.import_module("sfumato_samples").load_vectors(text.partition(":")[2])
        return VectorField.from_array(vectors, volume, text)
    task = Task(Path(text))
    with guarded(task):
        if not task.path.is_file():
            raise task.error("there is no such file", "check the path")
        directions = direction_file(task.path)
        if directions is not None:
            vectors, grid, told = read_directions(directions, task, array)
            made = VectorField.from_array(vectors, grid, text)
            return replace(made, notices=(*told, *made.notices), axial=True)
        dataset = run(_reader(task), task)
        points, vectors, notices = _vectors(dataset, task, array)
        made = _finished(points, vectors, text)
        return VectorField(made.dataset, text, made.key, (*notices, *made.notices))


def has_vectors(path: str | os.PathLike[str]) -> bool:
    """Tell whether streamlines could be traced in a file, without reading all of it."""
    text = os.fspath(path)
    if text.startswith("sample:"):
        names = importlib.import_module("sfumato_samples").catalogue()
        return any(e.vectors and f"sample:{e.name}" == text for e in names)
    place = Path(text)
    if direction_file(place) is not None:
        return True
    if (
        place.suffix.lower() not in (".vti", ".vtr", ".vtk")
        or not place.is_file()
        or not place.stat().st_size
    ):
        return False
    with place.open("rb") as stream, mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data:
        return _SAYS_VECTORS.search(data) is not None


def _reader(task: Task) -> Any:
    with task.path.open("rb") as stream:
        head = stream.read(4096)
    xml = head.lstrip().startswith(b"<")
    pattern = rb"<VTKFile[^>]*\btype\s*=\s*[\"'](\w+)" if xml else rb"^\s*DATASET\s+(\w+)"
    found = re.search(pattern, head, re.MULTILINE | re.IGNORECASE)
    kind = found.group(1).decode() if found else ""
    table = _XML if xml else _LEGACY
    name = table.get(kind if xml else kind.upper())
    if name is None:
        raise task.error("it holds no vector field", "export it as image data with vectors (.vti)")
    counts = re.search(rb"^\s*DIMENSIONS\s+(\d+)\s+(\d+)\s+(\d+)", head, re.MULTILINE | re.IGNORECASE)
    if counts:
        claimed = int(counts.group(1)) * int(counts.group(2)) * int(counts.group(3))
        check_claim(task, claimed // 8, task.path.stat().st_size)
    return getattr(need("vtkmodules.vtkIOXML" if xml else "vtkmodules.vtkIOLegacy", task), name)()


def _vectors(dataset: Any, task: Task, wanted: str) -> tuple[Any, np.ndarray, list[str]]:
    """Return the data set, its vectors (on points), and what there is to tell."""
    support = need("vtkmodules.util.numpy_support", task)
    if not _names(dataset.GetPointData()) and _names(dataset.GetCellData()):
        convert = need("vtkmodules.vtkFiltersCore", task).vtkCellDataToPointData()
        convert.SetInputData(dataset)
        convert.Update()
        dataset = convert.GetOutput()
    attributes = dataset.GetPointData()
    names = _names(attributes)
    if wanted and wanted not in names:
        raise task.error(
            f"it has no vectors called {wanted!r}", "it has " + (", ".join(names) or "none at all")
        )
    if not names:
        raise task.error("it holds no vectors", "streamlines need an array with three components")
    active = attributes.GetVectors()
    name = wanted or (active.GetName() if active is not None and active.GetName() in names else names[0])
    others = [n for n in names if n != name]
    notices = [f"Traced is {name!r}; the file also holds {', '.join(others[:5])}."] if others else []
    return dataset, np.asarray(support.vtk_to_numpy(attributes.GetArray(name)), np.float32), notices


def _names(attributes: Any) -> list[str]:
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    return [str(a.GetName()) for a in arrays if a is not None and a.GetNumberOfComponents() == 3]


def _finished(dataset: Any, vectors: np.ndarray, path: str) -> VectorField:
    vectors = np.ascontiguousarray(vectors, np.float32)
    masked = ~np.isfinite(vectors).all(axis=1)
    notices: tuple[str, ...] = ()
    if masked.any():
        if masked.all():
            raise LoadError(path or "vectors", "all vectors are masked or NaN", "check the field")
        # Where there is nothing, there is no speed: a streamline ends.
        vectors = np.where(masked[:, None], np.float32(0), vectors)
        notices = (
            f"{plural(int(masked.sum()), 'vector')} of {len(vectors)} are masked or NaN: lines end there.",
        )
    _attach(dataset, VECTORS, vectors)
    _attach(dataset, SPEED, np.linalg.norm(vectors, axis=1).astype(np.float32))
    dataset.GetPointData().SetActiveVectors(VECTORS)
    digest = hashlib.blake2b(repr(dataset.GetBounds()).encode(), digest_size=16)
    digest.update(vectors.data)
    return VectorField(dataset, path, digest.hexdigest(), notices)


def _attach(dataset: Any, name: str, values: np.ndarray) -> None:
    support = _module("vtkmodules.util.numpy_support")
    array = support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    dataset.GetPointData().AddArray(array)
