"""Opening files away from the window's thread, with progress and cancel."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

from qtpy.QtCore import QObject, Signal

import sfumato_samples
from sfumato import Scene, Volume
from sfumato.export.png import open_png

from .worker import one_line

#: Shown when nothing was asked for.
DEFAULT_SAMPLE = "sample:hand"
SCENE_SUFFIX = ".sfumato"
SAMPLE = "sample:"


class Loader(QObject):
    """Opens one thing at a time; asking for another gives up the first."""

    progress = Signal(float, str)
    #: A scene is ready, and the scene file it came from or an empty text.
    loaded = Signal(object, str)
    #: A folder holds several DICOM series (path, list of series).
    several = Signal(str, object)
    failed = Signal(str)
    cancelled = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def open(self, path: str, series: Any = None) -> None:
        """Begin to open a volume, a folder, a scene file or a sample."""
        self.cancel()
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=self._run, args=(path, series, self._stop), name="sfumato-load", daemon=True
        )
        self._thread.start()

    def cancel(self) -> None:
        """Give up what is being opened; the thread ends by itself."""
        self._stop.set()

    @property
    def alive(self) -> bool:
        """Whether something is being opened."""
        return self._thread is not None and self._thread.is_alive()

    # -- the thread -------------------------------------------------------------------------------
    def _run(self, path: str, series: Any, stop: threading.Event) -> None:
        def progress(fraction: float, text: str = "") -> None:
            if not stop.is_set():
                self.progress.emit(fraction, text)

        try:
            found = _several_series(path) if series is None else []
            if len(found) > 1 and not stop.is_set():
                self.several.emit(path, found)
                return
            scene = read_scene(path, series, progress, stop.is_set)
        except Exception as error:
            # A reader that was stopped ends with an error of its own; what counts is who asked for it.
            if stop.is_set():
                self._tell_cancelled(stop)
            else:
                self.failed.emit(one_line(error))
            return
        if stop.is_set():
            self._tell_cancelled(stop)
        else:
            self.loaded.emit(scene, path if path.endswith(SCENE_SUFFIX) else "")

    def _tell_cancelled(self, stop: threading.Event) -> None:
        """Tell that the user gave up; not if something else is being opened instead."""
        if stop is self._stop:
            self.cancelled.emit()


def read_scene(path: str, series: Any = None, progress: Any = None, cancel: Any = None) -> Scene:
    """Read a scene file, a picture that carries its scene, or a volume as a new, fitting scene.

    What is slow to compute once (content hash, histogram, range) is computed here, off the window's thread.
    """
    if path.endswith(SCENE_SUFFIX):
        scene = Scene.open(path)
    elif path.startswith(SAMPLE):
        scene = sfumato_samples.scene(path.removeprefix(SAMPLE))
    elif path.lower().endswith(".png"):
        scene = open_png(path)
    else:
        from sfumato import load

        options = {} if series is None else {"series": series}
        volume: Volume = load(path, progress=progress, cancel=cancel, **options)
        scene = Scene(volume=volume)
    if scene.volume is not None:
        _ = scene.volume.key, scene.volume.histogram
    return scene


def _several_series(path: str) -> list[Any]:
    """Return the DICOM series in a folder, the largest first; nothing for anything else."""
    if path.startswith(SAMPLE) or not Path(path).is_dir():
        return []
    from sfumato.io import find_series

    return list(find_series(path))
