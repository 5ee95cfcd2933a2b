"""Transfer function presets and the first picture's choices."""

from __future__ import annotations

import numpy as np

from .camera import Camera
from .transfer import TransferFunction
from .volume import Volume


def suggest_transfer(volume: Volume) -> TransferFunction:
    """Return a transfer function that suits a volume's modality and values."""
    low, high = volume.value_range
    a, b = low + 0.25 * (high - low), low + 0.5 * (high - low)
    return TransferFunction.from_points([(a, (0.6, 0.4, 0.3), 0.0), (b, (0.9, 0.85, 0.8), 0.8)])


def suggest_view(volume: Volume, transfer: TransferFunction | None) -> Camera:
    """Return the front view of what a transfer function shows of a volume."""
    return Camera.fit(np.asarray(volume.corners()))
