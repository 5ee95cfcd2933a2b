"""Makes the slices, in a thread."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from qtpy.QtCore import QObject, Signal
from qtpy.QtGui import QImage

from sfumato import Volume
from sfumato.slicing import Frame, ValueWindow, sample, windows_for

from .newest import NewestFirst


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


class Slicer(NewestFirst[SliceRequest | Volume]):
    """Makes slices for views, by their cuts' ids, and finds the windows that suit a volume."""

    #: A slice is made (`SliceImage`).
    sliced = Signal(object)
    #: A volume, and the windows that suit it.
    windows_found = Signal(object, object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        #: The newest values of each view: another window needs no new ones.
        self._values: dict[str, tuple[Volume, Frame, np.ndarray]] = {}

    def want(self, request: SliceRequest) -> None:
        """Ask for a slice instead of those that the same view asked for before."""
        self._add(request.frame.cut.id, request)

    def want_windows(self, volume: Volume) -> None:
        """Ask for the windows that suit a volume."""
        self._add("windows", volume)

    def forget(self) -> None:
        """Keep no values, either."""
        super().forget()
        with self._lock:
            self._values.clear()

    def _do(self, wish: SliceRequest | Volume) -> None:
        if isinstance(wish, Volume):
            self._tell(self.windows_found, wish, windows_for(wish))
        else:
            self._tell(self.sliced, SliceImage(wish, grey_image(self._values_of(wish), wish.window)))

    def _values_of(self, request: SliceRequest) -> np.ndarray:
        frame, name = request.frame, request.frame.cut.id
        with self._lock:
            kept = self._values.get(name)
        if kept is not None and kept[0] is request.volume and kept[1] == frame:
            return kept[2]
        values = sample(request.volume, frame)
        with self._lock:
            self._values[name] = (request.volume, frame, values)
        return values


def grey_image(values: np.ndarray, window: ValueWindow) -> QImage:
    """Return values, shape (height, width), as a grey picture that is transparent where there are none (NaN)."""
    grey = window.grey(values).astype(np.uint32)
    return packed_image(
        np.where(np.isnan(values), np.uint32(0), np.uint32(0xFF000000) | grey * np.uint32(0x010101))
    )


def packed_image(pixels: np.ndarray) -> QImage:
    """Return pixels of 32 bits (alpha, red, green, blue; premultiplied), shape (height, width), as an image."""
    height, width = pixels.shape
    kept = np.ascontiguousarray(pixels)
    return QImage(kept.data, width, height, 4 * width, QImage.Format.Format_ARGB32_Premultiplied).copy()


__all__ = ["SliceImage", "SliceRequest", "Slicer", "grey_image", "packed_image"]
