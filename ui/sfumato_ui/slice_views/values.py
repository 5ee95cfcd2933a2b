"""Values in words, in the unit that they have."""

from __future__ import annotations

import math

from sfumato import Volume

from ..transfer_editor.painting import text_of
from ..transfer_editor.scale import decimals_for
from ..transfer_editor.tissue import tissue_at


def unit_of(zero: float | None) -> str:
    """Return the unit of a volume's values, given the value of 0 HU."""
    return "HU" if zero is not None else ""


def decimals_of(volume: Volume) -> int:
    """Return how many decimals tell a volume's values apart."""
    low, high = volume.value_range
    return 0 if volume.data.dtype.kind in "ui" else decimals_for(high - low)


def value_words(volume: Volume, zero: float | None, value: float) -> str:
    """Return a value with its unit and, in Hounsfield units, its usual tissue."""
    if not math.isfinite(value):
        return "outside the volume"
    shown = value - (zero or 0.0)
    words = text_of(shown, decimals_of(volume))
    if zero is None:
        return f"value {words}"
    name = tissue_at(shown)
    return f"{words} HU, {name}" if name else f"{words} HU"


__all__ = ["decimals_of", "unit_of", "value_words"]
