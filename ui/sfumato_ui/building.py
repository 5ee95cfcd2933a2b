"""Meshes of changed geometry are built away from the window's and the render thread; until then the old ones are shown.

Tubes of thousands of lines take seconds. Meanwhile the picture can be turned about as it was, the bar tells how far
it is, and the change can be given up.
"""

from __future__ import annotations

import threading
import time
from contextlib import suppress
from dataclasses import replace
from typing import Any

from qtpy.QtCore import QObject, Signal

from sfumato import Geometry, Scene
from sfumato.geometry import known_mesh, mesh_of

#: Seconds of building after which its progress is told.
TOLD_SECONDS = 0.4


class _GivenUpError(Exception):
    """The user, or another wish, wants it no more."""


class MeshBuilder(QObject):
    """Builds the meshes that a scene lacks, one after the other; its thread lives while there is work."""

    #: How far it is (0 to 1), and what it does; 1 when there is nothing left to do.
    progress = Signal(float, str)
    #: The meshes that were wanted are there, or cannot be built.
    built = Signal()
    #: Given up: the geometry that is shown instead.
    given_up = Signal(object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._lock = threading.Lock()
        self._wanted: tuple[Geometry, ...] = ()
        self._running = self._stop = self._closed = False
        #: Keys of what cannot be built: the renderer says why.
        self._failed: set[str] = set()
        #: Geometry as it was shown last, by its place; and the newest that was looked at, with nothing missing.
        self._shown: dict[int, Geometry] = {}
        self._checked: tuple[Geometry, ...] = ()

    @property
    def alive(self) -> bool:
        """Whether something is being built."""
        with self._lock:
            return self._running

    def buildable(self, scene: Scene) -> Scene:
        """Return a scene that can be drawn at once: what is not built yet is as it was shown last, or hidden.

        What is missing is then being built; `built` follows.
        """
        if scene.geometry is self._checked:
            return scene
        missing = tuple(g for g in scene.geometry if self._is_missing(g))
        if not missing:
            self._checked, self._shown = scene.geometry, dict(enumerate(scene.geometry))
            return scene
        self._want(missing)
        stand_ins = tuple(self._stand_in(i, g) if g in missing else g for i, g in enumerate(scene.geometry))
        return replace(scene, geometry=stand_ins)

    def _is_missing(self, geometry: Geometry) -> bool:
        return geometry.visible and known_mesh(geometry) is None and geometry.mesh_key not in self._failed

    def _stand_in(self, index: int, geometry: Geometry) -> Geometry:
        before = self._shown.get(index)
        if before is None or before.shape is not geometry.shape or known_mesh(before) is None:
            return replace(geometry, visible=False)
        return replace(before, visible=True, clipped=geometry.clipped)

    def give_up(self) -> None:
        """Build no more; what was shown before is to be the scene's again."""
        with self._lock:
            if not self._running or not self._shown:
                return
            self._stop, self._wanted = True, ()
        self.given_up.emit(tuple(self._shown[i] for i in sorted(self._shown)))

    def close(self) -> None:
        """Tell of nothing any more."""
        with self._lock:
            self._closed = self._stop = True
            self._wanted = ()

    def _want(self, geometry: tuple[Geometry, ...]) -> None:
        """Ask for meshes instead of those asked for before; what is being built is finished, for a hand that drags."""
        with self._lock:
            self._wanted, self._stop = geometry, False
            if self._running or self._closed:
                return
            self._running = True
        threading.Thread(target=self._run, name="sfumato-meshes", daemon=True).start()

    # -- the thread -------------------------------------------------------------------------------
    def _run(self) -> None:
        while (geometry := self._next()) is not None:
            began = time.monotonic()

            def step(done: float, text: str, began: float = began) -> None:
                if self._stop:
                    raise _GivenUpError
                if time.monotonic() - began > TOLD_SECONDS:
                    self._tell(self.progress, done, text)

            try:
                mesh_of(geometry, step)
            except _GivenUpError:
                continue
            except (
                Exception
            ):  # a colour map that is not known, no memory: the renderer meets it too, and says so
                self._failed.add(geometry.mesh_key)
            self._tell(self.progress, 1.0, "")
            self._tell(self.built)
        self._tell(self.progress, 1.0, "")

    def _next(self) -> Geometry | None:
        with self._lock:
            self._wanted = tuple(g for g in self._wanted if self._is_missing(g))
            self._running = bool(self._wanted)
            return self._wanted[0] if self._wanted else None

    def _tell(self, signal: Any, *values: Any) -> None:
        with self._lock:
            if not self._closed:
                with suppress(RuntimeError):  # the window is gone
                    signal.emit(*values)
