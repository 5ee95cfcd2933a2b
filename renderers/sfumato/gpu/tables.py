"""Transfer functions on the GPU: integrals for pre-integrated classification, and two-dimensional tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ..scene import TransferFunction, Volume
from .device import Device
from .volume_texture import VolumeTexture

#: Entries over the value range: one per Hounsfield unit of a usual CT.
ENTRIES = 4096
#: Of a function of the gradient too, over the values and over the gradient magnitude.
ENTRIES_2D = (1024, 128)


@dataclass
class TransferTables:
    """A transfer function as the shaders read it.

    Attributes
    ----------
    color : texture
        1D: integral of (tau * colour, tau); 2D: the same for each gradient magnitude (rows).
    emission : texture
        The same of tau * emission.
    extinction : texture
        1D: integral of tau alone; 2D: how many entries, up to each, are seen at any gradient magnitude.
    visible : ndarray of bool, shape (ENTRIES,)
        Values with any extinction.
    max_gradient : float
        Gradient magnitude (normalised value per mm) at the 2D table's end; 0 for a 1D function.
    emits : bool
        Whether any tissue gives off light.
    """

    color: Any
    emission: Any
    extinction: Any
    visible: np.ndarray
    max_gradient: float
    emits: bool
    size: int

    def release(self) -> None:
        """Free the textures."""
        self.color.release()
        self.emission.release()
        self.extinction.release()


def make_tables(
    device: Device, volume: Volume, texture: VolumeTexture, transfer: TransferFunction
) -> TransferTables:
    """Build and upload the tables of a transfer function for a volume's values."""
    low, high = texture.domain
    if transfer.regions:
        return _tables_2d(device, volume, texture, transfer)
    values = np.linspace(low, high, ENTRIES)
    sampled = transfer.evaluate(values)
    tau = transfer.extinction(sampled[:, 3], volume.unit_distance)
    color = _integral(np.concatenate([sampled[:, :3] * tau[:, None], tau[:, None]], axis=1))
    emission = _integral(np.concatenate([sampled[:, 4:] * tau[:, None], tau[:, None]], axis=1))
    emits = bool((sampled[:, 4:] * tau[:, None]).any())
    textures = [_upload(device, table[None]) for table in (color, emission)]
    extinction = _upload(device, color[None, :, 3:])
    return TransferTables(textures[0], textures[1], extinction, tau > 0, 0.0, emits, 2 * color.nbytes)


def _integral(samples: np.ndarray) -> np.ndarray:
    """Integral over the normalised value by the trapezoidal rule, in float64, stored as float32."""
    steps = (samples[1:] + samples[:-1]) / 2 / (len(samples) - 1)
    return np.concatenate([np.zeros((1, samples.shape[1])), np.cumsum(steps, axis=0)]).astype(np.float32)


def _tables_2d(
    device: Device, volume: Volume, texture: VolumeTexture, transfer: TransferFunction
) -> TransferTables:
    low, high = texture.domain
    top = max(max(r.extent[1][1] for r in transfer.regions), 1e-9)
    across, up = ENTRIES_2D
    values = np.linspace(low, high, across)[None, :]
    # Square root spacing: most voxels have small gradients.
    gradients = (np.linspace(0, 1, up) ** 2 * top)[:, None]
    sampled = transfer.evaluate_2d(values, gradients)
    tau = transfer.extinction(sampled[..., 3], volume.unit_distance)[..., None]
    color, emission = (
        np.stack([_integral(row) for row in np.concatenate([part * tau, tau], axis=-1)])
        for part in (sampled[..., :3], sampled[..., 4:])
    )
    seen = (tau[..., 0] > 0).any(axis=0)
    visible = np.interp(np.linspace(0, 1, ENTRIES), np.linspace(0, 1, across), seen) > 0
    textures = [_upload(device, table) for table in (color, emission)]
    emits = bool((sampled[..., 4:] * tau).any())
    extinction = _upload(device, np.cumsum(seen).astype(np.float32)[None, :, None])
    return TransferTables(
        textures[0], textures[1], extinction, visible, top / (high - low), emits, 2 * color.nbytes
    )


def _upload(device: Device, table: np.ndarray) -> Any:
    height, width, components = table.shape
    texture = device.ctx.texture((width, height), components, np.ascontiguousarray(table), dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def occupied_blocks(texture: VolumeTexture, visible: np.ndarray) -> np.ndarray:
    """Tell which blocks can hold something visible; shape as the blocks."""
    count = np.concatenate([[0], np.cumsum(visible)])
    # One entry of margin on either side: tables are interpolated.
    first = np.clip(np.floor(texture.low * (ENTRIES - 1)).astype(np.int64) - 1, 0, ENTRIES - 1)
    last = np.clip(np.ceil(texture.high * (ENTRIES - 1)).astype(np.int64) + 1, 0, ENTRIES - 1)
    return np.asarray(count[last + 1] - count[first] > 0)
