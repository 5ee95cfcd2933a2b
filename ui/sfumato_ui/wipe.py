"""What lies over the picture while it is compared: the other picture beside a handle, or a map of differences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from qtpy.QtCore import QEvent, QObject, QPointF, QRect, QRectF, Qt, Signal
from qtpy.QtGui import QColor, QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from qtpy.QtWidgets import QWidget

from sfumato.geometry import ColorBar

from . import overlay
from .theme import DARK, PICTURE_GREY

#: Width of the handle in pixels, and what an arrow key moves it, as a part of the picture's width.
WIDTH, STEP, LARGE_STEP = 28, 0.01, 0.1


class WipeHandle(QWidget):
    """A line with a knob: left of it the present picture, right of it the other."""

    moved = Signal(float)

    def __init__(self, picture: QWidget) -> None:
        super().__init__(picture)
        self._picture = picture
        self.fraction = 0.5
        self._held = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.SplitHCursor)
        self.setAccessibleName("Wipe")
        self.setToolTip(
            "Drag, or press left and right: the present picture on the left, the other on the right"
        )
        self.set_fraction(0.5)
        self.hide()

    def set_fraction(self, fraction: float) -> None:
        """Put the handle at a part (0 to 1) of the picture's width."""
        self.fraction = min(1.0, max(0.0, fraction))
        self.setAccessibleDescription(f"{100 * self.fraction:.0f} % of the picture's width")
        self.place()
        self.moved.emit(self.fraction)

    def place(self) -> None:
        """Take the picture's height."""
        wide, high = self._picture.width(), self._picture.height()
        self.setGeometry(round(self.fraction * wide) - WIDTH // 2, 0, WIDTH, high)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the handle; the picture below does not turn."""
        self._held = event.button() == Qt.MouseButton.LeftButton
        event.accept()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let it go."""
        self._held = False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow the hand."""
        if self._held:
            x = self.mapToParent(event.position().toPoint()).x()
            self.set_fraction(x / max(1, self._picture.width()))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move by arrow keys, with Shift by more."""
        sign = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}.get(Qt.Key(event.key()))
        if sign is None:
            event.ignore()
            return
        large = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        self.set_fraction(self.fraction + sign * (LARGE_STEP if large else STEP))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw line, knob and focus, legible on any picture."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        x, y = self.width() / 2, self.height() / 2
        for color, width in ((QColor(20, 20, 20, 200), 4), (QColor(255, 255, 255), 2)):
            painter.setPen(QPen(color, width))
            painter.drawLine(QPointF(x, 0), QPointF(x, self.height()))
        accent = QColor(DARK.accent)
        painter.setPen(QPen(accent if self.hasFocus() else QColor(20, 20, 20), 3 if self.hasFocus() else 2))
        painter.setBrush(QColor(20, 20, 20) if self.hasFocus() else QColor(255, 255, 255))
        painter.drawEllipse(QPointF(x, y), 12, 12)
        painter.setPen(QPen(accent if self.hasFocus() else QColor(20, 20, 20), 2))
        for sign in (-1, 1):
            tip = QPointF(x + sign * 7, y)
            painter.drawPolyline([tip + QPointF(-sign * 4, -4), tip, tip + QPointF(-sign * 4, 4)])


class CompareLayer(QWidget):
    """Paints over the whole picture and lets the mouse through."""

    def __init__(self, picture: QWidget) -> None:
        super().__init__(picture)
        self._picture = picture
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.image: QImage | None = None
        self.bars: Sequence[ColorBar] = ()
        self.names = ("", "")
        self.told = ""
        #: The patient's sides at the edges.
        self.letters: dict[str, str] | None = None
        #: Where the other picture begins, as a part of the width.
        self.begin = 0.5
        self.hide()

    def place(self) -> None:
        """Cover the picture."""
        self.setGeometry(self._picture.rect())

    def set_begin(self, fraction: float) -> None:
        """Show the other picture right of a part of the width."""
        self.begin = fraction
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the other picture on the picture's grey, then names and legend."""
        painter = QPainter(self)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        left = round(self.begin * self.width())
        if self.image is not None:
            painter.save()
            painter.setClipRect(QRect(left, 0, self.width() - left, self.height()))
            painter.fillRect(self.rect(), QColor(PICTURE_GREY))
            painter.drawImage(QRectF(self.rect()), self.image)
            painter.restore()
        if self.letters is not None:
            overlay.draw_letters(painter, self.rect(), self.letters)
        overlay.draw_color_bars(painter, self.rect(), self.bars)
        self._draw_names(painter, left)

    def _draw_names(self, painter: QPainter, left: int) -> None:
        """Name both sides at the top of each, as far as there is room."""
        metrics = painter.fontMetrics()
        high = metrics.height() + 6
        texts = (self.names[0], self.told or self.names[1])
        for text, start, end in (
            (texts[0], 44, left - 20),
            (texts[1], max(44, left + 20), self.width() - 44),
        ):
            wide = metrics.horizontalAdvance(text) + 16
            if text and wide <= end - start:
                overlay.draw_text(painter, QRectF(start, 8, wide, high), text)


class FollowsSize(QObject):
    """Keeps what lies over a widget at its size."""

    def __init__(self, below: QWidget, over: Sequence[Any]) -> None:
        super().__init__(below)
        self._over = tuple(over)
        below.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Place everything anew."""
        if event.type() == QEvent.Type.Resize:
            for widget in self._over:
                widget.place()
        return False
