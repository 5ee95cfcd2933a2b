"""The scene's JSON in a TIFF file that we wrote (`streams.TiffStream`)."""

from __future__ import annotations

import os
import struct
from typing import BinaryIO

#: Bytes of text that a reader takes.
MAX_TEXT = 1 << 26
MAGIC = b"II*\0"
_DESCRIPTION, _ASCII = 270, 2
_OURS = '{"program": "sfumato'


def read_tiff_text(stream: BinaryIO) -> str | None:
    """Return the text of a TIFF of ours, None for any other file that begins like one.

    Raises
    ------
    struct.error
        If the file ends too soon.
    ValueError
        If it is no TIFF.
    """
    if stream.read(4) != MAGIC:
        raise ValueError("it does not begin as one")
    stream.seek(struct.unpack("<I", stream.read(4))[0])
    count = struct.unpack("<H", stream.read(2))[0]
    for _ in range(count):
        tag, kind, length, place = struct.unpack("<HHII", stream.read(12))
        if tag == _DESCRIPTION:
            if kind != _ASCII or not 4 < length <= MAX_TEXT:
                return None
            stream.seek(place)
            text = stream.read(length).rstrip(b"\0").decode("ascii", "replace")
            return text if text.startswith(_OURS) else None
    return None


def is_tiff_of_ours(path: str | os.PathLike[str]) -> bool:
    """Tell whether a file is a TIFF that carries a scene; other TIFFs are volumes."""
    try:
        with open(path, "rb") as stream:
            return read_tiff_text(stream) is not None
    except (OSError, ValueError, struct.error):
        return False
