"""A small picture of a transfer function over the volume's histogram."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRectF, QSize, Qt
from qtpy.QtGui import QColor, QIcon, QPainter, QPaintEvent, QPen, QPixmap, QPolygonF
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato import Scene, TransferFunction, Volume

from .color_button import to_srgb
from .theme import current_theme


def swatch(transfer: TransferFunction, width: int = 44, height: int = 20) -> QIcon:
    """Return an icon of a transfer function's colours, from its first to its last visible value."""
    values = visible_range(transfer)
    colours = transfer.evaluate(np.linspace(*values, width))
    pixmap = QPixmap(width, height)
    pixmap.fill(QColor(0, 0, 0, 0))
    painter = QPainter(pixmap)
    for x, row in enumerate(colours):
        painter.setPen(to_srgb((float(row[0]), float(row[1]), float(row[2]))))
        painter.drawLine(x, 2, x, height - 3)
    painter.end()
    return QIcon(pixmap)


def visible_range(transfer: TransferFunction) -> tuple[float, float]:
    """Return the values between which a transfer function shows something."""
    values = [p.value for p in transfer.points]
    shown = [p.value for p in transfer.points if p.opacity > 0] or values
    low, high = min(shown), max(shown)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


class TransferPreview(QWidget):
    """Log histogram, opacity curve and colours; to look at."""

    def __init__(self) -> None:
        super().__init__()
        self._volume: Volume | None = None
        self._transfer: TransferFunction | None = None
        self._bars = np.zeros(0)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Transfer function over the histogram")

    def sizeHint(self) -> QSize:
        """Be a low strip."""
        return QSize(240, 116)

    def show_scene(self, scene: Scene) -> None:
        """Show a scene's function over its volume's values."""
        if scene.volume is not self._volume:
            self._volume = scene.volume
            counts = scene.volume.histogram[0] if scene.volume is not None else np.zeros(1)
            bars = np.log1p(counts.astype(float))
            self._bars = bars / max(1e-9, float(bars.max()))
        self._transfer = scene.transfer
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw histogram, curve, colour strip and the ends of the value range."""
        theme = current_theme()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        line = painter.fontMetrics().height() + 2
        box = QRectF(0.5, 0.5, self.width() - 1, self.height() - line - 1)
        painter.setPen(QPen(QColor(theme.border), 1))
        painter.setBrush(QColor(theme.base))
        painter.drawRoundedRect(box, 5, 5)
        if self._volume is None or self._transfer is None:
            return
        plot = box.adjusted(5, 6, -5, -16)
        self._draw_histogram(painter, plot)
        self._draw_strip(painter, QRectF(plot.left(), plot.bottom() + 4, plot.width(), 7))
        self._draw_curve(painter, plot)
        low, high = self._volume.value_range
        unit = " HU" if self._volume.info.modality == "CT" else ""
        ends = QRectF(2, self.height() - line, self.width() - 4, line)
        painter.setPen(QColor(theme.muted))
        painter.drawText(ends, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, f"{low:g}{unit}")
        painter.drawText(ends, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, f"{high:g}{unit}")

    def _draw_histogram(self, painter: QPainter, plot: QRectF) -> None:
        xs = np.linspace(plot.left(), plot.right(), len(self._bars))
        tops = [QPointF(x, plot.bottom() - b * plot.height()) for x, b in zip(xs, self._bars, strict=True)]
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(current_theme().separator))
        painter.drawPolygon(
            QPolygonF([QPointF(plot.left(), plot.bottom()), *tops, QPointF(plot.right(), plot.bottom())])
        )

    def _samples(self, count: int) -> np.ndarray:
        assert self._volume is not None
        assert self._transfer is not None
        return self._transfer.evaluate(np.linspace(*self._volume.value_range, count))

    def _draw_strip(self, painter: QPainter, strip: QRectF) -> None:
        colours = self._samples(int(strip.width()))
        for i, row in enumerate(colours):
            painter.setPen(to_srgb((float(row[0]), float(row[1]), float(row[2]))))
            painter.drawLine(
                QPointF(strip.left() + i, strip.top()), QPointF(strip.left() + i, strip.bottom())
            )

    def _draw_curve(self, painter: QPainter, plot: QRectF) -> None:
        alpha = self._samples(int(plot.width()))[:, 3]
        painter.setPen(QPen(QColor(current_theme().accent), 1.6))
        painter.drawPolyline(
            QPolygonF(
                [QPointF(plot.left() + i, plot.bottom() - a * plot.height()) for i, a in enumerate(alpha)]
            )
        )
