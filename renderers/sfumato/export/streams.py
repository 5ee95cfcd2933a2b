"""PNG and TIFF files that are written band by band, so that a large picture need not be in memory.

Both are RGBA in sRGB with straight alpha, 8 or 16 bits a channel, without loss. (Pillow writes no 16-bit
RGBA; tifffile pulls the strips it writes, where a drawing with progress and cancel has to push them.)
"""

from __future__ import annotations

import struct
import zlib
from typing import BinaryIO, Protocol

import numpy as np

#: Key of our text in a PNG.
KEYWORD = "sfumato-scene"
#: Rows that are filtered at a time; also the rows of a TIFF's strip.
ROWS = 64
_LEVEL = 6
INCH = 0.0254


class PictureStream(Protocol):
    """Takes a picture's rows from top to bottom."""

    def write(self, rows: np.ndarray) -> None:
        """Add rows; uint8 or uint16, shape (n, width, 4)."""
        ...

    def close(self) -> None:
        """Write what comes after the last row."""
        ...


class PngStream:
    """A PNG file (PNG specification, third edition).

    Parameters
    ----------
    stream : binary file
        Open for writing.
    size : (int, int)
        Width and height in pixels.
    bits : int
        8 or 16 for each channel.
    text : str
        Goes into an ``iTXt`` chunk; nothing if empty.
    dpi : float, optional
        Pixels per inch, for the ``pHYs`` chunk.
    """

    def __init__(
        self, stream: BinaryIO, size: tuple[int, int], bits: int, text: str = "", dpi: float | None = None
    ) -> None:
        self._stream = stream
        self._pack = zlib.compressobj(_LEVEL)
        self._pixel = bits // 2
        self._above = np.zeros(size[0] * self._pixel, dtype=np.uint8)
        stream.write(b"\x89PNG\r\n\x1a\n")
        self._chunk(b"IHDR", struct.pack(">IIBBBBB", *size, bits, 6, 0, 0, 0))
        self._chunk(b"sRGB", b"\0")
        if dpi:
            per_metre = round(dpi / INCH)
            self._chunk(b"pHYs", struct.pack(">IIB", per_metre, per_metre, 1))
        if text:
            self._chunk(b"iTXt", KEYWORD.encode() + b"\0\1\0\0\0" + zlib.compress(text.encode(), 9))

    def write(self, rows: np.ndarray) -> None:
        """Add rows; uint8 or uint16, shape (n, width, 4)."""
        for first in range(0, len(rows), ROWS):
            part = rows[first : first + ROWS]
            big_endian = np.ascontiguousarray(part.astype(part.dtype.newbyteorder(">"), copy=False))
            packed = self._pack.compress(self._filtered(big_endian.view(np.uint8).reshape(len(part), -1)))
            if packed:
                self._chunk(b"IDAT", packed)

    def _filtered(self, raw: np.ndarray) -> bytes:
        """Return rows of bytes, each by the filter (none, left, above) that leaves the smallest differences."""
        left, above = raw.copy(), raw.copy()
        left[:, self._pixel :] -= raw[:, : -self._pixel]
        above[0] -= self._above
        above[1:] -= raw[:-1]
        self._above = raw[-1].copy()
        ways = np.stack([raw, left, above])
        # Sum of absolute differences, as the specification proposes (12.7).
        best = np.abs(ways.view(np.int8).astype(np.int16)).sum(axis=2, dtype=np.int64).argmin(axis=0)
        rows = np.empty((len(raw), raw.shape[1] + 1), dtype=np.uint8)
        rows[:, 0] = best
        rows[:, 1:] = ways[best, np.arange(len(raw))]
        return rows.tobytes()

    def close(self) -> None:
        """Write what comes after the last row."""
        self._chunk(b"IDAT", self._pack.flush())
        self._chunk(b"IEND", b"")

    def _chunk(self, kind: bytes, payload: bytes) -> None:
        self._stream.write(struct.pack(">I", len(payload)) + kind + payload)
        self._stream.write(struct.pack(">I", zlib.crc32(kind + payload)))


class TiffStream:
    """A TIFF file (TIFF 6.0): strips packed by Deflate with differences along x; parameters as for `PngStream`."""

    def __init__(
        self, stream: BinaryIO, size: tuple[int, int], bits: int, text: str = "", dpi: float | None = None
    ) -> None:
        self._stream, self._size, self._bits, self._text, self._dpi = stream, size, bits, text, dpi
        self._rest = np.zeros((0, size[0], 4), dtype=np.uint8 if bits == 8 else np.uint16)
        self._offsets: list[int] = []
        self._lengths: list[int] = []
        stream.write(b"II*\0\0\0\0\0")

    def write(self, rows: np.ndarray) -> None:
        """Add rows; uint8 or uint16, shape (n, width, 4)."""
        rows = np.concatenate([self._rest, rows]) if len(self._rest) else rows
        whole = len(rows) // ROWS * ROWS
        for first in range(0, whole, ROWS):
            self._strip(rows[first : first + ROWS])
        self._rest = rows[whole:].copy()

    def _strip(self, rows: np.ndarray) -> None:
        differences = rows.astype(rows.dtype.newbyteorder("<"))
        differences[:, 1:] -= rows[:, :-1]
        packed = zlib.compress(differences.tobytes(), _LEVEL)
        self._offsets.append(self._stream.tell())
        self._lengths.append(len(packed))
        # The directory's values must begin at even places.
        self._stream.write(packed + b"\0" * (len(packed) % 2))

    def close(self) -> None:
        """Write what comes after the last row: the directory, to which the header is made to point."""
        if len(self._rest):
            self._strip(self._rest)
        entries = self._entries()
        start = self._stream.tell()
        place = start + 2 + 12 * len(entries) + 4
        directory, values = struct.pack("<H", len(entries)), b""
        for tag, (kind, count, data) in sorted(entries.items()):
            data += b"\0" * (len(data) % 2)
            where = data.ljust(4, b"\0") if len(data) <= 4 else struct.pack("<I", place + len(values))
            values += data if len(data) > 4 else b""
            directory += struct.pack("<HHI", tag, kind, count) + where
        self._stream.write(directory + b"\0\0\0\0" + values)
        self._stream.seek(4)
        self._stream.write(struct.pack("<I", start))

    def _entries(self) -> dict[int, tuple[int, int, bytes]]:
        """Return the directory: tag to (type, count, values)."""

        def short(*values: int) -> tuple[int, int, bytes]:
            return 3, len(values), struct.pack(f"<{len(values)}H", *values)

        def long(*values: int) -> tuple[int, int, bytes]:
            return 4, len(values), struct.pack(f"<{len(values)}I", *values)

        def words(text: str) -> tuple[int, int, bytes]:
            data = text.encode("ascii", "replace") + b"\0"
            return 2, len(data), data

        from .. import __version__

        resolution = 5, 1, struct.pack("<II", round((self._dpi or 1) * 1000), 1000)
        profile = srgb_profile()
        entries = {
            256: long(self._size[0]), 257: long(self._size[1]), 258: short(*[self._bits] * 4),
            259: short(8), 262: short(2), 273: long(*self._offsets), 277: short(4), 278: long(ROWS),
            279: long(*self._lengths), 282: resolution, 283: resolution, 284: short(1),
            296: short(2 if self._dpi else 1), 305: words(f"sfumato {__version__}"), 317: short(2),
            338: short(2), 34675: (7, len(profile), profile),
        }  # fmt: skip
        if self._text:
            # The space keeps readers that look for their own JSON (tifffile: a brace, and "shape": in it) off ours.
            entries[270] = words(self._text.replace('"shape":', '"shape" :'))
        return entries


def srgb_profile() -> bytes:
    """Return the ICC profile of sRGB."""
    from PIL import ImageCms

    return ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
