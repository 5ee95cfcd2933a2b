"""When the device cannot draw the scene: what went wrong, and a button that helps where one can."""

from __future__ import annotations

from collections.abc import Callable

from qtpy.QtCore import QObject

from .driver import ViewDriver
from .editing import Editor
from .files import Files
from .jobs import Picture
from .messages import MessageBar
from .worker import RenderWorker

#: Smallest part of the window's resolution that is offered.
LEAST_SCALE = 1 / 8
#: What draws when another technique's shader does not compile, the first that is not that one itself.
PLAIN_TECHNIQUES = ("raycast-phong", "raycast")


class Trouble(QObject):
    """Tells of failed pictures of one window; the message goes when pictures come again."""

    def __init__(
        self, editor: Editor, files: Files, driver: ViewDriver, worker: RenderWorker, bar: MessageBar
    ) -> None:
        super().__init__(bar)
        self._editor, self._files, self._driver = editor, files, driver
        self._worker, self._bar = worker, bar
        self._failed = False
        worker.failed.connect(self._on_failed)
        worker.picture.connect(self._on_picture)
        files.opened.connect(lambda: worker.set_scale(1.0))

    def _on_failed(self, message: str, remedy: str) -> None:
        self._failed = True
        kept = "The last good picture stays" if self._driver.has_picture else "Nothing can be shown"
        answers = self._answers(remedy)
        hint = "." if answers else "; undo, or choose another technique."
        self._bar.show_error(f"{message[:1].upper()}{message[1:]}. {kept}{hint}", answers)

    def _on_picture(self, picture: Picture) -> None:
        # A coarse picture, which a device may have room for, does not mend the full one.
        if self._failed and not picture.interactive:
            self._failed = False
            self._bar.clear("error")

    def _answers(self, remedy: str) -> dict[str, Callable[[], object]]:
        """Return the buttons that may help, by their text."""
        if remedy == "smaller picture" and self._worker.scale > LEAST_SCALE:
            return {"Use a smaller size": self._shrink_picture}
        if remedy == "smaller volume":
            return {"Use a smaller size": self._files.reduce}
        if remedy == "other technique":
            plain = next(t for t in PLAIN_TECHNIQUES if t != self._editor.scene.technique_id)
            return {
                "Use another technique": lambda: self._editor.change("Choose the technique", technique=plain)
            }
        if remedy == "new renderer":
            return {"Try again": self._driver.ask}
        return {}

    def _shrink_picture(self) -> None:
        self._worker.set_scale(self._worker.scale / 2)
        self._driver.ask()
