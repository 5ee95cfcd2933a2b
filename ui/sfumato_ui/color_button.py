"""A button that shows a colour and lets the user pick another."""

from __future__ import annotations

from qtpy.QtCore import QPoint, QSize, Qt, Signal
from qtpy.QtGui import QColor, QPainter, QPaintEvent, QPen
from qtpy.QtWidgets import QAbstractSpinBox, QColorDialog, QPushButton

from .theme import current_theme

RGB = tuple[float, float, float]
#: Of the dialog from the window's edges, in pixels.
MARGIN = 12


def to_srgb(color: RGB) -> QColor:
    """Return a linear colour as Qt's sRGB colour; brighter than white counts as white."""
    return QColor.fromRgbF(*(_encode(min(1.0, c)) for c in color))


def to_linear(color: QColor) -> RGB:
    """Return a Qt colour (sRGB) as a linear one."""
    return _decode(color.redF()), _decode(color.greenF()), _decode(color.blueF())


def _encode(c: float) -> float:
    return 12.92 * c if c <= 0.0031308 else 1.055 * float(c ** (1 / 2.4)) - 0.055


def _decode(c: float) -> float:
    return c / 12.92 if c <= 0.04045 else float(((c + 0.055) / 1.055) ** 2.4)


class ColorButton(QPushButton):
    """Shows a linear colour; a click opens the colour dialog."""

    #: The user picked this linear colour.
    picked = Signal(object)
    #: The dialog opened, or was closed: what is picked in between is one step.
    opened = Signal()
    closed = Signal()

    def __init__(self, name: str) -> None:
        super().__init__()
        self._name = name
        self._color: RGB = (1.0, 1.0, 1.0)
        self.setAccessibleName(name)
        self.setToolTip(name)
        self.clicked.connect(self._ask)

    def set_color(self, color: RGB) -> None:
        """Show a colour without telling anybody."""
        self._color = color
        self.setAccessibleDescription(to_srgb(color).name())
        self.update()

    def sizeHint(self) -> QSize:
        """Be as tall as other controls."""
        return QSize(80, 28)

    def _ask(self) -> None:
        dialog = QColorDialog(to_srgb(self._color), self)
        dialog.setOption(QColorDialog.ColorDialogOption.DontUseNativeDialog)
        dialog.setWindowTitle(self._name)
        for box in dialog.findChildren(QAbstractSpinBox):  # as the window's own fields of numbers
            box.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
        dialog.currentColorChanged.connect(lambda color: self.picked.emit(to_linear(color)))
        before = self._color
        dialog.rejected.connect(lambda: self.picked.emit(before))
        dialog.finished.connect(self.closed)
        dialog.finished.connect(dialog.deleteLater)
        self.opened.emit()
        dialog.open()
        dialog.move(self._beside(dialog))

    def _beside(self, dialog: QColorDialog) -> QPoint:
        """Return the dialog's place: over the panel, in the window's lower right corner, off the subject."""
        window = self.window()
        corner = window.mapToGlobal(window.rect().bottomRight())
        place = corner - QPoint(dialog.width() + MARGIN, dialog.height() + MARGIN)
        screen = self.screen().availableGeometry()
        return QPoint(max(screen.left(), place.x()), max(screen.top(), place.y()))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the colour inside the button's frame."""
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(current_theme().border), 1))
        # What cannot be chosen has no colour of its own to show.
        painter.setBrush(to_srgb(self._color) if self.isEnabled() else Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(self.rect().adjusted(6, 6, -7, -7), 3, 3)
