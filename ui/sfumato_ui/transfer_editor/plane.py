"""Where values and gradient magnitudes lie on the screen."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from qtpy.QtCore import QPointF, QRectF

#: Least part of the whole plane, along each axis, that can be seen.
CLOSEST = 1 / 100

Range = tuple[float, float]


@dataclass(frozen=True)
class Plane:
    """A plot's rectangle, the values at its left and right edge, and the gradients at its lower and upper one."""

    rect: QRectF
    values: Range
    gradients: Range

    def at(self, value: float, gradient: float) -> QPointF:
        """Return the place of both, also outside of the plot."""
        (x, y) = self.places(np.array([[value, gradient]]))[0].tolist()
        return QPointF(x, y)

    def places(self, pairs: np.ndarray) -> np.ndarray:
        """Return the places in pixels of pairs of value and gradient, shape (n, 2)."""
        low = np.array([self.values[0], self.gradients[0]])
        part = (np.asarray(pairs, dtype=float) - low) * self._pixels_per_unit
        return np.asarray(np.array([self.rect.left(), self.rect.bottom()]) + part * [1, -1])

    def pair(self, at: QPointF) -> Range:
        """Return value and gradient magnitude at a place."""
        across, up = self.per_pixel
        return (
            self.values[0] + (at.x() - self.rect.left()) * across,
            self.gradients[0] + (self.rect.bottom() - at.y()) * up,
        )

    @property
    def per_pixel(self) -> Range:
        """Values, and gradients, that one pixel spans."""
        across, up = (1 / self._pixels_per_unit).tolist()
        return across, up

    @property
    def _pixels_per_unit(self) -> np.ndarray:
        spans = np.array([self.values[1] - self.values[0], self.gradients[1] - self.gradients[0]])
        return np.asarray(np.array([max(1.0, self.rect.width()), max(1.0, self.rect.height())]) / spans)

    def clamped(self, at: QPointF) -> QPointF:
        """Return the place within the plot that is nearest to one."""
        rect = self.rect
        return QPointF(
            min(max(at.x(), rect.left()), rect.right()), min(max(at.y(), rect.top()), rect.bottom())
        )

    def zoomed(self, factor: float, about: QPointF, whole: Plane) -> Plane:
        """Return a plane with a factor less in view and a place staying where it is, within the whole one."""
        value, gradient = self.pair(self.clamped(about))
        return replace(
            self,
            values=_within(_zoomed(self.values, value, factor, whole.values), whole.values),
            gradients=_within(_zoomed(self.gradients, gradient, factor, whole.gradients), whole.gradients),
        )

    def moved(self, values: float, gradients: float, whole: Plane) -> Plane:
        """Return a plane with other values in view, as many, within the whole one."""
        return replace(
            self,
            values=_within((self.values[0] + values, self.values[1] + values), whole.values),
            gradients=_within(
                (self.gradients[0] + gradients, self.gradients[1] + gradients), whole.gradients
            ),
        )


def _zoomed(seen: Range, about: float, factor: float, whole: Range) -> Range:
    most = whole[1] - whole[0]
    span = min(max((seen[1] - seen[0]) / factor, most * CLOSEST), most)
    part = (about - seen[0]) / (seen[1] - seen[0])
    return about - part * span, about + (1 - part) * span


def _within(seen: Range, whole: Range) -> Range:
    """Move a range into the whole one."""
    move = max(0.0, whole[0] - seen[0]) - max(0.0, seen[1] - whole[1])
    return seen[0] + move, seen[1] + move
