"""What was opened last: the list of recent files, its menu, and the folder where dialogs start."""

from __future__ import annotations

import os
import threading
from pathlib import Path

from qtpy.QtCore import Signal
from qtpy.QtGui import QAction
from qtpy.QtWidgets import QMenu, QWidget

from .settings import settings

MAX_RECENT = 10
_FILES, _FOLDER = "files/recent", "files/folder"
#: Longest folder that is shown beside a file's name, in characters.
_FOLDER_LENGTH = 40


def recent_files() -> list[str]:
    """Return the paths that were opened or saved last, the newest first."""
    kept = settings().value(_FILES, [])
    # An INI file does not tell one text from a list of one.
    paths = kept if isinstance(kept, list) else [kept]
    return [path for path in paths if isinstance(path, str) and path][:MAX_RECENT]


def remember(path: str) -> None:
    """Put a file or folder in front of the list, and let dialogs start beside it."""
    absolute = os.path.abspath(path)
    others = [p for p in recent_files() if p != absolute]
    kept = settings()
    kept.setValue(_FILES, [absolute, *others][:MAX_RECENT])
    kept.setValue(_FOLDER, os.path.dirname(absolute))


def forget_all() -> None:
    """Empty the list."""
    settings().remove(_FILES)


def last_folder() -> str:
    """Return the folder where a dialog starts: that of the last file, or the user's own."""
    return str(settings().value(_FOLDER, "")) or str(Path.home())


def recent_folders() -> list[str]:
    """Return the folders of the recent files, each once: where a volume that has moved may be."""
    return list(dict.fromkeys(os.path.dirname(path) for path in recent_files()))


class RecentMenu(QMenu):
    """Lists the recent files; those that are gone are marked and cannot be chosen."""

    #: The user wants to open this path.
    chosen = Signal(str)
    #: What of the list is missing, from the thread that looked (a network folder may take its time).
    _looked = Signal(object)

    def __init__(self, parent: QWidget) -> None:
        super().__init__("Recent", parent)
        self.setToolTipsVisible(True)
        self._actions: dict[str, QAction] = {}
        self.aboutToShow.connect(self.refresh)
        self._looked.connect(self._mark)
        self.refresh()

    def refresh(self) -> None:
        """Show the list as it is now."""
        self.clear()
        self._actions = {path: self._add(path) for path in recent_files()}
        if not self._actions:
            self.addAction("Nothing was opened yet").setEnabled(False)
            return
        self.addSeparator()
        self.addAction("Clear the list", forget_all)
        paths = list(self._actions)
        threading.Thread(target=self._look, args=(paths,), name="sfumato-recent", daemon=True).start()

    def _add(self, path: str) -> QAction:
        folder, name = os.path.split(path)
        if len(folder) > _FOLDER_LENGTH:
            folder = "…" + folder[-_FOLDER_LENGTH:]
        action = self.addAction(f"{name}  –  {folder}".replace("&", "&&"))
        action.setToolTip(path)
        action.triggered.connect(lambda _=False: self.chosen.emit(path))
        return action

    def _look(self, paths: list[str]) -> None:
        missing = {path for path in paths if not os.path.exists(path)}
        try:
            self._looked.emit(missing)
        except RuntimeError:  # the window was closed meanwhile
            return

    def _mark(self, missing: set[str]) -> None:
        for path in missing & self._actions.keys():
            action = self._actions[path]
            if action.isEnabled():
                action.setText(f"{action.text()}  (missing)")
                action.setEnabled(False)
