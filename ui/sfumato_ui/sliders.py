"""A slider for numbers, and the row of label, typed number, reset and slider made around it.

The slider's range may consist of pieces: a lamp's tilt skips the band in which its cone would graze the
slices. Wheel and keys act on the focused control only, so that scrolling a panel changes nothing.
"""

from __future__ import annotations

import math

from qtpy.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import QColor, QKeyEvent, QKeySequence, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from qtpy.QtWidgets import QDoubleSpinBox, QGridLayout, QLabel, QSizePolicy, QSlider, QToolButton, QWidget

from .icons import icon
from .theme import TARGET, current_theme

_STEPS = 10_000
_HANDLE = 8.0

Range = tuple[float, float]


class Slider(QSlider):
    """A horizontal slider over one or more pieces of the number line, drawn in the theme's colours."""

    #: The user moved it to this value.
    moved = Signal(float)

    def __init__(self, pieces: tuple[Range, ...], log: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self._pieces = pieces
        self._log = log
        self._default: float | None = None
        self._faint = False
        self.key_step = 1.0
        self.setRange(0, _STEPS)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMinimumHeight(TARGET)
        self.valueChanged.connect(lambda position: self.moved.emit(self.number_at(position / _STEPS)))

    # -- values and places ------------------------------------------------------------------------
    def set_pieces(self, pieces: tuple[Range, ...]) -> None:
        """Give the slider other pieces; its value must be set anew after that."""
        if pieces != self._pieces:
            self._pieces = pieces
            self.update()

    def set_default(self, value: float) -> None:
        """Mark a value with a tick."""
        self._default = value
        self.update()

    def set_faint(self, faint: bool) -> None:
        """Show that the value is not the slider's own."""
        self._faint = faint
        self.update()

    def set_number(self, value: float) -> None:
        """Show a value without telling anybody."""
        self.blockSignals(True)
        self.setValue(round(self.fraction_of(value) * _STEPS))
        self.blockSignals(False)
        self.update()

    def _scaled(self) -> list[Range]:
        return [(math.log(a), math.log(b)) if self._log else (a, b) for a, b in self._pieces]

    def number_at(self, fraction: float) -> float:
        """Return the value at a fraction of the slider's length."""
        pieces = self._scaled()
        at = fraction * sum(b - a for a, b in pieces)
        for a, b in pieces:
            if at <= b - a or (a, b) == pieces[-1]:
                value = min(a + at, b)
                return math.exp(value) if self._log else value
            at -= b - a
        raise AssertionError("a slider has at least one piece")

    def fraction_of(self, value: float) -> float:
        """Return the fraction of the slider's length at which a value lies."""
        pieces = self._scaled()
        value = math.log(max(value, 1e-12)) if self._log else value
        total = sum(b - a for a, b in pieces)
        below = sum(min(max(value - a, 0.0), b - a) for a, b in pieces)
        return below / total if total > 0 else 0.0

    # -- mouse and keys ---------------------------------------------------------------------------
    def _fraction_under(self, event: QMouseEvent) -> float:
        length = self.width() - 2 * _HANDLE - 4
        return max(0.0, min(1.0, (event.position().x() - _HANDLE - 2) / max(1.0, length)))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Jump to the pointer and follow it."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        self.setSliderDown(True)
        self.setValue(round(self._fraction_under(event) * _STEPS))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow the pointer."""
        if self.isSliderDown():
            self.setValue(round(self._fraction_under(event) * _STEPS))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.setSliderDown(False)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Change the value if focused, else let the panel scroll."""
        if not self.hasFocus():
            event.ignore()
            return
        self.nudge(event.angleDelta().y() / 120)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrow keys change the value by a step, with shift or the page keys by ten."""
        key, big = Qt.Key(event.key()), event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        steps = {
            Qt.Key.Key_Right: 1, Qt.Key.Key_Up: 1, Qt.Key.Key_Left: -1, Qt.Key.Key_Down: -1,
            Qt.Key.Key_PageUp: 10, Qt.Key.Key_PageDown: -10,
        }.get(key)  # fmt: skip
        if steps is not None:
            self.nudge(steps * (10 if big else 1))
        elif key in (Qt.Key.Key_Home, Qt.Key.Key_End):
            self.setValue(0 if key == Qt.Key.Key_Home else _STEPS)
        else:
            event.ignore()

    def nudge(self, steps: float) -> None:
        """Change the value by a number of key steps."""
        number = self.number_at(self.value() / _STEPS)
        wanted = number * (1 + self.key_step) ** steps if self._log else number + steps * self.key_step
        # Across the gap between two pieces the next piece begins at once.
        position = round(self.fraction_of(wanted) * _STEPS)
        if position == self.value():
            position += 1 if steps > 0 else -1
        self.setValue(position)

    # -- looks ------------------------------------------------------------------------------------
    def sizeHint(self) -> QSize:
        """Prefer a comfortable length."""
        return QSize(160, TARGET)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw groove, travelled part, ticks and handle."""
        theme = current_theme()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        middle = self.height() / 2
        left, length = _HANDLE + 2, self.width() - 2 * _HANDLE - 4
        at = left + length * self.value() / _STEPS
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(theme.border))
        painter.drawRoundedRect(QRectF(left, middle - 2, length, 4), 2, 2)
        on = self.isEnabled()
        painter.setBrush(QColor(theme.accent if on and not self._faint else theme.border))
        painter.drawRoundedRect(QRectF(left, middle - 2, at - left, 4), 2, 2)
        self._draw_ticks(painter, left, length, middle)
        painter.setBrush(QColor(theme.panel if self._faint else theme.text if on else theme.border))
        painter.setPen(QPen(QColor(theme.muted if self._faint else theme.panel), 2))
        painter.drawEllipse(QPointF(at, middle), _HANDLE - 1, _HANDLE - 1)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(theme.accent), 2))
            painter.drawEllipse(QPointF(at, middle), _HANDLE + 1, _HANDLE + 1)

    def _draw_ticks(self, painter: QPainter, left: float, length: float, middle: float) -> None:
        """Draw the default as a dot below, and a notch where the range jumps from one piece to the next."""
        theme = current_theme()
        total = sum(b - a for a, b in self._scaled())
        if len(self._pieces) > 1 and total > 0:
            a, b = self._scaled()[0]
            painter.setBrush(QColor(theme.panel))
            painter.drawRect(QRectF(left + length * (b - a) / total - 2, middle - 4, 4, 8))
        if self._default is not None:
            painter.setBrush(QColor(theme.border))
            painter.drawEllipse(
                QPointF(left + length * self.fraction_of(self._default), middle + 7), 1.5, 1.5
            )


class NumberBox(QDoubleSpinBox):
    """A typed number with a unit; the wheel acts only when it is focused."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setKeyboardTracking(False)
        self.setButtonSymbols(QDoubleSpinBox.ButtonSymbols.NoButtons)
        self.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._hidden = False

    def set_hidden(self, hidden: bool) -> None:
        """Show a dash instead of the number, which is not known."""
        if hidden != self._hidden:
            self._hidden = hidden
            self.setValue(self.value())

    def textFromValue(self, value: float) -> str:
        """Return the number as it is shown."""
        return "\N{EN DASH}" if self._hidden else super().textFromValue(value)

    def event(self, event: QEvent) -> bool:
        """Leave Ctrl+Z to the window: what it takes back is the value, not the letters."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.ShortcutOverride:
            standard = QKeySequence.StandardKey
            if event.matches(standard.Undo) or event.matches(standard.Redo):
                event.ignore()
                return False
        return super().event(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Ignore the wheel unless focused."""
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()


class LabelledSlider(QWidget):
    """Label, reset, typed number with unit, and below them the slider, all for one number.

    Parameters
    ----------
    label, unit, tip : str
        What it says, in which unit ("deg" is shown as °), and the tooltip.
    pieces : tuple of (float, float)
        Range of the slider, in one or more pieces.
    default : float, optional
        Value of the reset; nothing where having no value is the default: then the reset emits `cleared`.
    none_label : str
        What having no value means, in the label: "from lamp".
    pictures : str
        Rich text with pictures of less and more, for the tooltip.
    limits : (float, float), optional
        Range of the typed number; the slider's if not given.
    """

    #: The user chose this value.
    edited = Signal(float)
    #: The user wants it to have no value of its own again.
    cleared = Signal()
    #: The user took the slider, or let it go.
    drag_started = Signal()
    drag_finished = Signal()

    def __init__(
        self, label: str, pieces: tuple[Range, ...], default: float | None, *, unit: str = "", tip: str = "",
        decimals: int = 0, step: float = 1.0, limits: Range | None = None, log: bool = False,
        none_label: str = "", pictures: str = "",
    ) -> None:  # fmt: skip
        super().__init__()
        self._pictures = pictures
        self.default = default
        self._text, self._none_label = label, none_label
        self.label = QLabel(label)
        self.slider = Slider(pieces, log)
        self.slider.key_step = step
        if default is not None:
            self.slider.set_default(default)
        self.number = NumberBox()
        self.number.setDecimals(decimals)
        self.number.setSingleStep(step)
        self.number.setSuffix({"deg": "°", "": ""}.get(unit, f" {unit}"))
        self.number.setRange(*(limits or (pieces[0][0], pieces[-1][1])))
        self.reset = QToolButton()
        self.reset.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self._name(label, unit, tip)
        self._lay_out()
        self._connect()
        self.refresh_theme()
        self.set_number(default)

    def _name(self, label: str, unit: str, tip: str) -> None:
        shown = self._none_label
        if self.default is not None:
            shown = f"{self.number.textFromValue(self.default)}{self.number.suffix()}"
        for widget in (self, self.label, self.slider, self.number):
            widget.setToolTip(
                f"<p>{tip}</p>{self._pictures}<p>Double-click the name for {shown}.</p>" if tip else ""
            )
        self.slider.setAccessibleName(label)
        self.number.setAccessibleName(f"{label} in {unit or 'numbers'}")
        self.reset.setAccessibleName(f"Reset {label}")
        self.reset.setToolTip(f"Back to {shown}")
        self.setObjectName(label.lower().replace(" ", "_"))

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(4)
        grid.setVerticalSpacing(0)
        metrics = self.number.fontMetrics()
        longest = max(
            (self.number.textFromValue(v) for v in (self.number.minimum(), self.number.maximum())), key=len
        )
        room = max(
            metrics.horizontalAdvance(longest + self.number.suffix()), metrics.horizontalAdvance("000.00°")
        )
        self.number.setFixedWidth(room + 22)
        keep = self.reset.sizePolicy()
        keep.setRetainSizeWhenHidden(True)
        self.reset.setSizePolicy(keep)
        grid.addWidget(self.label, 0, 0)
        grid.addWidget(self.reset, 0, 1)
        grid.addWidget(self.number, 0, 2)
        grid.addWidget(self.slider, 1, 0, 1, 3)
        grid.setColumnStretch(0, 1)
        QWidget.setTabOrder(self.reset, self.number)
        QWidget.setTabOrder(self.number, self.slider)
        self.label.setBuddy(self.slider)

    def add_button(self, button: QWidget) -> None:
        """Put a button that sets the number beside it."""
        grid = self.layout()
        assert isinstance(grid, QGridLayout)
        grid.removeWidget(self.slider)
        grid.addWidget(button, 0, 3)
        grid.addWidget(self.slider, 1, 0, 1, 4)  # after the button, in the order of Tab, too

    def _connect(self) -> None:
        self.slider.moved.connect(self.edited)
        self.slider.sliderPressed.connect(self.drag_started)
        self.slider.sliderReleased.connect(self.drag_finished)
        self.number.valueChanged.connect(self.edited)
        self.reset.clicked.connect(self._back)
        self.label.mouseDoubleClickEvent = lambda event: self._back()  # type: ignore[method-assign]

    def _back(self) -> None:
        if self.default is None:
            self.cleared.emit()
        else:
            self.edited.emit(self.default)

    def set_number(self, value: float | None, in_effect: float | None = None) -> None:
        """Show a value without telling anybody.

        Parameters
        ----------
        value : float or None
            None: it has no value of its own; the label says what that means.
        in_effect : float, optional
            What no value amounts to, as far as it is known.
        """
        shown = value if value is not None else in_effect
        if shown is None:
            shown = self.number.minimum()
        self.slider.set_number(shown)
        self.slider.set_faint(value is None)
        self.number.blockSignals(True)
        self.number.setValue(shown)
        self.number.blockSignals(False)
        spoken = self.number.text()
        if value is None:
            spoken = self._none_label + (f", {spoken}" if in_effect is not None else "")
        self.label.setText(
            self._text if value is not None else f"{self._text} \N{MIDDLE DOT} {self._none_label}"
        )
        self.number.set_hidden(value is None and in_effect is None)
        self.slider.setAccessibleDescription(spoken)
        if value is None or self.default is None:
            self.reset.setVisible(value != self.default)
        else:
            self.reset.setVisible(abs(value - self.default) > 10 ** -self.number.decimals() / 2)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.reset.setIcon(icon("reset", current_theme()))
