"""A slider with two handles, and the row of label, two typed numbers and reset around it."""

from __future__ import annotations

from qtpy.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from qtpy.QtWidgets import QGridLayout, QLabel, QSizePolicy, QToolButton, QWidget

from .icons import icon
from .sliders import NumberBox
from .theme import TARGET, current_theme

_HANDLE = 8.0


class RangeSlider(QWidget):
    """Two handles on one groove; drag one, or what is between them.

    Arrow keys move the active handle (the one taken last, marked with a ring), Space changes to the other.
    """

    #: The user moved a handle (low, high).
    moved = Signal(float, float)
    drag_started = Signal()
    drag_finished = Signal()

    def __init__(self, name: str, end: float, step: float) -> None:
        super().__init__()
        self._end, self.step = end, step
        self.low, self.high = 0.0, end
        self._active = 0
        self._grip: str = ""
        self._slip = 0.0
        self.setAccessibleName(name)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMinimumHeight(TARGET)

    def sizeHint(self) -> QSize:
        """Prefer a comfortable length."""
        return QSize(160, TARGET)

    @property
    def dragging(self) -> bool:
        """Whether the user holds it."""
        return bool(self._grip)

    def set_range(self, end: float, step: float) -> None:
        """Let the slider run from 0 to another end, and the keys by another step."""
        self._end, self.step = end, step
        self.update()

    def set_values(self, low: float, high: float) -> None:
        """Show values without telling anybody."""
        self.low, self.high = low, high
        self.setAccessibleDescription(f"{low:.1f} to {high:.1f} mm")
        self.update()

    # -- places -----------------------------------------------------------------------------------
    def place(self, value: float) -> float:
        """Return where a value lies, in pixels from the left."""
        return _HANDLE + 2 + (self.width() - 2 * _HANDLE - 4) * value / self._end

    def value_at(self, x: float) -> float:
        """Return the value at a place, within the range."""
        length = max(1.0, self.width() - 2 * _HANDLE - 4)
        return min(self._end, max(0.0, (x - _HANDLE - 2) / length * self._end))

    # -- mouse and keys ---------------------------------------------------------------------------
    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take a handle or the part between; elsewhere the nearer handle comes."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        x = event.position().x()
        a, b = self.place(self.low), self.place(self.high)
        near = min(abs(x - a), abs(x - b))
        if near > _HANDLE + 4 and a < x < b and (self.low > 0 or self.high < self._end):
            self._grip = "both"
        else:
            upper = abs(x - b) < abs(x - a) or (a == b and x > b)
            self._active, self._grip = int(upper), "high" if upper else "low"
        self._slip = self.value_at(x) - self.low if self._grip == "both" else 0.0
        self.drag_started.emit()
        self._follow(x)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow the pointer."""
        if self._grip:
            self._follow(event.position().x())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        if self._grip and event.button() == Qt.MouseButton.LeftButton:
            self._grip = ""
            self.drag_finished.emit()

    def _follow(self, x: float) -> None:
        value = self.value_at(x)
        if self._grip == "both":
            width = self.high - self.low
            low = min(self._end - width, max(0.0, value - self._slip))
            self.moved.emit(low, low + width)
        elif self._grip == "low":
            self.moved.emit(min(value, self.high), self.high)
        else:
            self.moved.emit(self.low, max(value, self.low))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Move the active handle if focused, else let the panel scroll."""
        if not self.hasFocus():
            event.ignore()
            return
        self._nudge(event.angleDelta().y() / 120)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the active handle, by ten steps with Shift or the page keys; Space changes the handle."""
        key, big = Qt.Key(event.key()), event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        steps = {
            Qt.Key.Key_Right: 1, Qt.Key.Key_Up: 1, Qt.Key.Key_Left: -1, Qt.Key.Key_Down: -1,
            Qt.Key.Key_PageUp: 10, Qt.Key.Key_PageDown: -10,
        }.get(key)  # fmt: skip
        if steps is not None:
            self._nudge(steps * (10 if big else 1))
        elif key == Qt.Key.Key_Space:
            self._active = 1 - self._active
            self.update()
        else:
            event.ignore()

    def _nudge(self, steps: float) -> None:
        by = steps * self.step
        if self._active:
            self.moved.emit(self.low, max(self.low, min(self._end, self.high + by)))
        else:
            self.moved.emit(min(self.high, max(0.0, self.low + by)), self.high)

    # -- looks ------------------------------------------------------------------------------------
    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw groove, the part between, and the handles."""
        theme = current_theme()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        middle, on = self.height() / 2, self.isEnabled()
        a, b = self.place(self.low), self.place(self.high)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(theme.border))
        painter.drawRoundedRect(QRectF(_HANDLE + 2, middle - 2, self.width() - 2 * _HANDLE - 4, 4), 2, 2)
        painter.setBrush(QColor(theme.accent if on else theme.border))
        painter.drawRoundedRect(QRectF(a, middle - 2, b - a, 4), 2, 2)
        for i, x in enumerate((a, b)):
            painter.setBrush(QColor(theme.text if on else theme.border))
            painter.setPen(QPen(QColor(theme.panel), 2))
            painter.drawEllipse(QPointF(x, middle), _HANDLE - 1, _HANDLE - 1)
            if self.hasFocus() and i == self._active:
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.setPen(QPen(QColor(theme.accent), 2))
                painter.drawEllipse(QPointF(x, middle), _HANDLE + 1, _HANDLE + 1)

    def focusInEvent(self, event: QEvent) -> None:
        """Show the ring."""
        self.update()

    def focusOutEvent(self, event: QEvent) -> None:
        """Hide the ring."""
        self.update()


class LabelledRange(QWidget):
    """Label, reset, two typed numbers in mm, and below them the slider.

    Parameters
    ----------
    label, tip : str
        What it says.
    """

    #: The user chose this range.
    edited = Signal(float, float)
    drag_started = Signal()
    drag_finished = Signal()

    def __init__(self, label: str, tip: str) -> None:
        super().__init__()
        self._tip = tip
        self._end = 1.0
        self.label = QLabel()
        self.slider = RangeSlider(label, 1.0, 0.1)
        self.numbers = (NumberBox(), NumberBox())
        self.reset = QToolButton()
        self.reset.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self._lay_out()
        self._connect()
        self.set_axis(label, 1.0, 0.1)
        self.refresh_theme()

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(4)
        grid.setVerticalSpacing(0)
        for number in self.numbers:
            number.setDecimals(1)
            number.setSuffix(" mm")
            number.setFixedWidth(number.fontMetrics().horizontalAdvance("0000.0 mm") + 18)
        keep = self.reset.sizePolicy()
        keep.setRetainSizeWhenHidden(True)
        self.reset.setSizePolicy(keep)
        grid.addWidget(self.label, 0, 0)
        grid.addWidget(self.reset, 0, 1)
        grid.addWidget(self.numbers[0], 0, 2)
        grid.addWidget(self.numbers[1], 0, 3)
        grid.addWidget(self.slider, 1, 0, 1, 4)
        grid.setColumnStretch(0, 1)
        self.label.setBuddy(self.slider)

    def _connect(self) -> None:
        low, high = self.numbers
        self.slider.moved.connect(self.edited)
        self.slider.drag_started.connect(self.drag_started)
        self.slider.drag_finished.connect(self.drag_finished)
        low.valueChanged.connect(
            lambda value: self.edited.emit(min(value, self.slider.high), self.slider.high)
        )
        high.valueChanged.connect(
            lambda value: self.edited.emit(self.slider.low, max(value, self.slider.low))
        )
        self.reset.clicked.connect(lambda: self.edited.emit(0.0, self._end))

    def set_axis(self, label: str, end: float, step: float) -> None:
        """Name the range and let it run from 0 to another end, in mm."""
        self._end = end
        self.label.setText(label)
        self.slider.set_range(end, step)
        self.slider.setAccessibleName(f"Crop {label}")
        self.reset.setAccessibleName(f"Reset crop {label}")
        self.reset.setToolTip(f"Back to the whole: 0 to {end:.1f} mm")
        for number, which in zip(self.numbers, ("from", "to"), strict=True):
            number.blockSignals(True)
            number.setRange(0.0, end)
            number.setSingleStep(step)
            number.setAccessibleName(f"Crop {label} {which}, in mm")
            number.setToolTip(self._tip)
            number.blockSignals(False)
        for widget in (self.label, self.slider):
            widget.setToolTip(f"<p>{self._tip}</p><p>Space changes the handle that the arrow keys move.</p>")

    def set_values(self, low: float, high: float) -> None:
        """Show a range without telling anybody."""
        self.slider.set_values(low, high)
        for number, value in zip(self.numbers, (low, high), strict=True):
            number.blockSignals(True)
            number.setValue(value)
            number.blockSignals(False)
        self.reset.setVisible(low > 1e-6 * self._end or high < self._end * (1 - 1e-6))

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.reset.setIcon(icon("reset", current_theme()))
