"""How the transfer function is drawn: histogram, curve filled with its colours, points, strip and axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QImage, QPainter, QPainterPath, QPen, QPolygonF

from sfumato import TransferFunction

from ..theme import Theme
from ..transfer_preview import colours
from .histogram import Histogram
from .scale import OPACITY_LINES, Scale, ticks
from .tissue import TISSUES

#: Radius of a point in pixels.
POINT = 5.5
STRIP = 8.0
_INSET = 9.0


@dataclass(frozen=True)
class Areas:
    """The parts of the widget, in pixels: box around all, plot, colour strip, axis and marks of tissues."""

    box: QRectF
    plot: QRectF
    strip: QRectF
    axis: QRectF
    marks: QRectF


def areas_of(width: float, height: float, line: float, gutter: float, marked: bool) -> Areas:
    """Divide the widget.

    `line` is the height of a line of small text, `gutter` the room for numbers at the right; `marked` leaves
    a line for the tissues.
    """
    box = QRectF(0.5, 0.5, width - 1, height - line - 4)
    inside = box.width() - 2 * _INSET - gutter
    marks = QRectF(box.left() + _INSET, box.top() + 3, inside, line + 3 if marked else 0.0)
    top = marks.bottom() + 9
    strip = QRectF(box.left() + _INSET, box.bottom() - STRIP - 6, inside, STRIP)
    plot = QRectF(strip.left(), top, strip.width(), strip.top() - 9 - top)
    return Areas(box, plot, strip, QRectF(strip.left(), box.bottom() + 3, strip.width(), line), marks)


def small(font: QFont) -> QFont:
    """Return the font of the axis."""
    reduced = QFont(font)
    reduced.setPointSizeF(max(7.0, font.pointSizeF() * 0.88))
    return reduced


def text_of(value: float, decimals: int) -> str:
    """Return a number with a true minus sign."""
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return ("0" if text in ("-0", "") else text).replace("-", "\N{MINUS SIGN}")


# -- behind ---------------------------------------------------------------------------------------
def draw_box(painter: QPainter, areas: Areas, theme: Theme, focused: bool) -> None:
    """Draw the frame and its ground."""
    painter.setPen(QPen(QColor(theme.accent), 2) if focused else QPen(QColor(theme.border), 1))
    painter.setBrush(QColor(theme.base))
    inset = 0.5 if focused else 0.0
    painter.drawRoundedRect(areas.box.adjusted(inset, inset, -inset, -inset), 5, 5)


def draw_histogram(painter: QPainter, scale: Scale, histogram: Histogram, theme: Theme) -> None:
    """Draw the values' logarithmic histogram."""
    if not len(histogram.values):
        return
    rect = scale.rect
    xs = rect.left() + (histogram.values - scale.low) / (scale.high - scale.low) * rect.width()
    ys = rect.bottom() - histogram.heights * rect.height() * 0.92
    outline = [QPointF(x, y) for x, y in zip(xs.tolist(), ys.tolist(), strict=True)]
    polygon = QPolygonF([QPointF(outline[0].x(), rect.bottom()), *outline])
    polygon.append(QPointF(outline[-1].x(), rect.bottom()))
    ground = QColor(theme.border)
    ground.setAlphaF(0.32)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(ground)
    painter.drawPolygon(polygon)


def draw_lines(painter: QPainter, scale: Scale, theme: Theme) -> None:
    """Draw the lines of round opacities, with their numbers in the gutter at the right."""
    metrics = QFontMetricsF(painter.font())
    for opacity in (0.0, *OPACITY_LINES):
        y = round(scale.y(opacity)) + 0.5
        painter.setPen(QPen(QColor(theme.separator), 1))
        painter.drawLine(QPointF(scale.rect.left() - 5, y), QPointF(scale.rect.right() + 5, y))
        if opacity > 0:
            text = f"{100 * opacity:g} %"
            painter.setPen(QColor(theme.muted))
            painter.drawText(QPointF(scale.rect.right() + 9, y + 0.36 * metrics.ascent()), text)


def draw_axis(
    painter: QPainter, areas: Areas, scale: Scale, theme: Theme, zero: float, unit: str, decimals: int
) -> None:
    """Draw round values below, and the unit at the right end."""
    metrics, axis = QFontMetricsF(painter.font()), areas.axis
    painter.setPen(QColor(theme.muted))
    right = areas.box.right() - 2
    if unit:
        right -= metrics.horizontalAdvance(unit)
        painter.drawText(QPointF(right, axis.top() + metrics.ascent()), unit)
        right -= 6
    widest = max(metrics.horizontalAdvance(text_of(v - zero, decimals)) for v in (scale.low, scale.high))
    for value in ticks(scale.low - zero, scale.high - zero, int(axis.width() / (widest + 10))):
        text, x = text_of(value, decimals), scale.x(value + zero)
        half = metrics.horizontalAdvance(text) / 2
        painter.drawLine(QPointF(x, areas.box.bottom() + 1), QPointF(x, areas.box.bottom() + 4))
        if x + half < right:
            painter.drawText(QPointF(max(1.0, x - half), axis.top() + metrics.ascent()), text)


def draw_tissues(painter: QPainter, areas: Areas, scale: Scale, theme: Theme, zero: float) -> None:
    """Mark the tissues above; a name that has no room is left out, its tick stays."""
    metrics, taken = QFontMetricsF(painter.font()), list[tuple[float, float]]()
    for tissue in TISSUES:
        x = scale.x(tissue.middle + zero)
        if not scale.rect.left() - 4 <= x <= scale.rect.right() + 4:
            continue
        painter.setPen(QPen(QColor(theme.border), 1.2))
        painter.drawLine(QPointF(x, areas.marks.bottom() - 3), QPointF(x, areas.marks.bottom() + 2))
        width = metrics.horizontalAdvance(tissue.name)
        left = min(max(x - width / 2, areas.marks.left() - 4), areas.marks.right() + 4 - width)
        if all(left > b + 5 or left + width < a - 5 for a, b in taken):
            taken.append((left, left + width))
            painter.setPen(QColor(theme.muted))
            painter.drawText(QPointF(left, areas.marks.top() + metrics.ascent()), tissue.name)


# -- the function ---------------------------------------------------------------------------------
def colours_of(transfer: TransferFunction, scale: Scale) -> QImage:
    """Return the function's colours over the plot's width as a picture one pixel high."""
    return colours(transfer, scale.low, scale.high, max(2, round(scale.rect.width())))


def curve_of(transfer: TransferFunction, scale: Scale) -> list[QPointF]:
    """Return the opacity's curve, a point a pixel and at each of the function's own."""
    own = np.array([p.value for p in transfer.points])
    values = np.linspace(scale.low, scale.high, max(2, round(scale.rect.width())))
    inside = own[(own > scale.low) & (own < scale.high)]
    # Just beside each point, so that a step of two points at one value stays upright.
    values = np.sort(np.concatenate([values, inside, np.nextafter(inside, np.inf)]))
    opacity = np.interp(values, own, [p.opacity for p in transfer.points])
    xs = scale.rect.left() + (values - scale.low) / (scale.high - scale.low) * scale.rect.width()
    ys = scale.rect.bottom() - np.sqrt(np.clip(opacity, 0, 1)) * scale.rect.height()
    return [QPointF(x, y) for x, y in zip(xs.tolist(), ys.tolist(), strict=True)]


def draw_function(
    painter: QPainter, areas: Areas, curve: list[QPointF], colours: QImage, theme: Theme
) -> None:
    """Draw the curve, what is below it in its colours, and the strip of colours."""
    below = QPainterPath(QPointF(curve[0].x(), areas.plot.bottom()))
    for point in curve:
        below.lineTo(point)
    below.lineTo(QPointF(curve[-1].x(), areas.plot.bottom()))
    below.closeSubpath()
    painter.save()
    painter.setClipPath(below, Qt.ClipOperation.IntersectClip)
    painter.setOpacity(0.72)
    painter.drawImage(areas.plot, colours)
    painter.restore()
    rounded = QPainterPath()
    rounded.addRoundedRect(areas.strip, 3, 3)
    painter.save()
    painter.setClipPath(rounded)
    painter.drawImage(areas.strip, colours)
    painter.restore()
    painter.setPen(QPen(QColor(theme.border), 1))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPath(rounded)
    painter.setPen(QPen(QColor(theme.text), 1.6, j=Qt.PenJoinStyle.RoundJoin))
    painter.drawPolyline(QPolygonF(curve))


def draw_point(
    painter: QPainter, at: QPointF, colour: QColor, theme: Theme, *, selected: bool, hot: bool
) -> None:
    """Draw one point of the function in its colour."""
    radius = POINT + (1.5 if selected or hot else 0.0)
    painter.setBrush(QColor(theme.base))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawEllipse(at, radius + 2, radius + 2)
    painter.setBrush(colour)
    painter.setPen(QPen(QColor(theme.accent if selected else theme.text), 2.4 if selected else 1.4))
    painter.drawEllipse(at, radius, radius)


def draw_peaks(painter: QPainter, scale: Scale, peaks: tuple[float, ...], theme: Theme) -> None:
    """Mark the histogram's peaks below it: points snap to them."""
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(theme.muted))
    foot = scale.rect.bottom()
    for peak in peaks:
        x = scale.at(peak, 0).x()
        if scale.rect.left() <= x <= scale.rect.right():
            painter.drawPolygon([QPointF(x, foot - 5), QPointF(x - 3, foot), QPointF(x + 3, foot)])


def draw_picked(painter: QPainter, scale: Scale, value: float, theme: Theme) -> None:
    """Draw where the value lies that was picked in the picture."""
    x = scale.at(value, 0).x()
    if scale.rect.left() - 1 <= x <= scale.rect.right() + 1:
        painter.setPen(QPen(QColor(theme.accent), 1.5, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(x, scale.rect.top()), QPointF(x, scale.rect.bottom()))


def draw_readout(painter: QPainter, areas: Areas, text: str, theme: Theme) -> None:
    """Write what lies under the pointer in the tissues' line, else into the plot's upper left corner."""
    metrics = QFontMetricsF(painter.font())
    ground = QColor(theme.base)
    if areas.marks.height():  # it names the tissue, and covers no point there
        box = areas.marks.adjusted(-4, 0, 4, -3)
    else:
        ground.setAlphaF(0.85)
        width = metrics.horizontalAdvance(text) + 10
        box = QRectF(areas.plot.left() - 4, areas.plot.top() - 6, width, metrics.height() + 4)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(ground)
    painter.drawRoundedRect(box, 3, 3)
    painter.setPen(QColor(theme.text))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def draw_message(painter: QPainter, areas: Areas, text: str, theme: Theme) -> None:
    """Write why there is nothing to drag."""
    painter.setPen(QColor(theme.muted))
    box = areas.box.adjusted(16, 8, -16, -8)
    painter.drawText(box, int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap), text)
