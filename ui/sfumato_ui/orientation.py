"""The orientation cube in the picture's upper left corner: whose side one looks at, and a way to the others."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRectF
from qtpy.QtGui import QImage, QPainter

from sfumato import Camera
from sfumato.export.orientation_cube import cube_pixels, face_at

from .settings import settings

#: Side of the square in which it turns, and distance from the picture's edges, in widget pixels.
SIDE, MARGIN = 76, 10
_KEPT = "view/orientation_cube"


def cube_wanted() -> bool:
    """Tell whether the user wants it."""
    return bool(settings().value(_KEPT, False, type=bool))


class OrientationCube:
    """Draws the cube, and tells which of its faces is under the pointer."""

    def __init__(self) -> None:
        self.on = cube_wanted()
        self._key: tuple[object, ...] = ()
        self._image = QImage()

    def set_on(self, on: bool) -> None:
        """Show it or not, and remember that."""
        self.on = on
        settings().setValue(_KEPT, on)

    def paint(self, painter: QPainter, camera: Camera, known: bool, ratio: float) -> None:
        """Draw it as the camera sees it; it is made anew only when the camera has turned."""
        basis = camera.basis()
        key = (basis.right, basis.up, known, ratio)
        if key != self._key:
            self._key, self._image = key, _image(cube_pixels(camera, round(SIDE * ratio), known))
        painter.drawImage(QRectF(MARGIN, MARGIN, SIDE, SIDE), self._image)

    def face(self, camera: Camera, at: QPointF) -> str:
        """Return the standard view that looks at the face under a place in the picture; "" if it is none."""
        x, y = (at.x() - MARGIN) / SIDE * 2 - 1, 1 - (at.y() - MARGIN) / SIDE * 2
        if not self.on or max(abs(x), abs(y)) > 1:
            return ""
        return face_at(camera, x, y)


def _image(pixels: np.ndarray) -> QImage:
    """Return grey and coverage as a picture, straight alpha."""
    coded = np.rint(255 * pixels).astype(np.uint8)
    rgba = np.ascontiguousarray(coded[..., [0, 0, 0, 1]])
    height, width = rgba.shape[:2]
    # A copy: the picture must not outlive the array.
    return QImage(rgba.data, width, height, 4 * width, QImage.Format.Format_RGBA8888).copy()
