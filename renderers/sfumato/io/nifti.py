"""NIfTI-1, NIfTI-2 and Analyze 7.5, read here so that no axis is straightened silently.

Source: the NIfTI-1 header file nifti1.h (methods 1 to 3 for the orientation), and NIfTI-2's.
"""

from __future__ import annotations

import gzip
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from .reading import Reading, Source, Task, check_claim, check_memory, pick_frame
from .voxels import component_notice, is_colour, one_value

_DTYPES = {
    2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 128: "u1", 256: "i1", 512: "u2", 768: "u4",
    1024: "i8", 1280: "u8", 2304: "u1",
}  # fmt: skip
_COLOURS = {128: 3, 2304: 4}
_UNIT_MM = {1: 1000.0, 2: 1.0, 3: 1e-3}
#: RAS (NIfTI's world) to LPS (ours).
_LPS = np.diag([-1.0, -1.0, 1.0])


@dataclass(frozen=True)
class Header:
    """What of a header is used; lengths as stored, in the file's own unit."""

    dim: tuple[int, ...]
    datatype: int
    order: str
    pixdim: tuple[float, ...]
    offset: int
    slope: float
    inter: float
    qform: int
    sform: int
    quatern: tuple[float, ...]
    qoffset: tuple[float, ...]
    srow: tuple[float, ...]
    unit: int
    magic: bytes


def is_nifti(head: bytes) -> bool:
    """Whether a file that begins like this (after unpacking) is NIfTI or Analyze."""
    return len(head) >= 4 and any(struct.unpack(e + "i", head[:4])[0] in (348, 540) for e in "<>")


def open_packed(path: Path) -> BinaryIO:
    """Open a file for reading, through gzip if it is packed."""
    with path.open("rb") as stream:
        packed = stream.read(2) == b"\x1f\x8b"
    return gzip.open(path, "rb") if packed else path.open("rb")  # type: ignore[return-value]


def read(task: Task) -> Reading:
    """Read a NIfTI file, or a pair of header and image file."""
    header_path, voxel_path = _pair(task)
    with open_packed(header_path) as stream:
        header = parse(stream.read(540), task)
    notices: list[str] = []
    axes, origin, known = geometry(header)
    source = _source(header, voxel_path, header_path == voxel_path, task, notices)
    return Reading(source, axes, origin, "", known, notices=notices)


def _pair(task: Task) -> tuple[Path, Path]:
    path = task.path
    name = path.name.lower()
    if name.endswith((".img", ".img.gz", ".hdr", ".hdr.gz")):
        stem = path.name[: -len(".hdr.gz" if name.endswith(".gz") else ".hdr")]
        header, image = (_existing(path.parent, stem, kind) for kind in ("hdr", "img"))
        if header is None or image is None:
            raise task.error("it is half of a pair", f"put {stem}.hdr and {stem}.img side by side")
        return header, image
    return path, path


def _existing(folder: Path, stem: str, kind: str) -> Path | None:
    options = (kind, kind.upper(), kind + ".gz")
    return next((folder / f"{stem}.{o}" for o in options if (folder / f"{stem}.{o}").is_file()), None)


def parse(raw: bytes, task: Task) -> Header:
    """Return the header from the first 540 bytes (348 are enough for NIfTI-1)."""
    for order in "<>":
        size = struct.unpack(order + "i", raw[:4])[0] if len(raw) >= 4 else 0
        if size == 348 and len(raw) >= 348:
            return _parse_1(raw, order)
        if size == 540 and len(raw) >= 540:
            return _parse_2(raw, order)
    raise task.error("its header is not NIfTI or is cut off", "copy or export it again")


def _parse_1(raw: bytes, order: str) -> Header:
    def get(kind: str, at: int) -> tuple[float, ...]:
        return struct.unpack_from(order + kind, raw, at)

    offset, slope, inter = get("3f", 108)
    qform, sform = get("2h", 252)
    nifti = raw[344:347] in (b"n+1", b"ni1")
    dims = tuple(int(n) for n in get("8h", 40))
    return Header(
        dims, int(get("h", 70)[0]), order, get("8f", 76), int(offset) if 0 <= offset < 2**31 else 0,
        slope if nifti else 0.0, inter if nifti else 0.0,
        int(qform) if nifti else 0, int(sform) if nifti else 0,
        get("3f", 256), get("3f", 268), get("12f", 280), raw[123] & 7 if nifti else 0, raw[344:347],
    )  # fmt: skip


def _parse_2(raw: bytes, order: str) -> Header:
    def get(kind: str, at: int) -> tuple[float, ...]:
        return struct.unpack_from(order + kind, raw, at)

    qform, sform = get("2i", 344)
    slope, inter = get("2d", 176)
    dims = tuple(int(n) for n in get("8q", 16))
    return Header(
        dims, int(get("h", 12)[0]), order, get("8d", 104), int(get("q", 168)[0]), slope, inter,
        int(qform), int(sform), get("3d", 352), get("3d", 376), get("12d", 400),
        int(get("i", 500)[0]) & 7, raw[4:7],
    )  # fmt: skip


# -- geometry --------------------------------------------------------------------------------------
def geometry(header: Header) -> tuple[np.ndarray, np.ndarray | None, bool]:
    """Return axes (columns, mm, LPS), origin and whether the orientation is the patient's."""
    unit = _UNIT_MM.get(header.unit, 1.0)
    if header.sform > 0:
        matrix = np.array(header.srow, dtype=float).reshape(3, 4) * unit
        if np.isfinite(matrix).all() and abs(np.linalg.det(matrix[:, :3])) > 0:
            return _LPS @ matrix[:, :3], _LPS @ matrix[:, 3], True
    steps = np.abs(np.array(header.pixdim[1:4], dtype=float)) * unit
    steps = np.where(np.isfinite(steps) & (steps > 0), steps, 1.0)
    if header.qform > 0:
        sign = -1.0 if header.pixdim[0] < 0 else 1.0
        axes = _rotation(header.quatern) * (steps * (1.0, 1.0, sign))
        return _LPS @ axes, _LPS @ (np.array(header.qoffset) * unit), True
    # Method 1: no orientation is promised; by custom x grows to the right, y to the front, z upwards.
    return _LPS @ np.diag(steps), None, False


def _rotation(quatern: tuple[float, ...]) -> np.ndarray:
    b, c, d = (float(q) for q in quatern)
    a = np.sqrt(max(0.0, 1.0 - (b * b + c * c + d * d)))
    length = np.sqrt(a * a + b * b + c * c + d * d)
    a, b, c, d = a / length, b / length, c / length, d / length
    return np.array(
        [
            [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c],
        ]
    )


# -- voxels ----------------------------------------------------------------------------------------
def _source(header: Header, path: Path, single: bool, task: Task, notices: list[str]) -> Source:
    if header.datatype not in _DTYPES:
        raise task.error(
            f"voxels of NIfTI type {header.datatype} are not supported", "convert it to real numbers"
        )
    rank = header.dim[0]
    if not 1 <= rank <= 7 or any(n < 0 for n in header.dim[1 : rank + 1]):
        raise task.error(
            "the dimensions in its header make no sense", "it is damaged: copy or export it again"
        )
    nx, ny, nz, *rest = [*header.dim[1 : rank + 1], 1, 1, 1][: max(rank, 3)]
    vectors = rest[1] if len(rest) > 1 and rest[0] <= 1 else 1  # 5D with one time: NIfTI's form of vectors
    frames = int(np.prod(rest, dtype=np.int64)) // max(1, vectors) if rest else 1
    dtype = np.dtype(header.order + _DTYPES[header.datatype])
    colours = _COLOURS.get(header.datatype, 1)
    frame = pick_frame(task, frames, notices)
    count = nx * ny * nz
    nbytes = count * dtype.itemsize * colours
    start = (max(header.offset, 352 if len(header.magic) and single else 0)) + frame * nbytes
    stored = path.stat().st_size
    with path.open("rb") as raw:
        packed = raw.read(2) == b"\x1f\x8b"
    check_claim(task, start + nbytes * vectors, stored, packed)
    if vectors > 1:
        return _vector_source(path, dtype, (nz, ny, nx), start, vectors, task, notices)
    if colours > 1:
        notices.append(component_notice(dtype, colours))
    return _stream(header, path, dtype, (nz, ny, nx), colours, start, task)


def _stream(
    header: Header,
    path: Path,
    dtype: np.dtype,
    shape: tuple[int, int, int],
    colours: int,
    start: int,
    task: Task,
) -> Source:
    slope, inter = _scaling(header)
    scaled = (slope, inter) != (1.0, 0.0)
    whole = dtype.kind in "iu" and slope == 1 and inter.is_integer() and dtype.itemsize <= 2
    result = (np.dtype(np.int32) if whole else np.dtype(np.float32)) if scaled else dtype
    stream = open_packed(path)
    plane = shape[1] * shape[2] * colours

    def planes(z0: int, z1: int) -> np.ndarray:
        stream.seek(start + z0 * plane * dtype.itemsize)
        raw = read_exactly(stream, (z1 - z0) * plane * dtype.itemsize, task)
        voxels = np.frombuffer(raw, dtype=dtype)
        if colours > 1:
            return one_value(voxels.reshape(z1 - z0, shape[1], shape[2], colours))
        voxels = voxels.reshape(z1 - z0, shape[1], shape[2])
        if not scaled:
            return voxels
        return (
            voxels.astype(np.int32) + np.int32(inter)
            if whole
            else (voxels * slope + inter).astype(np.float32)
        )

    return Source(shape, result, planes, stream.close)


def read_exactly(stream: BinaryIO, nbytes: int, task: Task) -> bytes:
    """Read a number of bytes; a `LoadError` if the file ends before."""
    try:
        raw = stream.read(nbytes)
    except (EOFError, OSError, ValueError) as error:
        raise task.error(
            f"its packed data end too early or are damaged ({error})", "copy or export it again"
        ) from error
    if len(raw) != nbytes:
        raise task.error("it ends before its last voxel", "it is truncated: copy or export it again")
    return raw


def _scaling(header: Header) -> tuple[float, float]:
    slope, inter = float(header.slope), float(header.inter)
    if not np.isfinite(slope) or slope == 0:
        return 1.0, 0.0
    return slope, inter if np.isfinite(inter) else 0.0


def _vector_source(
    path: Path,
    dtype: np.dtype,
    shape: tuple[int, int, int],
    start: int,
    count: int,
    task: Task,
    notices: list[str],
) -> Source:
    nbytes = int(np.prod(shape, dtype=np.int64)) * count * dtype.itemsize
    check_memory(task, 2 * nbytes)
    with open_packed(path) as stream:
        stream.seek(start)
        voxels = np.frombuffer(read_exactly(stream, nbytes, task), dtype=dtype).reshape(count, *shape)
    notices.append(component_notice(dtype, count))
    colour = is_colour(dtype, count)
    return Source(
        shape,
        dtype if colour else np.dtype(np.float32),
        lambda z0, z1: one_value(np.moveaxis(voxels[:, z0:z1], 0, -1)),
    )
