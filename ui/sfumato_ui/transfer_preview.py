"""A small picture of a transfer function's colours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from qtpy.QtGui import QImage

from sfumato import Region, TransferFunction


def ramp(transfer: TransferFunction, width: int) -> QImage:
    """Return a function's colours, from its first to its last visible value, as a picture one pixel high."""
    return colours(transfer, *visible_range(transfer), width)


def colours(transfer: TransferFunction, low: float, high: float, width: int) -> QImage:
    """Return a function's colours between two values as a picture one pixel high."""
    linear = np.clip(transfer.most_opaque(np.linspace(low, high, width))[:, :3], 0, 1)
    srgb = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    pixels = np.full((1, width, 4), 255, np.uint8)
    pixels[0, :, :3] = np.rint(srgb * 255)
    return QImage(pixels.tobytes(), width, 1, 4 * width, QImage.Format.Format_RGBA8888).copy()


def visible_range(transfer: TransferFunction) -> tuple[float, float]:
    """Return the values between which a transfer function shows something, a two-dimensional one's regions lie."""
    if transfer.regions:
        ends = [_shown_values(transfer, region) for region in transfer.regions if region.opacity > 0]
        return (min(low for low, _ in ends), max(high for _, high in ends)) if ends else (0.0, 1.0)
    values = [p.value for p in transfer.points]
    shown = [p.value for p in transfer.points if p.opacity > 0] or values
    low, high = min(shown), max(shown)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _shown_values(transfer: TransferFunction, region: Region) -> tuple[float, float]:
    """Return the values between which a region shows something: of a curve, those that its points show."""
    low, high = region.extent[0]
    if region.shape != "curve":
        return low, high
    first, last = visible_range(replace(transfer, regions=()))
    low, high = max(low, first), min(high, last)
    return (low, high) if low < high else region.extent[0]
