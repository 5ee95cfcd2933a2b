"""From pieces to an array: assembling, shrinking by block means, colours and vectors to one value."""

from __future__ import annotations

import numpy as np

from .reading import Source, Task

#: No axis may be longer: OpenGL 3.3 promises 256 voxels a side in 3D, today's drivers take 2048 or more.
MAX_AXIS = 2048
#: Pieces are read in about this many bytes, so that cancelling is felt at once.
PIECE_BYTES = 8 << 20
#: Rec. 709 luma.
LUMA = np.array([0.2126, 0.7152, 0.0722], dtype=np.float32)

_KEPT = {
    np.dtype(t) for t in ("uint8", "int8", "uint16", "int16", "float32", "int32", "uint32", "int64", "uint64")
}


def held_dtype(dtype: np.dtype, task: Task) -> np.dtype:
    """Return the native type in which voxels of a type are held; a `LoadError` for what is not a number."""
    native = dtype.newbyteorder("=")
    if native.kind == "b":
        return np.dtype(np.uint8)
    if native in _KEPT:
        return native
    if native.kind == "f":
        return np.dtype(np.float32)
    raise task.error(
        f"its values are of type {dtype}", "real numbers are needed; export magnitude or one component"
    )


def shrink_factors(
    shape: tuple[int, int, int], itemsize: int, spacing: np.ndarray, task: Task, use_level: bool = True
) -> tuple[int, int, int]:
    """Return the integer factors (z, y, x) by which a volume must shrink to fit its budget and the GPU.

    Parameters
    ----------
    shape : (z, y, x)
        Voxels as stored.
    spacing : ndarray, shape (3,)
        Along x, y, z in mm; the finest axis shrinks first, so that voxels stay near cubes.
    """
    start = 2**task.level if use_level and task.level else 1
    factors = np.maximum(1, [min(start, n // 2) for n in shape])
    factors = np.maximum(factors, [-(-n // MAX_AXIS) for n in shape])
    steps = np.asarray(spacing, dtype=float)[::-1]
    while True:
        dims = -(-np.asarray(shape) // factors)
        if float(np.prod(dims.astype(float))) * itemsize <= task.budget_bytes or dims.max() <= 2:
            return int(factors[0]), int(factors[1]), int(factors[2])
        axis = int(np.argmin(np.where(dims > 2, steps * factors, np.inf)))
        factors[axis] += 1


def assemble(source: Source, factors: tuple[int, int, int], task: Task, begin: float = 0.0) -> np.ndarray:
    """Read all planes of a source in bounded pieces, shrinking each as it comes; array (z, y, x)."""
    dtype = held_dtype(source.dtype, task)
    nz, ny, nx = source.shape
    out = np.empty([-(-n // f) for n, f in zip(source.shape, factors, strict=True)], dtype=dtype)
    planes = max(1, PIECE_BYTES // max(1, ny * nx * source.dtype.itemsize) // factors[0]) * factors[0]
    for z0 in range(0, nz, planes):
        task.step(begin + (1 - begin) * z0 / nz, "Reading voxels")
        z1 = min(nz, z0 + planes)
        part = source.read(z0, z1)
        if part.shape != (z1 - z0, ny, nx):
            raise task.error(f"it ends after {z0} of {nz} slices", "it is truncated: copy or export it again")
        with np.errstate(over="ignore", invalid="ignore"):
            out[z0 // factors[0] : -(-z1 // factors[0])] = block_mean(part, factors, dtype)
    task.step(1.0, "Reading voxels")
    return out


def block_mean(part: np.ndarray, factors: tuple[int, int, int], dtype: np.dtype) -> np.ndarray:
    """Return means over blocks of factors (z, y, x) voxels; the last block repeats the edge."""
    if factors == (1, 1, 1):
        return part
    pad = [(0, -n % f) for n, f in zip(part.shape, factors, strict=True)]
    padded = np.pad(part, pad, mode="edge")
    (z, y, x), (fz, fy, fx) = padded.shape, factors
    blocks = padded.reshape(z // fz, fz, y // fy, fy, x // fx, fx)
    mean = blocks.mean(axis=(1, 3, 5), dtype=np.float32 if dtype.itemsize < 4 else np.float64)
    return np.asarray(np.rint(mean) if dtype.kind in "iu" else mean)


def one_value(voxels: np.ndarray) -> np.ndarray:
    """Return one value a voxel from its components (last axis): luma of a colour, else magnitude."""
    count = voxels.shape[-1]
    if count == 1:
        return np.asarray(voxels[..., 0])
    if is_colour(voxels.dtype, count):
        luma = voxels[..., :3].astype(np.float32) @ LUMA
        return np.asarray(np.rint(luma), dtype=voxels.dtype.newbyteorder("="))
    return np.asarray(np.sqrt(np.square(voxels, dtype=np.float32).sum(axis=-1, dtype=np.float32)))


def is_colour(dtype: np.dtype, count: int) -> bool:
    """Whether components of this type and number are a colour (RGB or RGBA) rather than a vector."""
    return count in (3, 4) and dtype.kind == "u"


def one_value_source(
    shape: tuple[int, int, int], dtype: np.dtype, count: int, read: object, notices: list[str]
) -> Source:
    """Return a source of single values from a reader of planes with several components (last axis)."""
    notices.append(component_notice(dtype, count))
    result = dtype if is_colour(dtype, count) else np.dtype(np.float32)
    return Source(shape, result, lambda z0, z1: one_value(read(z0, z1)))  # type: ignore[operator]


def component_notice(dtype: np.dtype, count: int) -> str:
    """Return the sentence that says what became of several components."""
    if is_colour(dtype, count):
        return "The file is in colour; its brightness is shown."
    return f"The file holds vectors of {count} components; their length is shown."
