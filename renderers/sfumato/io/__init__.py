"""Readers: a file or folder in, a `sfumato.Volume` out; everything untrusted enters here.

One module a format family; each hands back a `reading.Reading` (voxels that are read piece by piece, axes
in mm, notices), and `finish` turns it into a volume: checked, shrunk to the budget, straightened. Packages
that only one format needs are imported when such a file is opened.

Geometry is LPS throughout; ``origin`` is the centre of voxel 0; the columns of ``direction`` are the array's
axes x, y and z. Whatever a reader had to decide is told in ``volume.info.notices``. On bad input only
`LoadError` (with its kin `LoadCancelled`) leaves this package.
"""

from __future__ import annotations

import dataclasses
import importlib
import logging
import os
import warnings
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import LoadError, SfumatoError
from ..scene import Volume
from . import dicom, formats, raw
from .dicom_header import is_dicom
from .dicom_series import SeriesInfo
from .finish import finish
from .formats import SUPPORTED
from .known import OtherContent, load_known
from .moved import MissingVolume, find_moved
from .raw import NeedsDescription, RawGuess
from .reading import Cancel, LoadCancelled, Progress, Reading, Source, Task

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = [
    "SUPPORTED",
    "LoadCancelled",
    "MissingVolume",
    "NeedsDescription",
    "OtherContent",
    "RawGuess",
    "SeriesInfo",
    "describe_raw",
    "find_moved",
    "find_series",
    "guess_raw",
    "load",
    "load_known",
    "load_raw",
    "preview_series",
    "reduce_volume",
    "register_scheme",
]

#: Largest size of the voxels in memory, unless the caller says otherwise.
BUDGET_BYTES = 2 << 30

_schemes: dict[str, Callable[[str], Volume]] = {}
#: Packages that register a scheme when they are imported, or offer ``load(name)``.
_SCHEME_PACKAGES = {"sample": "sfumato_samples"}


def load(
    path: str | os.PathLike[str],
    *,
    level: int | None = None,
    series: str | int | None = None,
    frame: int = 0,
    budget_bytes: int | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Volume:
    """Read a volume from a file, a folder (DICOM, slices, OME-Zarr), or a generator (``sample:hand``).

    Parameters
    ----------
    path : str or path
        What to read.
    level : int, optional
        Level of an OME-Zarr pyramid, 0 the finest; for other formats, how often to halve the resolution.
        By default the finest that fits the budget.
    series : str or int, optional
        Which DICOM series of a folder: the key, or the place, of one of `find_series`. By default that with
        most slices.
    frame : int
        Which frame (time, phase, channel) of a file with several.
    budget_bytes : int, optional
        Largest size of the voxels in memory (default 2 GiB); what is larger is reduced, with a notice.
    progress : callable (fraction, text), optional
        Told how far the work is, 0..1; called in the thread that loads.
    cancel : callable () -> bool, optional
        Asked between bounded pieces of work; once true, `LoadCancelled` is raised.

    Returns
    -------
    Volume
        ``info.notices`` says what was done to the data.

    Raises
    ------
    LoadError
        With the file, what is wrong with it and what can be done.
    LoadCancelled
        If ``cancel`` said so.
    """
    text = os.fspath(path)
    scheme, colon, name = text.partition(":")
    if colon and (scheme in _schemes or scheme in _SCHEME_PACKAGES):
        return _generated(scheme, name, text)
    task = Task(
        Path(text),
        level,
        series,
        frame,
        BUDGET_BYTES if budget_bytes is None else int(budget_bytes),
        progress,
        cancel,
    )
    with guarded(task):
        task.step(0.0, "Opening")
        return finish(formats.read(task), task)


def find_series(
    path: str | os.PathLike[str], *, progress: Progress | None = None, cancel: Cancel | None = None
) -> tuple[SeriesInfo, ...]:
    """Return the DICOM series in a folder (or of a DICOM file), most slices first; empty if there is none."""
    task = Task(Path(path), progress=progress, cancel=cancel)
    with guarded(task):
        if not task.path.exists():
            raise task.error("there is no such file or folder", "check the path")
        if task.path.is_file() and not is_dicom(task.path):
            return ()
        return dicom.find_series(task.path, task)


def guess_raw(path: str | os.PathLike[str]) -> list[RawGuess]:
    """Return ways to read a raw file whose size agrees with it, best first, for a dialog; may be empty."""
    task = Task(Path(path))
    with guarded(task):
        return raw.guess(task.path)


def describe_raw(path: str | os.PathLike[str], how: RawGuess) -> None:
    """Write how to read a raw file into a JSON file beside it, which `load` heeds.

    Raises
    ------
    LoadError
        If the folder cannot be written.
    """
    task = Task(Path(path))
    with guarded(task):
        raw.describe(task.path, how)


def preview_series(
    path: str | os.PathLike[str], show: Callable[[str, np.ndarray], object], *, cancel: Cancel | None = None
) -> None:
    """Hand over the middle slice of each DICOM series of a folder, one after the other, for a dialog.

    Parameters
    ----------
    show : callable (key, slice)
        Called in this thread; the slice in units (Hounsfield ...), shape (rows, columns). A series whose
        pixels cannot be decoded is left out.
    cancel : callable () -> bool, optional
        As in `load`.

    Raises
    ------
    LoadError
        If the folder cannot be read.
    LoadCancelled
        If ``cancel`` said so.
    """
    task = Task(Path(path), cancel=cancel)
    with guarded(task):
        for key, plane in dicom.middle_slices(task.path, task):
            show(key, plane)


def reduce_volume(
    volume: Volume, *, progress: Progress | None = None, cancel: Cancel | None = None
) -> Volume:
    """Return a volume at half its resolution, for a device that has no room for the whole.

    Raises
    ------
    LoadError
        If it is too small for that, or there is not enough memory.
    LoadCancelled
        If ``cancel`` said so.
    """
    task = Task(Path(volume.info.path), level=1, progress=progress, cancel=cancel)
    axes = np.asarray(volume.direction) * np.asarray(volume.spacing)
    info = volume.info
    with guarded(task):
        made = finish(
            Reading(
                Source.of(volume.data), axes, np.asarray(volume.origin), info.modality,
                info.orientation_known, info.name, list(info.notices),
            ),
            task,
        )  # fmt: skip
        # What Path makes of "sample:hand" or an empty text is not what the volume was called.
        return dataclasses.replace(made, info=dataclasses.replace(made.info, path=info.path))


def load_raw(
    path: str | os.PathLike[str],
    dims: tuple[int, int, int],
    dtype: str,
    spacing: tuple[float, float, float] = (1.0, 1.0, 1.0),
    *,
    offset: int = 0,
    budget_bytes: int | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Volume:
    """Read bare voxels.

    Parameters
    ----------
    dims : (int, int, int)
        Voxels along x, y, z; x runs fastest.
    dtype : str
        NumPy's name of the type; ``>`` in front for big endian, as in ``>u2``.
    spacing : (float, float, float)
        In mm along x, y, z.
    offset : int
        Bytes before the first voxel.
    budget_bytes, progress, cancel
        As in `load`.

    Raises
    ------
    LoadError
        If the file is too short, or its description makes no sense.
    """
    task = Task(
        Path(path),
        budget_bytes=BUDGET_BYTES if budget_bytes is None else budget_bytes,
        progress=progress,
        cancel=cancel,
    )
    with guarded(task):
        return finish(raw.source(task, RawGuess(dims, dtype, spacing, offset)), task)


def register_scheme(scheme: str, loader: Callable[[str], Volume]) -> None:
    """Let ``load("scheme:name")`` call ``loader(name)``: how packages above the core offer their volumes."""
    _schemes[scheme] = loader


def _generated(scheme: str, name: str, text: str) -> Volume:
    if scheme not in _schemes:
        package = _SCHEME_PACKAGES[scheme]
        try:
            module = importlib.import_module(package)
        except ImportError:
            raise LoadError(
                text, f"the package {package} is not installed", "install Sfumato again"
            ) from None
        _schemes.setdefault(scheme, module.load)
    try:
        return _schemes[scheme](name)
    except SfumatoError:
        raise
    except (KeyError, ValueError) as error:
        raise LoadError(
            text, f"there is no {scheme} of this name ({error})", "see the list of samples"
        ) from error


@contextmanager
def _quiet_loggers() -> Iterator[None]:
    """Keep readers' libraries from writing to stderr what a `LoadError` or a notice says better."""
    loggers = [logging.getLogger(name) for name in ("tifffile", "pydicom")]
    before = [logger.disabled for logger in loggers]
    for logger in loggers:
        logger.disabled = True
    try:
        yield
    finally:
        for logger, disabled in zip(loggers, before, strict=True):
            logger.disabled = disabled


@contextmanager
def guarded(task: Task) -> Iterator[None]:
    """Let nothing but `SfumatoError` out, and no library's warnings."""
    try:
        with warnings.catch_warnings(), _quiet_loggers():
            warnings.simplefilter("ignore")
            yield
    except LoadError:
        raise
    except LoadCancelled:
        raise
    except SfumatoError as error:
        raise task.error(str(error)) from error
    except MemoryError as error:
        raise task.error(
            "there is not enough memory to read it", "close other programs, or lower the budget"
        ) from error
    except PermissionError as error:
        raise task.error("it may not be read", "check its permissions") from error
    except Exception as error:  # a reader's library, on input nobody foresaw
        reason = next(iter(str(error).strip().splitlines()), "") or type(error).__name__
        raise task.error(
            f"it cannot be read ({reason[:200]})", "it may be damaged: copy or export it again"
        ) from error
