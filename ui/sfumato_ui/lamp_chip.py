"""A lamp as a button with its colour and name, and the line in which it is renamed."""

from __future__ import annotations

from qtpy.QtCore import QEvent, QPoint, QPointF, QRect, QSize, Qt, Signal
from qtpy.QtGui import QColor, QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from qtpy.QtWidgets import QApplication, QLineEdit, QStyle, QStyleOptionToolButton, QToolButton, QWidget

from sfumato import Light

from .color_button import to_srgb
from .lamp_places import kind_of
from .theme import TARGET, Theme, current_theme

#: Longest name of a lamp in letters.
LONGEST_NAME = 24
_DOT = 5.0
_PAD = 7
#: Width in pixels to which a long name is shortened, so that four lamps fit beside each other.
_LEAST_WIDTH = 56


class LampChip(QToolButton):
    """Shows one lamp; its row decides what its gestures do."""

    rename_wanted = Signal()
    #: The lamp is to go one place on: -1 or 1.
    nudged = Signal(int)
    #: The chip is dragged to this place, in the row's coordinates.
    dragged = Signal(QPoint)
    drag_started = Signal()
    drag_finished = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._light = Light()
        #: The lamp's name; not the button's text, which the style would draw without regard for the room.
        self.label = ""
        self._dark = False
        self._pressed_at: QPointF | None = None
        self._dragging = False
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def show_light(self, light: Light, label: str, shines: bool, selected: bool) -> None:
        """Show a lamp under a label; `shines` is whether any of its light reaches the picture."""
        self._light, self._dark = light, not shines
        self.label = label
        self.setChecked(selected)
        state = "muted" if not light.enabled else "solo" if light.solo else "" if shines else "dark"
        self.setAccessibleName(f"Lamp {label}")
        self.setAccessibleDescription(state)
        why = {
            "muted": " (muted)",
            "solo": " (solo: the others are dark)",
            "dark": " (dark: another lamp is solo, or its intensity is 0)",
        }.get(state, "")
        kind = kind_of(light).title.lower()
        self.setToolTip(
            f"<p>{label}, {kind}{why}</p><p>F2 or a double-click renames it; drag it, or Ctrl+arrow keys, for another "
            "order.</p>"
        )
        self.updateGeometry()
        self.update()

    # -- size and looks ---------------------------------------------------------------------------
    def sizeHint(self) -> QSize:
        """Be as wide as dot and name."""
        metrics = self.fontMetrics()
        width = metrics.horizontalAdvance(self.label) + round(2 * _DOT) + 2 * _PAD + 8
        return QSize(max(TARGET, width), max(TARGET + 2, metrics.height() + 10))

    def minimumSizeHint(self) -> QSize:
        """Shrink, with the name shortened, where there is no room."""
        hint = self.sizeHint()
        return QSize(min(_LEAST_WIDTH, hint.width()), hint.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the button, the lamp's dot and its name, as much of it as there is room for."""
        theme = current_theme()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        option = QStyleOptionToolButton()
        self.initStyleOption(option)
        self.style().drawComplexControl(QStyle.ComplexControl.CC_ToolButton, option, painter, self)
        ink = QColor(theme.on_accent if self.isChecked() else theme.muted if self._dark else theme.text)
        self._draw_dot(painter, ink, theme)
        font = painter.font()
        font.setStrikeOut(not self._light.enabled)
        painter.setFont(font)
        painter.setPen(ink)
        room = QRect(self.rect()).adjusted(_PAD + round(2 * _DOT) + 6, 0, -_PAD + 3, 0)
        words = self.fontMetrics().elidedText(self.label, Qt.TextElideMode.ElideRight, room.width())
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, words)

    def _draw_dot(self, painter: QPainter, ink: QColor, theme: Theme) -> None:
        """Draw the lamp's colour: hollow if it is dark, in a ring if it is solo."""
        centre = QPointF(_PAD + _DOT, self.height() / 2)
        painter.setPen(QPen(ink, 1.5))
        painter.setBrush(Qt.BrushStyle.NoBrush if self._dark else to_srgb(self._light.color))
        painter.drawEllipse(centre, _DOT - 1, _DOT - 1)
        if self._light.solo:
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(centre, _DOT + 1.5, _DOT + 1.5)

    def nextCheckState(self) -> None:
        """Leave the mark to the editor, which knows the selected lamp."""

    # -- gestures ---------------------------------------------------------------------------------
    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the chip."""
        super().mousePressEvent(event)
        if event.button() == Qt.MouseButton.LeftButton:
            self._pressed_at = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the chip along the row."""
        if self._pressed_at is None:
            return
        far = abs(event.position().x() - self._pressed_at.x()) >= QApplication.startDragDistance()
        if far and not self._dragging:
            self._dragging = True
            self.drag_started.emit()
        if self._dragging:
            self.dragged.emit(self.mapToParent(event.position().toPoint()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let the chip go."""
        super().mouseReleaseEvent(event)
        self._pressed_at = None
        if self._dragging:
            self._dragging = False
            self.drag_finished.emit()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Rename the lamp."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.rename_wanted.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """F2 renames, Ctrl+Left and Ctrl+Right move the lamp in the row."""
        steps = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}
        if event.key() == Qt.Key.Key_F2:
            self.rename_wanted.emit()
        elif event.modifiers() & Qt.KeyboardModifier.ControlModifier and event.key() in steps:
            self.nudged.emit(steps[Qt.Key(event.key())])
        else:
            super().keyPressEvent(event)


class NameLine(QLineEdit):
    """A lamp's name while it is typed: Enter, or leaving the line, takes it; Esc does not."""

    #: The name is typed; empty if it was given up.
    finished = Signal(str)

    def __init__(self, name: str, parent: QWidget) -> None:
        super().__init__(name, parent)
        self._open = True
        self.setMaxLength(LONGEST_NAME)
        self.setAccessibleName("Name of the lamp")
        self.selectAll()
        self.returnPressed.connect(lambda: self._finish(self.text().strip()))

    def _finish(self, name: str) -> None:
        if self._open:
            self._open = False
            self.finished.emit(name)

    def event(self, event: QEvent) -> bool:
        """Keep Esc, which is the window's otherwise."""
        if (
            isinstance(event, QKeyEvent)
            and event.type() == QEvent.Type.ShortcutOverride
            and event.key() == Qt.Key.Key_Escape
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Give up with Esc."""
        if event.key() == Qt.Key.Key_Escape:
            self._finish("")
        else:
            super().keyPressEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Take the name when the line is left."""
        super().focusOutEvent(event)
        self._finish(self.text().strip())
