"""Which reader a file or folder needs: told by content first, by its name where the content is silent."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from . import dicom, itk, nifti, npy, raw, slc, tiff, vtk, zarr
from .dicom_header import is_dicom
from .reading import Reading, Task

SUPPORTED = (
    "DICOM, NIfTI, NRRD, MetaImage, MINC, Analyze, VTI, legacy VTK, TIFF, OME-Zarr, .npy, .npz, "
    "RAW with a sidecar, SLC"
)
#: Readers by the end of the name; used for what lies in a folder, and where the content does not tell.
_VOLUME_NAMES = re.compile(
    r"\.(nii|nii\.gz|nrrd|nhdr|mha|mhd|mnc|vti|vtr|vtk|npy|npz|slc|hdr|dcm|zarr|gipl|gipl\.gz|mrc)$",
    re.IGNORECASE,
)
_OTHER_ITK = re.compile(r"\.(gipl|gipl\.gz|mrc|map|pic|lsm)$", re.IGNORECASE)


def read(task: Task) -> Reading:
    """Read a file or folder with the reader of its format."""
    if not task.path.exists():
        raise task.error("there is no such file or folder", "check the path")
    return _folder(task) if task.path.is_dir() else _file(task)


def _file(task: Task) -> Reading:
    if task.path.stat().st_size == 0:
        raise task.error("it is empty", "copy or export it again")
    reader = _by_content(task.path) or _by_name(task.path)
    if reader is None:
        raise task.error("its format is not known", f"these are: {SUPPORTED}")
    return reader(task)


def _by_content(path: Path) -> Callable[[Task], Reading] | None:
    with path.open("rb") as stream:
        head = stream.read(512)
    if head[128:132] == b"DICM":  # first, since the preamble before it may look like a TIFF
        return dicom.read
    if tiff.is_tiff(head):
        return itk.read_other if path.suffix.lower() == ".lsm" else tiff.read
    signs: tuple[tuple[bytes, Callable[[Task], Reading]], ...] = (
        (b"NRRD000", itk.read_nrrd),
        (b"\x93NUMPY", npy.read),
        (b"# vtk DataFile", vtk.read),
        (b"11111", slc.read),
    )
    for sign, reader in signs:
        if head.startswith(sign):
            return reader
    if head.lstrip().startswith(b"<") and b"<VTKFile" in head:
        return vtk.read
    if re.match(rb"\s*(ObjectType|NDims|Comment)\s*=", head):
        return itk.read_meta
    if is_dicom(path):
        return dicom.read
    return nifti.read if _is_nifti(path, head) else None


def _is_nifti(path: Path, head: bytes) -> bool:
    if head[:2] == b"\x1f\x8b":
        try:
            with nifti.open_packed(path) as stream:
                head = stream.read(352)
        except (OSError, EOFError):
            return False
    return nifti.is_nifti(head)


def _by_name(path: Path) -> Callable[[Task], Reading] | None:
    name = path.name.lower()
    if name.endswith((".nii", ".nii.gz", ".hdr", ".img", ".img.gz")):
        return nifti.read
    if name.endswith((".npz", ".npy")):
        return npy.read
    if name.endswith(".mnc"):
        return itk.read_minc
    if _OTHER_ITK.search(name):
        return itk.read_other
    if name.endswith((".raw", ".bin", ".dat")):
        return _raw
    damaged = {
        ".nrrd": "NRRD",
        ".mha": "MetaImage",
        ".mhd": "MetaImage",
        ".vti": "VTK",
        ".vtk": "VTK",
        ".slc": "SLC",
        ".dcm": "DICOM",
    }
    kind = damaged.get(path.suffix.lower()) or ("TIFF" if path.suffix.lower() in (".tif", ".tiff") else None)
    return _damaged(kind) if kind else None


def _damaged(kind: str) -> Callable[[Task], Reading]:
    def fail(task: Task) -> Reading:
        raise task.error(
            f"it is named like a {kind} file, but its content is not {kind}",
            "it is damaged: copy or export it again",
        )

    return fail


def _raw(task: Task) -> Reading:
    header = raw.sidecar(task.path)
    if header is None:
        return raw.read(task)
    return _file(replace(task, path=header))


def _folder(task: Task) -> Reading:
    if zarr.is_zarr(task.path):
        return zarr.read(task)
    if dicom.has_dicom(task.path, task):
        return dicom.read(task)
    volumes = sorted(
        p for p in task.path.iterdir() if _VOLUME_NAMES.search(p.name) and not p.name.startswith(".")
    )
    if len(volumes) == 1:
        return read(replace(task, path=volumes[0]))
    if volumes:
        names = ", ".join(p.name for p in volumes[:6])
        raise task.error(f"the folder holds {len(volumes)} volumes", f"open one of them: {names}")
    slices = tiff.slices_in(task.path)
    if slices:
        return tiff.read_folder(task, slices)
    single = [p for p in task.path.iterdir() if p.suffix.lower() in (".tif", ".tiff", ".raw")]
    if len(single) == 1:
        return read(replace(task, path=single[0]))
    raise task.error("no volume was found in this folder", f"these formats are known: {SUPPORTED}")
