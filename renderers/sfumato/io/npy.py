"""NumPy's .npy and .npz; pickled objects are never loaded."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from .reading import Reading, Source, Task, check_claim, check_memory, pick_frame
from .voxels import is_colour, one_value_source

#: Names under which an archive may hold its volume, tried in this order before the largest array.
_NAMES = ("data", "volume", "image", "arr_0")


def read(task: Task) -> Reading:
    """Read an array (z, y, x); an archive may also hold ``spacing``, ``origin`` and ``direction``."""
    try:
        if task.path.suffix.lower() == ".npz" or zipfile.is_zipfile(task.path):
            return _archive(task)
        array = np.load(task.path, mmap_mode="r", allow_pickle=False)
    except (ValueError, EOFError, OSError, zipfile.BadZipFile) as error:
        raise _damaged(task, error) from error
    notices = ["The size of its voxels is not known: taken as 1 mm."]
    return Reading(source_of(array, task, notices), notices=notices)


def _damaged(task: Task, error: Exception) -> Exception:
    if any(word in str(error) for word in ("pickle", "Python objects")):
        return task.error("it holds Python objects, which are never loaded", "save a plain numeric array")
    return task.error(f"it is not a readable NumPy file ({str(error)[:120]})", "save it again")


def source_of(array: np.ndarray, task: Task, notices: list[str]) -> Source:
    """Return the source for an array of 3 axes, or 4 (colour last, or time first)."""
    if array.ndim == 4 and (is_colour(array.dtype, array.shape[-1]) and array.shape[0] > 1):
        z, y, x, count = array.shape
        return one_value_source((z, y, x), array.dtype, count, lambda z0, z1: array[z0:z1], notices)
    if array.ndim == 4:
        array = array[pick_frame(task, array.shape[0], notices)]
    if array.ndim == 2:
        raise task.error("it holds only one slice", "a volume needs at least 2 along each axis")
    if array.ndim != 3:
        raise task.error(f"its array has {array.ndim} axes", "an array (z, y, x) is needed")
    return Source.of(array)


def _archive(task: Task) -> Reading:
    headers = _headers(task)
    name = _chosen(headers, task)
    shape, dtype = headers[name]
    nbytes = int(np.prod(shape, dtype=object)) * dtype.itemsize if shape else 0
    check_memory(task, nbytes)
    with zipfile.ZipFile(task.path) as archive:
        check_claim(task, nbytes, archive.getinfo(name + ".npy").file_size)
    notices: list[str] = []
    with np.load(task.path, allow_pickle=False) as archive:
        task.step(0.0, "Unpacking")
        array = archive[name]
        small = {
            k: np.asarray(archive[k], dtype=float)
            for k in ("spacing", "origin", "direction")
            if _is_small(headers.get(k))
        }
    rest = [k for k in headers if k != name and k not in small]
    if rest:
        notices.append(f"Shown is {name!r}; the file also holds {', '.join(rest[:5])}.")
    spacing = small.get("spacing")
    if spacing is None or spacing.shape != (3,):
        spacing = np.ones(3)
        notices.append("The size of its voxels is not known: taken as 1 mm.")
    direction = small.get("direction")
    axes = (direction if direction is not None and direction.shape == (3, 3) else np.eye(3)) * spacing
    origin = small.get("origin")
    return Reading(
        source_of(array, task, notices),
        axes,
        origin if origin is not None and origin.shape == (3,) else None,
        notices=notices,
    )


def _headers(task: Task) -> dict[str, tuple[tuple[int, ...], np.dtype]]:
    """Return shape and type of each array in an archive, read from their headers alone."""
    found = {}
    with zipfile.ZipFile(task.path) as archive:
        for entry in archive.namelist():
            if not entry.endswith(".npy"):
                continue
            with archive.open(entry) as stream:
                version = np.lib.format.read_magic(stream)
                header = (
                    np.lib.format.read_array_header_1_0
                    if version == (1, 0)
                    else np.lib.format.read_array_header_2_0
                )
                shape, _, dtype = header(stream)
                found[Path(entry).name.removesuffix(".npy")] = (tuple(shape), dtype)
    return found


def _chosen(headers: dict[str, tuple[tuple[int, ...], np.dtype]], task: Task) -> str:
    if any(dtype.hasobject for _, dtype in headers.values()):
        raise task.error("it holds Python objects, which are never loaded", "save plain numeric arrays")
    volumes = {k: v[0] for k, v in headers.items() if len(v[0]) in (3, 4)}
    if not volumes:
        raise task.error("it holds no array with three axes", "save one as (z, y, x)")
    named = next((k for k in _NAMES if k in volumes), None)
    return named or max(volumes, key=lambda k: int(np.prod(volumes[k], dtype=object)))


def _is_small(header: tuple[tuple[int, ...], np.dtype] | None) -> bool:
    return header is not None and header[1].kind in "iuf" and header[0] in ((3,), (3, 3))
