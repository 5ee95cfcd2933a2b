"""How a two-dimensional function is drawn: joint histogram, the function's own colours over it, shapes, handles."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QFontMetricsF, QImage, QPainter, QPen, QPolygonF

from sfumato import Region, TransferFunction
from sfumato.scene.joint_histogram import JointHistogram
from sfumato.scene.region_edit import MIDDLE, outline

from ..theme import Theme
from .painting import Areas, text_of
from .plane import Plane
from .scale import decimals_for, ticks

#: Half the side of a handle in pixels.
HANDLE = 4.0
_INSET = 9.0
#: Pixels of the plot for one of the function's picture: its edges are soft anyway.
_COARSE = 2
#: How far the densest bin's lightness is from the ground's, of the way to the muted text's.
_REACH = 0.85
#: Opacity in the plot of what is opaque.
_FILL = 0.5


def areas_of(width: float, height: float, line: float, gutter: float, unit: float) -> Areas:
    """Divide the widget: as for one dimension, without the strip of colours; `unit` is the width of the gradients'."""
    box = QRectF(0.5, 0.5, width - 1, height - line - 4)
    inside = box.width() - 2 * _INSET - gutter
    marks = QRectF(box.left() + _INSET, box.top() + 3, box.width() - _INSET - unit - 20, line + 3)
    top = marks.bottom() + 5
    plot = QRectF(marks.left(), top, inside, box.bottom() - 9 - top)
    strip = QRectF(plot.left(), plot.bottom(), plot.width(), 0)
    return Areas(box, plot, strip, QRectF(plot.left(), box.bottom() + 3, plot.width(), line), marks)


# -- behind ---------------------------------------------------------------------------------------
def histogram_image(histogram: JointHistogram, theme: Theme) -> QImage:
    """Return a joint histogram as a picture, a pixel a bin, steep gradients above.

    On the plain ground its greys go in equal steps of lightness, and on the shapes' colours they stay to be seen:
    they are laid over them, as much as each differs from the ground.
    """
    ground, dense = QColor(theme.base), QColor(theme.muted)
    darkest = _lightness(ground)
    grey = _grey(darkest + (_lightness(dense) - darkest) * _REACH * histogram.heights[::-1])
    cover = np.clip((grey - 255 * ground.redF()) / (255 * (dense.redF() - ground.redF())), 0, 1)
    pixels = np.empty((*grey.shape, 4), dtype=np.uint8)
    pixels[..., :3], pixels[..., 3] = dense.red(), np.rint(255 * cover)
    return _image(pixels)


def _image(pixels: np.ndarray) -> QImage:
    """Return 8-bit RGBA, shape (height, width, 4), as a picture."""
    height, width = pixels.shape[:2]
    flat = np.ascontiguousarray(pixels).tobytes()
    return QImage(flat, width, height, 4 * width, QImage.Format.Format_RGBA8888).copy()


def _lightness(grey: QColor) -> float:
    """Return L* of a grey."""
    c = grey.redF()
    linear = c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
    return 116 * linear ** (1 / 3) - 16 if linear > (6 / 29) ** 3 else linear * (29 / 3) ** 3


def _grey(lightness: np.ndarray) -> np.ndarray:
    """Return the sRGB greys, 0 to 255 and between, of some L*."""
    linear = np.where(lightness > 8, ((lightness + 16) / 116) ** 3, lightness * (3 / 29) ** 3)
    srgb = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * np.abs(linear) ** (1 / 2.4) - 0.055)
    return np.asarray(np.clip(srgb, 0, 1) * 255)


def draw_histogram(painter: QPainter, plane: Plane, histogram: JointHistogram, image: QImage) -> None:
    """Draw the part of the histogram that is in view."""
    corners = [plane.at(v, g) for v, g in zip(histogram.values, reversed(histogram.gradients), strict=True)]
    painter.save()
    painter.setClipRect(plane.rect)
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    painter.drawImage(QRectF(*corners), image)
    painter.restore()


def draw_gradient_axis(painter: QPainter, areas: Areas, plane: Plane, theme: Theme, unit: str) -> None:
    """Draw round gradients in the gutter at the right, with faint lines, and their unit above them."""
    metrics, rect = QFontMetricsF(painter.font()), plane.rect
    low, high = plane.gradients
    decimals = decimals_for(high - low) if high - low < 100 else 0
    for gradient in ticks(low, high, max(1, int(rect.height() / (2.2 * metrics.height())))):
        y = plane.at(plane.values[0], gradient).y()
        painter.setPen(QPen(QColor(theme.separator), 1))
        painter.drawLine(QPointF(rect.right(), y), QPointF(rect.right() + 5, y))
        painter.setPen(QColor(theme.muted))
        text = text_of(gradient, decimals)
        painter.drawText(QPointF(rect.right() + 8, y + 0.36 * metrics.ascent()), text)
    painter.setPen(QColor(theme.muted))
    right = areas.box.right() - 6
    painter.drawText(
        QPointF(right - metrics.horizontalAdvance(unit), areas.marks.top() + metrics.ascent()), unit
    )


# -- the function ---------------------------------------------------------------------------------
def function_image(transfer: TransferFunction, plane: Plane) -> QImage:
    """Return what the function shows over the plot: its colours, the more opaque the more there."""
    width = max(2, round(plane.rect.width() / _COARSE))
    height = max(2, round(plane.rect.height() / _COARSE))
    values = np.linspace(*plane.values, width)[None, :]
    gradients = np.linspace(*plane.gradients[::-1], height)[:, None]
    look = transfer.evaluate_2d(values, gradients)
    # By its square root, as the plot of one dimension has it: what thin tissue needs lies below 10 %.
    alpha = _FILL * np.sqrt(np.clip(look[..., 3:4], 0, 1))
    linear = np.clip(look[..., :3], 0, 1)
    srgb = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    return _image(np.rint(np.concatenate([srgb, alpha], axis=-1) * 255).astype(np.uint8))


def draw_function(painter: QPainter, plane: Plane, image: QImage) -> None:
    """Draw the function's colours."""
    painter.save()
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    painter.drawImage(plane.rect, image)
    painter.restore()


def polygon_of(region: Region, plane: Plane) -> QPolygonF:
    """Return a region's edge in pixels."""
    return QPolygonF([QPointF(x, y) for x, y in plane.places(outline(region)).tolist()])


def draw_shape(
    painter: QPainter, plane: Plane, region: Region, theme: Theme, *, selected: bool, hot: bool
) -> None:
    """Draw a region's edge, over a line of the ground's colour so that it is seen on any ground."""
    polygon = polygon_of(region, plane)
    painter.save()
    painter.setClipRect(plane.rect.adjusted(-1, -1, 1, 1))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    width = 2.0 if selected or hot else 1.2
    for colour, wide in ((theme.base, width + 2), (theme.accent if selected else theme.text, width)):
        painter.setPen(QPen(QColor(colour), wide, j=Qt.PenJoinStyle.RoundJoin))
        painter.drawPolygon(polygon)
    painter.restore()


def draw_handle(painter: QPainter, at: QPointF, name: str, theme: Theme, *, hot: bool) -> None:
    """Draw a handle: squares stretch, the round one in the middle moves."""
    half = HANDLE + (1.5 if hot else 0.0)
    painter.setPen(QPen(QColor(theme.base), 1.5))
    painter.setBrush(QColor(theme.accent))
    box = QRectF(at.x() - half, at.y() - half, 2 * half, 2 * half)
    if name == MIDDLE:
        painter.drawEllipse(box)
    else:
        painter.drawRect(box)


def draw_outline(painter: QPainter, places: list[QPointF], theme: Theme) -> None:
    """Draw the outline that a hand draws."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for colour, wide in ((theme.base, 4.0), (theme.accent, 2.0)):
        painter.setPen(QPen(QColor(colour), wide, j=Qt.PenJoinStyle.RoundJoin))
        painter.drawPolyline(QPolygonF(places))


def draw_picked(painter: QPainter, plane: Plane, value: float, gradient: float, theme: Theme) -> None:
    """Draw a cross where what was picked in the picture lies."""
    at = plane.clamped(plane.at(value, gradient))
    rect = plane.rect
    painter.setPen(QPen(QColor(theme.accent), 1.2, Qt.PenStyle.DashLine))
    painter.drawLine(QPointF(at.x(), rect.top()), QPointF(at.x(), rect.bottom()))
    painter.drawLine(QPointF(rect.left(), at.y()), QPointF(rect.right(), at.y()))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for colour, wide in ((theme.base, 4.0), (theme.accent, 2.0)):
        painter.setPen(QPen(QColor(colour), wide))
        painter.drawEllipse(at, 6.0, 6.0)
