"""Small scenes whose pictures are known beforehand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sfumato import Camera, Light, Scene, TransferFunction, Volume

#: Viewed along +y (the front view): image right is +x, image up is +z, depth is +y.
SOLID = 0.999


def facing(volume: Volume, parallel: bool = True, fill: float = 1.0) -> Camera:
    """Return the front view in which the volume fills the picture."""
    return Camera.fit(volume.corners(), "front", parallel_projection=parallel, fill=fill)


def slab(tau: float, n: int = 8) -> tuple[Volume, TransferFunction]:
    """Return a homogeneous cube of 8 mm and its extinction per mm."""
    volume = Volume(np.full((n, n, n), 1.0, dtype=np.float32), spacing=(8 / n,) * 3)
    return volume, TransferFunction.from_points(
        [(1, (0.8, 0.6, 0.4), 1 - float(np.exp(-tau)))], unit_distance=1.0
    )


def wall(n: int = 24, solid: np.ndarray | None = None, thick: int = 4) -> tuple[Volume, TransferFunction]:
    """Return a wall at the back of an n^3 volume of 1 mm voxels, with something solid before it."""
    data = np.zeros((n, n, n), dtype=np.float32)
    if solid is not None:
        data[solid] = 1.0
    data[:, n - thick :, :] = 1.0
    return Volume(data), TransferFunction.from_points([(0.4, (1, 1, 1), 0.0), (0.6, (1, 1, 1), SOLID)], 0.5)


@pytest.fixture
def make_slab() -> Callable[..., tuple[Volume, TransferFunction]]:
    return slab


@pytest.fixture
def make_wall() -> Callable[..., tuple[Volume, TransferFunction]]:
    return wall


@pytest.fixture
def make_scene() -> Callable[..., Scene]:
    def make(
        volume: Volume, transfer: TransferFunction, *lights: Light, parallel: bool = True, **more: Any
    ) -> Scene:
        more.setdefault("camera", facing(volume, parallel))
        more.setdefault("technique", "multidirectional")
        return Scene(volume=volume, transfer=transfer, lights=lights or (Light(),), **more)

    return make


@pytest.fixture
def lumpy() -> tuple[Volume, TransferFunction]:
    """A soft, coloured, asymmetric thing of 20 x 18 x 16 voxels."""
    rng = np.random.default_rng(7)
    z, y, x = np.indices((16, 18, 20)) - np.array([7.5, 8.5, 9.5])[:, None, None, None]
    data = np.zeros(x.shape)
    for _ in range(6):
        a, b, c = rng.uniform(-5, 5, 3)
        data += np.exp(-((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2) / rng.uniform(4, 20))
    transfer = TransferFunction.from_points(
        [(0.2, (0.9, 0.3, 0.1), 0.0), (0.6, (1, 0.9, 0.7), 0.5), (1.2, (0.2, 0.4, 1), 0.8)]
    )
    return Volume(data.astype(np.float32)), transfer
