"""Geometry for VTK's own pictures: lines as lines, so that a cell that is picked is a line of the geometry."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..io.reading import Task, need
from ..scene.geometry import Geometry
from ..scene.shapes import Lines
from .color import point_colors
from .meshing import mesh_of
from .polyline import Strand, strand_of, thinned_out
from .tubes import tangents_of

#: Name of the array of colours, 8-bit sRGB.
COLORS = "colors"
#: Points of lines in a preview, at most: beyond, whole lines are left out evenly. VTK draws on the window's
#: thread, and a software renderer takes some 0.1 s for so many.
MOST_POINTS = 100_000
#: The same while something moves.
MOVING_POINTS = 10_000
#: How far lines may leave theirs for the sake of fewer points, in radii.
TOLERANCE, MOVING_TOLERANCE = 0.5, 2.0


@dataclass(frozen=True)
class Preview:
    """What VTK shows of a geometry.

    Attributes
    ----------
    poly : vtkPolyData
        Lines, or triangles with normals; world mm LPS; colours in `COLORS`.
    numbers : ndarray, shape (cells,)
        The number of the line in ``geometry.shape`` that each cell is; of the triangle for a surface.
    moving : vtkPolyData
        The same with less in it, while something moves; itself where there is little.
    """

    poly: Any
    numbers: np.ndarray
    moving: Any


def preview_of(geometry: Geometry) -> Preview:
    """Return what VTK is to show of a geometry: what the filters leave, in few enough points to turn it about.

    Points on nearly straight parts are left out; of very many lines every second, third, … is shown
    (`MOST_POINTS`), and of very fine meshes the coarse one.
    """
    if isinstance(geometry.shape, Lines):
        return _lines(geometry)
    mesh = mesh_of(geometry)
    mesh = mesh.coarse or mesh
    count = len(mesh.triangles)
    poly = _poly(mesh.points, mesh.colors)
    poly.SetPolys(_cells(np.arange(0, 3 * count + 1, 3), mesh.triangles.ravel()))
    poly.GetPointData().SetNormals(_vtk(mesh.normals))
    return Preview(poly, np.arange(count), poly)


def line_poly(geometry: Geometry, number: int) -> Any:
    """Return a vtkPolyData of one line of a geometry."""
    shape = geometry.shape
    assert isinstance(shape, Lines)
    points = shape.points[shape.offsets[number] : shape.offsets[number + 1]]
    poly = _poly(points, np.ones_like(points))
    poly.SetLines(_cells(np.array([0, len(points)]), np.arange(len(points))))
    return poly


def _lines(geometry: Geometry) -> Preview:
    names = (geometry.scalar,) if geometry.color_by == "scalar" else ()
    strand = _few_enough(strand_of(geometry, names), 8 * MOST_POINTS)
    strand = _few_enough(_thinned(strand, TOLERANCE * geometry.radius), MOST_POINTS)
    poly, numbers = _line_cells(geometry, strand)
    if len(strand.points) <= MOVING_POINTS:
        return Preview(poly, numbers, poly)
    moving = _few_enough(_thinned(strand, MOVING_TOLERANCE * geometry.radius), MOVING_POINTS)
    return Preview(poly, numbers, _line_cells(geometry, moving)[0])


def _thinned(strand: Strand, tolerance: float) -> Strand:
    return thinned_out(strand, tolerance) if len(strand.points) else strand


def _line_cells(geometry: Geometry, strand: Strand) -> tuple[Any, np.ndarray]:
    """Return lines as a vtkPolyData, and the numbers of its cells."""
    values = strand.values[:, 0] if geometry.color_by == "scalar" else None
    tangents = tangents_of(strand) if len(strand.points) else np.empty((0, 3), np.float32)
    poly = _poly(strand.points, point_colors(geometry, tangents, values))
    numbers, lengths = np.unique(strand.line, return_counts=True)
    poly.SetLines(_cells(np.concatenate([[0], np.cumsum(lengths)]), np.arange(len(strand.points))))
    return poly, numbers


def _few_enough(strand: Strand, most: int) -> Strand:
    """Leave out lines evenly until their points are few enough."""
    every = -(-len(strand.points) // most)
    if every < 2:
        return strand
    numbers = np.unique(strand.line)
    return strand.taken(np.isin(strand.line, numbers[::every]))


def _module(name: str) -> Any:
    return need(name, Task(Path("geometry")))


def _vtk(array: np.ndarray) -> Any:
    support = _module("vtkmodules.util.numpy_support")
    return support.numpy_to_vtk(np.ascontiguousarray(array), deep=True)


def _poly(points: np.ndarray, colors: np.ndarray) -> Any:
    places = _module("vtkmodules.vtkCommonCore").vtkPoints()
    places.SetData(_vtk(points.astype(np.float32)))
    poly = _module("vtkmodules.vtkCommonDataModel").vtkPolyData()
    poly.SetPoints(places)
    coded = np.where(colors > 0.0031308, 1.055 * np.maximum(colors, 0) ** (1 / 2.4) - 0.055, 12.92 * colors)
    array = _vtk(np.rint(255 * np.clip(coded, 0, 1)).astype(np.uint8))
    array.SetName(COLORS)
    poly.GetPointData().SetScalars(array)
    return poly


def _cells(offsets: np.ndarray, connectivity: np.ndarray) -> Any:
    cells = _module("vtkmodules.vtkCommonDataModel").vtkCellArray()
    cells.SetData(_vtk(offsets.astype(np.int64)), _vtk(connectivity.astype(np.int64)))
    return cells
