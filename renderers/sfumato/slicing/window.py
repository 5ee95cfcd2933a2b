"""Window and level: which values are shown as black, which as white."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..scene.presets.values import hounsfield_zero, remembered, thinned
from ..scene.volume import Volume

#: Percentiles of the values above the least that *Automatic* shows as black and as white.
DARKEST, BRIGHTEST = 1.0, 99.5
#: Level and width in Hounsfield units of the usual windows (Radiopaedia, "Windowing (CT)"); the first is the start.
HOUNSFIELD = (
    ("Soft tissue", 40.0, 400.0),
    ("Lung", -600.0, 1500.0),
    ("Bone", 400.0, 1800.0),
    ("Brain", 40.0, 80.0),
)
AUTOMATIC, WHOLE = "Automatic", "Whole range"


@dataclass(frozen=True)
class ValueWindow:
    """The values between black and white: ``level`` is their middle, ``width`` their span (DICOM's linear-exact)."""

    level: float
    width: float

    @classmethod
    def between(cls, low: float, high: float) -> ValueWindow:
        """Return the window from one value to a larger one."""
        return cls((low + high) / 2, high - low)

    @property
    def low(self) -> float:
        """Value that is shown as black; what lies below is, too."""
        return self.level - self.width / 2

    @property
    def high(self) -> float:
        """Value that is shown as white; what lies above is, too."""
        return self.level + self.width / 2

    def grey(self, values: np.ndarray) -> np.ndarray:
        """Return values as grey levels, uint8; NaN is black."""
        part = (values - np.float32(self.low)) * np.float32(255 / self.width)
        return np.asarray(np.rint(np.nan_to_num(np.clip(part, 0, 255)))).astype(np.uint8)

    def dragged(self, right: float, up: float) -> ValueWindow:
        """Return the window after a drag, in parts of a way that is felt as long (about 200 pixels).

        To the right it widens, by the factor e over the whole way, so that narrow windows are set as finely as
        wide ones; upwards the level rises by the width.
        """
        return ValueWindow(self.level + up * self.width, self.width * math.exp(right))

    def limited(self, volume: Volume) -> ValueWindow:
        """Return the window as far as it makes sense for a volume's values."""
        low, high = volume.value_range
        span = max(high - low, 1e-6 * max(abs(high), 1.0))
        least = 1.0 if volume.data.dtype.kind in "ui" else 1e-4 * span
        # A window for another range (brain, in a scan of bone alone) may lie beside the values, not far from them.
        level = min(max(self.level, low - 2 * span), high + 2 * span)
        return ValueWindow(level, min(max(self.width, least), max(16 * span, least)))


@dataclass(frozen=True)
class NamedWindow:
    """A window to choose."""

    name: str
    window: ValueWindow


@remembered
def windows_for(volume: Volume) -> tuple[NamedWindow, ...]:
    """Return the windows that suit a volume; the first is the one to start with."""
    general = (
        NamedWindow(AUTOMATIC, automatic_window(volume)),
        NamedWindow(WHOLE, ValueWindow.between(*_apart(*volume.value_range))),
    )
    zero = hounsfield_zero(volume)
    if zero is None:
        return general
    usual = (NamedWindow(name, ValueWindow(zero + level, width)) for name, level, width in HOUNSFIELD)
    return (*usual, *general)


def automatic_window(volume: Volume) -> ValueWindow:
    """Return the window that leaves out the darkest and brightest few values.

    The least value is not counted: it is the empty space of most volumes, and may be all but a few of their voxels.
    """
    values, whole = thinned(volume), volume.value_range
    filled = values[values > values.min()]
    low, high = (float(v) for v in np.percentile(filled, (DARKEST, BRIGHTEST))) if filled.size else whole
    # Of a mask, what is filled is all the same: its contrast is that to the empty space.
    return ValueWindow.between(*_apart(*((low, high) if high > low else whole)))


def _apart(low: float, high: float) -> tuple[float, float]:
    """Return two values that differ."""
    return (low, high) if high > low else (low - 0.5, low + 0.5)


__all__ = ["NamedWindow", "ValueWindow", "automatic_window", "windows_for"]
