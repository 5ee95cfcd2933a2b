"""What is drawn over the picture whatever the tool: the patient's sides and the hint."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QImage, QPainter

from sfumato import Camera
from sfumato.export.encode import srgb
from sfumato.export.scale_bar import SHARE, round_length, words_for
from sfumato.geometry import ColorBar

#: Radius of the hemisphere on which lamps are moved, in the shorter side of the picture; with the ring
#: around it for lamps from behind it fills the picture.
LIGHT_RADIUS = 0.36
#: Size in pixels of a colour bar's strip, where there is room.
BAR_WIDTH, BAR_HEIGHT = 14, 150
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
    """Name the patient's sides at the picture's edges, or say that they are not known; an edge may have no name."""
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
        if edge in letters:
            draw_text(painter, QRectF(left, top, side, side), letters[edge])


def draw_hint(painter: QPainter, area: QRect, text: str) -> None:
    """Draw the hint in the lower right corner, where the subject seldom is; in a narrow picture above the letters."""
    metrics = painter.fontMetrics()
    width, height, side = metrics.horizontalAdvance(text) + 28, metrics.height() + 14, metrics.height() + 4
    lift = side + 14 if width + 15 > (area.width() - side) / 2 else 7
    draw_text(painter, QRectF(area.right() - width - 7, area.bottom() - height - lift, width, height), text)


def draw_badge(painter: QPainter, area: QRect, text: str) -> None:
    """Draw in the picture's upper right corner what must not be overlooked."""
    metrics = painter.fontMetrics()
    width, height = metrics.horizontalAdvance(text) + 20, metrics.height() + 8
    draw_text(painter, QRectF(area.right() - width - 7, area.top() + 8, width, height), text)


def draw_scale_bar(painter: QPainter, area: QRect, camera: Camera, lift: float = 0.0) -> None:
    """Draw a bar of true length in the lower right corner of an orthographic picture, ``lift`` pixels higher."""
    if not camera.parallel_projection:
        return
    length, pixels = scale_bar_length(camera, area.width(), area.height())
    metrics = painter.fontMetrics()
    text = words_for(length)
    wide, high = max(pixels, metrics.horizontalAdvance(text)) + 16, metrics.height() + 18
    box = QRectF(area.right() - wide - 7, area.bottom() - high - 7 - lift, wide, high)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(_SHADE)
    painter.drawRoundedRect(box, 4, 4)
    painter.setPen(_INK)
    painter.drawText(box.adjusted(0, 3, 0, -12), Qt.AlignmentFlag.AlignCenter, text)
    painter.fillRect(QRectF(box.center().x() - pixels / 2, box.bottom() - 10, pixels, 4), _INK)


def scale_bar_length(camera: Camera, width: float, height: float) -> tuple[float, float]:
    """Return the length in mm of an orthographic picture's scale bar, and the same in pixels of the picture."""
    per_pixel = 2 * camera.parallel_scale / height
    length = round_length(SHARE * width * per_pixel)
    return length, length / per_pixel


def draw_color_bars(painter: QPainter, area: QRect, bars: Sequence[ColorBar]) -> None:
    """Draw colour bars in the picture's lower left corner, beside each other, above the letters' row."""
    line = painter.fontMetrics().height()
    height = min(BAR_HEIGHT, area.height() // 3)
    left = area.left() + 14
    top = area.bottom() - height - 3 * line
    for bar in bars:
        texts = [text for _, text in bar.ticks]
        wide = max(painter.fontMetrics().horizontalAdvance(t) for t in (*texts, bar.title))
        box = QRectF(left - 6, top - line - 8, BAR_WIDTH + wide + 22, height + line + 18)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(_SHADE)
        painter.drawRoundedRect(box, 4, 4)
        _draw_bar(painter, QRectF(left, top, BAR_WIDTH, height), bar)
        left += round(box.width()) + 8


def _draw_bar(painter: QPainter, strip: QRectF, bar: ColorBar) -> None:
    rows = max(1, round(strip.height()))
    picked = bar.colors[np.linspace(len(bar.colors) - 1, 0, rows).astype(int)]
    pixels = np.ascontiguousarray(np.rint(255 * srgb(picked)).astype(np.uint8))
    # A row of one pixel is three bytes: Qt has to be told, it would take four.
    painter.drawImage(strip, QImage(pixels.data, 1, rows, 3, QImage.Format.Format_RGB888))
    painter.setPen(_INK)
    line = painter.fontMetrics().height()
    middle = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
    painter.drawText(QRectF(strip.left(), strip.top() - line - 4, 400, line), middle, bar.title)
    for value, text in bar.ticks:
        y = strip.bottom() - strip.height() * (value - bar.low) / (bar.high - bar.low)
        painter.drawLine(QPointF(strip.right(), y), QPointF(strip.right() + 4, y))
        painter.drawText(QRectF(strip.right() + 8, y - line / 2, 400, line), middle, text)
