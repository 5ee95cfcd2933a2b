"""The light dial: a matte ball lit by the scene's lamps, on which the lamps are dragged.

Drag a lamp's dot for tilt and rotation, its cone's handle for the aperture; the ring outside the ball holds
the lights behind the subject. With the focus: arrow keys turn and tilt by 1 degree, with Shift by 10, the
wheel changes the intensity.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from qtpy.QtCore import QPointF, QSize, Qt, Signal
from qtpy.QtGui import (
    QColor,
    QImage,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QWheelEvent,
)
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato import Light
from sfumato.scene import nearest_possible_tilt
from sfumato.scene.lamps import half_angles
from sfumato.scene.light import shining

from . import light_moves
from .editing import Editor
from .lamp_places import dial_angles, middle_of, placed
from .theme import current_theme

#: Distance in pixels within which a handle is hit.
HIT = 14.0
#: The cone's handle is never drawn nearer to its lamp than this, in pixels.
HANDLE_ROOM = 24.0
MOVE, SOFTEN = "Move the light", "Change the softness"


class LightDial(QWidget):
    """Shows all lamps of a scene; edits the selected one. A lamp with a place turns about the subject's middle."""

    #: The user takes part in a drag of the light (for the hint).
    used = Signal()

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._grip: str = ""
        self._offset = (0.0, 0.0)
        self._start = (0.0, 0.0)
        self._ball = QImage()
        self._ball_key: object = None
        self.setObjectName("dial")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Light dial")
        self.setToolTip(
            "<p>Drag the lamp to place it; the ring outside is behind the subject. Drag the "
            "small square for softer or harder shadows.</p><p>Arrow keys turn and tilt by 1°, "
            "with Shift by 10°; the wheel "
            "changes the intensity.</p>"
        )
        editor.changed.connect(self._on_changed)
        editor.light_selected.connect(self.refresh)
        self.refresh()

    def sizeHint(self) -> QSize:
        """Prefer a square as tall as a panel can spare."""
        return QSize(180, 180)

    def minimumSizeHint(self) -> QSize:
        """Stay large enough to aim at, beside wide neighbours too."""
        return QSize(140, 140)

    def refresh(self) -> None:
        """Show the scene's lamps."""
        light = self._editor.light
        if light is not None:
            tilt, rotation = self._angles(light)
            place = f"tilt {tilt:.0f}°, rotation {rotation % 360:.0f}°"
            self.setAccessibleDescription(f"{light.name}: {place}, aperture {light.aperture:.0f}°")
        self.setEnabled(light is not None)
        self.update()

    def _on_changed(self, old: object, new: object) -> None:
        self.refresh()

    # -- geometry ---------------------------------------------------------------------------------
    @property
    def radius(self) -> float:
        """Radius of the ball in pixels."""
        return (min(self.width(), self.height()) / 2 - 7) / light_moves.RING

    def point(self, place: tuple[float, float]) -> QPointF:
        """Return where a place of the disc lies in the widget."""
        return QPointF(self.width() / 2 + place[0] * self.radius, self.height() / 2 - place[1] * self.radius)

    def place(self, point: QPointF) -> tuple[float, float]:
        """Return the place of the disc at a point of the widget."""
        return (point.x() - self.width() / 2) / self.radius, (self.height() / 2 - point.y()) / self.radius

    def _angles(self, light: Light) -> tuple[float, float]:
        return (
            dial_angles(self._editor.scene, light)
            if self._editor.scene.camera
            else (light.tilt, light.rotation)
        )

    def lamp_point(self, light: Light) -> QPointF:
        """Return where a lamp's dot is."""
        return self.point(light_moves.to_disc(*self._angles(light)))

    def handle_point(self, light: Light) -> QPointF:
        """Return where the handle of a lamp's aperture is."""
        lamp, handle = self.lamp_point(light), self.point(light_moves.cone_handle(light))
        away = handle - lamp
        length = math.hypot(away.x(), away.y())
        return lamp + away * (max(length, HANDLE_ROOM) / max(length, 1e-6))

    # -- mouse ------------------------------------------------------------------------------------
    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the cone's handle, a lamp's dot, or bring the selected lamp here."""
        light = self._editor.light
        if event.button() != Qt.MouseButton.LeftButton or light is None:
            return
        at = event.position()
        self._grip = self._grip_at(at, light)
        light = self._editor.light
        assert light is not None
        if self._grip == "aperture":
            self._start = (light.aperture, self._angle_to(at, light))
            self._editor.begin(SOFTEN)
            return
        self._editor.begin(MOVE)
        lamp = self.lamp_point(light) - at
        near = math.hypot(lamp.x(), lamp.y()) <= HIT
        self._offset = (lamp.x(), lamp.y()) if near else (0.0, 0.0)
        if not near:
            self._move_to(at)

    def _grip_at(self, at: QPointF, light: Light) -> str:
        """Tell what lies under the pointer, selecting another lamp if its dot does."""
        if not light.placed and _distance(at, self.handle_point(light)) <= HIT:
            return "aperture"
        dots = [(_distance(at, self.lamp_point(lamp)), i) for i, lamp in enumerate(self._editor.scene.lights)]
        nearest, index = min(dots)
        if nearest <= HIT and index != self._editor.selected and _distance(at, self.lamp_point(light)) > HIT:
            self._editor.select_light(index)
        return "lamp"

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow the pointer."""
        light = self._editor.light
        if light is None:
            return
        if self._grip == "lamp":
            self._move_to(event.position() + QPointF(*self._offset))
        elif self._grip == "aperture":
            aperture, start = self._start
            self.set_aperture(aperture + self._angle_to(event.position(), light) - start)
        else:
            on_handle = not light.placed and _distance(event.position(), self.handle_point(light)) <= HIT
            self.setCursor(Qt.CursorShape.SizeAllCursor if on_handle else Qt.CursorShape.PointingHandCursor)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag: one step of the history."""
        if event.button() == Qt.MouseButton.LeftButton and self._grip:
            self._grip = ""
            self._editor.end()

    def _move_to(self, at: QPointF) -> None:
        light = self._editor.light
        assert light is not None
        if light.placed:
            self._editor.change_light(MOVE, **placed(self._editor.scene, light, *self.place(at)))
            return
        tilt, rotation = light_moves.from_disc(*self.place(at), light.rotation)
        self._editor.change_light(MOVE, tilt=nearest_possible_tilt(tilt, light.aperture), rotation=rotation)

    def set_aperture(self, aperture: float) -> None:
        """Give the selected lamp an aperture in degrees, as far as its tilt allows."""
        light = self._editor.light
        if light is not None:
            allowed = max(light_moves.MIN_APERTURE, min(aperture, light_moves.largest_aperture(light.tilt)))
            self._editor.change_light(SOFTEN, aperture=allowed)

    def _angle_to(self, at: QPointF, light: Light) -> float:
        """Return the angle in degrees between a lamp and the direction under the pointer."""
        under = light_moves.direction(*light_moves.from_disc(*self.place(at)))
        cosine = float(under @ light_moves.direction(light.tilt, light.rotation))
        return math.degrees(math.acos(max(-1.0, min(1.0, cosine))))

    # -- keys and wheel ---------------------------------------------------------------------------
    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Nudge the selected lamp."""
        light = self._editor.light
        step = 10.0 if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else 1.0
        turn = {Qt.Key.Key_Left: step, Qt.Key.Key_Right: -step}.get(Qt.Key(event.key()))
        tip = {Qt.Key.Key_Up: step, Qt.Key.Key_Down: -step}.get(Qt.Key(event.key()))
        if light is None or (turn is None and tip is None):
            event.ignore()
        elif light.placed:
            tilt, rotation = self._angles(light)
            tilt = min(180.0, max(0.0, tilt + (tip or 0.0)))
            place = light_moves.to_disc(tilt, rotation + (turn or 0.0))
            self._editor.change_light(MOVE, True, **placed(self._editor.scene, light, *place))
        elif turn is not None:
            self._editor.change_light(MOVE, True, rotation=(light.rotation + turn) % 360.0)
        else:
            assert tip is not None
            self._editor.change_light(MOVE, True, tilt=stepped_tilt(light, tip))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Change the intensity if focused, else let the panel scroll."""
        light = self._editor.light
        if not self.hasFocus() or light is None:
            event.ignore()
            return
        intensity = max(0.0, min(100.0, light.intensity + 0.05 * event.angleDelta().y() / 120))
        self._editor.change_light("Change the intensity", True, intensity=round(intensity, 4))

    # -- looks ------------------------------------------------------------------------------------
    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw ring, ball, cones and lamps."""
        theme = current_theme()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        centre = QPointF(self.width() / 2, self.height() / 2)
        painter.setPen(QPen(QColor(theme.border), 1))
        painter.setBrush(QColor(theme.window))
        painter.drawEllipse(centre, self.radius * light_moves.RING, self.radius * light_moves.RING)
        ball = self._shaded_ball()
        painter.drawImage(QPointF(centre.x() - self.radius, centre.y() - self.radius), ball)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(theme.accent), 2))
            outer = self.radius * light_moves.RING + 3
            painter.drawEllipse(centre, outer, outer)
        for i, light in enumerate(self._editor.scene.lights):
            if i != self._editor.selected:
                self._draw_lamp(painter, light, False)
        if self._editor.light is not None:
            if not self._editor.light.placed:
                self._draw_cone(painter, self._editor.light)
            self._draw_lamp(painter, self._editor.light, True)

    def _draw_cone(self, painter: QPainter, light: Light) -> None:
        """Outline the cone, and put its handle on it."""
        accent = QColor(current_theme().accent) if current_theme().name == "dark" else QColor("#f2b34c")
        outline = QPolygonF([self.point(p) for p in light_moves.cone_outline(light)])
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for colour, width in ((QColor(0, 0, 0, 150), 3.0), (accent, 1.5)):
            painter.setPen(QPen(colour, width))
            painter.drawPolygon(outline)
        handle = self.handle_point(light)
        painter.setPen(QPen(QColor("#1b1b1b"), 1.5))
        painter.setBrush(accent)
        painter.drawRoundedRect(int(handle.x()) - 5, int(handle.y()) - 5, 10, 10, 2, 2)

    def _draw_lamp(self, painter: QPainter, light: Light, selected: bool) -> None:
        at = self.lamp_point(light)
        shown = QColor(*(round(255 * min(1.0, c) ** (1 / 2.2)) for c in light.color))
        painter.setPen(QPen(QColor("#1b1b1b"), 2))
        lit = any(light is one for one in shining(self._editor.scene.lights))
        painter.setBrush(shown if lit else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(at, 7.0 if selected else 5.0, 7.0 if selected else 5.0)
        if selected:
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor("#f2b34c"), 2))
            painter.drawEllipse(at, 9.0, 9.0)

    def _as_parallel(self, light: Light) -> Light:
        """Return a lamp as the ball is lit by it: one with a place from there, as wide as the middle sees it."""
        scene = self._editor.scene
        if not light.placed or scene.camera is None:
            return light
        tilt, rotation = self._angles(light)
        wide = float(half_angles(light, middle_of(scene)[None])[0])
        aperture = max(light_moves.MIN_APERTURE, min(wide, light_moves.largest_aperture(tilt)))
        tilt = nearest_possible_tilt(tilt, aperture)
        return replace(light, kind="directional", tilt=tilt, rotation=rotation, aperture=aperture)

    def _shaded_ball(self) -> QImage:
        ratio = self.devicePixelRatioF()
        pixels = round(2 * self.radius * ratio)
        lights = tuple(self._as_parallel(light) for light in self._editor.scene.lights)
        if self._ball_key != (pixels, lights):
            self._ball_key = (pixels, lights)
            self._ball = ball_image(lights, pixels)
            self._ball.setDevicePixelRatio(ratio)
        return self._ball


def stepped_tilt(light: Light, step: float) -> float:
    """Return a light's tilt after a nudge in degrees, if need be across the band its aperture forbids."""
    wanted = light.tilt + step
    tilt = nearest_possible_tilt(wanted, light.aperture)
    (_, front), (rear, _) = light_moves.tilt_ranges(light.aperture)
    if front < wanted < rear and tilt == light.tilt:
        return rear if step > 0 else front
    return tilt


def ball_image(lights: tuple[Light, ...], pixels: int) -> QImage:
    """Return a matte ball lit by the lamps, ``pixels`` wide, in sRGB with a transparent surround.

    The irradiance of a cone of light on a matte surface is its cosine, rounded off where the cone sets
    behind the horizon: over the width sin(aperture), as for a strip of light.
    """
    grid = (np.arange(pixels) + 0.5) * 2 / pixels - 1
    x, y = np.meshgrid(grid, -grid)
    r2 = x * x + y * y
    z = np.sqrt(np.clip(1 - r2, 0, None))
    linear = np.full((pixels, pixels, 3), 0.03)
    for light in shining(lights):
        if light.kind != "directional":
            continue
        towards = light_moves.direction(light.tilt, light.rotation)
        cosine = x * towards[0] + y * towards[1] + z * towards[2]
        s = math.sin(math.radians(light.aperture))
        lit = np.where(cosine > s, cosine, np.clip(cosine + s, 0, None) ** 2 / (4 * s))
        linear += 0.62 * light.intensity * lit[..., None] * np.asarray(light.color)
    srgb = np.clip(
        np.where(
            linear <= 0.0031308, 12.92 * linear, 1.055 * np.clip(linear, 1e-9, None) ** (1 / 2.4) - 0.055
        ),
        0,
        1,
    )
    alpha = np.clip((1 - np.sqrt(r2)) * pixels / 2, 0, 1)
    rgba = np.ascontiguousarray((np.dstack([srgb, alpha]) * 255 + 0.5).astype(np.uint8))
    return QImage(rgba.data, pixels, pixels, 4 * pixels, QImage.Format.Format_RGBA8888).copy()


def _distance(a: QPointF, b: QPointF) -> float:
    return math.hypot(a.x() - b.x(), a.y() - b.y())
