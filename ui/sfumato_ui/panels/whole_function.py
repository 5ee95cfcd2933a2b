"""The transfer function as a whole, beside the preset that it was made from: density, shift, width."""

from __future__ import annotations

from dataclasses import dataclass, replace

from sfumato import TransferFunction, Volume
from sfumato.scene import transfer_edit


@dataclass(frozen=True)
class WholeFunction:
    """A volume's function, and the one of the preset that it is, or was made from."""

    volume: Volume
    transfer: TransferFunction
    origin: TransferFunction | None

    @property
    def density(self) -> float:
        """How many times as dense as the preset it is."""
        return self._base / (self.transfer.unit_distance or self._base)

    @property
    def _base(self) -> float:
        """Unit distance in mm that counts as density 1."""
        return (self.origin.unit_distance if self.origin is not None else None) or self.volume.unit_distance

    @property
    def shift_and_width(self) -> tuple[float, float]:
        """How far it lies from its preset in per cent of the volume's values, and how much wider it is."""
        if self.origin is None:
            return 0.0, 1.0
        level, width = transfer_edit.level_and_width(self.transfer)
        first, first_width = transfer_edit.level_and_width(self.origin)
        ratio = width / first_width if first_width > 0 and width > 0 else 1.0
        return (level - first) / self._per_cent, ratio

    @property
    def _per_cent(self) -> float:
        low, high = self.volume.value_range
        return (high - low) / 100 or 0.01

    def with_density(self, density: float) -> TransferFunction:
        """Return it with another density."""
        return replace(self.transfer, unit_distance=self._base / density)

    def with_shift(self, percent: float) -> TransferFunction:
        """Return it moved along the values."""
        return self.transfer.rescaled(1.0, (percent - self.shift_and_width[0]) * self._per_cent)

    def with_width(self, ratio: float) -> TransferFunction:
        """Return it stretched about its middle."""
        level = transfer_edit.level_and_width(self.transfer)[0]
        return transfer_edit.scaled_about(self.transfer, level, ratio / self.shift_and_width[1])
