"""Where values and opacities lie on the screen."""

from __future__ import annotations

import math
from dataclasses import dataclass

from qtpy.QtCore import QPointF, QRectF

#: Opacities with a line of their own.
OPACITY_LINES = (0.01, 0.1, 0.5, 1.0)


@dataclass(frozen=True)
class Scale:
    """A plot's rectangle and the values at its left and right edge.

    Opacity goes up by its square root, because what thin tissue needs lies below 10 %.
    """

    rect: QRectF
    low: float
    high: float

    def x(self, value: float) -> float:
        """Return the place of a value, also outside of the plot."""
        return self.rect.left() + (value - self.low) / (self.high - self.low) * self.rect.width()

    def y(self, opacity: float) -> float:
        """Return the place of an opacity."""
        return self.rect.bottom() - math.sqrt(max(0.0, opacity)) * self.rect.height()

    def at(self, value: float, opacity: float) -> QPointF:
        """Return the place of both."""
        return QPointF(self.x(value), self.y(opacity))

    def value(self, x: float) -> float:
        """Return the value at a place."""
        return self.low + (x - self.rect.left()) / self.rect.width() * (self.high - self.low)

    def opacity(self, y: float) -> float:
        """Return the opacity at a place, 0 to 1."""
        part = (self.rect.bottom() - y) / self.rect.height()
        return min(1.0, max(0.0, part)) ** 2

    @property
    def per_pixel(self) -> float:
        """Values that one pixel spans."""
        return (self.high - self.low) / self.rect.width()


def ticks(low: float, high: float, most: int) -> list[float]:
    """Return round values between two others, as many as there is room for."""
    span = (high - low) / max(1, most)
    power = 10.0 ** math.floor(math.log10(span))
    step = next(power * k for k in (1, 2, 5, 10) if power * k >= span)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def decimals_for(span: float) -> int:
    """Return how many decimals tell values apart over a range."""
    return max(0, min(6, 3 - math.floor(math.log10(max(span, 1e-9)))))


def nudge(opacity: float, steps: float) -> float:
    """Return an opacity moved by hundredths of the plot's height."""
    return min(1.0, max(0.0, math.sqrt(opacity) + steps / 100)) ** 2
