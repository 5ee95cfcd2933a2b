"""What the VTK view shows, built away from the window's thread: the last wish for each place counts."""

from __future__ import annotations

import threading
from typing import Any

from qtpy.QtCore import QObject, Signal

from sfumato import Geometry
from sfumato.geometry.preview import preview_of

from ..wording import one_line


class PreviewBuilder(QObject):
    """Builds what was wished for last, one after the other; its thread lives while there is work."""

    #: Built: place in the scene, geometry, `Preview`.
    built = Signal(int, object, object)
    #: Why a geometry cannot be shown.
    failed = Signal(str)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._lock = threading.Lock()
        self._wanted: dict[int, Geometry] = {}
        self._running = False
        self._closed = False

    @property
    def busy(self) -> bool:
        """Whether something is being built."""
        with self._lock:
            return self._running

    def want(self, index: int, geometry: Geometry) -> None:
        """Ask for what is shown of a geometry."""
        with self._lock:
            self._wanted[index] = geometry
            if self._running:
                return
            self._running = True
        threading.Thread(target=self._run, name="sfumato-vtk-build", daemon=True).start()

    def close(self) -> None:
        """Tell of nothing any more."""
        with self._lock:
            self._closed = True
            self._wanted.clear()

    def _run(self) -> None:
        while (wish := self._next()) is not None:
            index, geometry = wish
            made: Any
            try:
                made = preview_of(geometry)
            except Exception as error:  # a colour map that is not known, no memory: the view says so
                self._tell(self.failed, one_line(error))
                continue
            self._tell(self.built, index, geometry, made)

    def _tell(self, signal: Any, *values: Any) -> None:
        with self._lock:
            if not self._closed:
                signal.emit(*values)

    def _next(self) -> tuple[int, Geometry] | None:
        with self._lock:
            self._running = bool(self._wanted)
            return (index := min(self._wanted), self._wanted.pop(index)) if self._wanted else None
