"""Where the tissues lie on the Hounsfield scale."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tissue:
    """A tissue's usual range in Hounsfield units; those named first are labelled first where room is short."""

    name: str
    low: float
    high: float

    @property
    def middle(self) -> float:
        """Its mark."""
        return (self.low + self.high) / 2


TISSUES = (
    Tissue("air", -1024, -950),
    Tissue("bone", 250, 1600),
    Tissue("fat", -120, -60),
    Tissue("muscle", 35, 75),
    Tissue("water", -10, 10),
    Tissue("lung", -900, -550),
)


def tissue_at(hounsfield: float) -> str:
    """Return what usually has a value, or nothing."""
    return next((t.name for t in TISSUES if t.low <= hounsfield <= t.high), "")
