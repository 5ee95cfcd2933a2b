"""SLC, the format of VolVis: a text header, an icon, and slices of bytes that may be run-length coded.

Source: the VolVis file format as VTK's vtkSLCReader documents it; checked against that reader in the tests.
"""

from __future__ import annotations

import re
from typing import BinaryIO

import numpy as np

from .nifti import read_exactly
from .reading import Reading, Source, Task, check_claim

_NUMBER = rb"([-+0-9.eE]+)"
_HEADER = re.compile(
    rb"\s*11111\s+" + rb"\s+".join([_NUMBER] * 7) + rb"\s+" + rb"\s+".join([rb"(\d+)"] * 6) + rb"\s*X"
)


def read(task: Task) -> Reading:
    """Read an SLC volume of 8 bits."""
    with task.path.open("rb") as stream:
        head = stream.read(1024)
    match = _HEADER.match(head)
    try:
        nx, ny, nz, bits = (int(match.group(i)) for i in range(1, 5))  # type: ignore[union-attr]
        spacing = [float(match.group(i)) for i in range(5, 8)]  # type: ignore[union-attr]
        packing, width, height = (int(match.group(i)) for i in (11, 12, 13))  # type: ignore[union-attr]
    except (AttributeError, ValueError):
        raise task.error("its SLC header cannot be read", "it is damaged: copy it again") from None
    if bits != 8 or packing not in (0, 1):
        raise task.error(f"{bits}-bit SLC with compression {packing} is not supported", "convert it to NRRD")
    check_claim(task, nx * ny * nz, task.path.stat().st_size, compressed=packing == 1)
    stream = task.path.open("rb")
    stream.seek(match.end() + 3 * width * height)  # type: ignore[union-attr]

    def planes(z0: int, z1: int) -> np.ndarray:
        return np.stack([_plane(stream, ny * nx, packing, task).reshape(ny, nx) for _ in range(z0, z1)])

    return Reading(Source((nz, ny, nx), np.dtype(np.uint8), planes, stream.close), np.diag(spacing))


def _plane(stream: BinaryIO, size: int, packing: int, task: Task) -> np.ndarray:
    if packing == 0:
        return np.frombuffer(read_exactly(stream, size, task), dtype=np.uint8)
    digits = b""
    while not digits.endswith(b"X") and len(digits) < 24:
        digits += read_exactly(stream, 1, task)
    try:
        length = int(digits[:-1])
    except ValueError:
        raise task.error(
            "one of its slices does not begin with a length", "it is damaged: copy it again"
        ) from None
    if not 0 <= length <= 2 * size + 1024:
        raise task.error("one of its slices has an impossible length", "it is damaged: copy it again")
    return _unpack(read_exactly(stream, length, task), size, task)


def _unpack(packed: bytes, size: int, task: Task) -> np.ndarray:
    """Undo the run lengths: a byte says how many, its top bit whether literal or one repeated; 0 ends.

    VolVis itself drops the last voxel of a slice; it counts as 0.
    """
    out, at = bytearray(), 0
    while at < len(packed):
        count = packed[at] & 0x7F
        if count == 0:
            break
        if packed[at] & 0x80:
            out += packed[at + 1 : at + 1 + count]
            at += 1 + count
        else:
            out += packed[at + 1 : at + 2] * count
            at += 2
    out += bytes(size - len(out) == 1)
    if len(out) != size:
        raise task.error("one of its slices unpacks to a wrong length", "it is damaged: copy it again")
    return np.frombuffer(bytes(out), dtype=np.uint8)
