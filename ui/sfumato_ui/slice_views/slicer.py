"""The thread that slices: the window's own never waits, and of what is wanted the newest counts."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any

import numpy as np
from qtpy.QtCore import QObject, Signal
from qtpy.QtGui import QImage

from sfumato import Volume
from sfumato.slicing import Frame, ValueWindow, sample, windows_for

from ..threads import tell
from ..wording import one_line


@dataclass(frozen=True)
class SliceRequest:
    """A view wants this part of a slice."""

    volume: Volume
    frame: Frame
    window: ValueWindow


@dataclass(frozen=True)
class SliceImage:
    """What was wanted, and its picture: transparent outside of the volume."""

    request: SliceRequest
    image: QImage


class Slicer(QObject):
    """Makes slices; its thread lives while there is work."""

    #: A slice is made (`SliceImage`).
    sliced = Signal(object)
    #: A volume, and the windows that suit it.
    windows_found = Signal(object, object)
    #: Something could not be made; why.
    failed = Signal(str)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._lock = threading.Lock()
        #: What is wanted, by the view (its cut's id); of a volume its windows, by "".
        self._wanted: dict[str, SliceRequest | Volume] = {}
        self._running = self._closed = False
        #: The newest values of each view: another window needs no new ones.
        self._values: dict[str, tuple[Volume, Frame, np.ndarray]] = {}

    @property
    def idle(self) -> bool:
        """Whether all that was wanted is made."""
        with self._lock:
            return not self._running

    def want(self, request: SliceRequest) -> None:
        """Ask for a slice instead of those that the same view asked for before."""
        self._add(request.frame.cut.id, request)

    def want_windows(self, volume: Volume) -> None:
        """Ask for the windows that suit a volume."""
        self._add("", volume)

    def forget(self) -> None:
        """Make nothing more of what was wanted, and keep no values: nobody looks, or the volume is another."""
        with self._lock:
            self._wanted.clear()
            self._values.clear()

    def close(self) -> None:
        """Tell of nothing any more."""
        with self._lock:
            self._closed = True
            self._wanted.clear()

    def _add(self, name: str, wanted: SliceRequest | Volume) -> None:
        with self._lock:
            if self._closed:
                return
            self._wanted[name] = wanted
            if self._running:
                return
            self._running = True
        threading.Thread(target=self._run, name="sfumato-slices", daemon=True).start()

    # -- the thread -------------------------------------------------------------------------------
    def _run(self) -> None:
        while (wanted := self._next()) is not None:
            try:
                if isinstance(wanted, Volume):
                    self._tell(self.windows_found, wanted, windows_for(wanted))
                else:
                    self._tell(self.sliced, SliceImage(wanted, self._image(wanted)))
            except Exception as error:  # no memory, a file that is mapped and gone: the views say so
                self._tell(self.failed, one_line(error))

    def _next(self) -> SliceRequest | Volume | None:
        with self._lock:
            self._running = bool(self._wanted)
            return self._wanted.pop(next(iter(self._wanted))) if self._wanted else None

    def _image(self, request: SliceRequest) -> QImage:
        frame, name = request.frame, request.frame.cut.id
        with self._lock:
            kept = self._values.get(name)
        if kept is not None and kept[0] is request.volume and kept[1] == frame:
            values = kept[2]
        else:
            values = sample(request.volume, frame)
            with self._lock:
                self._values[name] = (request.volume, frame, values)
        return grey_image(values, request.window)

    def _tell(self, signal: Any, *values: Any) -> None:
        with self._lock:
            closed = self._closed
        if not closed:
            tell(signal, *values)


def grey_image(values: np.ndarray, window: ValueWindow) -> QImage:
    """Return values, shape (height, width), as a grey picture that is transparent where there are none (NaN)."""
    grey = window.grey(values).astype(np.uint32)
    pixels = np.where(np.isnan(values), np.uint32(0), np.uint32(0xFF000000) | grey * np.uint32(0x010101))
    height, width = pixels.shape
    image = QImage(pixels.data, width, height, 4 * width, QImage.Format.Format_ARGB32_Premultiplied)
    return image.copy()


__all__ = ["SliceImage", "SliceRequest", "Slicer", "grey_image"]
