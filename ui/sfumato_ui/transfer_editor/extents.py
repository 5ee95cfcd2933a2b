"""The selected shape's extents as typed numbers: values and gradient magnitudes from – to."""

from __future__ import annotations

from collections.abc import Callable

from qtpy.QtWidgets import QGridLayout, QLabel, QWidget

from sfumato import Region

from ..sliders import NumberBox
from ..theme import TARGET
from .canvas import TransferCanvas
from .region_plot import RegionPlot


class Extents(QWidget):
    """Two rows of two numbers."""

    def __init__(self, plot: RegionPlot, line: TransferCanvas) -> None:
        super().__init__()
        self._plot, self._line = plot, line
        self.values = _number("Lowest value", "value"), _number("Highest value", "value")
        self.gradients = (
            _number("Smallest gradient", "gradient magnitude"),
            _number("Largest gradient", "gradient magnitude"),
        )
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(4)
        for row, (text, pair) in enumerate((("Values", self.values), ("Gradients", self.gradients))):
            grid.addWidget(QLabel(text), row, 0)
            grid.addWidget(pair[0], row, 1)
            grid.addWidget(QLabel("\N{EN DASH}"), row, 2)
            grid.addWidget(pair[1], row, 3)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(3, 1)
        for pair, axis in ((self.values, 0), (self.gradients, 1)):
            for end, box in enumerate(pair):
                box.valueChanged.connect(self._setter(axis, end))

    def _setter(self, axis: int, end: int) -> Callable[[float], None]:
        """Return what takes one typed number; the other end gives way, so that the shape keeps a width."""

        def take(number: float) -> None:
            region = self._plot.region
            if region is None:
                return
            extents = [list(extent) for extent in region.extent]
            wanted = number + ((self._line.zero or 0.0) if axis == 0 else 0.0)
            width = extents[axis][1] - extents[axis][0]
            extents[axis][end] = wanted
            if extents[axis][0] >= extents[axis][1]:
                extents[axis][1 - end] = wanted + (width if end == 0 else -width)
            if axis == 1 and extents[1][0] < 0 <= extents[1][1] and end == 1:
                extents[1][0] = 0.0
            (v0, v1), (g0, g1) = extents
            self._plot.stretch("Type the shape's extent", (v0, v1), (g0, g1))

        return take

    def show_region(self, region: Region) -> None:
        """Show a region's extents."""
        line, plot = self._line, self._plot
        (values, gradients), zero = region.extent, line.zero or 0.0
        unit = f" {line.unit}" if line.unit else ""
        for boxes, numbers, decimals, suffix, least in (
            (self.values, [v - zero for v in values], line.decimals, unit, None),
            (self.gradients, list(gradients), plot.decimals, f" {plot.unit}".replace(" per mm", " /mm"), 0.0),
        ):
            for box, number in zip(boxes, numbers, strict=True):
                box.blockSignals(True)
                box.setDecimals(decimals)
                box.setSingleStep(10.0**-decimals)
                box.setSuffix(suffix)
                limit = 100 * (max(abs(n) for n in numbers) + 1)
                if least is not None and box is boxes[1]:
                    least = box.singleStep()  # a shape has some height
                box.setRange(min(number, -limit if least is None else least), limit)
                box.setValue(number)
                box.blockSignals(False)


def _number(name: str, what: str) -> NumberBox:
    box = NumberBox()
    box.setAccessibleName(f"{name} of the shape in the {what}'s unit")
    box.setToolTip(f"{name} that the shape holds")
    box.setMinimumWidth(3 * TARGET)
    return box
