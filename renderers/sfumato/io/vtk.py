"""VTK: image data (.vti), legacy structured points, rectilinear grids; scalars, or the length of vectors."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np

from .reading import Reading, Source, Task, check_claim, check_memory, need
from .voxels import component_notice, one_value

_XML = {"ImageData": "vtkXMLImageDataReader", "RectilinearGrid": "vtkXMLRectilinearGridReader"}
_LEGACY = {"STRUCTURED_POINTS": "vtkStructuredPointsReader", "RECTILINEAR_GRID": "vtkRectilinearGridReader"}
#: One coordinate may differ by this part of a step before a rectilinear grid counts as uneven.
_EVEN = 1e-3


def read(task: Task) -> Reading:
    """Read a VTK file with voxels; poly data and unstructured grids are no volumes."""
    with task.path.open("rb") as stream:
        head = stream.read(4096)
    reader = _xml_reader(head, task) if head.lstrip().startswith(b"<") else _legacy_reader(head, task)
    grid = run(reader, task, _check_extent)
    if re.match(rb"# vtk[^\n]*\n[^\n]*\n\s*ASCII", head, re.IGNORECASE):
        _check_words(grid, task)
    need("vtkmodules.util.numpy_support", task)
    notices: list[str] = []
    if grid.IsA("vtkRectilinearGrid"):
        return _rectilinear(grid, task, notices)
    low = np.array(grid.GetExtent()[::2], dtype=float)
    direction = np.array([[grid.GetDirectionMatrix().GetElement(i, j) for j in range(3)] for i in range(3)])
    axes = direction * np.array(grid.GetSpacing())
    voxels, cells = _voxels(grid, task, notices)
    first = low + 0.5 if cells else low
    return Reading(Source.of(voxels), axes, np.array(grid.GetOrigin()) + axes @ first, notices=notices)


def _xml_reader(head: bytes, task: Task) -> Any:
    kind = re.search(rb"<VTKFile[^>]*\btype\s*=\s*[\"'](\w+)", head)
    name = kind.group(1).decode() if kind else "no VTK data"
    if name not in _XML:
        raise task.error(f"it holds {name}, which is not a volume", "resample it to image data (.vti)")
    reader = getattr(need("vtkmodules.vtkIOXML", task), _XML[name])()
    return reader


def _legacy_reader(head: bytes, task: Task) -> Any:
    kind = re.search(rb"^\s*DATASET\s+(\w+)", head, re.MULTILINE | re.IGNORECASE)
    name = kind.group(1).decode().upper() if kind else "no data set"
    if name not in _LEGACY:
        raise task.error(
            f"it holds {name.lower().replace('_', ' ')}, which is not a volume",
            "resample it to structured points",
        )
    dims = re.search(rb"^\s*DIMENSIONS\s+(\d+)\s+(\d+)\s+(\d+)", head, re.MULTILINE | re.IGNORECASE)
    if dims is None:
        raise task.error("it does not say how many voxels it has", "it is damaged: export it again")
    count = int(dims.group(1)) * int(dims.group(2)) * int(dims.group(3))
    check_claim(
        task, count // 8, task.path.stat().st_size
    )  # one bit a voxel is the least that the format stores
    return getattr(need("vtkmodules.vtkIOLegacy", task), _LEGACY[name])()


def run(reader: Any, task: Task, check: Callable[[Any, Task], object] | None = None) -> Any:
    """Run a reader of VTK on the task's file and return what it holds.

    Parameters
    ----------
    check : callable (reader, task), optional
        Asked before the data is read, when the reader knows what the file announces.

    Raises
    ------
    LoadError
        If VTK complains or there is no point in it.
    """
    core = need("vtkmodules.vtkCommonCore", task)
    # Errors of a reader inside the reader send no events: they are only written, so that is where we listen.
    before, window = core.vtkOutputWindow.GetInstance(), core.vtkStringOutputWindow()
    core.vtkOutputWindow.SetInstance(window)
    logger, cutoff = core.vtkLogger, core.vtkLogger.GetCurrentVerbosityCutoff()
    logger.SetStderrVerbosity(logger.VERBOSITY_OFF)
    try:
        reader.SetFileName(str(task.path))
        task.step(0.0, "Reading")
        if check is not None:
            check(reader, task)
        reader.AddObserver("ProgressEvent", lambda *_: _progress(reader, task))
        reader.Update()
    finally:
        core.vtkOutputWindow.SetInstance(before)
        logger.SetStderrVerbosity(cutoff)
    task.step(0.0, "Reading")
    grid = reader.GetOutput()
    if "ERROR" in window.GetOutput().upper() or grid is None or grid.GetNumberOfPoints() == 0:
        raise task.error("VTK cannot read its data", "it is truncated or damaged: copy or export it again")
    return grid


def _progress(reader: Any, task: Task) -> None:
    if task.cancel is not None and task.cancel():
        reader.AbortExecuteOn()


def _check_extent(reader: Any, task: Task) -> None:
    if not reader.IsA("vtkXMLReader"):
        return
    reader.UpdateInformation()
    module = need("vtkmodules.vtkCommonExecutionModel", task)
    extent = reader.GetOutputInformation(0).Get(module.vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT())
    if not extent:
        raise task.error("it does not say how many voxels it has", "it is damaged: export it again")
    count = 1
    for low, high in zip(extent[::2], extent[1::2], strict=True):
        count *= max(0, int(high) - int(low) + 1)
    check_claim(task, count, task.path.stat().st_size, compressed=True)
    check_memory(task, count)


def _check_words(grid: Any, task: Task) -> None:
    """Refuse a text file with fewer words than values: VTK reads on past its end, and says nothing."""
    values = sum(
        attributes.GetAbstractArray(i).GetNumberOfValues()
        for attributes in (grid.GetPointData(), grid.GetCellData())
        for i in range(attributes.GetNumberOfArrays())
    )
    words, before = 0, False
    with task.path.open("rb") as stream:
        while chunk := stream.read(1 << 24):
            inked = np.frombuffer(chunk, np.uint8) > ord(" ")
            words += int(np.count_nonzero(inked[1:] & ~inked[:-1])) + int(inked[0] and not before)
            before = bool(inked[-1])
    if words < values:
        raise task.error("it ends before its last value", "it is truncated: copy or export it again")


# -- voxels ----------------------------------------------------------------------------------------
def _voxels(grid: Any, task: Task, notices: list[str]) -> tuple[np.ndarray, bool]:
    """Return the array to show, shape (z, y, x), and whether it lies on cells instead of points."""
    numpy_support = need("vtkmodules.util.numpy_support", task)
    for attributes, cells in ((grid.GetPointData(), False), (grid.GetCellData(), True)):
        chosen = _chosen(attributes)
        if chosen is None:
            continue
        dims = np.maximum(np.array(grid.GetDimensions()) - int(cells), 1)
        if chosen.GetNumberOfTuples() != int(np.prod(dims)):
            raise task.error("its array has another length than its grid", "it is damaged: export it again")
        others = [a for a in _names(attributes) if a != chosen.GetName()]
        if others:
            notices.append(f"Shown is {chosen.GetName()!r}; the file also holds {', '.join(others[:5])}.")
        values = numpy_support.vtk_to_numpy(chosen)
        shape = tuple(int(n) for n in dims[::-1])
        count = chosen.GetNumberOfComponents()
        if count == 1:
            return values.reshape(shape), cells
        notices.append(component_notice(values.dtype, count))
        return one_value(values.reshape(*shape, count)), cells
    raise task.error("it has a grid but no values on it", "export it with a scalar array")


def _names(attributes: Any) -> list[str]:
    return [str(attributes.GetArrayName(i)) for i in range(attributes.GetNumberOfArrays())]


def _chosen(attributes: Any) -> Any:
    """Return the active scalars, else the first array of single numbers, else the first of all."""
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]
    numeric = [a for a in arrays if a is not None]
    singles = [a for a in numeric if a.GetNumberOfComponents() == 1]
    return attributes.GetScalars() or next(iter(singles), None) or next(iter(numeric), None)


# -- rectilinear grids -----------------------------------------------------------------------------
def _rectilinear(grid: Any, task: Task, notices: list[str]) -> Reading:
    numpy_support = need("vtkmodules.util.numpy_support", task)
    voxels, cells = _voxels(grid, task, notices)
    points = [
        np.asarray(numpy_support.vtk_to_numpy(c), dtype=float)
        for c in (grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates())
    ]
    if cells:
        points = [(p[1:] + p[:-1]) / 2 if len(p) > 1 else p for p in points]
    if min(len(p) for p in points) < 2:
        raise task.error("it holds only one slice", "a volume needs at least 2 along each axis")
    if any((np.diff(p) <= 0).any() for p in points):
        raise task.error("its coordinates do not grow", "correct the file")
    steps, uneven = np.empty(3), False
    for axis, p in enumerate(points):
        steps[axis] = (p[-1] - p[0]) / (len(p) - 1)
        if np.abs(np.diff(p) / steps[axis] - 1).max() > _EVEN:
            uneven = True
            voxels, steps[axis] = _resample(voxels, p, 2 - axis, task)
    if uneven:
        notices.append("The grid's planes are unevenly spaced: resampled onto a regular grid.")
    return Reading(Source.of(voxels), np.diag(steps), np.array([p[0] for p in points]), notices=notices)


def _resample(voxels: np.ndarray, places: np.ndarray, axis: int, task: Task) -> tuple[np.ndarray, float]:
    """Interpolate linearly along one array axis at evenly spaced places; at most 4 times as many."""
    extent = places[-1] - places[0]
    count = int(np.clip(round(extent / np.quantile(np.diff(places), 0.25)) + 1, len(places), 4 * len(places)))
    check_memory(task, voxels.nbytes // len(places) * count * 2)
    wanted = np.linspace(places[0], places[-1], count)
    upper = np.clip(np.searchsorted(places, wanted), 1, len(places) - 1)
    weight = np.clip((wanted - places[upper - 1]) / (places[upper] - places[upper - 1]), 0, 1).astype(
        np.float32
    )
    along = np.moveaxis(voxels, axis, -1)
    mixed = along[..., upper - 1] * (1 - weight) + along[..., upper] * weight
    if voxels.dtype.kind in "iu":
        mixed = np.rint(mixed).astype(voxels.dtype)
    return np.moveaxis(mixed, -1, axis), float(extent / (count - 1))
