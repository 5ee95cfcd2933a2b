"""Window and level by name, by numbers, and back."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QGridLayout, QLabel, QToolButton, QWidget

from sfumato.slicing import ValueWindow

from ..generated import ChoiceBox
from ..icons import icon
from ..sliders import NumberBox
from ..theme import current_theme
from .state import SliceState
from .values import decimals_of, unit_of

OWN = "Own window"
#: What a number box takes: more than any volume has, and still read with its unit.
MOST = 1e7


class WindowRow(QWidget):
    """Level, width and reset."""

    def __init__(self, state: SliceState) -> None:
        super().__init__()
        self._state = state
        #: The windows by name; it has its place elsewhere in the bar.
        self.choice = ChoiceBox()
        self.level, self.width_box = NumberBox(), NumberBox()
        self.reset = QToolButton()
        self._name()
        self._lay_out()
        self.choice.activated.connect(self._choose)
        self.level.valueChanged.connect(lambda value: self._type())
        self.width_box.valueChanged.connect(lambda value: self._type())
        self.reset.clicked.connect(state.reset_window)
        state.windowed.connect(self.refresh)
        state.replaced.connect(self.refresh)
        self.refresh_theme()
        self.refresh()

    def _name(self) -> None:
        self.choice.setAccessibleName("Window: the values shown from black to white")
        self.choice.setToolTip("Values shown from black to white; right-drag in a slice changes them")
        self.level.setToolTip("Level: the value that is shown as middle grey")
        self.width_box.setToolTip("Width: how many values lie between black and white")
        self.reset.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.reset.setAccessibleName("Reset window and level")
        keep = self.reset.sizePolicy()
        keep.setRetainSizeWhenHidden(True)
        self.reset.setSizePolicy(keep)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        for column, (words, box) in enumerate((("Level", self.level), ("Width", self.width_box))):
            grid.addWidget(QLabel(words), 0, 2 * column)
            grid.addWidget(box, 0, 2 * column + 1)
            grid.setColumnStretch(2 * column + 1, 1)
            box.setMinimumWidth(box.fontMetrics().horizontalAdvance("\N{MINUS SIGN}0000 HU") + 18)
        grid.addWidget(self.reset, 0, 4)

    # -- showing ----------------------------------------------------------------------------------
    def refresh(self) -> None:
        """Show the window as it is."""
        state = self._state
        known = state.volume is not None and state.window is not None
        for control in (self.choice, self.level, self.width_box):
            control.setEnabled(known)
        self._show_names()
        if known and state.volume is not None and state.window is not None:
            self._show_numbers(state.window)
        first = state.windows[0] if state.windows else None
        self.reset.setVisible(known and first is not None and state.window != first.window)
        self.reset.setToolTip(f"Back to {first.name.lower()}" if first is not None else "Nothing to reset")

    def _show_names(self) -> None:
        state = self._state
        name = state.window_name or (OWN if state.window is not None else "")
        names = [named.name for named in state.windows] + ([name] if name == OWN else [])
        if names != [self.choice.itemText(i) for i in range(self.choice.count())]:
            self.choice.clear()
            self.choice.addItems(names)
        self.choice.setCurrentIndex(names.index(name) if name in names else -1)

    def _show_numbers(self, window: ValueWindow) -> None:
        zero, volume = self._state.zero, self._state.volume
        assert volume is not None
        unit, decimals = unit_of(zero), decimals_of(volume)
        for box, word, value in (
            (self.level, "Level", window.level - (zero or 0.0)), (self.width_box, "Width", window.width),
        ):  # fmt: skip
            box.blockSignals(True)
            box.setAccessibleName(f"{word} in {unit or 'values'}")
            box.setSuffix(f" {unit}" if unit else "")
            box.setDecimals(decimals)
            box.setRange(-MOST if box is self.level else 0.0, MOST)
            box.setSingleStep(10.0 if unit else max(10.0**-decimals, window.width / 50))
            box.setValue(value)
            box.blockSignals(False)

    # -- acting -----------------------------------------------------------------------------------
    def _choose(self, index: int) -> None:
        if index < len(self._state.windows):
            self._state.set_window(self._state.windows[index].window)

    def _type(self) -> None:
        """Take what was typed, as far as the volume allows."""
        state = self._state
        if state.volume is None:
            return
        level = self.level.value() + (state.zero or 0.0)
        state.set_window(ValueWindow(level, max(self.width_box.value(), 1e-30)).limited(state.volume))
        self.refresh()

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.reset.setIcon(icon("reset", current_theme()))


__all__ = ["WindowRow"]
