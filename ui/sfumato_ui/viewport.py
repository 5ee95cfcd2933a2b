"""The picture: paints the newest one and turns the hand's moves into edits of camera and lamp.

Left drag orbits; with Shift it moves the selected lamp, with Ctrl or Alt (or the middle button) it pans,
with Ctrl and Shift (or the right button) it zooms. The wheel zooms about the cursor. Arrow keys orbit by
5 degrees, + and - zoom.
"""

from __future__ import annotations

import math

import numpy as np
from qtpy.QtCore import QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import (
    QColor,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
    QShowEvent,
    QWheelEvent,
)
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato import Camera

from . import camera_moves, light_moves, overlay
from .dial import MOVE
from .editing import Editor
from .theme import PICTURE_GREY, current_theme
from .worker import Picture

_MODIFIER = Qt.KeyboardModifier
LABELS = {"orbit": "Orbit", "pan": "Pan", "zoom": "Zoom", "light": MOVE}
#: Degrees that a drag across the picture's height turns the subject.
DEGREES_ACROSS = 220.0
ARROW_DEGREES = 5.0
ZOOM_STEP = 1.12


class Viewport(QWidget):
    """Shows pictures, takes the mouse and the keys."""

    #: The size in pixels changed.
    resized = Signal()
    #: The user moved the lamp in the picture (for the hint).
    lamp_moved = Signal()

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._picture: Picture | None = None
        self._mode = ""
        self._last = QPointF()
        self.tool = "orbit"
        self.hint = ""
        self.empty_text = "Drop a volume or a folder here, or press Ctrl+O"
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(240, 180)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setAccessibleName("Picture")
        self.setAccessibleDescription(
            "Drag to orbit, Shift-drag to move the light, wheel to zoom, arrow keys to orbit"
        )

    def sizeHint(self) -> QSize:
        """Take what is there."""
        return QSize(916, 640)

    # -- what is shown ----------------------------------------------------------------------------
    @property
    def pixel_size(self) -> tuple[int, int]:
        """Width and height in device pixels."""
        ratio = self.devicePixelRatioF()
        return max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio))

    @property
    def picture(self) -> Picture | None:
        """The picture that is shown."""
        return self._picture

    def show_picture(self, picture: Picture | None) -> None:
        """Show a picture, or none."""
        self._picture = picture
        self.update()

    def set_hint(self, text: str) -> None:
        """Show a hint on the picture; nothing, if the text is empty."""
        self.hint = text
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the picture on neutral grey, then letters, hint and focus."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(PICTURE_GREY))
        scene = self._editor.scene
        if self._picture is not None:
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.drawImage(self._target(self._picture), self._picture.image)
        elif scene.volume is None:
            overlay.draw_centred(painter, self.rect(), self.empty_text)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if scene.volume is not None and scene.camera is not None:
            known = scene.volume.info.orientation_known
            overlay.draw_letters(
                painter, self.rect(), camera_moves.edge_letters(scene.camera) if known else None
            )
        if self._mode == "light" and self._editor.light is not None:
            overlay.draw_light_guide(painter, self.rect(), self._editor.light)
        if self.hint and scene.volume is not None:
            overlay.draw_hint(painter, self.rect(), self.hint)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(current_theme().accent), 2))
            painter.drawRect(self.rect().adjusted(1, 1, -1, -1))

    def _target(self, picture: Picture) -> QRectF:
        """Return where to paint: a picture of another size keeps its height, as the camera's opening does."""
        if picture.size == self.pixel_size:
            return QRectF(self.rect())
        width = self.height() * picture.size[0] / picture.size[1]
        return QRectF((self.width() - width) / 2, 0, width, self.height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Tell that another size is wanted."""
        super().resizeEvent(event)
        self.resized.emit()

    def showEvent(self, event: QShowEvent) -> None:
        """Only now is the size known."""
        super().showEvent(event)
        self.resized.emit()

    # -- mouse ------------------------------------------------------------------------------------
    def _mode_for(self, event: QMouseEvent) -> str:
        button, keys = event.button(), event.modifiers()
        shift = bool(keys & _MODIFIER.ShiftModifier)
        pan = bool(keys & (_MODIFIER.ControlModifier | _MODIFIER.AltModifier))
        if button == Qt.MouseButton.MiddleButton:
            return "pan"
        if button == Qt.MouseButton.RightButton:
            return "zoom"
        if button != Qt.MouseButton.LeftButton:
            return ""
        if pan:
            return "zoom" if shift else "pan"
        return "light" if shift or self.tool == "light" else "orbit"

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a drag."""
        if self._mode or self._editor.scene.camera is None:
            return
        self._mode = self._mode_for(event)
        self._last = event.position()
        if self._mode:
            self._editor.begin(LABELS[self._mode])
            self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow the pointer."""
        if not self._mode:
            return
        delta = event.position() - self._last
        self._last = event.position()
        dx, dy = delta.x() / self.height(), -delta.y() / self.height()
        camera = self._editor.scene.camera
        if self._mode == "light":
            self._move_light(dx, dy)
        elif camera is None:
            return
        elif self._mode == "orbit":
            self._set_camera(camera_moves.orbit(camera, dx * DEGREES_ACROSS, -dy * DEGREES_ACROSS), "orbit")
        elif self._mode == "pan":
            self._set_camera(camera_moves.pan(camera, dx, dy), "pan")
        else:
            self._set_camera(camera_moves.zoom(camera, math.exp(2.5 * dy), size=self._subject_size()), "zoom")

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag: one step of the history."""
        if self._mode and not event.buttons():
            self._mode = ""
            self._editor.end()
            self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom about the cursor."""
        camera = self._editor.scene.camera
        if camera is None or not event.angleDelta().y():
            return
        x = (event.position().x() - self.width() / 2) / self.height()
        y = (self.height() / 2 - event.position().y()) / self.height()
        factor = ZOOM_STEP ** (event.angleDelta().y() / 120)
        self._set_camera(camera_moves.zoom(camera, factor, x, y, self._subject_size()), "zoom")

    # -- keys -------------------------------------------------------------------------------------
    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Orbit by arrow keys (move the lamp with Shift), zoom by + and -."""
        camera, key = self._editor.scene.camera, Qt.Key(event.key())
        turn = {
            Qt.Key.Key_Left: (-1, 0),
            Qt.Key.Key_Right: (1, 0),
            Qt.Key.Key_Up: (0, 1),
            Qt.Key.Key_Down: (0, -1),
        }.get(key)
        scale = {
            Qt.Key.Key_Plus: ZOOM_STEP,
            Qt.Key.Key_Equal: ZOOM_STEP,
            Qt.Key.Key_Minus: 1 / ZOOM_STEP,
        }.get(key)
        if camera is not None and turn and event.modifiers() & _MODIFIER.ShiftModifier:
            self._move_light(0.02 * turn[0], 0.02 * turn[1])
        elif camera is not None and turn:
            self._set_camera(
                camera_moves.orbit(camera, turn[0] * ARROW_DEGREES, turn[1] * -ARROW_DEGREES), "orbit"
            )
        elif camera is not None and scale:
            self._set_camera(camera_moves.zoom(camera, scale, size=self._subject_size()), "zoom")
        else:
            event.ignore()

    # -- edits ------------------------------------------------------------------------------------
    def _set_camera(self, camera: Camera, mode: str) -> None:
        self._editor.change(LABELS[mode], True, camera=camera)

    def _move_light(self, dx: float, dy: float) -> None:
        """Move the lamp over a hemisphere as wide as 0.8 of the picture's height."""
        light = self._editor.light
        if light is not None:
            radius = overlay.LIGHT_RADIUS
            self._editor.change_light(MOVE, True, **light_moves.moved(light, dx / radius, dy / radius))
            self.lamp_moved.emit()

    def _subject_size(self) -> float:
        volume = self._editor.scene.volume
        return float(np.linalg.norm(np.ptp(volume.corners(), axis=0))) if volume is not None else 0.0
