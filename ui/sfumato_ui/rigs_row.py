"""Rigs as live pictures of the user's own scene; a click lights it so. Six are seen at first, the rest under More."""

from __future__ import annotations

import dataclasses
from collections.abc import Hashable, Sequence

from qtpy.QtCore import QRectF, QSize, Qt, QTimer, Signal
from qtpy.QtGui import (
    QColor,
    QFont,
    QFontMetrics,
    QHideEvent,
    QImage,
    QKeyEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QShowEvent,
)
from qtpy.QtWidgets import QAbstractButton, QGridLayout, QSizePolicy, QWidget

from sfumato import Light, Scene
from sfumato.scene.rig_files import fitted
from sfumato.scene.rigs import Rig, rigs

from .auto_exposure import AutoExposure, exposure_of, unexposed
from .editing import Editor
from .theme import PICTURE_GREY, current_theme
from .thumbnails import Thumbnails

COLUMNS = 3
#: Rigs that the tab shows at first.
FIRST = 6
#: Width and height of a picture in pixels.
PICTURE = (88, 60)
#: Quiet time in milliseconds after which the pictures are drawn anew.
QUIET_MS = 400


#: What a rig's exposure depends on, besides its lamps.
_SEEN = tuple(f.name for f in dataclasses.fields(Scene) if f.name not in ("lights", "exposure"))


def _ground(scene: Scene, exposed: bool) -> Scene:
    """Return the scene that rigs are shown on."""
    return unexposed(scene) if exposed else scene


class RigButton(QAbstractButton):
    """A rig's picture with its name below."""

    #: The focus is to go this many buttons on.
    focus_moved = Signal(int)

    def __init__(self, rig: Rig) -> None:
        super().__init__()
        self.rig = rig
        self._image = QImage()
        #: Its automatic exposure in stops on the present scene, as far as that is known.
        self.exposure: float | None = None
        self.setCheckable(True)
        self.setText(rig.title)
        self.setAccessibleName(f"Rig {rig.title}")
        self.set_reason("")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    @property
    def image(self) -> QImage:
        """The picture, null until it is drawn."""
        return self._image

    def set_image(self, image: QImage) -> None:
        """Show a picture."""
        self._image = image
        self.update()

    def set_reason(self, reason: str) -> None:
        """Say in the tooltip what the rig does, and why it cannot be had."""
        why = f"<p>{reason}</p>" if reason else ""
        self.setToolTip(f"<p><b>{self.rig.title}</b></p><p>{self.rig.description}</p>{why}")

    def nextCheckState(self) -> None:
        """Leave the mark to the scene: a click on the current rig does not take it away."""

    def sizeHint(self) -> QSize:
        """Hold picture, frame and name."""
        name = QFontMetrics(self._marked_font())
        width = max(PICTURE[0] + 4, name.horizontalAdvance(self.text()) + 2)
        return QSize(width, PICTURE[1] + name.height() + 8)

    def minimumSizeHint(self) -> QSize:
        """Shrink to the picture; the name is shortened then."""
        return QSize(PICTURE[0] + 4, self.sizeHint().height())

    def _marked_font(self) -> QFont:
        font = QFont(self.font())
        font.setBold(True)
        return font

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrow keys go from rig to rig, Enter applies as Space does."""
        steps = {
            Qt.Key.Key_Left: -1,
            Qt.Key.Key_Right: 1,
            Qt.Key.Key_Up: -COLUMNS,
            Qt.Key.Key_Down: COLUMNS,
        }
        key = Qt.Key(event.key())
        if key in steps:
            self.focus_moved.emit(steps[key])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.click()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw picture, name, the mark of the current rig and the focus ring."""
        theme = current_theme()
        painter = QPainter(self)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        frame = QRectF((self.width() - PICTURE[0]) / 2, 3, *PICTURE)
        rounded = QPainterPath()
        rounded.addRoundedRect(frame, 4, 4)
        if self.isEnabled() or not self._image.isNull():
            painter.fillPath(rounded, QColor(PICTURE_GREY))
        painter.save()
        painter.setClipPath(rounded)
        painter.setOpacity(1.0 if self.isEnabled() else 0.4)
        if not self._image.isNull():
            painter.drawImage(frame, self._image)
        painter.restore()
        self._draw_frame(painter, frame)
        painter.setPen(QColor(theme.text if self.isEnabled() else theme.border))
        if self.isChecked():
            painter.setFont(self._marked_font())
        below = QRectF(0, frame.bottom() + 3, self.width(), self.height() - frame.bottom() - 3)
        name = painter.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, self.width())
        painter.drawText(below, Qt.AlignmentFlag.AlignCenter, name)

    def _draw_frame(self, painter: QPainter, frame: QRectF) -> None:
        """Draw an accent frame for the current rig, and the focus ring around it."""
        theme = current_theme()
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if not self.isEnabled() and self._image.isNull():
            painter.setPen(QPen(QColor(theme.border), 1, Qt.PenStyle.DashLine))
            painter.drawRoundedRect(frame.adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)
        elif self.isChecked():
            painter.setPen(QPen(QColor(theme.accent), 3))
            painter.drawRoundedRect(frame.adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)
        elif self.underMouse() and self.isEnabled():
            painter.setPen(QPen(QColor(theme.border), 2))
            painter.drawRoundedRect(frame, 4, 4)
        if self.hasFocus():
            painter.setPen(QPen(QColor(theme.text if self.isChecked() else theme.accent), 2))
            painter.drawRoundedRect(frame.adjusted(-2, -2, 2, 2), 5, 5)


class RigsRow(QWidget):
    """Some of the rigs; the pictures are drawn when the scene is still and the row is seen.

    Parameters
    ----------
    group : str
        Name of its thumbnails; ``rigs`` are those that the tab shows at first, others the rest.
    own : sequence of Rig, optional
        The user's own rigs, which are of the size of no volume (`sfumato.scene.rig_files`), instead.
    """

    def __init__(
        self,
        editor: Editor,
        thumbnails: Thumbnails,
        auto: AutoExposure,
        group: str = "rigs",
        own: Sequence[Rig] | None = None,
    ) -> None:
        super().__init__()
        self._editor, self._thumbnails, self._auto, self._group = editor, thumbnails, auto, group
        self._own = own is not None
        self._reason = ""
        self.buttons: dict[str, RigButton] = {}
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(2)
        for column in range(COLUMNS):
            grid.setColumnStretch(column, 1)
        self._grid = grid
        self._quiet = QTimer(self)
        self._quiet.setSingleShot(True)
        self._quiet.setInterval(QUIET_MS)
        self._quiet.timeout.connect(self._want_pictures)
        editor.changed.connect(self._on_changed)
        thumbnails.ready.connect(self._on_ready)
        built_in = tuple(rigs().values())
        self.set_rigs(own if own is not None else built_in[:FIRST] if group == "rigs" else built_in[FIRST:])

    def set_rigs(self, shown: Sequence[Rig]) -> None:
        """Show other rigs."""
        for button in self.buttons.values():
            self._grid.removeWidget(button)
            button.hide()
            button.deleteLater()
        self.buttons = {rig.id: RigButton(rig) for rig in shown}
        for i, button in enumerate(self.buttons.values()):
            self._grid.addWidget(button, i // COLUMNS, i % COLUMNS)
            button.clicked.connect(lambda _, rig=button.rig: self._apply(rig))
            button.focus_moved.connect(lambda step, i=i: self._move_focus(i + step))
            button.set_reason(self._reason)
        self.refresh()

    def _lights(self, rig: Rig) -> tuple[Light, ...]:
        """Return a rig's lamps in the scene's world."""
        volume = self._editor.scene.volume
        return fitted(rig.lights, volume) if self._own and volume is not None else rig.lights

    @property
    def current(self) -> str:
        """The rig by which the scene is lit, if it is one of these."""
        lights = self._editor.scene.lights
        return next((name for name, b in self.buttons.items() if self._lights(b.rig) == lights), "")

    def refresh(self) -> None:
        """Mark the current rig, and draw the pictures soon."""
        current = self.current
        for name, button in self.buttons.items():
            button.setChecked(name == current)
        self._quiet.start()

    def set_reason(self, reason: str) -> None:
        """Disable the rigs for a reason, or enable them if there is none."""
        self._reason = reason
        self.setEnabled(not reason)
        self.setToolTip(reason)
        for button in self.buttons.values():
            button.set_reason(reason)
        if not reason:
            self._quiet.start()

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.volume is not new.volume:
            for button in self.buttons.values():
                button.set_image(QImage())
        if any(getattr(old, name) != getattr(new, name) for name in _SEEN):
            for button in self.buttons.values():
                button.exposure = None
        self.refresh()

    def _apply(self, rig: Rig) -> None:
        lights = self._lights(rig)
        if self._editor.scene.lights == lights:
            return
        label, stops = f"Light with rig {rig.title}", self.buttons[rig.id].exposure
        exposed = {"exposure": stops} if self._auto.on and stops is not None else {}
        if self._editor.change(label, lights=lights, **exposed):
            self._editor.select_light(0)
            if self._auto.on and not exposed:
                self._auto.ask(label)

    def _move_focus(self, index: int) -> None:
        if 0 <= index < len(self.buttons):
            list(self.buttons.values())[index].setFocus(Qt.FocusReason.OtherFocusReason)

    # -- pictures ---------------------------------------------------------------------------------
    def _want_pictures(self) -> None:
        scene = self._editor.scene
        if scene.volume is None or not (self.isVisible() and self.isEnabled()):
            return
        ratio = self.devicePixelRatioF()
        size = round(PICTURE[0] * ratio), round(PICTURE[1] * ratio)
        wanted: dict[Hashable, Scene] = {
            name: _ground(scene, self._auto.on).with_(lights=self._lights(button.rig))
            for name, button in self.buttons.items()
        }
        self._thumbnails.want(self._group, wanted, size, exposed=self._auto.on)

    def _on_ready(self, group: str, key: Hashable, image: QImage) -> None:
        if group == self._group and isinstance(key, str) and key in self.buttons:
            self.buttons[key].set_image(image)
            self.buttons[key].exposure = exposure_of(image)

    def showEvent(self, event: QShowEvent) -> None:
        """Draw what changed while the row was hidden."""
        super().showEvent(event)
        self._quiet.start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Draw nothing that nobody sees."""
        super().hideEvent(event)
        self._quiet.stop()
        self._thumbnails.forget(self._group)
