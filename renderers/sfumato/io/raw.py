"""RAW: bare voxels, described by a sidecar, by the file's name, or by the user."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import LoadError
from .reading import Reading, Source, Task, check_claim

_TYPE_NAMES = {
    "uint8": "u1", "uchar": "u1", "byte": "u1", "u8": "u1", "8bit": "u1",
    "int8": "i1", "char": "i1", "i8": "i1",
    "uint16": "u2", "ushort": "u2", "u16": "u2", "16bit": "u2", "int16": "i2", "short": "i2", "i16": "i2",
    "uint32": "u4", "u32": "u4", "int32": "i4", "i32": "i4", "float32": "f4", "float": "f4", "f32": "f4",
    "float64": "f8", "double": "f8", "f64": "f8",
}  # fmt: skip
#: Tried when only the file's size is known, the likeliest first.
_LIKELY = ("uint8", "uint16", "int16", "float32")
_SIDES = (
    64,
    96,
    128,
    160,
    181,
    192,
    200,
    217,
    240,
    256,
    300,
    320,
    384,
    400,
    480,
    500,
    512,
    600,
    640,
    768,
    800,
    1000,
    1024,
)


class NeedsDescription(LoadError):  # noqa: N818  (it asks for something)
    """Bare voxels whose form nothing tells: ``load_raw`` can read them, `guess` proposes how."""


@dataclass(frozen=True)
class RawGuess:
    """One way to read a raw file.

    Parameters
    ----------
    dims : (int, int, int)
        Voxels along x, y, z.
    dtype : str
        NumPy type; ``>`` in front means big endian.
    spacing : (float, float, float)
        In mm along x, y, z.
    offset : int
        Bytes before the first voxel.
    sure : bool
        Whether name or sidecar say so and the file's size agrees.
    reason : str
        Where the guess comes from, for a dialog.
    """

    dims: tuple[int, int, int]
    dtype: str
    spacing: tuple[float, float, float] = (1.0, 1.0, 1.0)
    offset: int = 0
    sure: bool = False
    reason: str = ""


def guess(path: Path) -> list[RawGuess]:
    """Return ways to read a raw file whose size agrees, best first: sidecar, name, then size alone."""
    size = path.stat().st_size
    found = [*_from_json(path, size), *_from_name(path.name, size)]
    found += [g for g in _from_size(size) if all((g.dims, g.dtype) != (f.dims, f.dtype) for f in found)]
    return found


def sidecar(path: Path) -> Path | None:
    """Return the MetaImage or NRRD header beside a raw file that names it."""
    for header in sorted([*path.parent.glob("*.mhd"), *path.parent.glob("*.nhdr")]):
        try:
            text = header.read_text(encoding="latin-1")[: 1 << 16]
        except OSError:
            continue
        if re.search(rf"(?im)^(ElementDataFile\s*=|data ?file:)\s*(\./)?{re.escape(path.name)}\s*$", text):
            return header
    return None


def read(task: Task) -> Reading:
    """Read a raw file whose form is certain; otherwise say how to give it."""
    if task.path.stat().st_size == 0:
        raise task.error("it is empty")
    sure = [g for g in guess(task.path) if g.sure]
    if not sure:
        raise NeedsDescription(
            task.path,
            "raw voxels without a description",
            "name it like head_256x256x128_uint8.raw, put an .mhd beside it, or use load_raw",
        )
    best = sure[0]
    reading = source(task, best)
    x, y, z = best.dims
    reading.notices.append(f"Read as {x} x {y} x {z} voxels of {best.dtype} ({best.reason}).")
    return reading


def source(task: Task, how: RawGuess) -> Reading:
    """Return the reading of a raw file in a given way, mapped from disk."""
    try:
        dtype = np.dtype(how.dtype)
    except TypeError:
        raise task.error(
            f"{how.dtype!r} is not a type of voxels", f"use one of {', '.join(_LIKELY)}"
        ) from None
    if dtype.hasobject or dtype.itemsize == 0:
        raise task.error(f"{how.dtype!r} is not a type of voxels", f"use one of {', '.join(_LIKELY)}")
    dims = tuple(int(n) for n in how.dims)
    if len(dims) != 3 or min(dims) < 1 or how.offset < 0:
        raise task.error(
            f"{how.dims} voxels after {how.offset} bytes cannot be", "give three positive numbers (x, y, z)"
        )
    check_claim(task, how.offset + dims[0] * dims[1] * dims[2] * dtype.itemsize, task.path.stat().st_size)
    array = np.memmap(task.path, dtype, "r", how.offset, dims[::-1])
    return Reading(Source.of(array), np.diag([float(s) for s in how.spacing]))


def describe(path: Path, how: RawGuess) -> Path:
    """Write how to read a raw file beside it, as JSON, so that it opens without a question from now on.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    beside = path.with_name(path.name + ".json")
    about = {"dims": how.dims, "dtype": how.dtype, "spacing": how.spacing, "offset": how.offset}
    beside.write_text(json.dumps(about) + "\n", encoding="utf-8")
    return beside


# -- guessing --------------------------------------------------------------------------------------
def _from_json(path: Path, size: int) -> list[RawGuess]:
    for beside in (path.with_suffix(".json"), path.with_name(path.name + ".json")):
        try:
            about = json.loads(beside.read_text(encoding="utf-8"))
            x, y, z = (int(n) for n in about.get("dims") or about.get("size"))
            kind = np.dtype(
                _TYPE_NAMES.get(str(about.get("dtype") or about.get("type")).lower()) or str(about["dtype"])
            )
            sx, sy, sz = (float(s) for s in about.get("spacing", (1, 1, 1)))
        except (OSError, ValueError, TypeError, KeyError, AttributeError):
            continue
        rest = size - x * y * z * kind.itemsize
        told = about.get("offset")
        offset = told if isinstance(told, int) else rest
        if min(x, y, z) > 0 and 0 <= offset <= rest:
            sure = isinstance(told, int) or rest == 0
            return [RawGuess((x, y, z), _name(kind), (sx, sy, sz), offset, sure, f"from {beside.name}")]
    return []


def _from_name(name: str, size: int) -> list[RawGuess]:
    match = re.search(r"(?<!\d)(\d{1,5})[xX_](\d{1,5})[xX_](\d{1,5})(?!\d)", name)
    if match is None or "0" in (dims := match.groups()):
        return []
    x, y, z = (int(n) for n in dims)
    words = re.split(r"[^a-z0-9]+", name.lower())
    named = next((_TYPE_NAMES[w] for w in words if w in _TYPE_NAMES), None)
    swapped = any(w in ("be", "bigendian", "msb") for w in words)
    kinds = [named] if named else ["u1", "u2", "i2", "f4"]
    steps = _spacing(name)
    found = []
    for kind in kinds:
        dtype = np.dtype((">" if swapped else "<") + kind)
        offset = size - x * y * z * dtype.itemsize
        exact = offset == 0
        # Without a type in the name the size tells one byte from two, but not signed from unsigned.
        sure = exact and (named is not None or kind == "u1")
        if exact or (named and 0 < offset <= 4096):
            found.append(RawGuess((x, y, z), _name(dtype), steps, offset, sure, "from its name"))
    return found


def _spacing(name: str) -> tuple[float, float, float]:
    match = re.search(r"(\d*\.\d+)[xX_](\d*\.\d+)[xX_](\d*\.\d+)", name)
    x, y, z = (float(s) for s in match.groups()) if match else (1.0, 1.0, 1.0)
    return (x, y, z) if min(x, y, z) > 0 else (1.0, 1.0, 1.0)


def _from_size(size: int) -> list[RawGuess]:
    """Cubes first, then stacks of square slices of usual sizes, for each likely type."""
    found = []
    for kind in _LIKELY:
        count, rest = divmod(size, np.dtype(kind).itemsize)
        if rest or count < 8:
            continue
        side = round(count ** (1 / 3))
        if side**3 == count:
            found.append((0, RawGuess((side, side, side), kind, reason="a cube of this size")))
        for n in _SIDES:
            depth, left = divmod(count, n * n)
            if not left and 8 <= depth <= 4 * n and depth != n:
                found.append(
                    (1 + abs(np.log(depth / n)), RawGuess((n, n, depth), kind, reason="square slices"))
                )
    return [g for _, g in sorted(found, key=lambda pair: pair[0])][:12]


def _name(dtype: np.dtype) -> str:
    # NumPy knows ">i2", but not ">int16".
    return dtype.str if dtype.byteorder == ">" else dtype.name
