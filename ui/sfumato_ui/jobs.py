"""What the render thread is asked for, and what it gives back."""

from __future__ import annotations

from collections.abc import Callable, Generator, Hashable
from dataclasses import dataclass
from typing import Any

import numpy as np
from qtpy.QtGui import QImage

from sfumato import Scene
from sfumato.audit import Audit
from sfumato.export.tiles import Guest
from sfumato.techniques.frame import Quality

#: Jittered frames that a still picture accumulates.
STILL_FRAMES = 8
#: Seconds after which a still picture of so many frames is good enough with fewer.
STILL_SECONDS = 18.0


@dataclass(frozen=True)
class Picture:
    """A finished picture and how it came about."""

    image: QImage
    scene: Scene
    size: tuple[int, int]
    seconds: float
    frames: int
    interactive: bool
    #: Frames that it will have in the end.
    wanted: int = STILL_FRAMES
    #: How much of the light that comes by and by it shows, 0 to 1.
    light: float = 1.0
    #: What the shadow audit found, if it shows one.
    audit: Audit | None = None

    @property
    def settled(self) -> bool:
        """Whether no better picture of this scene will follow."""
        return not self.interactive and self.light >= 1 and self.frames >= self.wanted


@dataclass(frozen=True)
class ViewRequest:
    """The window wants to see this scene at this size in pixels."""

    scene: Scene
    size: tuple[int, int]
    interactive: bool
    frames: int = STILL_FRAMES
    #: Threshold of the shadow audit, 0 to 1; 0: none.
    audit: float = 0.0


@dataclass(frozen=True)
class SaveRequest:
    """A file is to be drawn and written on the worker's thread.

    ``work`` is given the renderer and a guest to whom it lends it in between; it yields its progress (0 to 1)
    and ends at once when it is closed. ``done`` names the file.
    """

    work: Callable[[Any, Guest], Generator[float, None, None]]
    done: str


@dataclass(frozen=True)
class ThumbnailRequest:
    """A control wants a picture when there is time; ``group`` and ``key`` are its own names for it.

    Without quality and frames it is drawn coarsely, as suits a small one. If ``timed``, the image says by its text
    "seconds" how long a frame takes. If ``exposed``, it has the scene's automatic exposure, and says it by "exposure".
    One that is ``urgent`` waits for no more than the first frame of the picture.
    """

    group: str
    key: Hashable
    scene: Scene
    size: tuple[int, int]
    quality: Quality | None = None
    frames: int = 0
    timed: bool = False
    exposed: bool = False
    urgent: bool = False


def affordable_frames(most: int, drawn: int, seconds: float) -> int:
    """Return how many of a picture's frames to draw, when some are drawn and took so many seconds.

    A slow device settles on fewer frames, unless the user asked for many.
    """
    if most > STILL_FRAMES:
        return most
    return min(most, max(drawn, round(STILL_SECONDS * drawn / max(seconds, 1e-6))))


def image_of(accumulation: Any) -> QImage:
    """Return the picture so far in the form that paints quickest.

    The conversion, which also copies, is done here: the window's thread has nothing left to do but to paint.
    """
    return image_from(accumulation.picture())


def image_from(picture: np.ndarray) -> QImage:
    """Return a picture, shape (height, width, 4), as the image that paints quickest."""
    pixels = np.ascontiguousarray(picture)
    height, width = pixels.shape[:2]
    image = QImage(pixels.data, width, height, 4 * width, QImage.Format.Format_RGBA8888)
    return image.convertToFormat(QImage.Format.Format_ARGB32_Premultiplied)
