"""A section of a panel that opens and closes under its name; its state persists."""

from __future__ import annotations

from qtpy.QtCore import QPointF, QSize, Qt
from qtpy.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from qtpy.QtWidgets import QAbstractButton, QSizePolicy, QVBoxLayout, QWidget

from .settings import settings
from .theme import TARGET, current_theme


class Header(QAbstractButton):
    """The section's name behind an arrow, flush with the labels above and below."""

    def sizeHint(self) -> QSize:
        """Be as wide as arrow and name, and tall enough to click."""
        metrics = self.fontMetrics()
        return QSize(metrics.horizontalAdvance(self.text()) + 32, max(TARGET + 4, metrics.height() + 10))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw arrow, name and focus ring."""
        theme = current_theme()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.underMouse() or self.hasFocus():
            painter.setPen(QPen(QColor(theme.accent), 2) if self.hasFocus() else Qt.PenStyle.NoPen)
            painter.setBrush(QColor(theme.hover) if self.underMouse() else Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(self.rect().adjusted(1, 1, -1, -1), 5, 5)
        middle = self.height() / 2
        tips = ((1, -2), (5, 2), (9, -2)) if self.isChecked() else ((3, -4), (7, 0), (3, 4))
        painter.setPen(QPen(QColor(theme.text), 1.6, c=Qt.PenCapStyle.RoundCap, j=Qt.PenJoinStyle.RoundJoin))
        painter.drawPolyline(QPolygonF([QPointF(3 + x, middle + y) for x, y in tips]))
        font = painter.font()
        font.setBold(True)
        painter.setFont(font)
        painter.drawText(self.rect().adjusted(20, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, self.text())


class Section(QWidget):
    """Closed at first; `key` names it in the settings, where its state is kept."""

    def __init__(self, title: str, key: str) -> None:
        super().__init__()
        self._key = f"section/{key}"
        self.header = Header()
        self.header.setCheckable(True)
        self.header.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.header.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.header.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.body = QWidget()
        self._widgets: list[QWidget] = []
        self._inside = inside = QVBoxLayout(self.body)
        inside.setContentsMargins(0, 4, 0, 4)
        inside.setSpacing(6)
        outside = QVBoxLayout(self)
        outside.setContentsMargins(0, 0, 0, 0)
        outside.setSpacing(0)
        outside.addWidget(self.header)
        outside.addWidget(self.body)
        self.set_title(title)
        self.header.toggled.connect(self._on_toggled)
        self.set_open(bool(settings().value(self._key, False, type=bool)))
        self._on_toggled(self.header.isChecked(), remember=False)

    def set_title(self, title: str) -> None:
        """Name the section."""
        self.header.setText(title)
        self.header.setAccessibleName(title)

    def set_open(self, opened: bool) -> None:
        """Open or close it."""
        self.header.setChecked(opened)

    def clear(self) -> None:
        """Delete what is in it, but not what has another parent by now."""
        for widget in [w for w in self._widgets if w.parentWidget() is self.body]:
            self._inside.removeWidget(widget)
            widget.hide()
            widget.deleteLater()
        self._widgets.clear()

    def add(self, widget: QWidget) -> None:
        """Put a widget at its end."""
        self._widgets.append(widget)
        self._inside.addWidget(widget)

    def _on_toggled(self, opened: bool, remember: bool = True) -> None:
        self.body.setVisible(opened)
        if remember:
            settings().setValue(self._key, opened)
