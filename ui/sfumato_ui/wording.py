"""Errors in words for people."""

from __future__ import annotations

import traceback

from sfumato import GpuError, SfumatoError


def remedy_of(error: BaseException) -> str:
    """Return what would help, as in `GpuError`; nothing if it is not known."""
    if isinstance(error, MemoryError):
        return "smaller picture"
    return error.remedy if isinstance(error, GpuError) else ""


def one_line(error: BaseException) -> str:
    """Return an error in one line for people; unexpected ones with their kind and place."""
    if isinstance(error, SfumatoError):
        return str(error).splitlines()[0]
    if isinstance(error, MemoryError):
        return "Not enough memory for this; close other programs or make the picture smaller"
    frame = traceback.extract_tb(error.__traceback__)[-1]
    text = (str(error).splitlines() or [""])[0]
    return f"{type(error).__name__}: {text} ({frame.filename.rsplit('/', 1)[-1]}, line {frame.lineno})"


def duration(seconds: float) -> str:
    """Return a short time in words."""
    return f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"
