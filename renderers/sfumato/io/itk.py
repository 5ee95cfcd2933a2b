"""NRRD, MetaImage, MINC and the other formats that SimpleITK reads.

Voxels come from SimpleITK; what it loses (whether the axes are the patient's, sheared axes of NRRD) is read
from the text header here. Uncompressed NRRD and MetaImage that exceed the budget are mapped instead of read.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .reading import Reading, Source, Task, check_claim, check_memory, need, pick_frame
from .voxels import one_value_source

#: Type names of NRRD and MetaImage for what may be mapped from disk.
_DTYPES = {
    "MET_UCHAR": "u1", "MET_CHAR": "i1", "MET_USHORT": "u2", "MET_SHORT": "i2", "MET_UINT": "u4",
    "MET_INT": "i4", "MET_FLOAT": "f4", "MET_DOUBLE": "f8",
    "uchar": "u1", "unsigned char": "u1", "uint8": "u1", "uint8_t": "u1",
    "signed char": "i1", "int8": "i1", "int8_t": "i1",
    "short": "i2", "short int": "i2", "signed short": "i2", "int16": "i2", "int16_t": "i2",
    "ushort": "u2", "unsigned short": "u2", "uint16": "u2", "uint16_t": "u2",
    "int": "i4", "signed int": "i4", "int32": "i4", "int32_t": "i4",
    "uint": "u4", "unsigned int": "u4", "uint32": "u4", "uint32_t": "u4", "float": "f4", "double": "f8",
}  # fmt: skip
_ANATOMICAL = {
    "right-anterior-superior": (-1, -1, 1), "ras": (-1, -1, 1),
    "left-anterior-superior": (1, -1, 1), "las": (1, -1, 1),
    "left-posterior-superior": (1, 1, 1), "lps": (1, 1, 1),
}  # fmt: skip
_HEADER_BYTES = 1 << 16


def read_nrrd(task: Task) -> Reading:
    """Read NRRD (.nrrd, or .nhdr with its data beside)."""
    fields, start = nrrd_header(task.path, task)
    reading = _read(task, _nrrd_layout(task, fields, start))
    axes, origin, known = _nrrd_geometry(fields, task)
    if axes is not None:
        reading.axes, reading.origin = axes, origin
    elif not known and origin is None:
        reading.origin = None
    reading.orientation_known = known
    return reading


def read_meta(task: Task) -> Reading:
    """Read MetaImage (.mha, or .mhd with its data beside)."""
    fields, start = meta_header(task.path)
    reading = _read(task, _meta_layout(task, fields, start))
    letters = fields.get("anatomicalorientation", "")
    reading.orientation_known = len(letters) == 3 and set(letters.upper()) <= set("RLAPSI")
    if not any(key in fields for key in ("offset", "position", "origin")):
        reading.origin = None
    return reading


def read_minc(task: Task) -> Reading:
    """Read MINC, whose world is RAS by definition (x to the right, y to the front, z up)."""
    reading = _read(task, None)
    # ITK hands MINC's coordinates on as they are, although its own world is LPS.
    flip = np.array([-1.0, -1.0, 1.0])
    reading.axes = flip[:, None] * reading.axes
    reading.origin = None if reading.origin is None else flip * reading.origin
    reading.orientation_known = True
    return reading


def read_other(task: Task) -> Reading:
    """Read what else SimpleITK knows (GIPL, MRC, BioRad ...)."""
    return _read(task, None)


# -- SimpleITK -------------------------------------------------------------------------------------
def _read(task: Task, layout: tuple[Path, int, np.dtype] | None) -> Reading:
    sitk = need("SimpleITK", task)
    sitk.ProcessObject.GlobalWarningDisplayOff()
    reader = sitk.ImageFileReader()
    reader.SetFileName(str(task.path))
    try:
        reader.ReadImageInformation()
    except RuntimeError as error:
        raise task.error(
            f"its header cannot be read ({_reason(error)})", "copy or export it again"
        ) from error
    size, rank, count = (
        [int(n) for n in reader.GetSize()],
        reader.GetDimension(),
        reader.GetNumberOfComponents(),
    )
    if rank < 3:
        raise task.error("it holds only one slice", "a volume needs at least 2 along each axis")
    notices: list[str] = []
    frames = int(np.prod(size[3:], dtype=np.int64)) if rank > 3 else 1
    frame = pick_frame(task, frames, notices)
    pixel = reader.GetPixelID()
    if "complex" in sitk.GetPixelIDValueAsString(pixel):
        raise task.error("its voxels are complex numbers", "export magnitude or one component")
    itemsize = _itemsize(sitk, pixel)
    voxels = int(np.prod(size[:3], dtype=np.int64))
    check_claim(task, voxels * frames * count * itemsize, _stored(task.path), compressed=layout is None)
    axes, origin = _geometry(reader, rank)
    if layout is not None and voxels * itemsize > task.budget_bytes and count == 1:
        source = _mapped(layout, (size[2], size[1], size[0]), frame, task)
    else:
        check_memory(task, voxels * frames * count * itemsize)
        source = _in_memory(sitk, reader, size, frame, count, task, notices)
    return Reading(source, axes, origin, notices=notices)


def _in_memory(
    sitk: Any, reader: Any, size: list[int], frame: int, count: int, task: Task, notices: list[str]
) -> Source:
    task.step(0.0, "Reading")
    try:
        image = reader.Execute()
    except RuntimeError as error:
        if "No such file" in (reason := _reason(error)):
            raise task.error(
                "the file of voxels that it names is missing", "put it where its header says"
            ) from error
        raise task.error(f"its voxels cannot be read ({reason})", "copy or export it again") from error
    array = sitk.GetArrayViewFromImage(image)
    shape = (size[2], size[1], size[0])
    array = array.reshape(-1, *shape, count)[frame] if count > 1 else array.reshape(-1, *shape)[frame]
    # The view does not keep its image alive: the closures below do.
    if count == 1:
        return Source(shape, array.dtype, lambda z0, z1, keep=image: array[z0:z1])  # type: ignore[misc]
    return one_value_source(shape, array.dtype, count, lambda z0, z1, keep=image: array[z0:z1], notices)


def _itemsize(sitk: Any, pixel: int) -> int:
    name = sitk.GetPixelIDValueAsString(pixel)
    return next((n // 8 for n in (8, 16, 32, 64) if f"{n}-bit" in name), 1)


def _stored(path: Path) -> int:
    """Return the bytes of a file and, for a detached header, of what lies beside it under any name."""
    own = path.stat().st_size
    if path.suffix.lower() in (".mhd", ".nhdr"):
        own += sum(p.stat().st_size for p in path.parent.rglob("*") if p.is_file() and p != path)
    return own


def _geometry(reader: Any, rank: int) -> tuple[np.ndarray, np.ndarray]:
    direction = np.array(reader.GetDirection()).reshape(rank, rank)[:3, :3]
    return direction * np.array(reader.GetSpacing())[:3], np.array(reader.GetOrigin())[:3]


def _reason(error: Exception) -> str:
    """Return the one line of an ITK exception that says something."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return (lines[-1] if lines else type(error).__name__).rpartition("): ")[2][:160]


def _mapped(
    layout: tuple[Path, int, np.dtype], shape: tuple[int, int, int], frame: int, task: Task
) -> Source:
    path, start, dtype = layout
    nbytes = int(np.prod(shape, dtype=np.int64)) * dtype.itemsize
    check_claim(task, start + (frame + 1) * nbytes, path.stat().st_size)
    return Source.of(np.memmap(path, dtype, "r", start + frame * nbytes, shape))


# -- text headers ----------------------------------------------------------------------------------
def nrrd_header(path: Path, task: Task) -> tuple[dict[str, str], int]:
    """Return the fields of a NRRD header, names in lower case, and where attached data begin (bytes)."""
    with path.open("rb") as stream:
        raw = stream.read(_HEADER_BYTES)
    lines, start = [], 0
    for row in raw.split(b"\n"):
        start += len(row) + 1
        if not row.strip():
            break
        lines.append(row.decode("latin-1").rstrip("\r"))
    fields = {}
    for line in lines[1:]:
        name, colon, value = line.partition(":")
        if colon and not line.startswith("#"):
            fields[name.strip().lower()] = value.lstrip("=").strip()
    if "sizes" not in fields or "type" not in fields:
        raise task.error("its NRRD header has no sizes or type", "it is damaged: copy or export it again")
    return fields, start


def meta_header(path: Path) -> tuple[dict[str, str], int]:
    """Return the fields of a MetaImage header, names in lower case, and where attached data begin (bytes)."""
    with path.open("rb") as stream:
        raw = stream.read(_HEADER_BYTES)
    fields, start = {}, 0
    for line in raw.split(b"\n"):
        start += len(line) + 1
        name, equals, value = line.decode("latin-1").partition("=")
        if equals:
            fields[name.strip().lower()] = value.strip()
        if name.strip().lower() == "elementdatafile":
            break
    return fields, start


def _nrrd_layout(task: Task, fields: dict[str, str], start: int) -> tuple[Path, int, np.dtype] | None:
    data = fields.get("data file") or fields.get("datafile")
    plain = fields.get("encoding", "").lower() == "raw" and not any(
        k in fields for k in ("line skip", "byte skip", "lineskip", "byteskip")
    )
    spatial = [k for k in fields.get("kinds", "").lower().split() if k not in ("domain", "space")]
    kind = _DTYPES.get(fields["type"].lower())
    if not plain or spatial or kind is None or (data and (data.startswith("LIST") or "%" in data)):
        return None
    order = ">" if fields.get("endian", "little").lower() == "big" else "<"
    return (task.path.parent / data if data else task.path), 0 if data else start, np.dtype(order + kind)


def _meta_layout(task: Task, fields: dict[str, str], start: int) -> tuple[Path, int, np.dtype] | None:
    data, kind = fields.get("elementdatafile", ""), _DTYPES.get(fields.get("elementtype", "").upper())
    packed = fields.get("compresseddata", "").lower() == "true"
    channels, skip = fields.get("elementnumberofchannels", "1"), fields.get("headersize", "0")
    if (
        packed
        or kind is None
        or channels != "1"
        or not skip.isdigit()
        or " " in data
        or "%" in data
        or data == "LIST"
    ):
        return None
    order = (
        ">"
        if fields.get("binarydatabyteordermsb", fields.get("elementbyteordermsb", "")).lower() == "true"
        else "<"
    )
    own = data.upper() == "LOCAL"
    return (
        (task.path if own else task.path.parent / data),
        start if own else int(skip),
        np.dtype(order + kind),
    )


def _nrrd_geometry(fields: dict[str, str], task: Task) -> tuple[np.ndarray | None, np.ndarray | None, bool]:
    """Return axes and origin in LPS as the header has them (SimpleITK would straighten sheared ones)."""
    space = fields.get("space", "").lower()
    signs = _ANATOMICAL.get(space.removesuffix("-time"))
    text = fields.get("space directions", "")
    vectors = [
        v for v in text.replace(" ", "").replace(")(", ") (").replace("none", " none ").split() if v != "none"
    ]
    if not vectors:
        return None, None, False
    try:
        axes = np.array([[float(c) for c in v.strip("()").split(",")] for v in vectors[:3]]).T
        start = fields.get("space origin", "")
        origin = np.array([float(c) for c in start.strip("() ").split(",")][:3]) if start else None
    except ValueError:
        raise task.error("its space directions cannot be read", "correct the header") from None
    if axes.shape != (3, 3):
        return None, None, False
    flip = np.array(signs or (1, 1, 1), dtype=float)
    return flip[:, None] * axes, None if origin is None else flip * origin, signs is not None
