"""Between document and worker: which scene to draw, when coarsely and when in full."""

from __future__ import annotations

from qtpy.QtCore import QObject, QTimer

from sfumato import Scene

from .building import MeshBuilder
from .editing import Editor
from .jobs import Picture, ViewRequest
from .quality import chosen_quality
from .subject import is_drawable
from .viewport import Viewport
from .worker import RenderWorker

#: Quiet time in milliseconds after which a scene counts as still.
STILL_MS = 160
#: Technique of the unlit picture.
UNLIT = "raycast"


class ViewDriver(QObject):
    """Asks for a coarse picture at each change, and for the full one once nothing changes any more."""

    def __init__(self, editor: Editor, viewport: Viewport, worker: RenderWorker) -> None:
        super().__init__(viewport)
        self._editor, self._viewport, self._worker = editor, viewport, worker
        #: Builds the meshes of changed geometry.
        self.builder = MeshBuilder(self)
        self.builder.built.connect(self.ask)
        self._unlit = False
        self._audit = 0.0
        self._frames = chosen_quality().frames
        self._still = QTimer(self)
        self._still.setSingleShot(True)
        self._still.timeout.connect(lambda: self._request(interactive=False))
        editor.changed.connect(lambda old, new: self.ask())
        viewport.resized.connect(self.ask)
        worker.picture.connect(self._on_picture)

    def ask(self) -> None:
        """Something changed: show it soon, then well."""
        self._request(interactive=True)
        self._still.start(STILL_MS)

    def set_unlit(self, unlit: bool) -> None:
        """Show the picture without light, or with it again."""
        if unlit != self._unlit:
            self._unlit = unlit
            self.ask()

    def set_audit(self, threshold: float) -> None:
        """Show the shadow audit with a threshold (0 to 1), or end it (0)."""
        if threshold != self._audit:
            self._audit = threshold
            self.ask()

    def set_frames(self, frames: int) -> None:
        """Let a still picture accumulate so many frames."""
        if frames != self._frames:
            self._frames = frames
            self.ask()

    @property
    def has_picture(self) -> bool:
        """Whether the viewport shows a picture."""
        return self._viewport.picture is not None

    @property
    def shown_scene(self) -> Scene:
        """The scene that the viewport shows."""
        scene = self._editor.scene
        unlit = self._unlit and scene.volume is not None
        return scene.with_(technique=UNLIT) if unlit else scene

    def stop(self) -> None:
        """Ask for nothing more."""
        self._still.stop()
        self.builder.close()

    def _request(self, interactive: bool) -> None:
        if is_drawable(self.shown_scene) and self._viewport.isVisible():
            size = self._viewport.pixel_size
            audit = 0.0 if self._unlit else self._audit
            scene = self.builder.buildable(self.shown_scene)
            self._worker.show(ViewRequest(scene, size, interactive, self._frames, audit))

    def _on_picture(self, picture: Picture) -> None:
        """Show a picture, unless it is of data that are no longer open."""
        if picture.scene.volume is self._editor.scene.volume:
            self._viewport.show_picture(picture)
