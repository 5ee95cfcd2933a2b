"""A scanner's faults, the same on every machine: seeded noise, and the blur of its focus."""

from __future__ import annotations

import numpy as np

_LOW, _HIGH, _EVEN, _ODD = slice(None, -1), slice(1, None), slice(0, None, 2), slice(1, None, 2)


def grain(shape: tuple[int, int, int], seed: int) -> np.ndarray:
    """Return white noise of mean 0 and deviation 1, nearly normal, float32.

    The sum of the four bytes of a random word; a scanner's noise needs no better tails.
    """
    count = int(np.prod(shape))
    words = np.random.Generator(np.random.PCG64(seed)).integers(0, 1 << 32, count, dtype=np.uint32)
    total = words.view(np.uint8).reshape(count, 4).sum(axis=1, dtype=np.uint16)
    # Each byte has mean 127.5 and variance (256^2 - 1) / 12.
    return np.asarray(((total.astype(np.float32) - 510) * np.float32(1 / 147.8)).reshape(shape))


def smooth_noise(shape: tuple[int, int, int], cell: int, seed: int) -> np.ndarray:
    """Return smooth noise in -1 to 1 with features of `cell` voxels (a power of two), float32."""
    lattice = [n // cell + 2 for n in shape]
    field = np.random.Generator(np.random.PCG64(seed)).random(lattice, dtype=np.float32) * 2 - 1
    while cell > 1:
        cell //= 2
        for axis in range(3):
            field = _doubled(field, axis)
    return field[: shape[0], : shape[1], : shape[2]]


def _doubled(field: np.ndarray, axis: int) -> np.ndarray:
    shape = list(field.shape)
    shape[axis] = 2 * shape[axis] - 1
    result = np.empty(shape, dtype=np.float32)
    every = [slice(None)] * 3
    low, high, even, odd = (tuple([*every[:axis], s, *every[axis + 1 :]]) for s in (_LOW, _HIGH, _EVEN, _ODD))
    result[even] = field
    result[odd] = (field[low] + field[high]) * np.float32(0.5)
    return result


def blurred(values: np.ndarray, axes: tuple[int, ...] = (0, 1, 2)) -> np.ndarray:
    """Return float32 values averaged with their neighbours (1 : 2 : 1) along each axis: a deviation of 0.7 voxels.

    About what a scanner's focus does; without it, edges are sharper than voxels can tell, and show their steps.
    """
    for axis in axes:
        result = values * np.float32(0.5)
        old, new = np.moveaxis(values, axis, 0), np.moveaxis(result, axis, 0)
        new[1:] += old[:-1] * np.float32(0.25)
        new[:1] += old[:1] * np.float32(0.25)
        new[:-1] += old[1:] * np.float32(0.25)
        new[-1:] += old[-1:] * np.float32(0.25)
        values = result
    return values
