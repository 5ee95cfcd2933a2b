"""Our own techniques as contenders."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

import sfumato
from sfumato.renderer import FULL, Quality
from sfumato.techniques.combined.passes import CombinedPainter

from .contender import Unavailable
from .setting import Setting

#: Degrees within which a moving light swings to and fro, and how far it gets a frame. Centred on the resting
#: light, so that on the whole the frames of both ask for the same work.
SWING, STRIDE = 21, 8
#: Degrees a frame by which a light trembles: for the eye it rests, but nothing kept can help.
TRIFLE = 1e-4


class Ours:
    """One of our techniques, its light at rest: what it keeps of its light from frame to frame it uses.

    Parameters
    ----------
    changes : mapping, optional
        By dotted paths, what is other than in the setting's scene.
    settling : int
        Frames that are drawn before each turn, untimed, until all is there that is kept.
    """

    def __init__(
        self,
        renderer: sfumato.Renderer,
        setting: Setting,
        technique: str,
        quality: Quality = FULL,
        changes: Mapping[str, Any] | None = None,
        settling: int = 0,
    ) -> None:
        self._settling = settling
        self._renderer = renderer
        self._quality = quality
        self._size = setting.picture_size
        self._light = np.zeros((0, 0, 3), dtype=np.float32)
        self._keep = False
        try:
            self._scene = setting.scene(technique).with_(dict(changes or {}))
            renderer.painter(self._scene)
        except (sfumato.SfumatoError, ImportError) as error:
            raise Unavailable(str(error)) from None

    def settle(self) -> None:
        """Draw until all is there that is kept."""
        for _ in range(self._settling):
            Ours.draw(self)

    def draw(self) -> None:
        """Draw the first frame of a new picture: its jitter, and with it the work, is always the same."""
        accumulation = self._renderer.begin(self.next_scene(), self._size, self._quality)
        try:
            for _ in accumulation.add_frame():
                pass
            if self._keep:
                self._light = np.clip(accumulation.linear()[..., :3], 0, 1)
        finally:
            accumulation.release()

    def next_scene(self) -> sfumato.Scene:
        """Return the scene to draw next."""
        return self._scene

    def light(self) -> np.ndarray:
        """Draw once more and return linear light."""
        self._keep = True
        self.draw()
        self._keep = False
        return self._light


class MovingLight(Ours):
    """One of our techniques while somebody moves the lamp: no two frames in a row have the same light.

    Parameters
    ----------
    angle : str
        What moves: ``rotation``, ``tilt`` or ``aperture``.
    swing : int
        Degrees within which it moves, in strides; with 1 it only trembles.
    """

    def __init__(
        self,
        renderer: sfumato.Renderer,
        setting: Setting,
        technique: str,
        angle: str,
        swing: int = SWING,
        quality: Quality = FULL,
        changes: Mapping[str, Any] | None = None,
        settling: int = 0,
    ) -> None:
        super().__init__(renderer, setting, technique, quality, changes, settling)
        self._paths = [f"lights.{k}.{angle}" for k in range(len(self._scene.lights))]
        self._starts = [getattr(light, angle) for light in self._scene.lights]
        self._turns = _swing(swing)

    def next_scene(self) -> sfumato.Scene:
        """Return the scene with its lights moved on."""
        turn = next(self._turns)
        return self._scene.with_(
            {path: start + turn for path, start in zip(self._paths, self._starts, strict=True)}
        )


class Refined(Ours):
    """Geometry in a picture at rest: light is kept, surfaces are drawn anew, as their jitter is another each frame."""

    def draw(self) -> None:
        """Draw a frame whose surfaces are not there yet."""
        painter = self._renderer.painter(self._scene)
        assert isinstance(painter, CombinedPainter)
        painter.surfaces.forget()
        super().draw()


class Retouched(Ours):
    """One of our techniques while somebody edits the transfer function: the first picture after each change."""

    def next_scene(self) -> sfumato.Scene:
        """Return the scene with its densest tissue a trifle less opaque."""
        transfer = self._scene.transfer
        assert transfer is not None
        last = len(transfer.points) - 1
        opacity = transfer.points[last].opacity - TRIFLE * (1 + next(_trifles))
        return self._scene.with_({f"transfer.points.{last}.opacity": opacity})


#: Counts the frames of all moving lights: no two contenders' lamps stand at one place either.
_trifles = itertools.count()


def _swing(swing: int) -> Iterator[float]:
    """Degrees around 0 that do not repeat: nothing kept from an earlier frame, whose ever, can help."""
    for count in itertools.count():
        yield (count * STRIDE) % swing - swing // 2 + TRIFLE * next(_trifles)
