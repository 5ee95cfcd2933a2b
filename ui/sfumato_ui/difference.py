"""How much two pictures differ to the eye: CIE 1976 colour difference, shown by a perceptually uniform map."""

from __future__ import annotations

import numpy as np
from qtpy.QtGui import QColor, QImage, QPainter

from sfumato.colorimetry import cielab
from sfumato.export.encode import srgb
from sfumato.geometry import ColorBar
from sfumato.geometry.color import color_table, linear
from sfumato.geometry.color_bar import round_ticks

from .theme import PICTURE_GREY

#: Perceptually uniform, and told apart by colour-blind people.
MAP = "viridis"
#: Upper ends of the scale: the least that holds all but a thousandth of the pixels is taken.
ENDS = (5.0, 10.0, 20.0, 50.0, 100.0)
_LINEAR = linear(np.arange(256) / 255).astype(np.float32)


def seen(image: QImage) -> np.ndarray:
    """Return a picture on the window's grey as sRGB, shape (height, width, 3), uint8."""
    ground = QImage(image.width(), image.height(), QImage.Format.Format_RGB888)
    ground.fill(QColor(PICTURE_GREY))
    painter = QPainter(ground)
    painter.drawImage(0, 0, image)
    painter.end()
    flat = np.frombuffer(ground.constBits(), np.uint8).reshape(ground.height(), ground.bytesPerLine())
    return flat[:, : 3 * ground.width()].reshape(ground.height(), ground.width(), 3).copy()


def color_difference(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the CIE 1976 difference (about 2 is just seen) of sRGB pictures of one size, shape (height, width)."""
    return np.asarray(np.linalg.norm(cielab(_LINEAR[one]) - cielab(_LINEAR[other]), axis=-1))


def difference_picture(one: QImage, other: QImage) -> tuple[QImage, ColorBar, float]:
    """Return the map of the differences of two pictures, its legend, and their mean."""
    if other.size() != one.size():
        other = other.scaled(one.size())
    amount = color_difference(seen(one), seen(other))
    most = float(np.quantile(amount, 0.999))
    high = next((end for end in ENDS if end >= most), ENDS[-1])
    table = color_table(MAP)
    colors = np.rint(255 * srgb(table)).astype(np.uint8)
    shown = colors[np.clip(amount / high * (len(colors) - 1), 0, len(colors) - 1).astype(np.int32)]
    height, width = amount.shape
    image = QImage(np.ascontiguousarray(shown).data, width, height, 3 * width, QImage.Format.Format_RGB888)
    bar = ColorBar("Difference (ΔE)", 0.0, high, round_ticks(0.0, high), table)
    return image.copy(), bar, float(amount.mean())
