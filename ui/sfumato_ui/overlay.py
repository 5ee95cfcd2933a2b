"""What is drawn over the picture: the patient's sides, the hint, the lamp while it moves."""

from __future__ import annotations

from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen

from sfumato import Light

from . import light_moves

#: Radius of the hemisphere on which Shift-drag moves the lamp, in picture heights.
LIGHT_RADIUS = 0.4
_INK = QColor(255, 255, 255)
_SHADE = QColor(20, 20, 20, 200)


def draw_text(painter: QPainter, box: QRectF, text: str) -> None:
    """Draw white text on a dark rounded patch, legible on any picture."""
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(_SHADE)
    painter.drawRoundedRect(box, 4, 4)
    painter.setPen(_INK)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def draw_centred(painter: QPainter, area: QRect, text: str) -> None:
    """Draw text in the middle of the empty picture."""
    painter.setPen(_INK)
    painter.drawText(area, Qt.AlignmentFlag.AlignCenter, text)


def draw_letters(painter: QPainter, area: QRect, letters: dict[str, str] | None) -> None:
    """Name the patient's sides at the picture's edges, or say that they are not known."""
    metrics = painter.fontMetrics()
    side = metrics.height() + 4
    if letters is None:
        width = metrics.horizontalAdvance("orientation unknown") + 16
        draw_text(
            painter, QRectF(area.left() + 8, area.bottom() - side - 7, width, side), "orientation unknown"
        )
        return
    x, y = area.center().x(), area.center().y()
    for edge, (left, top) in {
        "left": (area.left() + 8, y - side / 2), "right": (area.right() - side - 7, y - side / 2),
        "top": (x - side / 2, area.top() + 8), "bottom": (x - side / 2, area.bottom() - side - 7),
    }.items():  # fmt: skip
        draw_text(painter, QRectF(left, top, side, side), letters[edge])


def draw_hint(painter: QPainter, area: QRect, text: str) -> None:
    """Draw the hint near the picture's lower edge."""
    metrics = painter.fontMetrics()
    width, height = metrics.horizontalAdvance(text) + 28, metrics.height() + 14
    top = area.bottom() - height - metrics.height() - 24
    draw_text(painter, QRectF(area.center().x() - width / 2, top, width, height), text)


def draw_light_guide(painter: QPainter, area: QRect, light: Light) -> None:
    """Show the hemisphere and the lamp on it while the lamp is dragged in the picture."""
    radius = LIGHT_RADIUS * area.height()
    centre = QPointF(area.width() / 2, area.height() / 2)
    x, y = light_moves.to_disc(light.tilt, light.rotation)
    lamp = QPointF(centre.x() + x * radius, centre.y() - y * radius)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for colour, width in ((QColor(0, 0, 0, 160), 3.0), (QColor(255, 255, 255, 190), 1.0)):
        painter.setPen(QPen(colour, width))
        painter.drawEllipse(centre, radius, radius)
        painter.drawLine(centre, lamp)
    painter.setPen(QPen(QColor("#1b1b1b"), 2))
    painter.setBrush(QColor("#f2b34c"))
    painter.drawEllipse(lamp, 9.0, 9.0)
    words = f"tilt {light.tilt:.0f}°   rotation {light.rotation % 360:.0f}°"
    metrics = painter.fontMetrics()
    wide, tall = metrics.horizontalAdvance(words) + 20, metrics.height() + 8
    draw_text(painter, QRectF(lamp.x() - wide / 2, lamp.y() + 16, wide, tall), words)
