"""The menu of the recent files, each with what it looked like."""

from __future__ import annotations

import os
import threading

from qtpy.QtCore import Signal
from qtpy.QtGui import QAction
from qtpy.QtWidgets import QMenu, QProxyStyle, QStyle, QStyleOption, QWidget

from .recent import forget_all, recent_files
from .recent_pictures import SIDE, icon_of

#: Longest folder that is shown beside a file's name, in characters.
_FOLDER_LENGTH = 40


class _LargeIcons(QProxyStyle):
    """Lets a menu's icons be as large as the recent files' pictures."""

    def pixelMetric(
        self, metric: QStyle.PixelMetric, option: QStyleOption | None = None, widget: QWidget | None = None
    ) -> int:
        """Return a length of the style."""
        if metric == QStyle.PixelMetric.PM_SmallIconSize:
            return SIDE
        return super().pixelMetric(metric, option, widget)


class RecentMenu(QMenu):
    """Lists the recent files; those that are gone are marked and cannot be chosen."""

    #: The user wants to open this path.
    chosen = Signal(str)
    #: What of the list is missing, from the thread that looked (a network folder may take its time).
    _looked = Signal(object)

    def __init__(self, parent: QWidget) -> None:
        super().__init__("Recent", parent)
        self.setToolTipsVisible(True)
        style = _LargeIcons("fusion")
        style.setParent(self)
        self.setStyle(style)
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
        action = self.addAction(icon_of(path), f"{name}  –  {folder}".replace("&", "&&"))
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
