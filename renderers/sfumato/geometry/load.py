"""`load_geometry`: a file in, a `Geometry` out; the format is told by the name, poly data in .vtk by a look."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ..errors import SceneError
from ..io import guarded
from ..io.reading import Cancel, Progress, Task
from ..scene.geometry import Geometry, Shape
from ..scene.shapes import Lines
from . import polydata, tractograms, trx
from .cleaning import RawLines, RawSurface, lines_of, plural, surface_of, to_lps

Reader = Callable[[Task], RawLines | RawSurface]

_FORMATS: dict[str, Reader] = {
    ".trk": tractograms.read_trk,
    ".tck": tractograms.read_tck,
    ".trx": trx.read,
    ".vtp": polydata.read,
    ".vtk": polydata.read,
    ".stl": polydata.read,
    ".ply": polydata.read,
    ".obj": polydata.read,
}
#: What a file dialog offers.
SUFFIXES = tuple(_FORMATS)
SPACES = ("", "LPS", "RAS")


def is_geometry(path: str | os.PathLike[str]) -> bool:
    """Tell whether a path is a file of tracts or a mesh, by its name; a .vtk file by what it holds."""
    place = Path(path)
    suffix = place.suffix.lower()
    if suffix != ".vtk":
        return suffix in _FORMATS
    try:
        with place.open("rb") as stream:
            head = stream.read(4096)
    except OSError:
        return False
    return re.search(rb"^\s*DATASET\s+POLYDATA", head, re.MULTILINE | re.IGNORECASE) is not None


def load_geometry(
    path: str | os.PathLike[str],
    *,
    space: str = "",
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Geometry:
    """Read tracts (TRK, TCK, TRX), poly data (VTP, legacy VTK) or a surface (STL, PLY, OBJ).

    Parameters
    ----------
    path : str or path
        What to read.
    space : str
        ``RAS`` or ``LPS``: the space of a VTK file, STL, PLY or OBJ that does not say. By default LPS, with a
        notice; tractograms come with their affine and do not need it.
    progress : callable (fraction, text), optional
        Told how far the work is, 0..1; called in the thread that loads.
    cancel : callable () -> bool, optional
        Asked between bounded pieces of work; once true, `LoadCancelled` is raised.

    Returns
    -------
    Geometry
        ``notices`` tells with counts what was left out.

    Raises
    ------
    LoadError
        With the file, what is wrong with it and what can be done.
    SceneError
        If ``space`` is none of these.
    """
    if space not in SPACES:
        raise SceneError("space", space, "LPS or RAS")
    task = Task(Path(path), progress=progress, cancel=cancel)
    with guarded(task):
        task.step(0.0, "Opening")
        if not task.path.exists():
            raise task.error("there is no such file or folder", "check the path")
        reader = _FORMATS.get(task.path.suffix.lower())
        if reader is None:
            raise task.error("it is no format of tracts or meshes", "known: " + ", ".join(SUFFIXES))
        shape, notices = _shape(reader(task), task, space)
        task.step(0.8, "Checking")
        made = Geometry(
            shape,
            str(task.path),
            name=task.path.stem,
            notices=tuple(notices),
            space=space,
            color_by=_look(shape),
        )
        made.shape.key  # noqa: B018  (hashed here, in the thread that loads)
        if isinstance(shape, Lines):
            shape.lengths, shape.boxes  # noqa: B018  (what the window asks for, too)
        task.step(1.0, "Done")
        return made


def _shape(raw: RawLines | RawSurface, task: Task, space: str) -> tuple[Shape, list[str]]:
    if not raw.space:
        if space == "RAS":
            raw.points = to_lps(raw.points)
            if isinstance(raw, RawSurface) and raw.normals is not None:
                raw.normals = to_lps(raw.normals)
        elif not space:
            raw.notices.append(
                "The file does not name its space: its coordinates are taken as LPS millimetres."
            )
    task.step(0.7, "Checking")
    return lines_of(raw, task) if isinstance(raw, RawLines) else surface_of(raw, task)


def _look(shape: Shape) -> str:
    """Choose how it is coloured at first: lines by direction, surfaces in their own colours if they have any."""
    if isinstance(shape, Lines):
        return "direction"
    return "file" if shape.colors is not None else "color"


def outside_notice(geometry: Geometry, texture_from_world: np.ndarray) -> str:
    """Return a sentence on how much of a geometry lies outside a volume's box, or nothing.

    Parameters
    ----------
    texture_from_world : ndarray, shape (4, 4)
        As `Volume.texture_from_world`: the box is [0, 1]^3.
    """
    points = geometry.shape.points @ texture_from_world[:3, :3].T.astype(np.float32)
    points += texture_from_world[:3, 3].astype(np.float32)
    out = np.any((points < 0) | (points > 1), axis=1)
    shape = geometry.shape
    if isinstance(shape, Lines):
        parts = np.logical_and.reduceat(out, shape.offsets[:-1])
        touched, noun = np.logical_or.reduceat(out, shape.offsets[:-1]), "line"
    else:
        parts, touched, noun = out[shape.triangles].all(axis=1), out[shape.triangles].any(axis=1), "triangle"
    if not touched.any():
        return ""
    whole = int(parts.sum())
    text = f"{plural(int(touched.sum()), noun)} of {len(touched)} leave the volume"
    text += f", {whole} of them lie outside it altogether" if whole else ""
    return text + ("; they may belong to another scan." if whole == len(touched) else ".")
