"""Automatic exposure in the window: on opening a volume, on choosing a rig and by a key, never while a lamp is moved.

The render thread measures it on a small picture while it is idle (`sfumato.exposure`).
"""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QObject
from qtpy.QtGui import QImage

from sfumato import Scene
from sfumato.exposure import SIZE

from .editing import Editor
from .settings import settings
from .thumbnails import Thumbnails

GROUP, KEPT = "exposure", "exposure/automatic"
LABEL = "Automatic exposure"


class AutoExposure(QObject):
    """Measures the exposure of the present scene, and knows whether rigs bring their own."""

    def __init__(self, editor: Editor, thumbnails: Thumbnails, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._editor, self._thumbnails = editor, thumbnails
        #: The scene that is being measured, and the step of the history that its exposure is to belong to.
        self._asked: tuple[Scene, str] | None = None
        thumbnails.ready.connect(self._on_ready)

    @property
    def on(self) -> bool:
        """Whether volumes and rigs are exposed when they are opened or chosen."""
        return bool(settings().value(KEPT, True, type=bool))

    def set_on(self, on: bool) -> None:
        """Expose volumes and rigs from now on, or leave the exposure alone; remembered."""
        settings().setValue(KEPT, on)

    def ask(self, label: str = LABEL) -> None:
        """Measure the present scene; its exposure joins the last step of the history if that has this label."""
        scene = self._editor.scene
        if scene.volume is not None:
            self._asked = scene, label
            self._thumbnails.want(GROUP, {"now": unexposed(scene)}, SIZE, exposed=True, first=True)

    def opened(self) -> None:
        """Expose a volume that was just opened, before anything was done to it: that is no step of the history."""
        if self.on and self._editor.scene.exposure == 0:
            self.ask("")

    def _on_ready(self, group: str, key: Any, image: QImage) -> None:
        if group != GROUP or self._asked is None:
            return
        (scene, label), self._asked = self._asked, None
        stops = exposure_of(image)
        document = self._editor.document
        if stops is None or self._editor.scene is not scene or document.dragging or stops == scene.exposure:
            return
        if label:
            self._editor.change(label, True, exposure=stops)
        elif not document.modified and len(document.steps) == 1:
            self._editor.reset(scene.with_(exposure=stops))


def unexposed(scene: Scene) -> Scene:
    """Return a scene whose pictures do not change with its exposure."""
    return scene if scene.exposure == 0 else scene.with_(exposure=0.0)


def exposure_of(image: QImage) -> float | None:
    """Return the exposure in stops that a small picture says is right for its scene."""
    told = image.text("exposure")
    return float(told) if told else None


__all__ = ["AutoExposure", "exposure_of", "unexposed"]
