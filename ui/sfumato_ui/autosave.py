"""Autosave: a modified scene is written every few seconds, away from the window's thread.

Each window has a *slot*, a scene file in ``data_dir()/autosave`` with a lock beside it that the window
holds. The system lets go of the lock when the program dies, however it dies: a slot without a holder is
what a crash left behind (`recovery` offers it). Saving, undoing and closing remove the slot's files.
"""

from __future__ import annotations

import json
import threading
import time
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from qtpy.QtCore import QLockFile, QObject, QTimer, Signal

from sfumato import Scene, SfumatoError

from .editing import Editor
from .loading import SCENE_SUFFIX
from .settings import data_dir
from .wording import one_line

#: Milliseconds from a change to the file.
AUTOSAVE_MS = 3000


@dataclass(frozen=True)
class About:
    """What is kept beside an autosaved scene: its own file (or nothing), its name, when it was written."""

    scene_path: str = ""
    name: str = ""
    when: float = 0.0


class Slot:
    """An autosaved scene on the disk, and the lock that tells whose it is."""

    def __init__(self, stem: Path) -> None:
        self.scene_file = stem.with_suffix(SCENE_SUFFIX)
        self._about_file = stem.with_suffix(".json")
        self._lock = QLockFile(str(stem.with_suffix(".lock")))
        self._lock.setStaleLockTime(0)

    def take(self) -> bool:
        """Take the slot, if nobody who lives has it; tells whether it is ours."""
        if not self._lock.isLocked():
            # Fails while the holder lives: the lock is the system's, the file only its name.
            self._lock.removeStaleLockFile()
            self._lock.tryLock(0)
        return self._lock.isLocked()

    def write(self, scene: Scene, about: About) -> None:
        """Write the scene, whole or not at all.

        Raises
        ------
        SfumatoError, OSError
            If it cannot be written.
        """
        self._about_file.write_text(json.dumps(about.__dict__), encoding="utf-8")
        scene.save(self.scene_file)

    def about(self) -> About:
        """Return what is known about the scene; little, if the file is damaged."""
        try:
            kept = json.loads(self._about_file.read_text(encoding="utf-8"))
            return About(str(kept["scene_path"]), str(kept["name"]), float(kept["when"]))
        except (OSError, ValueError, KeyError, TypeError):
            return About()

    def remove(self) -> None:
        """Remove the scene; the slot stays ours."""
        for file in (self.scene_file, self._about_file):
            file.unlink(missing_ok=True)

    def release(self) -> None:
        """Let go of the slot; what is in it can be recovered."""
        self._lock.unlock()


def folder() -> Path:
    """Return the folder of the slots.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    made = data_dir() / "autosave"
    made.mkdir(exist_ok=True)
    return made


class Autosave(QObject):
    """Writes a window's scene while it differs from what is saved.

    Parameters
    ----------
    identify : callable () -> (str, str)
        Tells the scene's own file, or nothing, and its name.
    """

    #: It could not be written; said once until it can be again.
    failed = Signal(str)
    _written = Signal(str)

    def __init__(self, editor: Editor, identify: Callable[[], tuple[str, str]], parent: QObject) -> None:
        super().__init__(parent)
        self._editor, self._identify = editor, identify
        self._slot: Slot | None = None
        self._thread: threading.Thread | None = None
        self._troubled = False
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._save)
        self._written.connect(self._on_written)
        editor.changed.connect(lambda old, new: self.watch())
        editor.history_changed.connect(self.watch)

    def watch(self) -> None:
        """Look whether there is something to write, or no longer."""
        scene = self._editor.scene
        named = bool(scene.volume.info.path) if scene.volume is not None else bool(scene.geometry)
        if not self._editor.document.modified:
            self.clear()
        elif named and not self._timer.isActive():
            # Not started anew at each change: a hand that never rests is saved too.
            self._timer.start(AUTOSAVE_MS)

    def clear(self) -> None:
        """Remove what was written: it is saved, or was given up."""
        self._timer.stop()
        self._wait()
        if self._slot is not None:
            self._slot.remove()

    def adopt(self, slot: Slot) -> None:
        """Go on with the slot of a scene that was recovered."""
        self.close()
        self._slot = slot

    def close(self) -> None:
        """Remove what was written, and the slot."""
        self.clear()
        if self._slot is not None:
            self._slot.release()
            self._slot = None

    # -- writing ----------------------------------------------------------------------------------
    def _save(self) -> None:
        if not self._editor.document.modified:
            return
        if self._thread is not None and self._thread.is_alive():
            self._timer.start(AUTOSAVE_MS)
            return
        about = About(*self._identify(), time.time())
        self._thread = threading.Thread(
            target=self._write, args=(self._editor.scene, about), name="sfumato-autosave", daemon=True
        )
        self._thread.start()

    def _write(self, scene: Scene, about: About) -> None:
        try:
            if self._slot is None:
                slot = Slot(folder() / uuid.uuid4().hex)
                if not slot.take():
                    raise OSError(f"{slot.scene_file.parent} cannot be written")
                self._slot = slot
            self._slot.write(scene, about)
        except (OSError, SfumatoError) as error:
            self._written.emit(one_line(error))
        else:
            self._written.emit("")

    def _on_written(self, problem: str) -> None:
        if problem and not self._troubled:
            self.failed.emit(problem)
        self._troubled = bool(problem)

    def _wait(self) -> None:
        """Wait for a write that is under way; a scene without its volume is a few kilobytes."""
        if self._thread is not None:
            self._thread.join(2.0)
            self._thread = None
