"""OME-Zarr (versions 0.4 and 0.5) and plain Zarr arrays, read chunk row by chunk row.

Source: OME-NGFF specification, "multiscales" metadata; the anatomical orientation of axes is its RFC 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .reading import Reading, Source, Task, need, pick_frame
from .units import length_mm
from .voxels import MAX_AXIS, held_dtype

#: World direction (LPS) in which an axis of RFC 4 grows.
_TOWARDS = {
    "right-to-left": (1, 0, 0), "left-to-right": (-1, 0, 0),
    "anterior-to-posterior": (0, 1, 0), "posterior-to-anterior": (0, -1, 0),
    "inferior-to-superior": (0, 0, 1), "superior-to-inferior": (0, 0, -1),
}  # fmt: skip


@dataclass(frozen=True)
class _Axis:
    name: str
    kind: str
    unit_mm: float
    towards: tuple[int, int, int] | None


def is_zarr(folder: Path) -> bool:
    """Whether a folder is the root of a Zarr hierarchy or array."""
    return any((folder / name).is_file() for name in (".zgroup", ".zattrs", ".zarray", "zarr.json"))


def read(task: Task) -> Reading:
    """Read the finest level of a multiscale image that fits the budget, or the one the task asks for."""
    zarr = need("zarr", task)
    try:
        node = zarr.open(str(task.path), mode="r")
    except Exception as error:
        raise task.error(
            f"its Zarr metadata cannot be read ({error})", "copy the whole folder again"
        ) from error
    notices: list[str] = []
    if not hasattr(node, "keys"):
        axes = _default_axes(node.ndim)
        return _reading(node, axes, np.ones(node.ndim), None, notices, task)
    image = _multiscale(dict(node.attrs), task)
    axes = _axes(image, task)
    level, array = _level(node, image["datasets"], axes, notices, task)
    scale, translation = _transform(image, level, array.ndim)
    reading = _reading(array, axes, scale, translation, notices, task)
    reading.name = str(image.get("name") or "") or task.path.name
    reading.level_done = True
    return reading


def _multiscale(attributes: dict[str, Any], task: Task) -> dict[str, Any]:
    found = attributes.get("multiscales") or (attributes.get("ome") or {}).get("multiscales")
    if (
        not isinstance(found, list)
        or not found
        or not isinstance(found[0], dict)
        or not found[0].get("datasets")
    ):
        raise task.error(
            "it is a Zarr group without an OME multiscale image", "open the array or image inside it"
        )
    return dict(found[0])


def _axes(image: dict[str, Any], task: Task) -> list[_Axis]:
    axes = []
    for axis in image.get("axes") or [{"name": n} for n in "tczyx"]:
        axis = {"name": axis} if isinstance(axis, str) else axis
        name = str(axis.get("name", "")).lower()
        kind = str(axis.get("type") or ("space" if name in "xyz" else name))
        orientation = axis.get("orientation")
        value = orientation.get("value") if isinstance(orientation, dict) else orientation
        axes.append(
            _Axis(name, kind, length_mm(str(axis.get("unit") or "mm")) or 1.0, _TOWARDS.get(str(value)))
        )
    if sum(a.kind == "space" for a in axes) != 3:
        raise task.error("it does not have three axes of space", "only 3D images are volumes")
    return axes


def _default_axes(rank: int) -> list[_Axis]:
    names = "vutczyx"[-rank:] if rank <= 7 else ""
    return [_Axis(n, "space" if n in "xyz" else n, 1.0, None) for n in names]


def _level(
    node: Any, datasets: list[dict[str, Any]], axes: list[_Axis], notices: list[str], task: Task
) -> tuple[dict[str, Any], Any]:
    """Return the entry and the array of the level to read."""
    if task.level is not None:
        if not 0 <= task.level < len(datasets):
            raise task.error(
                f"there is no level {task.level}",
                f"it has {len(datasets)}: 0 (finest) to {len(datasets) - 1}",
            )
        candidates = [task.level]
    else:
        candidates = list(range(len(datasets)))
    for number in candidates:
        array = _array(node, str(datasets[number].get("path", "")), task)
        if array.ndim != len(axes):
            raise task.error(
                f"level {number} has {array.ndim} axes, its metadata {len(axes)}", "the file is inconsistent"
            )
        dims = [n for n, a in zip(array.shape, axes, strict=True) if a.kind == "space"]
        itemsize = min(4, held_dtype(array.dtype, task).itemsize)
        if (
            np.prod(dims, dtype=float) * itemsize <= task.budget_bytes and max(dims) <= MAX_AXIS
        ) or number == candidates[-1]:
            break
    if number > 0 and task.level is None:
        notices.append(f"Level {number} of {len(datasets)} is shown: the finer ones do not fit into memory.")
    return datasets[number], array


def _array(node: Any, path: str, task: Task) -> Any:
    try:
        array = node[path]
    except Exception as error:
        raise task.error(
            f"its level {path!r} is missing or damaged", "copy the whole folder again"
        ) from error
    if not hasattr(array, "shape"):
        raise task.error(f"its level {path!r} is a group, not an array", "the file is inconsistent")
    return array


def _transform(image: dict[str, Any], dataset: dict[str, Any], rank: int) -> tuple[np.ndarray, np.ndarray]:
    """Return scale and translation of a level: its own transformations, then those of the whole image."""
    scale, translation = np.ones(rank), np.zeros(rank)
    for holder in (dataset, image):
        for step in holder.get("coordinateTransformations") or []:
            kind = step.get("type")
            values = np.asarray(step.get(kind), dtype=float) if isinstance(step.get(kind), list) else None
            if values is None or values.shape != (rank,):
                continue
            if kind == "scale":
                scale, translation = scale * values, translation * values
            elif kind == "translation":
                translation = translation + values
    return scale, translation


def _reading(
    array: Any,
    axes: list[_Axis],
    scale: np.ndarray,
    translation: np.ndarray | None,
    notices: list[str],
    task: Task,
) -> Reading:
    if len(axes) != array.ndim or array.ndim < 3:
        raise task.error(f"its array has {array.ndim} axes", "a volume needs three")
    space = [i for i, a in enumerate(axes) if a.kind == "space"]
    names = {axes[i].name: i for i in space}
    order = [names[n] for n in "zyx"] if set(names) == set("xyz") else space
    others = [i for i in range(array.ndim) if i not in space]
    shape = (int(array.shape[order[0]]), int(array.shape[order[1]]), int(array.shape[order[2]]))
    frames = pick_frame(
        task, int(np.prod([array.shape[i] for i in others], dtype=int)), notices, "times or channels"
    )
    index = (
        dict(zip(others, np.unravel_index(frames, [array.shape[i] for i in others]), strict=True))
        if others
        else {}
    )

    def planes(z0: int, z1: int) -> np.ndarray:
        slices = tuple(
            int(index[i]) if i in index else slice(z0, z1) if i == order[0] else slice(None)
            for i in range(array.ndim)
        )
        kept = [i for i in range(array.ndim) if i not in index]
        return np.transpose(np.asarray(array[slices]), [kept.index(i) for i in order])

    source = Source(
        shape, np.dtype(array.dtype), _by_chunks(planes, int(array.chunks[order[0]]), shape, array.dtype)
    )
    world = [order[2], order[1], order[0]]
    units = np.array([axes[i].unit_mm for i in world])
    steps = np.abs(scale[world]) * units
    direction, known = _direction([axes[i].towards for i in world])
    origin = None if translation is None else direction @ (translation[world] * units)
    return Reading(source, direction * steps, origin, "", known, notices=notices)


def _by_chunks(planes: Any, chunk: int, shape: tuple[int, int, int], dtype: np.dtype) -> Any:
    """Return a reader that unpacks each row of chunks once (if a row is not larger than 256 MiB)."""
    if chunk * shape[1] * shape[2] * np.dtype(dtype).itemsize > 256 << 20:
        return planes
    held: dict[int, np.ndarray] = {}

    def read(z0: int, z1: int) -> np.ndarray:
        parts = []
        for row in range(z0 // chunk, -(-z1 // chunk)):
            if row not in held:
                held.clear()
                held[row] = planes(row * chunk, min(shape[0], (row + 1) * chunk))
            base = row * chunk
            parts.append(held[row][max(z0 - base, 0) : z1 - base])
        return np.concatenate(parts)

    return read


def _direction(towards: list[tuple[int, int, int] | None]) -> tuple[np.ndarray, bool]:
    if any(t is None for t in towards):
        return np.eye(3), False
    direction = np.array(towards, dtype=float).T
    return (direction, True) if abs(np.linalg.det(direction)) == 1 else (np.eye(3), False)
