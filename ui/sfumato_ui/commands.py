"""Binds the window's commands to what they do: one `QAction` each, with the keys of `bindings`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from qtpy.QtCore import QObject, QTimer, Signal
from qtpy.QtGui import QAction, QKeySequence
from qtpy.QtWidgets import QWidget

from .bindings import commands, keys_of, refresh_tips
from .keyboard_dialog import KeyboardDialog
from .palette import CommandPalette


class Commands(QObject):
    """All commands of a window.

    Parameters
    ----------
    acts : mapping
        What each command does, by its id; one without is not there.
    possible : mapping
        Tells whether it can be done now; always, if not given.
    """

    #: Keys were changed.
    rebound = Signal()

    def __init__(
        self,
        window: QWidget,
        acts: Mapping[str, Callable[[], Any]],
        possible: Mapping[str, Callable[[], bool]],
    ) -> None:
        super().__init__(window)
        self._window, self._possible = window, dict(possible)
        self.actions: dict[str, QAction] = {}
        own: dict[str, Callable[[], Any]] = {"palette": self.ask, "keyboard": self.ask_for_keys}
        for name in commands():
            act = {**acts, **own}.get(name)
            if act is not None:
                self.actions[name] = self._action(name, act)
        self._bind()

    def _action(self, name: str, act: Callable[[], Any]) -> QAction:
        action = QAction(commands()[name].title, self._window)
        action.triggered.connect(lambda _=False: act())
        self._window.addAction(action)
        return action

    def _bind(self) -> None:
        for name, action in self.actions.items():
            action.setShortcuts([QKeySequence(k) for k in keys_of(name)])

    def possible(self) -> list[str]:
        """Return the commands that can be done now."""
        return [name for name in self.actions if self._possible.get(name, lambda: True)()]

    def run(self, name: str) -> None:
        """Do a command."""
        self.actions[name].trigger()

    # -- dialogs ----------------------------------------------------------------------------------
    def ask(self) -> None:
        """Show the palette; what is chosen there is done once it is gone."""
        palette = CommandPalette([n for n in self.possible() if n != "palette"], self._window)
        palette.chosen.connect(lambda name: QTimer.singleShot(0, self, lambda: self.run(name)))
        palette.finished.connect(palette.deleteLater)
        palette.open()

    def ask_for_keys(self) -> None:
        """Show the dialog *Keyboard*."""
        dialog = KeyboardDialog(list(self.actions), self._window)
        dialog.rebound.connect(self._on_rebound)
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _on_rebound(self) -> None:
        self._bind()
        refresh_tips(self._window)
        self.rebound.emit()
