"""Streamlines by vtkStreamTracer, a few seeds at a time, so that they can be watched and cancelled."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LoadError, SceneError
from ..io import guarded
from ..io.reading import Cancel, Progress, Task, need
from ..scene.geometry import Geometry
from ..scene.shapes import Surface
from ..scene.tracing import Tracing
from .cleaning import RawLines, lines_of, plural
from .field import SPEED, VECTORS, VectorField, load_field
from .load import load_geometry
from .seeding import seed_points

#: Seeds traced in one call of VTK: it holds Python's lock meanwhile, so a call has to be short.
_CHUNK = 25
#: Name of the scalar that tells how long a particle was under way, in the field's own units.
TIME = "time"
_INTEGRATORS = {"rk2": "SetIntegratorTypeToRungeKutta2", "rk4": "SetIntegratorTypeToRungeKutta4",
                "rk45": "SetIntegratorTypeToRungeKutta45"}  # fmt: skip
_WAYS = {"both": "Both", "forward": "Forward", "backward": "Backward"}


def trace(
    tracing: Tracing,
    field: VectorField | None = None,
    *,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Geometry:
    """Trace streamlines.

    Parameters
    ----------
    tracing : Tracing
        Field, seeds and settings.
    field : VectorField, optional
        The field, if it is in memory already; otherwise ``tracing.path`` is read.
    progress, cancel
        As in `load_geometry`.

    Returns
    -------
    Geometry
        Coloured by speed; its scalars are those of the field along the lines, ``speed`` and ``time``.

    Raises
    ------
    LoadError
        If the field cannot be read, is another than ``tracing.hash`` says, or no seed gives a line.
    """
    task = Task(Path(tracing.path or "vectors"), progress=progress, cancel=cancel)
    task.step(0.0, "Reading the field")
    if field is None:
        if not tracing.path:
            raise SceneError("tracing.path", "", "the file of a vector field is needed")
        field = load_field(tracing.path, tracing.array)
    if tracing.hash and tracing.hash != field.key:
        raise LoadError(
            task.path, "this is not the field that the streamlines were traced in", "trace them anew"
        )
    seeds = seed_points(tracing.seeds, _seed_surface(tracing))
    with guarded(task):
        raw = _traced(field, tracing, seeds, task)
        shape, notices = lines_of(raw, task)
        name = f"Streamlines from {plural(len(seeds), 'seed')}"
        full = _identified(tracing, field)
        return Geometry(
            shape,
            tracing=full,
            kind="streamlines",
            name=name,
            notices=(*field.notices, *notices),
            color_by="direction" if field.axial else "scalar",
            scalar=SPEED,
        )


def _identified(tracing: Tracing, field: VectorField) -> Tracing | None:
    """Return the tracing with its field's place and key: what a scene needs to trace it again."""
    if not field.path:
        return None
    return dataclasses.replace(tracing, path=field.path, hash=field.key)


def _seed_surface(tracing: Tracing) -> Surface | None:
    if tracing.seeds.kind != "surface":
        return None
    shape = load_geometry(tracing.seeds.path).shape
    if not isinstance(shape, Surface):
        raise LoadError(tracing.seeds.path, "it holds lines, not a surface", "choose a surface for the seeds")
    return shape


def _traced(field: VectorField, tracing: Tracing, seeds: np.ndarray, task: Task) -> RawLines:
    tracer = _tracer(field, tracing, task)
    found: list[tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]] = []
    numbers, lines = 0, 0
    for i in range(0, len(seeds), _CHUNK):
        task.step(0.1 + 0.8 * i / len(seeds), "Tracing")
        for points, length, values in _pieces(tracer, seeds[i : i + _CHUNK], task):
            found.append((points, length, values))
            lines += len(length)
        numbers += len(seeds[i : i + _CHUNK])
    if not lines:
        raise task.error(
            f"none of the {numbers} seeds gives a streamline",
            "put them where the field is: " + _box_text(field.bounds),
        )
    notices = (
        []
        if lines == numbers
        else [f"{numbers - lines} of {numbers} seeds give no line: outside or at rest."]
    )
    return RawLines(
        np.concatenate([f[0] for f in found]),
        np.concatenate([f[1] for f in found]),
        {name: np.concatenate([f[2][name] for f in found]) for name in found[0][2]},
        notices=notices,
    )


def _box_text(bounds: np.ndarray) -> str:
    return ", ".join(f"{a} {lo:g} to {hi:g} mm" for a, lo, hi in zip("xyz", *bounds, strict=True))


def _tracer(field: VectorField, tracing: Tracing, task: Task) -> Any:
    tracer = need("vtkmodules.vtkFiltersFlowPaths", task).vtkStreamTracer()
    # A copy that shares the arrays: another thread may still trace in the same field.
    dataset = field.dataset.NewInstance()
    dataset.ShallowCopy(field.dataset)
    tracer.SetInputData(dataset)
    tracer.SetInputArrayToProcess(0, 0, 0, 0, VECTORS)  # first input, port and connection 0, point data
    getattr(tracer, _INTEGRATORS[tracing.integrator])()
    getattr(tracer, f"SetIntegrationDirectionTo{_WAYS[tracing.direction]}")()
    longest = float((field.bounds[1] - field.bounds[0]).max())
    tracer.SetMaximumPropagation(tracing.length or 10 * longest)
    tracer.SetIntegrationStepUnit(2)  # lengths of the cell
    step = tracing.step / np.sqrt(3)  # VTK's length of a cell is its diagonal
    tracer.SetInitialIntegrationStep(step)
    tracer.SetMinimumIntegrationStep(step / 50)
    tracer.SetMaximumIntegrationStep(step)
    tracer.SetMaximumNumberOfSteps(tracing.max_steps)
    speed = field.dataset.GetPointData().GetArray(SPEED).GetRange()[1]
    tracer.SetTerminalSpeed(max(tracing.min_speed * speed, 1e-30))
    tracer.SetComputeVorticity(False)
    return tracer


def _pieces(
    tracer: Any, seeds: np.ndarray, task: Task
) -> Iterator[tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]]:
    """Trace a few seeds; both ways from a seed become one line, from its far past to its far future."""
    support = need("vtkmodules.util.numpy_support", task)
    model = need("vtkmodules.vtkCommonDataModel", task)
    places = need("vtkmodules.vtkCommonCore", task).vtkPoints()
    places.SetData(support.numpy_to_vtk(np.ascontiguousarray(seeds), deep=True))
    source = model.vtkPolyData()
    source.SetPoints(places)
    tracer.SetSourceData(source)
    tracer.Update()
    out = tracer.GetOutput()
    if not out.GetNumberOfLines():
        return
    cells = out.GetLines()
    at = support.vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    lengths = np.diff(support.vtk_to_numpy(cells.GetOffsetsArray()))
    data = out.GetPointData()
    seed = np.repeat(support.vtk_to_numpy(out.GetCellData().GetArray("SeedIds")), lengths)
    time = support.vtk_to_numpy(data.GetArray("IntegrationTime"))[at]
    order = np.lexsort((time, seed))
    at, seed, time = at[order], seed[order], time[order]
    points = support.vtk_to_numpy(out.GetPoints().GetData())[at].astype(np.float32)
    fresh = np.concatenate([[True], (np.diff(seed) != 0) | (np.diff(points, axis=0) != 0).any(axis=1)])
    values = {TIME: time[fresh]}
    for i in range(data.GetNumberOfArrays()):
        array, name = data.GetArray(i), data.GetArrayName(i)
        if array is not None and name not in (VECTORS, "IntegrationTime", "Normals", None):
            values[name] = support.vtk_to_numpy(array)[at][fresh]
    _, counts = np.unique(seed[fresh], return_counts=True)
    yield points[fresh], counts, values
