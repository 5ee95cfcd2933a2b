"""After a crash: offers the work that was not saved, one scene after the other."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from qtpy.QtCore import QObject

from .autosave import Slot, folder
from .messages import MessageBar


class Recovery(QObject):
    """Looks for slots that nobody holds any more, and asks about each in the message bar.

    Parameters
    ----------
    recover : callable (Slot) -> bool
        Opens a slot's scene; tells whether it was allowed to.
    """

    def __init__(self, bar: MessageBar, recover: Callable[[Slot], bool]) -> None:
        super().__init__(bar)
        self._bar, self._open = bar, recover
        self._found: list[Slot] = []

    def offer(self) -> None:
        """Look, and ask about the newest that was found."""
        self._found = abandoned()
        self._ask_next()

    def close(self) -> None:
        """Leave what was not answered to the next start."""
        while self._found:
            self._found.pop().release()

    def _ask_next(self) -> None:
        if self._found:
            slot = self._found[-1]
            about = slot.about()
            name = f" on “{about.name}”" if about.name else ""
            when = _moment(about.when)
            text = f"Unsaved work{name}{when} was found: the program ended without saving it."
            self._bar.ask(text, {"Recover": self._recover, "Discard": self._discard})

    def _recover(self) -> None:
        if self._open(self._found[-1]):
            self._found.pop()
        self._ask_next()

    def _discard(self) -> None:
        slot = self._found.pop()
        slot.remove()
        slot.release()
        self._ask_next()


def abandoned() -> list[Slot]:
    """Return the slots whose window died, now ours, the oldest first."""
    try:
        files = sorted(folder().glob("*.sfumato"), key=_modified)
    except OSError:
        return []
    slots = [Slot(file) for file in files]
    return [slot for slot in slots if slot.take()]


def _modified(file: Path) -> float:
    try:
        return file.stat().st_mtime
    except OSError:  # another window has just removed it
        return 0.0


def _moment(when: float) -> str:
    """Return when it was, in words."""
    if not when:
        return ""
    then, now = time.localtime(when), time.localtime()
    same_day = then[:3] == now[:3]
    return time.strftime(" from %H:%M" if same_day else " from %Y-%m-%d %H:%M", then)
