"""The subject of the benchmark: a chest, made by code, so that every machine draws the same voxels.

Bones inside translucent flesh, air in the lungs and nine tenths of the volume empty: what a ray caster can
skip and what it has to march through are shared out as in a scan of a hand or a small animal.
"""

from __future__ import annotations

import functools

import numpy as np

import sfumato

#: Edge of the volume in mm, whatever its number of voxels, so that all sizes show the same picture.
EDGE_MM = 256.0
#: Values of the tissues, 8 bit.
AIR, LUNG, FLESH, BONE = 6.0, 22.0, 85.0, 200.0
_SEED = 20100
_RIBS = 9
#: Part of the volume's edge that the chest spans: a small animal in a scanner's field of view.
_SHARE = 0.75

#: Flesh lets most of the light through; bone is solid within a few voxels. Opacities refer to 1 mm.
TRANSFER = sfumato.TransferFunction.from_points(
    [
        (45, (0.70, 0.32, 0.20), 0.0),
        (70, (0.75, 0.36, 0.24), 0.012),
        (110, (0.70, 0.20, 0.14), 0.025),
        (140, (0.85, 0.74, 0.55), 0.10),
        (170, (0.92, 0.84, 0.68), 0.60),
        (255, (0.98, 0.95, 0.88), 0.90),
    ],
    unit_distance=1.0,
    name="chest",
)


@functools.lru_cache(maxsize=4)
def phantom(size: int) -> sfumato.Volume:
    """Return the chest as uint8, `size` voxels along each side of 256 mm.

    Parameters
    ----------
    size : int
        Voxels along a side, at least 8.
    """
    line = (((np.arange(size) + 0.5) / size * 2 - 1) / _SHARE).astype(np.float32)
    x, y = line[None, None, :], line[None, :, None]
    data = np.empty((size, size, size), dtype=np.uint8)
    noise = np.random.default_rng(_SEED)
    for first in range(0, size, 16):  # a few slices at a time: no float copies of the whole volume
        z = line[first : first + 16, None, None]
        values = _tissue(x, y, z, sharpness=np.float32(size * _SHARE / 2))
        values += noise.normal(0, 3, values.shape).astype(np.float32)
        data[first : first + 16] = np.clip(np.rint(values), 0, 255).astype(np.uint8)
    return sfumato.Volume(data, spacing=(EDGE_MM / size,) * 3, info=sfumato.VolumeInfo(name=f"chest {size}"))


def _tissue(x: np.ndarray, y: np.ndarray, z: np.ndarray, sharpness: np.float32) -> np.ndarray:
    """Return the noiseless values at coordinates in [-1, 1]; boundaries are a voxel wide."""

    def share(distance: np.ndarray) -> np.ndarray:
        return np.asarray(np.clip(0.5 - distance * sharpness, 0, 1))

    values = AIR + (FLESH - AIR) * share(_body(x, y, z))
    values = values + (LUNG - values) * share(_lungs(x, y, z))
    return np.asarray(values + (BONE - values) * share(_bones(x, y, z)), dtype=np.float32)


def _body(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Distance (about) to the skin: an oval trunk with rounded shoulders and waist."""
    radius = np.sqrt((x / 0.80) ** 2 + (y / 0.56) ** 2 + (z / 0.90) ** 6)
    return np.asarray((radius - 1) * np.float32(0.56))


def _lungs(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Distance (about) to two lungs."""
    side = np.abs(x) - np.float32(0.33)
    radius = np.sqrt((side / 0.24) ** 2 + ((y + 0.02) / 0.30) ** 2 + ((z - 0.08) / 0.58) ** 2)
    return np.asarray((radius - 1) * np.float32(0.24))


def _bones(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Distance to the nearest bone: ribs, spine and breastbone."""
    # Ribs are elliptical rings that slope down to the front; the breastbone closes them.
    radius = np.sqrt((x / 0.62) ** 2 + (y / 0.40) ** 2) + np.float32(1e-6)
    ring = (radius - 1) * np.float32(0.45)
    height = z - np.float32(0.30) * y
    pitch = np.float32(1.3 / (_RIBS - 1))
    nearest = np.clip(np.rint((height + 0.62) / pitch), 0, _RIBS - 1) * pitch - np.float32(0.62)
    ribs = np.hypot(ring, (height - nearest) * np.float32(0.7)) - np.float32(0.028)
    beads = np.float32(0.02) * np.cos(z * np.float32(2 * np.pi / 0.14))  # vertebrae
    column = np.hypot(x, y - np.float32(0.36)) - np.float32(0.085) - beads
    spine = np.maximum(column, np.abs(z) - np.float32(0.84))
    plate = np.maximum(np.abs(x) - np.float32(0.07), np.abs(y + np.float32(0.40)) - np.float32(0.03))
    breastbone = np.maximum(plate, np.abs(z - np.float32(0.02)) - np.float32(0.45))
    return np.asarray(np.minimum(np.minimum(ribs, spine), breastbone))
