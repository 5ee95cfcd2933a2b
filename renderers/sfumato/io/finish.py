"""The last step of every reader: check, shrink to the budget, straighten, and make the `Volume`."""

from __future__ import annotations

import numpy as np

from ..scene import Volume, VolumeInfo
from .deskew import straighten
from .reading import Reading, Task, size_text
from .voxels import assemble, held_dtype, shrink_factors


def finish(reading: Reading, task: Task) -> Volume:
    """Return the volume of a reading; a `LoadError` says why there is none."""
    source, notices = reading.source, list(reading.notices)
    _check_shape(source.shape, task)
    axes = _checked_axes(reading.axes, task)
    spacing = np.linalg.norm(axes, axis=0)
    itemsize = min(4, held_dtype(source.dtype, task).itemsize)
    factors = shrink_factors(source.shape, itemsize, spacing, task, use_level=not reading.level_done)
    try:
        data = assemble(source, factors, task, reading.begun)
    finally:
        source.close()
    origin = reading.origin
    if factors != (1, 1, 1):
        notices.append(_shrink_notice(source.shape, factors, data.nbytes))
        steps = np.array(factors[::-1], dtype=float)
        if origin is not None:
            origin = origin + axes @ ((steps - 1) / 2)
        axes = axes * steps
    spacing = np.linalg.norm(axes, axis=0)
    direction = axes / spacing
    if np.abs(direction.T @ direction - np.eye(3)).max() > 1e-3:
        start = origin if origin is not None else axes @ np.full(3, 0.5)
        data, spacing, direction, origin = straighten(data, axes, start, task)
        notices.append("The axes are not at right angles: resampled onto a straight grid.")
    return _volume(reading, data, spacing, direction, origin, notices, task)


def _volume(
    reading: Reading, data: np.ndarray, spacing: np.ndarray, direction: np.ndarray,
    origin: np.ndarray | None, notices: list[str], task: Task,
) -> Volume:  # fmt: skip
    low, high = data.min(), data.max()
    if low == high:
        notices.append(f"All voxels have the same value ({float(low):g}): there is nothing to see.")
    modality = _modality(reading.modality, data, notices)
    data.flags.writeable = False  # spares the volume its copy
    info = VolumeInfo(
        str(task.path), modality, reading.orientation_known, tuple(notices), reading.name or task.path.name
    )
    return Volume(
        data,
        spacing=(float(spacing[0]), float(spacing[1]), float(spacing[2])),
        origin=None if origin is None else (float(origin[0]), float(origin[1]), float(origin[2])),
        direction=tuple(tuple(float(c) for c in row) for row in _orthonormal(direction)),  # type: ignore[arg-type]
        info=info,
    )


def _check_shape(shape: tuple[int, int, int], task: Task) -> None:
    z, y, x = shape
    if 0 in shape:
        raise task.error(f"it is empty ({x} x {y} x {z} voxels)")
    if min(shape) < 2:
        problem = "it holds only one slice" if z == 1 else f"it is flat ({x} x {y} x {z} voxels)"
        raise task.error(
            problem, "a volume needs at least 2 voxels along each axis: open the folder or the whole stack"
        )


def _checked_axes(axes: np.ndarray, task: Task) -> np.ndarray:
    axes = np.asarray(axes, dtype=float)
    if not np.isfinite(axes).all() or (np.linalg.norm(axes, axis=0) <= 0).any():
        raise task.error(
            "its voxel spacing is not usable (zero, negative or not a number)", "correct the header"
        )
    if abs(np.linalg.det(axes / np.linalg.norm(axes, axis=0))) < 1e-2:
        raise task.error("two of its axes are (nearly) parallel", "correct the orientation in the header")
    return axes


def _orthonormal(direction: np.ndarray) -> np.ndarray:
    """Return the nearest orthonormal matrix: files round their cosines to a few digits."""
    if np.allclose(direction.T @ direction, np.eye(3), atol=1e-9):
        return direction
    u, _, vt = np.linalg.svd(direction)
    return np.asarray(u @ vt)


def _shrink_notice(shape: tuple[int, int, int], factors: tuple[int, int, int], nbytes: int) -> str:
    z, y, x = shape
    fz, fy, fx = factors
    by = f"{fx}" if fx == fy == fz else f"{fx} x {fy} x {fz}"
    return (
        f"Reduced from {x} x {y} x {z} voxels by a factor of {by} to fit into memory ({size_text(nbytes)})."
    )


# -- Hounsfield units or not -----------------------------------------------------------------------
def _modality(declared: str, data: np.ndarray, notices: list[str]) -> str:
    if declared == "CT" and _has_hidden_offset(data):
        notices.append(
            "CT numbers seem to have an offset of 1024 that the file does not declare; values are kept."
        )
        return ""
    if not declared and _looks_like_hounsfield(data):
        return "CT"
    return declared


def _sample(data: np.ndarray) -> np.ndarray:
    step = max(1, round((data.size / 2e6) ** (1 / 3)))
    return data[::step, ::step, ::step]


def _looks_like_hounsfield(data: np.ndarray) -> bool:
    """Whether there is much air (near -1000), some soft tissue (near 0), and nothing impossible."""
    if data.dtype not in (np.dtype(np.int16), np.dtype(np.float32), np.dtype(np.int32)):
        return False
    sample = _sample(data)
    low, high = float(sample.min()), float(sample.max())
    if not (-4096 <= low <= -850 and 100 <= high <= 32767):
        return False
    air = np.mean((sample > -1100) & (sample < -850))
    tissue = np.mean((sample > -150) & (sample < 150))
    return bool(air > 0.02 and tissue > 0.03)


def _has_hidden_offset(data: np.ndarray) -> bool:
    """Whether CT numbers are never negative while air lies at 0 and soft tissue near 1024."""
    sample = _sample(data)
    if float(sample.min()) < 0:
        return False
    air = np.mean(sample < 150)
    tissue = np.mean((sample > 900) & (sample < 1174))
    water = np.mean((sample >= 150) & (sample < 700))
    return bool(air > 0.05 and tissue > 0.03 and tissue > water)
