"""The picture: paints the newest one and turns the hand's moves into edits of camera and lamp.

Left drag does what the tool says: Orbit turns the subject, Light moves lamps, Shadow places the selected
lamp's shadow (with Alt its highlight), Clip takes the handles of
crop box and clip planes and turns the subject beside them. In every tool Shift-drag moves the selected
lamp, Ctrl or Alt (or the middle button) pans, Ctrl and Shift (or the right button) zooms, a double-click
re-centres on the surface under the cursor, the wheel zooms about it. Arrow keys do what a drag would, by
5 degrees or one step of the handle; with Ctrl they pan; + and - zoom; page keys go to the next handle.
"""

from __future__ import annotations

import math

import numpy as np
from qtpy.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
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
from qtpy.QtWidgets import QLayout, QSizePolicy, QVBoxLayout, QWidget

from sfumato import Camera
from sfumato.geometry import color_bars
from sfumato.scene.picking import surface_under

from . import camera_moves, lamp_places, overlay
from .clip_planes import ClipPlanes
from .dial import MOVE
from .editing import Editor
from .jobs import Picture
from .orientation import OrientationCube
from .settings import settings
from .shadow_audit import words_of
from .shadow_floor import badge_of
from .slice_views.painting import draw_marker
from .subject import is_open, size_of
from .theme import DARK, PICTURE_GREY
from .tools import ClipTool, HandleTool, LightTool, PickTool, PictureView, ShadowBar, ShadowTool
from .tools import light as light_tool

_MODIFIER = Qt.KeyboardModifier
LABELS = {"orbit": "Orbit", "pan": "Pan", "zoom": "Zoom", "light": MOVE}
#: Degrees that a drag across the picture's height turns the subject.
DEGREES_ACROSS = 220.0
ARROW_DEGREES = 5.0
#: Part of the picture's height that an arrow key with Ctrl pans.
ARROW_PAN = 0.05
ZOOM_STEP = 1.12
SCALE_BAR = "view/scale_bar"


class Viewport(QWidget):
    """Shows pictures, takes the mouse and the keys."""

    #: The size in pixels changed.
    resized = Signal()
    #: A picture is shown.
    shown = Signal(object)
    #: The user moved the lamp in the picture (for the hint).
    lamp_moved = Signal()
    #: The user pressed on a face of the orientation cube: the standard view that looks at it.
    side_chosen = Signal(str)

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._picture: Picture | None = None
        self._mode = ""
        self._last = QPointF()
        self._tool = "orbit"
        self.clips = ClipPlanes(editor)
        self._light_tool = LightTool(editor)
        #: Whether the lamp in the hand has a place.
        self._carried = False
        #: The tools that have handles.
        shadow, self.pick_tool = ShadowTool(editor), PickTool(editor)
        self.tools: dict[str, HandleTool] = {
            "light": self._light_tool,
            "shadow": shadow,
            "clip": ClipTool(editor, self.clips),
            "pick": self.pick_tool,
        }
        self.shadow_bar = ShadowBar(editor, shadow)
        self.hint = ""
        #: Where the cross-hair of the slice views is, world mm.
        self._mark: np.ndarray | None = None
        #: Whether an orthographic picture has a bar of true length.
        self.scale_bar = bool(settings().value(SCALE_BAR, False, type=bool))
        self.cube = OrientationCube()
        #: Controls that lie over the picture; Tab reaches them after it.
        self.controls_over: list[QWidget] = []
        self.empty_text = "Drop a volume or a folder here, or press Ctrl+O"
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(240, 180)
        self._lay_out()
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setAccessibleName("Picture")
        self.setAccessibleDescription(
            "Drag to orbit, Shift-drag to move the light, wheel to zoom, double-click to centre, "
            "arrow keys to orbit"
        )
        self.setMouseTracking(True)
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        self.clips.selected_changed.connect(self.update)
        editor.light_selected.connect(lambda index: self.update())
        editor.changed.connect(lambda old, new: self.update())

    def _lay_out(self) -> None:
        """Let the tool's bar float over the picture's lower edge, above the letter there."""
        over = QVBoxLayout(self)
        over.setContentsMargins(12, 12, 12, 36)
        over.setSizeConstraint(QLayout.SizeConstraint.SetNoConstraint)
        over.addStretch(1)
        over.addWidget(self.shadow_bar, 0, Qt.AlignmentFlag.AlignHCenter)
        self.resized.connect(self.shadow_bar.fit)

    def sizeHint(self) -> QSize:
        """Take what is there."""
        return QSize(916, 640)

    # -- the tool ---------------------------------------------------------------------------------
    @property
    def tool(self) -> str:
        """The active tool: ``orbit``, ``light``, ``shadow``, ``clip`` or ``pick``."""
        return self._tool

    @tool.setter
    def tool(self, name: str) -> None:
        for tool in self.tools.values():
            tool.leave()
        self._tool = name
        self.shadow_bar.set_shown(name == "shadow" and self.view is not None)
        self._hover(None)
        self.update()

    @property
    def view(self) -> PictureView | None:
        """From world to picture and back, for the current camera; None if nothing is open."""
        scene = self._editor.scene
        if scene.camera is None or not is_open(scene):
            return None
        return PictureView(scene.camera, self.width(), self.height())

    def _hover(self, at: QPointF | None) -> None:
        """Show by the cursor what is under it."""
        tool, view = self.tools.get(self._tool), self.view
        shape = Qt.CursorShape.OpenHandCursor
        if at is not None and view is not None and self.cube.face(view.camera, at):
            self.setCursor(Qt.CursorShape.PointingHandCursor)
            return
        if tool is not None and view is not None:
            before = tool.hovered
            shape = tool.hover(view, (at.x(), at.y()) if at is not None else None)
            if tool.hovered != before:
                self.update()
        self.setCursor(shape)

    # -- what is shown ----------------------------------------------------------------------------
    @property
    def pixel_size(self) -> tuple[int, int]:
        """Width and height in device pixels."""
        ratio = self.devicePixelRatioF()
        return max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio))

    @property
    def aspect(self) -> float:
        """Width over height."""
        return self.width() / max(1, self.height())

    @property
    def picture(self) -> Picture | None:
        """The picture that is shown."""
        return self._picture

    def show_picture(self, picture: Picture | None) -> None:
        """Show a picture, or none."""
        self._picture = picture
        self.update()
        if picture is not None:
            self.shown.emit(picture)

    def set_hint(self, text: str) -> None:
        """Show a hint on the picture; nothing, if the text is empty."""
        self.hint = text
        self.update()

    def set_mark(self, point: np.ndarray | None) -> None:
        """Mark a world point over the picture, or none; no export has it."""
        self._mark = point
        self.update()

    def set_scale_bar(self, on: bool) -> None:
        """Show a scale bar in orthographic pictures, and remember it."""
        self.scale_bar = on
        settings().setValue(SCALE_BAR, on)
        self.update()

    def set_cube(self, on: bool) -> None:
        """Show the orientation cube, and remember it."""
        self.cube.set_on(on)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the picture on neutral grey, then letters, hint and focus."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(PICTURE_GREY))
        scene = self._editor.scene
        if self._picture is not None:
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.drawImage(self._target(self._picture), self._picture.image)
        elif not is_open(scene):
            overlay.draw_centred(painter, self.rect(), self.empty_text)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if scene.volume is not None and scene.camera is not None:
            known = lamp_places.orientation_known(scene)
            overlay.draw_letters(
                painter, self.rect(), camera_moves.edge_letters(scene.camera) if known else None
            )
        if self._picture is not None:
            self._paint_legend(painter, self._picture)
        if self.scale_bar and self._picture is not None and scene.camera is not None:
            lift = self.fontMetrics().height() + 22 if self.hint else 0
            overlay.draw_scale_bar(painter, self.rect(), scene.camera, lift)
        if self.cube.on and is_open(scene) and scene.camera is not None:
            known = lamp_places.orientation_known(scene)
            self.cube.paint(painter, scene.camera, known, self.devicePixelRatioF())
        view = self.view
        if self._mark is not None and view is not None:
            draw_marker(painter, view, self._mark)
        self._paint_tool(painter)
        if self.hint and self._tool == "orbit" and scene.volume is not None:
            overlay.draw_hint(painter, self.rect(), self.hint)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(DARK.accent), 2))
            painter.drawRect(self.rect().adjusted(1, 1, -1, -1))

    def _paint_legend(self, painter: QPainter, picture: Picture) -> None:
        """Paint colour bars, and what must be said of the shadows."""
        bars, said = color_bars(picture.scene), [badge_of(picture.scene)]
        if picture.audit is not None:
            bars += (picture.audit.bar,) if picture.audit.share > 0 else ()
            said.insert(0, words_of(picture.audit, picture.scene))
        overlay.draw_color_bars(painter, self.rect(), bars)
        badge = "  ·  ".join(filter(None, said))
        if badge:
            overlay.draw_badge(painter, self.rect(), badge)

    def _paint_tool(self, painter: QPainter) -> None:
        """Paint the tool's handles; while the lamp moves with another tool, its guide alone."""
        view, light = self.view, self._editor.light
        tool = self.tools.get(self._tool)
        if view is None:
            return
        if self._mode == "light" and self._tool != "light" and light is not None:
            light_tool.paint_one(painter, view, self._editor.scene, light)
        elif tool is not None:
            tool.paint(painter, view)

    def _target(self, picture: Picture) -> QRectF:
        """Return where to paint: a picture of another size keeps its height, as the camera's opening does."""
        if picture.size == self.pixel_size:
            if (picture.image.width(), picture.image.height()) == picture.size:
                # Pixel on pixel: the widget's own size may be half a pixel off on a dense screen.
                ratio = self.devicePixelRatioF()
                return QRectF(0, 0, picture.size[0] / ratio, picture.size[1] / ratio)
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

    def event(self, event: QEvent) -> bool:
        """Ask for another picture on a screen with another pixel ratio."""
        if event.type() == QEvent.Type.DevicePixelRatioChange:
            self.resized.emit()
        return super().event(event)

    # -- mouse ------------------------------------------------------------------------------------
    def _mode_for(self, event: QMouseEvent) -> str:
        button, keys = event.button(), event.modifiers()
        shift = bool(keys & _MODIFIER.ShiftModifier)
        pan = bool(keys & (_MODIFIER.ControlModifier | _MODIFIER.AltModifier))
        tool = self.tools.get(self._tool)
        if tool is not None:
            tool.alternate = tool.own_alt and keys == _MODIFIER.AltModifier
            pan = pan and not tool.alternate
        if button == Qt.MouseButton.MiddleButton:
            return "pan"
        if button == Qt.MouseButton.RightButton:
            return "zoom"
        if button != Qt.MouseButton.LeftButton:
            return ""
        if pan:
            return "zoom" if shift else "pan"
        if shift:
            return "light"
        return "handle" if self._tool in self.tools else "orbit"

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a drag."""
        camera = self._editor.scene.camera
        if self._mode or camera is None:
            return
        plain = event.button() == Qt.MouseButton.LeftButton and not event.modifiers()
        if plain and (side := self.cube.face(camera, event.position())):
            self.side_chosen.emit(side)
            return
        self._mode = self._mode_for(event)
        self._last = event.position()
        label = LABELS.get(self._mode, "")
        if self._mode == "handle":
            label = self._take_handle(event.position())
        if self._mode == "light":
            self._take_lamp(event.position())
        if self._mode:
            self._editor.begin(label)
            if self._mode == "orbit":
                self.setCursor(Qt.CursorShape.ClosedHandCursor)
            self.update()

    def _take_handle(self, at: QPointF) -> str:
        """Take the handle under the pointer, or what the tool does beside its handles; returns its name."""
        tool, view = self.tools[self._tool], self.view
        label = tool.press(view, (at.x(), at.y())) if view is not None else ""
        if not label:
            self._mode = "light" if self._tool == "light" else "orbit"
        return label or LABELS[self._mode]

    def _take_lamp(self, at: QPointF) -> None:
        """Let the selected lamp follow the pointer, if it stands somewhere; others move over the hemisphere."""
        view = self.view
        self._carried = view is not None and self._light_tool.take(view, (at.x(), at.y()))

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Re-centre on the surface under the cursor; on a handle, a double-click is a click."""
        tool, view, at = self.tools.get(self._tool), self.view, event.position()
        plain = event.button() == Qt.MouseButton.LeftButton and not event.modifiers()
        if view is not None and self.cube.face(view.camera, at):
            return
        on_handle = tool is not None and view is not None and tool.hit(view, (at.x(), at.y())) is not None
        if not plain or view is None or on_handle:
            self.mousePressEvent(event)
            return
        point = surface_under(self._editor.scene, *view.fractions((at.x(), at.y())), self.aspect)
        if point is not None:
            self._editor.change("Centre the picture", camera=camera_moves.centred(view.camera, point))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow the pointer."""
        if not self._mode:
            self._hover(event.position())
            return
        delta = event.position() - self._last
        self._last = event.position()
        dx, dy = delta.x() / self.height(), -delta.y() / self.height()
        camera = self._editor.scene.camera
        view, at = self.view, event.position()
        if self._mode == "light" and self._carried and view is not None:
            self._light_tool.drag(view, (at.x(), at.y()))
            self.lamp_moved.emit()
        elif self._mode == "light":
            self._move_light(dx, dy)
        elif self._mode == "handle" and view is not None:
            self.tools[self._tool].drag(view, (at.x(), at.y()))
            if self._tool == "light":
                self.lamp_moved.emit()
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
            for tool in self.tools.values():
                tool.release()
            self._hover(event.position())
            self.update()

    def leaveEvent(self, event: QEvent) -> None:
        """Mark no handle any more."""
        self._hover(None)
        super().leaveEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom about the cursor; a lamp in the hand, or under the Light tool, moves along the view."""
        camera, view = self._editor.scene.camera, self.view
        if camera is None or not event.angleDelta().y():
            return
        lit = self._mode == "light" or (self._tool == "light" and self._mode in ("", "handle"))
        at, notches = event.position(), event.angleDelta().y() / 120
        if lit and view is not None and self._light_tool.wheel(view, (at.x(), at.y()), notches):
            return
        x = (event.position().x() - self.width() / 2) / self.height()
        y = (self.height() / 2 - event.position().y()) / self.height()
        factor = ZOOM_STEP ** (event.angleDelta().y() / 120)
        self._set_camera(camera_moves.zoom(camera, factor, x, y, self._subject_size()), "zoom")

    # -- keys -------------------------------------------------------------------------------------
    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Do by arrow keys what a drag would, zoom by + and -, go through the handles by the page keys."""
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
        page = {Qt.Key.Key_PageDown: 1, Qt.Key.Key_PageUp: -1}.get(key)
        tool, view = self.tools.get(self._tool), self.view
        if tool is not None and view is not None and page:
            tool.focus_next(view, page)
            self.update()
        elif camera is not None and turn and event.modifiers() & _MODIFIER.ControlModifier:
            self._set_camera(camera_moves.pan(camera, ARROW_PAN * turn[0], ARROW_PAN * turn[1]), "pan")
        elif tool is not None and view is not None and turn and tool.nudge(view, *turn, self._shift(event)):
            self.update()
        elif camera is not None and turn and self._shift(event):
            self._nudge_light(*turn)
        elif camera is not None and turn:
            self._set_camera(
                camera_moves.orbit(camera, turn[0] * ARROW_DEGREES, turn[1] * -ARROW_DEGREES), "orbit"
            )
        elif camera is not None and scale:
            self._set_camera(camera_moves.zoom(camera, scale, size=self._subject_size()), "zoom")
        else:
            event.ignore()

    @staticmethod
    def _shift(event: QKeyEvent) -> bool:
        return bool(event.modifiers() & _MODIFIER.ShiftModifier)

    # -- edits ------------------------------------------------------------------------------------
    def _set_camera(self, camera: Camera, mode: str) -> None:
        self._editor.change(LABELS[mode], True, camera=camera)

    def _nudge_light(self, right: int, up: int) -> None:
        """Move the selected lamp by an arrow key with another tool."""
        light, view = self._editor.light, self.view
        if light is not None and view is not None and light.placed:
            fields = self._light_tool.shifted(view, light, right, up, large=False)
            self._editor.change_light(MOVE, True, **fields)
            self.lamp_moved.emit()
        else:
            self._move_light(0.02 * right, 0.02 * up)

    def _move_light(self, dx: float, dy: float) -> None:
        """Move the selected lamp over the hemisphere by (dx, dy) picture heights, y up."""
        light, view = self._editor.light, self.view
        if light is not None and view is not None:
            grow = self.height() / light_tool.radius_of(view)
            fields = lamp_places.moved(self._editor.scene, light, grow * dx, grow * dy)
            self._editor.change_light(MOVE, True, **fields)
            self.lamp_moved.emit()

    def _subject_size(self) -> float:
        return size_of(self._editor.scene)
