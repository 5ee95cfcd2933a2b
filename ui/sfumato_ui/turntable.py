"""The turntable: the subject turns once and again about its upright axis, to be seen from all around."""

from __future__ import annotations

import time

from qtpy.QtCore import QEvent, QObject, QTimer, Signal
from qtpy.QtWidgets import QApplication

from sfumato import Camera, Scene

from . import camera_moves
from .editing import Editor

#: Seconds of a whole turn.
TURN_SECONDS = 12.0
LABEL = "Turntable"
#: Milliseconds after which the next step is taken even if no picture came.
PATIENCE_MS = 400
_ENDS = frozenset({
    QEvent.Type.MouseButtonPress, QEvent.Type.Wheel, QEvent.Type.KeyPress, QEvent.Type.Shortcut,
    QEvent.Type.WindowDeactivate,
})  # fmt: skip


class Turntable(QObject):
    """Turns the camera as fast as pictures come; the hand's next act ends it, and the camera is where it was.

    The steps are one open drag of the document, which leaves no trace in the history as it ends where it began.
    """

    #: It began or ended.
    playing_changed = Signal(bool)

    def __init__(self, editor: Editor, parent: QObject) -> None:
        super().__init__(parent)
        self._editor = editor
        self._start: Camera | None = None
        self._began = 0.0
        self._own: Scene | None = None
        self._just_ended = False
        self._waiting = QTimer(self)
        self._waiting.setSingleShot(True)
        self._waiting.timeout.connect(self.step)
        editor.changed.connect(self._on_changed)

    @property
    def playing(self) -> bool:
        """Whether the subject turns."""
        return self._start is not None

    def toggle(self) -> None:
        """Begin, or end; the press that has just ended it does not begin it again."""
        if self.playing:
            self.end()
        elif not self._just_ended:
            self.begin()

    def begin(self) -> None:
        """Begin to turn."""
        camera = self._editor.scene.camera
        if camera is None or self.playing:
            return
        self._editor.begin(LABEL)
        self._start, self._began = camera, time.monotonic()
        app = QApplication.instance()
        assert app is not None
        app.installEventFilter(self)
        self.playing_changed.emit(True)
        self.step()

    def step(self) -> None:
        """Turn as far as the time wants; to be called when a picture has come."""
        if self._start is None:
            return
        degrees = 360 * (time.monotonic() - self._began) / TURN_SECONDS
        self._show(camera_moves.orbit(self._start, degrees % 360, 0))
        self._waiting.start(PATIENCE_MS)

    def end(self) -> None:
        """Go back to where the camera stood."""
        start, self._start = self._start, None
        if start is None:
            return
        self._stop()
        self._show(start)
        self._editor.end()
        self.playing_changed.emit(False)

    def _show(self, camera: Camera) -> None:
        self._own = self._editor.scene.with_(camera=camera)
        self._editor.change(LABEL, camera=camera)

    def _stop(self) -> None:
        self._waiting.stop()
        app = QApplication.instance()
        assert app is not None
        app.removeEventFilter(self)
        self._just_ended = True
        QTimer.singleShot(0, self._forget_end)

    def _forget_end(self) -> None:
        self._just_ended = False

    def _on_changed(self, old: Scene, new: Scene) -> None:
        """End where somebody else has changed the scene: by another file, or from outside."""
        if self.playing and new != self._own:
            self._start = None
            self._stop()
            self.playing_changed.emit(False)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """End at the hand's next act, which then does what it does."""
        if event.type() in _ENDS:
            self.end()
        return False
