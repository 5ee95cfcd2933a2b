"""A scene without a volume: an empty one takes its place, so that everything else is as always."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np

from ...scene import CropBox, TransferFunction, Volume
from ..frame import Frame

#: Voxels of the stand-in along its longest side: its spacing sets the resolution of light.
LONGEST = 160
_CLEAR = TransferFunction.from_points([(0.0, (1, 1, 1), 0.0), (1.0, (1, 1, 1), 0.0)], 1.0)


def with_volume(frame: Frame, bounds: np.ndarray) -> Frame:
    """Return a frame whose scene has a volume: an empty one about `bounds`, mm, shape (2, 3), if it has none."""
    if frame.scene.volume is not None:
        return frame
    volume = _empty(tuple(map(tuple, np.asarray(bounds, dtype=float).tolist())))
    scene = dataclasses.replace(frame.scene, volume=volume, transfer=_CLEAR, crop=CropBox())
    return dataclasses.replace(frame, scene=scene)


@functools.lru_cache(maxsize=4)
def _empty(bounds: tuple[tuple[float, float, float], ...]) -> Volume:
    low, high = np.array(bounds)
    size = np.maximum(high - low, 1e-3 * max(float((high - low).max()), 1e-3))
    spacing = float(size.max()) / LONGEST
    dims = np.maximum(np.ceil(size / spacing), 2).astype(int)
    return Volume(np.zeros(tuple(dims[::-1]), np.uint8), (spacing,) * 3, tuple(low + spacing / 2))
