"""What is drawn over the picture whatever the tool: the patient's sides and the hint."""

from __future__ import annotations

from qtpy.QtCore import QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter

#: Radius of the hemisphere on which lamps are moved, in the shorter side of the picture; with the ring
#: around it for lamps from behind it fills the picture.
LIGHT_RADIUS = 0.36
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
    """Draw the hint in the picture's lower right corner, where the subject seldom is and no letter."""
    metrics = painter.fontMetrics()
    width, height = metrics.horizontalAdvance(text) + 28, metrics.height() + 14
    draw_text(painter, QRectF(area.right() - width - 7, area.bottom() - height - 7, width, height), text)
