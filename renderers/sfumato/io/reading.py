"""What every reader hands back, and the task it works for (options, progress, cancel)."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

import numpy as np

from ..errors import LoadError, SfumatoError

Progress = Callable[[float, str], object]
Cancel = Callable[[], bool]


class LoadCancelled(SfumatoError):  # noqa: N818  (it is no error of anybody)
    """Loading was stopped by its caller (the ``cancel`` callable returned true)."""

    def __init__(self, path: object) -> None:
        self.path = str(path)
        super().__init__(f"{self.path}: loading was cancelled")


@dataclass(frozen=True)
class Task:
    """One call of ``load``: what is read, with which options, and who wants to know how far it is.

    Parameters
    ----------
    path : Path
        File or folder, for messages too.
    level : int, optional
        Pyramid level (OME-Zarr); for other formats the number of times the resolution is halved.
    series : str or int, optional
        Which DICOM series of a folder: its key, or its place in ``find_series``.
    frame : int
        Which frame (time, phase, echo) of a 4D file.
    budget_bytes : int
        Largest size of the voxels in memory after reading.
    """

    path: Path
    level: int | None = None
    series: str | int | None = None
    frame: int = 0
    budget_bytes: int = 2 << 30
    progress: Progress | None = None
    cancel: Cancel | None = None

    def step(self, fraction: float, text: str) -> None:
        """Tell how far the work is (0..1); raise `LoadCancelled` if nobody wants it any more."""
        if self.cancel is not None and self.cancel():
            raise LoadCancelled(self.path)
        if self.progress is not None:
            self.progress(min(max(fraction, 0.0), 1.0), text)

    def error(self, problem: str, remedy: str = "") -> LoadError:
        """Return the error that says what is wrong with this task's file."""
        return LoadError(self.path, problem, remedy)


def _nothing() -> None:
    pass


@dataclass(frozen=True)
class Source:
    """Voxels that are read piece by piece, front to back along z.

    Parameters
    ----------
    shape : (int, int, int)
        Number of voxels along z, y and x.
    dtype : numpy dtype
        Type of what ``read`` returns.
    read : callable (z0, z1) -> ndarray, shape (z1 - z0, y, x)
        Reads some planes; called with growing z.
    """

    shape: tuple[int, int, int]
    dtype: np.dtype
    read: Callable[[int, int], np.ndarray]
    close: Callable[[], object] = _nothing

    @classmethod
    def of(cls, array: np.ndarray) -> Source:
        """Wrap an array (z, y, x) in memory, or mapped from a file."""
        z, y, x = array.shape
        return cls((z, y, x), array.dtype, lambda z0, z1: array[z0:z1])


@dataclass
class Reading:
    """A volume as its file describes it, before it is checked, shrunk and made a `Volume`.

    Parameters
    ----------
    source : Source
        The voxels.
    axes : ndarray, shape (3, 3)
        Columns: the step in mm (LPS) from one voxel to the next along the array's x, y and z axis.
    origin : ndarray, shape (3,), optional
        Centre of voxel 0 in mm.
    modality, orientation_known, name, notices
        As in `sfumato.VolumeInfo`.
    """

    source: Source
    axes: np.ndarray = field(default_factory=lambda: np.eye(3))
    origin: np.ndarray | None = None
    modality: str = ""
    orientation_known: bool = False
    name: str = ""
    notices: list[str] = field(default_factory=list)
    #: The reader has chosen the pyramid level itself.
    level_done: bool = False
    #: How much of the work (0..1) was done before the voxels are read.
    begun: float = 0.0


def need(module: str, task: Task) -> ModuleType:
    """Import an optional package, or say how to get it."""
    try:
        return importlib.import_module(module)
    except ImportError:
        package = {"vtkmodules": "vtk"}.get(module.split(".")[0], module.split(".")[0])
        raise task.error(
            f"reading this format needs {package}", 'install it with: pip install "sfumato[io]"'
        ) from None


def physical_memory() -> int:
    """Return the machine's memory in bytes (16 GiB where the system does not tell)."""
    try:
        return int(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return 16 << 30


def check_claim(task: Task, claimed: int, stored: int, compressed: bool = False) -> None:
    """Refuse a header that promises more than the file can hold or the machine can take, before allocating.

    Parameters
    ----------
    claimed : int
        Bytes of voxels that the header announces.
    stored : int
        Bytes that the file has for them.
    compressed : bool
        Whether they are packed: deflate, the usual case, reaches 1032 : 1; zstd and LZMA more.
    """
    if claimed > stored * (20000 if compressed else 1):
        raise task.error(
            f"it announces {size_text(claimed)} of voxels, but has only {size_text(stored)} of data",
            "it is truncated or damaged: copy or export it again",
        )


def check_memory(task: Task, nbytes: int) -> None:
    """Refuse what must be read in one piece and cannot fit into the machine's memory."""
    limit = int(0.8 * physical_memory())
    if nbytes > limit:
        raise task.error(
            f"reading it takes {size_text(nbytes)} of memory, this machine can spare {size_text(limit)}",
            "crop it, or convert it to OME-Zarr, uncompressed NRRD or .npy, which are read piece by piece",
        )


def size_text(nbytes: float) -> str:
    """Return a number of bytes for people: ``3.2 MiB``."""
    for unit in ("bytes", "KiB", "MiB", "GiB"):
        if nbytes < 1024:
            return f"{nbytes:.0f} {unit}" if unit == "bytes" else f"{nbytes:.1f} {unit}"
        nbytes /= 1024
    return f"{nbytes:.1f} TiB"


def pick_frame(task: Task, count: int, notices: list[str], what: str = "frames") -> int:
    """Return the frame of a 4D file that the task asks for, and add the notice that says so."""
    if count < 1:
        raise task.error("it holds no voxels")
    if not 0 <= task.frame < count:
        raise task.error(f"there is no frame {task.frame}", f"it has {count}: 0 to {count - 1}")
    if count > 1:
        notices.append(f"The file holds {count} {what}; number {task.frame + 1} is shown.")
    return task.frame
