"""Multi-page TIFF (plain, ImageJ, OME) and folders of slices (TIFF, PNG, JPEG, BMP)."""

from __future__ import annotations

import logging
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LoadError
from .reading import Reading, Source, Task, check_claim, need, pick_frame
from .units import length_mm
from .voxels import component_notice, is_colour, one_value

SLICE_SUFFIXES = (".tif", ".tiff", ".png", ".jpg", ".jpeg", ".bmp")


def is_tiff(head: bytes) -> bool:
    """Whether a file begins like TIFF or BigTIFF."""
    return head[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")


# -- one file --------------------------------------------------------------------------------------
def read(task: Task) -> Reading:
    """Read a multi-page TIFF page by page."""
    tifffile = need("tifffile", task)
    file = tifffile.TiffFile(task.path)
    try:
        with _complaints() as complaints:
            try:
                reading = _reading(file, task)
            except LoadError:
                if not complaints:
                    raise
        if complaints:  # tifffile goes on with the pages before the fault
            raise task.error(
                f"its directory of pages is damaged after {len(file.pages)}", "copy or export it again"
            )
    except BaseException:
        file.close()
        raise
    source = reading.source
    reading.source = Source(source.shape, source.dtype, source.read, file.close)
    return reading


@contextmanager
def _complaints() -> Iterator[list[str]]:
    """Collect what tifffile logs as errors."""
    found: list[str] = []
    logger = logging.getLogger("tifffile")

    def keep(record: logging.LogRecord) -> bool:
        if record.levelno >= logging.ERROR:
            found.append(record.getMessage())
        return False

    before, logger.disabled = logger.disabled, False
    logger.filters.insert(0, keep)
    try:
        yield found
    finally:
        logger.filters.remove(keep)
        logger.disabled = before


def _reading(file: Any, task: Task) -> Reading:
    if not file.series:
        raise task.error("it holds no image", "it is damaged: export it again")
    series = file.series[0]
    notices: list[str] = []
    shape, axes = tuple(int(n) for n in series.shape), str(series.axes)
    colour = axes.endswith("S") and shape[-1] > 1
    if axes.endswith("S"):
        shape, axes = shape[:-1], axes[:-1]
    if len(shape) < 3:
        raise task.error(
            "it holds only one slice", "open the folder of the whole stack, or a multi-page TIFF"
        )
    page = series.keyframe
    stored = task.path.stat().st_size
    check_claim(task, math.prod(series.shape) * page.dtype.itemsize, stored, compressed=page.compression != 1)
    if not axes.endswith("YX"):
        raise task.error(f"its axes are {axes}", "export it with planes (Y, X) last")
    first, step, depth = _stack(shape, axes, task, notices)
    if colour:
        notices.append(component_notice(page.dtype, int(series.shape[-1])))
    read = _page_reader(file, series, first, step, shape[-2:], colour, task)
    dtype = page.dtype if not colour or is_colour(page.dtype, int(series.shape[-1])) else np.dtype(np.float32)
    spacing = _spacing(file, page, notices)
    return Reading(Source((depth, shape[-2], shape[-1]), dtype, read), np.diag(spacing), notices=notices)


def _stack(shape: tuple[int, ...], axes: str, task: Task, notices: list[str]) -> tuple[int, int, int]:
    """Return the first page, the step from slice to slice, and the number of slices."""
    leading, letters = shape[:-2], axes[:-2]
    # Z is depth; without one, the longest of the unnamed axes (I, Q: pages) or of time.
    depth = letters.find("Z")
    if depth < 0:
        depth = max(range(len(leading)), key=lambda i: (letters[i] in "IQR", leading[i]))
    step = math.prod(leading[depth + 1 :])
    others = math.prod(leading) // max(1, leading[depth])
    frame = pick_frame(task, others, notices, "times or channels")
    inner, outer = frame % step, frame // step
    return outer * step * leading[depth] + inner, step, leading[depth]


def _page_reader(
    file: Any, series: Any, first: int, step: int, plane: tuple[int, ...], colour: bool, task: Task
) -> Callable[[int, int], np.ndarray]:
    whole = (
        len(series.pages) == 1
    )  # ImageJ keeps stacks over 4 GB, and others contiguous ones, behind one page
    mapped = file.pages[0].dtype is not None and whole and series.dataoffset is not None
    stack = (
        np.memmap(
            task.path, series.dtype.newbyteorder(file.byteorder), "r", series.dataoffset, tuple(series.shape)
        )
        if mapped
        else None
    )
    if stack is None and whole:
        stack = series.asarray()
    tail = (*plane, series.shape[-1]) if colour else plane

    def one(k: int) -> np.ndarray:
        if stack is not None:
            return np.asarray(stack.reshape(-1, *tail)[first + step * k])
        page = series.pages[first + step * k]
        if page is None:
            return np.zeros(tail, dtype=series.dtype)
        return np.asarray(page.asarray()).reshape(tail)

    def planes(z0: int, z1: int) -> np.ndarray:
        out = np.stack([one(k) for k in range(z0, z1)])
        return one_value(out) if colour else out

    return planes


def _spacing(file: Any, page: Any, notices: list[str]) -> np.ndarray:
    """Return the spacing (x, y, z) in mm by OME or ImageJ; resolution tags alone are for printers."""
    spacing = _ome_spacing(file.ome_metadata) if file.is_ome else None
    if spacing is None and file.is_imagej:
        spacing = _imagej_spacing(file, page, notices)
    if spacing is None or not (np.isfinite(spacing) & (spacing > 0)).all():
        notices.append("The size of its voxels is not known: taken as 1 mm.")
        return np.ones(3)
    return spacing


def _imagej_spacing(file: Any, page: Any, notices: list[str]) -> np.ndarray | None:
    data = file.imagej_metadata or {}
    x, y = (float(r) for r in page.resolution)
    unit = str(data.get("unit") or "").replace("\\u00B5", "u")
    if x <= 0 or y <= 0:
        return None
    steps = np.array([1 / x, 1 / y, float(data.get("spacing") or 1 / x)])
    mm = length_mm(unit)
    if mm is not None:
        return np.asarray(np.abs(steps) * mm)
    if np.allclose(steps, steps[0], rtol=1e-4):
        return None
    notices.append(
        "The unit of its voxels is not known: the smallest is taken as 1 mm, proportions are kept."
    )
    return np.asarray(np.abs(steps) / np.abs(steps).min())


def _ome_spacing(xml: str | None) -> np.ndarray | None:
    steps = []
    for axis in "XYZ":
        size = re.search(rf'\bPhysicalSize{axis}="([^"]+)"', xml or "")
        unit = re.search(rf'\bPhysicalSize{axis}Unit="([^"]+)"', xml or "")
        mm = length_mm(unit.group(1)) if unit else 1e-3  # OME's default unit is the micrometre
        try:
            steps.append(float(size.group(1)) * (mm or 0.0) if size else 0.0)
        except ValueError:
            return None
    if steps[2] == 0:
        steps[2] = steps[0]
    return np.array(steps) if min(steps) > 0 else None


# -- folders ---------------------------------------------------------------------------------------
def slices_in(folder: Path) -> list[Path]:
    """Return the slices of a folder in natural order: images of the commonest suffix, if two or more."""
    files = [
        p
        for p in folder.iterdir()
        if p.is_file() and p.suffix.lower() in SLICE_SUFFIXES and not p.name.startswith(".")
    ]
    if not files:
        return []
    common = Counter(p.suffix.lower() for p in files).most_common(1)[0][0]
    chosen = sorted((p for p in files if p.suffix.lower() == common), key=_natural)
    return chosen if len(chosen) > 1 else []


def _natural(path: Path) -> list[tuple[int, int, str]]:
    parts = re.split(r"(\d+)", path.name)
    return [(1, int(p), "") if p.isdigit() else (0, 0, p.lower()) for p in parts]


def read_folder(task: Task, files: list[Path]) -> Reading:
    """Read a folder of slices, one image a file, in natural order of their names."""
    first = _plane(files[0], task)
    shape, dtype = first.shape[:2], first.dtype
    notices = ["The distance of the slices is not known: voxels are taken as cubes of 1 mm."]
    if first.ndim == 3 and first.shape[2] > 1:
        notices.append(component_notice(dtype, first.shape[2]))

    def planes(z0: int, z1: int) -> np.ndarray:
        out = np.empty((z1 - z0, *shape), dtype=one_value(first[:1, :1]).dtype if first.ndim == 3 else dtype)
        for k in range(z0, z1):
            plane = _plane(files[k], task)
            plane = one_value(plane) if plane.ndim == 3 else plane
            if plane.shape != shape or plane.dtype != out.dtype:
                raise task.error(
                    f"{files[k].name} has another size or type than {files[0].name}",
                    "keep the slices of one stack in a folder",
                )
            out[k - z0] = plane
        return out

    kept = one_value(first[:1, :1]).dtype if first.ndim == 3 else dtype
    return Reading(Source((len(files), *shape), kept, planes), notices=notices, name=task.path.name)


def _plane(file: Path, task: Task) -> np.ndarray:
    try:
        if file.suffix.lower() in (".tif", ".tiff"):
            plane = np.asarray(need("tifffile", task).imread(file, key=0))
        else:
            from PIL import Image

            with Image.open(file) as image:
                plane = np.asarray(image.convert("RGB") if image.mode == "P" else image)
    except Exception as error:
        raise task.error(f"{file.name} cannot be read ({error})", "remove it or export it again") from error
    if plane.ndim not in (2, 3) or 0 in plane.shape:
        raise task.error(f"{file.name} is not a picture of one slice", "remove it from the folder")
    return plane
