"""A thread of which the newest wish counts: the window's own never waits for it."""

from __future__ import annotations

import threading
from typing import Any, Generic, TypeVar

from qtpy.QtCore import QObject, Signal

from ..threads import tell
from ..wording import one_line

Wish = TypeVar("Wish")


class NewestFirst(QObject, Generic[Wish]):
    """Does what is wanted, one wish after the other; a new wish under the same name takes the place of the old one.

    Its thread lives while there is work. Those that inherit from it do a wish in `_do` and tell by `_tell`.
    """

    #: Something could not be made; why.
    failed = Signal(str)
    _thread_name = "sfumato-slices"

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._lock = threading.Lock()
        self._wanted: dict[str, Wish] = {}
        self._running = self._closed = False

    @property
    def idle(self) -> bool:
        """Whether all that was wanted is made."""
        with self._lock:
            return not self._running

    def forget(self) -> None:
        """Make nothing more of what was wanted: nobody looks, or the volume is another."""
        with self._lock:
            self._wanted.clear()

    def close(self) -> None:
        """Tell of nothing any more."""
        with self._lock:
            self._closed = True
            self._wanted.clear()

    def _add(self, name: str, wish: Wish) -> None:
        with self._lock:
            if self._closed:
                return
            self._wanted[name] = wish
            if self._running:
                return
            self._running = True
        threading.Thread(target=self._run, name=self._thread_name, daemon=True).start()

    # -- the thread -------------------------------------------------------------------------------
    def _run(self) -> None:
        while (wish := self._next()) is not None:
            try:
                self._do(wish)
            except Exception as error:  # no memory, a file that is mapped and gone: the views say so
                self._tell(self.failed, one_line(error))

    def _next(self) -> Wish | None:
        with self._lock:
            self._running = bool(self._wanted)
            return self._wanted.pop(next(iter(self._wanted))) if self._wanted else None

    def _do(self, wish: Wish) -> None:
        raise NotImplementedError

    def _tell(self, signal: Any, *values: Any) -> None:
        with self._lock:
            closed = self._closed
        if not closed:
            tell(signal, *values)


__all__ = ["NewestFirst"]
