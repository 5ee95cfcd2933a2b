"""Stored values of one DICOM frame, whatever its transfer syntax, and their conversion to units."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from .dicom_header import Frame
from .dicom_series import Series
from .reading import Task, need
from .voxels import one_value

#: Transfer syntaxes for which pydicom has no freely licensed plug-in, and the codec of imagecodecs that has.
_CODECS = {
    "1.2.840.10008.1.2.4.50": "jpeg8_decode",
    "1.2.840.10008.1.2.4.51": "jpeg_decode",
    "1.2.840.10008.1.2.4.57": "ljpeg_decode",
    "1.2.840.10008.1.2.4.70": "ljpeg_decode",
    "1.2.840.10008.1.2.4.80": "jpegls_decode",
    "1.2.840.10008.1.2.4.81": "jpegls_decode",
}
_RLE = "1.2.840.10008.1.2.5"
#: No detector has more pixels; a header that says so would only fill the memory.
_MAX_PIXELS = 1 << 28


class Decoder:
    """Decodes frames; the file read last stays open, since the frames of one file are asked in turn."""

    def __init__(self, series: Series, task: Task) -> None:
        self._series, self._task = series, task
        self._open: Callable[[Path], Any] = lru_cache(maxsize=1)(self._read)
        if series.rows * series.columns > _MAX_PIXELS:
            raise task.error(
                f"its header announces {series.columns} x {series.rows} pixels", "the file is damaged"
            )

    def values(self, frame: Frame) -> np.ndarray:
        """Return a frame in units (Hounsfield ...), shape (rows, columns)."""
        series = self._series
        stored = self._stored(frame)
        if stored.ndim == 3:
            stored = one_value(stored)
        if stored.shape != (series.rows, series.columns):
            raise self._task.error(
                f"{frame.file.name} has {stored.shape[::-1]} pixels", "it does not belong to its series"
            )
        if series.inverted and series.modality != "CT":
            low = -(1 << (series.bits - 1)) if series.signed else 0
            stored = (2 * low + (1 << series.bits) - 1) - stored.astype(np.int32)
        return stored

    def _read(self, file: Path) -> Any:
        return need("pydicom", self._task).dcmread(file, force=True)

    def _stored(self, frame: Frame) -> np.ndarray:
        data_set = self._open(frame.file)
        if not any(name in data_set for name in ("PixelData", "FloatPixelData", "DoubleFloatPixelData")):
            raise self._task.error(f"{frame.file.name} holds no pixel data", "export the images again")
        try:
            return self._decode(data_set, frame.index)
        except MemoryError:
            raise
        except Exception as error:
            reason = str(error).splitlines()[0][:160] if str(error) else type(error).__name__
            raise self._task.error(
                f"the pixels of {frame.file.name} cannot be decoded ({reason})",
                "copy the file again, or export it uncompressed",
            ) from error

    def _decode(self, data_set: Any, index: int) -> np.ndarray:
        syntax = getattr(getattr(data_set, "file_meta", None), "TransferSyntaxUID", None)
        if syntax is None:  # no preamble: implicit little endian is what the standard says then
            data_set.ensure_file_meta()
            data_set.file_meta.TransferSyntaxUID = need("pydicom.uid", self._task).ImplicitVRLittleEndian
        elif str(syntax) in _CODECS:
            return self._by_imagecodecs(data_set, index, _CODECS[str(syntax)])
        pixels = need("pydicom.pixels", self._task)
        # The quicker plug-in for run lengths panics on damaged data, and writes that to stderr.
        plugin = "pydicom" if str(syntax) == _RLE else ""
        return np.asarray(pixels.pixel_array(data_set, index=index, decoding_plugin=plugin))

    def _by_imagecodecs(self, data_set: Any, index: int, codec: str) -> np.ndarray:
        encaps, codecs = need("pydicom.encaps", self._task), need("imagecodecs", self._task)
        count = int(data_set.get("NumberOfFrames") or 1)
        packed = encaps.get_frame(data_set.PixelData, index, number_of_frames=count)
        stored = np.asarray(getattr(codecs, codec)(packed))
        bits = int(data_set.BitsStored)
        if data_set.get("PixelRepresentation") and stored.dtype.kind == "u":
            wide = stored.astype(np.int32)
            stored = np.where(wide >= 1 << (bits - 1), wide - (1 << bits), wide)
        return stored


def unit_dtype(series: Series) -> np.dtype:
    """Return the narrowest of int16, uint16, int32 and float32 that holds all values in units exactly."""
    pairs = {(f.slope, f.intercept) for f in series.frames}
    if any(not (s.is_integer() and i.is_integer()) for s, i in pairs) or series.bits > 16:
        return np.dtype(np.float32)
    low = -(1 << (series.bits - 1)) if series.signed else 0
    ends = [s * v + i for s, i in pairs for v in (low, low + (1 << series.bits) - 1)]
    for kind in (np.uint8, np.int16, np.uint16):
        if np.iinfo(kind).min <= min(ends) and max(ends) <= np.iinfo(kind).max:
            return np.dtype(kind)
    return np.dtype(np.int32)


def to_units(stored: np.ndarray, frame: Frame, dtype: np.dtype) -> np.ndarray:
    """Apply a frame's rescale slope and intercept."""
    if dtype == np.float32:
        return (stored.astype(np.float64) * frame.slope + frame.intercept).astype(np.float32)
    if (frame.slope, frame.intercept) == (1.0, 0.0):
        return stored.astype(dtype)
    return (stored.astype(np.int64) * int(frame.slope) + int(frame.intercept)).astype(dtype)
