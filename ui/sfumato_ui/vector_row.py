"""A few typed numbers side by side, each under its own word: a place, a direction, a width and a height."""

from __future__ import annotations

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QGridLayout, QLabel, QWidget

from .sliders import NumberBox


class VectorRow(QWidget):
    """Numbers that belong together.

    Parameters
    ----------
    title : str
        What they are together: the beginning of each accessible name.
    count : int
    unit, tip : str
        Shown behind each word, and as the tooltip.
    limits : (float, float)
        Range of each number.
    """

    #: The user typed: all values, as a tuple.
    edited = Signal(object)

    def __init__(
        self, title: str, count: int, *, unit: str = "", tip: str = "", limits: tuple[float, float],
        decimals: int = 1, step: float = 1.0,
    ) -> None:  # fmt: skip
        super().__init__()
        self._title, self._unit, self._tip = title, unit, tip
        self.labels = [QLabel() for _ in range(count)]
        self.numbers = [NumberBox() for _ in range(count)]
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(2)
        for column, (label, number) in enumerate(zip(self.labels, self.numbers, strict=True)):
            number.setRange(*limits)
            number.setDecimals(decimals)
            number.setSingleStep(step)
            number.setMinimumWidth(number.fontMetrics().horizontalAdvance("-0000.0") + 16)
            label.setBuddy(number)
            grid.addWidget(label, 0, column)
            grid.addWidget(number, 1, column)
            grid.setColumnStretch(column, 1)
            number.valueChanged.connect(lambda _value: self.edited.emit(self.values))
        self.set_names(tuple((word, word) for word in ("x", "y", "z")[:count]))

    @property
    def values(self) -> tuple[float, ...]:
        """What is shown."""
        return tuple(number.value() for number in self.numbers)

    def set_names(self, names: tuple[tuple[str, str], ...]) -> None:
        """Name the numbers: a word above each, and what it is in full."""
        for (word, meaning), label, number in zip(names, self.labels, self.numbers, strict=True):
            label.setText(f"{word}, {self._unit}" if self._unit else word)
            number.setAccessibleName(f"{self._title}: {meaning}" + (f", {self._unit}" if self._unit else ""))
            for widget in (label, number):
                widget.setToolTip(f"<p>{self._tip}</p><p>{word}: {meaning}.</p>")

    def set_values(self, values: tuple[float, ...]) -> None:
        """Show values without telling anybody; what is being typed stays."""
        for value, number in zip(values, self.numbers, strict=True):
            if abs(value - number.value()) > 0.5 * 10 ** -number.decimals():
                number.blockSignals(True)
                number.setValue(value)
                number.blockSignals(False)
