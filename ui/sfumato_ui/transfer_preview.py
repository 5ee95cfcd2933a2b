"""A small picture of a transfer function's colours."""

from __future__ import annotations

import numpy as np
from qtpy.QtGui import QColor, QIcon, QPainter, QPixmap

from sfumato import TransferFunction

from .color_button import to_srgb


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
