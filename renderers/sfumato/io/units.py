"""Names of lengths in files."""

from __future__ import annotations

_MM = {
    "m": 1e3, "meter": 1e3, "metre": 1e3, "dm": 100.0, "cm": 10.0, "centimeter": 10.0, "centimetre": 10.0,
    "mm": 1.0, "millimeter": 1.0, "millimetre": 1.0,
    "um": 1e-3, "µm": 1e-3, "μm": 1e-3, "micron": 1e-3, "microns": 1e-3,
    "micrometer": 1e-3, "micrometre": 1e-3,
    "nm": 1e-6, "nanometer": 1e-6, "nanometre": 1e-6, "angstrom": 1e-7, "pm": 1e-9, "inch": 25.4, "in": 25.4,
}  # fmt: skip


def length_mm(unit: str) -> float | None:
    """Return how many mm a unit of length has; None for a name that is no length."""
    return _MM.get(unit.strip().lower())
