"""A still picture and its frames, which serve as long as nothing changes that they depend on.

Exposure, white balance, tone curve, background and shadow floor tell how light becomes a picture, once it is there: a
change of these shows the frames that there are in another way, at once and as finely as they are.
"""

from __future__ import annotations

import functools
from typing import Any

from sfumato import Scene
from sfumato.renderer import AFTERWARDS
from sfumato.techniques.frame import Quality

from .jobs import ViewRequest, affordable_frames


class Refinement:
    """Frames of a still picture, some drawn and some to come.

    Attributes
    ----------
    accumulation : Accumulation
        The frames so far.
    seconds : float
        What the last frame took.
    """

    def __init__(self, renderer: Any, request: ViewRequest, quality: Quality) -> None:
        self._key = _key_of(request, quality)
        self._most = request.frames
        self._spent = self.seconds = 0.0
        self._whole = True
        self._renderer = renderer
        self.accumulation = renderer.begin(
            request.scene, request.size, quality=quality, audited=request.audit > 0
        )

    def serves(self, request: ViewRequest, quality: Quality) -> bool:
        """Tell whether what is wanted are these very frames."""
        return self._whole and self.accumulation.frames > 0 and self._key == _key_of(request, quality)

    def take(self, request: ViewRequest) -> None:
        """Show the frames as a request wants it."""
        self.accumulation.scene = request.scene
        self._most = request.frames

    @property
    def drawn(self) -> int:
        """Frames so far that count: none before the light has settled."""
        return self.accumulation.frames if self.accumulation.settled else 0

    @property
    def count(self) -> int:
        """How many it will be, as far as can be said by now."""
        return affordable_frames(self._most, self.drawn, self._spent) if self.drawn else self._most

    @property
    def finished(self) -> bool:
        """Whether all frames are drawn."""
        return self.drawn >= self.count

    def note_frame(self, seconds: float) -> None:
        """Count a frame that was drawn."""
        self.seconds = seconds
        if self.accumulation.settled:
            self._spent += seconds

    def note_dropped(self) -> None:
        """Note that a frame was given up: where shadows are measured, only half of it may be there."""
        self._whole = not self.accumulation.measured

    def release(self) -> None:
        """Free what is on the GPU."""
        self.accumulation.release()
        self._renderer.device.collect()


@functools.cache
def _defaults() -> dict[str, Any]:
    return {name: getattr(Scene(), name) for name in AFTERWARDS}


def _key_of(request: ViewRequest, quality: Quality) -> Any:
    """Return all that frames depend on."""
    measured = request.audit > 0 or request.scene.shadow_floor > 0
    return request.scene.with_(_defaults()), request.size, quality, measured
