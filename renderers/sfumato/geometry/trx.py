"""TRX: a zip archive (or folder) of bare arrays whose names say their type, in RAS mm.

Layout (https://github.com/tee-ar-ex/trx-spec): ``header.json``, ``positions.3.float32``, ``offsets.uint64``,
``dpv/NAME[.columns].type`` (values at points), ``dps/NAME…`` (of lines), ``groups/NAME.uint32`` (numbers of
lines). Read here rather than by trx-python, which unpacks compressed archives onto the disk first and
brings five packages along; NumPy and zipfile are enough, and every size is checked before it is taken.
"""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable
from pathlib import PurePosixPath

import numpy as np

from ..io.reading import Task, check_memory
from .cleaning import RawLines, to_lps

_TYPES = {
    "float16", "float32", "float64", "int8", "int16", "int32", "int64",
    "uint8", "uint16", "uint32", "uint64",
}  # fmt: skip
#: Name of the scalar that tells lines of different groups apart.
GROUP = "group"

Reader = Callable[[str], bytes]


def read(task: Task) -> RawLines:
    """Read a TRX archive or folder."""
    if task.path.is_dir():
        sizes = {
            p.relative_to(task.path).as_posix(): p.stat().st_size for p in task.path.rglob("*") if p.is_file()
        }
        return _read(task, sizes, lambda name: (task.path / name).read_bytes())
    with zipfile.ZipFile(task.path) as archive:
        sizes = {info.filename: info.file_size for info in archive.infolist() if not info.is_dir()}
        return _read(task, sizes, archive.read)


def _read(task: Task, sizes: dict[str, int], contents: Reader) -> RawLines:
    check_memory(task, 2 * sum(sizes.values()))
    header = _header(task, sizes, contents)
    points = _array(task, _one(task, sizes, "positions"), contents)
    task.step(0.4, "Reading")
    offsets = _array(task, _one(task, sizes, "offsets"), contents).ravel().astype(np.int64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise task.error("its positions are not in three columns", "it is damaged: export it again")
    lengths = _lengths(task, offsets, len(points), header.get("NB_STREAMLINES"))
    raw = RawLines(to_lps(points.astype(np.float32)), lengths)
    for i, name in enumerate(sizes):
        folder = PurePosixPath(name).parts[0]
        if folder in ("dpv", "dps"):
            values = _array(task, name, contents)
            wanted, known = (
                (len(points), raw.point_values) if folder == "dpv" else (len(lengths), raw.line_values)
            )
            if len(values) == wanted:
                known[_label(name)] = values
            else:
                raw.notices.append(f"Values {_label(name)!r} do not fit the lines and are left out.")
        task.step(0.4 + 0.2 * (i + 1) / len(sizes), "Reading")
    _groups(task, raw, [n for n in sizes if n.startswith("groups/")], contents)
    return raw


def _header(task: Task, sizes: dict[str, int], contents: Reader) -> dict[str, object]:
    if "header.json" not in sizes:
        raise task.error("it has no header.json, so it is no TRX file", "export it again")
    data = json.loads(contents("header.json"))
    return data if isinstance(data, dict) else {}


def _one(task: Task, sizes: dict[str, int], stem: str) -> str:
    names = [name for name in sizes if name.split(".")[0] == stem]
    if len(names) != 1:
        raise task.error(f"it has {len(names)} arrays called {stem}", "it is damaged: export it again")
    return names[0]


def _lengths(task: Task, offsets: np.ndarray, points: int, count: object) -> np.ndarray:
    """Return the lines' lengths; some writers end the offsets with the number of points, some do not."""
    if isinstance(count, int) and len(offsets) == count:
        offsets = np.append(offsets, points)
    lengths = np.diff(offsets)
    if len(offsets) < 2 or offsets[0] != 0 or offsets[-1] != points or (lengths < 0).any():
        raise task.error("its offsets do not fit its positions", "it is truncated or damaged: copy it again")
    return np.asarray(lengths)


def _groups(task: Task, raw: RawLines, names: list[str], contents: Reader) -> None:
    if not names:
        return
    group = np.zeros(len(raw.lengths), np.float32)
    for number, name in enumerate(names, 1):
        lines = _array(task, name, contents).ravel()
        if lines.dtype.kind == "u" and len(lines) and int(lines.max()) < len(group):
            group[lines] = number
    raw.line_values.setdefault(GROUP, group)


def _label(name: str) -> str:
    return PurePosixPath(name).name.split(".")[0]


def _array(task: Task, name: str, contents: Reader) -> np.ndarray:
    """Return an array whose name says its type, and its columns if it has several: (n,) or (n, columns)."""
    parts = PurePosixPath(name).name.split(".")
    if parts[-1] not in _TYPES:
        raise task.error(f"its array {name} is of an unknown type", "export it again")
    columns = int(parts[-2]) if len(parts) == 3 and parts[-2].isdigit() else 1
    data = contents(name)
    dtype = np.dtype(parts[-1]).newbyteorder("<")
    if columns < 1 or len(data) % (dtype.itemsize * columns):
        raise task.error(f"its array {name} ends within a value", "it is truncated or damaged: copy it again")
    array = np.frombuffer(data, dtype)
    return array.reshape(-1, columns) if columns > 1 else array
