"""Our own techniques as contenders."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import sfumato

from .contender import Unavailable
from .setting import Setting

#: Degrees within which a moving light swings to and fro, and how far it gets a frame. Centred on the resting
#: light, so that on the whole the frames of both ask for the same work.
SWING, STRIDE = 21, 8


class Ours:
    """One of our techniques, its light at rest."""

    def __init__(self, renderer: sfumato.Renderer, setting: Setting, technique: str) -> None:
        self._renderer = renderer
        self._size = setting.picture_size
        self._light = np.zeros((0, 0, 3), dtype=np.float32)
        self._keep = False
        try:
            self._scene = setting.scene(technique)
            renderer.painter(self._scene)
        except (sfumato.SfumatoError, ImportError) as error:
            raise Unavailable(str(error)) from None

    def draw(self) -> None:
        """Draw the first frame of a new picture: its jitter, and with it the work, is always the same."""
        accumulation = self._renderer.begin(self.next_scene(), self._size)
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
    """One of our techniques while somebody moves the lamp: no two frames in a row have the same light."""

    def __init__(self, renderer: sfumato.Renderer, setting: Setting, technique: str, angle: str) -> None:
        super().__init__(renderer, setting, technique)
        self._path = f"lights.0.{angle}"
        self._angles = _swing(getattr(setting, angle))

    def next_scene(self) -> sfumato.Scene:
        """Return the scene with the light moved on."""
        return self._scene.with_({self._path: next(self._angles)})


def _swing(middle: float) -> Iterator[float]:
    """Angles in degrees around a middle that do not repeat: nothing kept from an earlier frame can help."""
    count = 0
    while True:
        yield middle + (count * STRIDE) % SWING - SWING // 2 + 1e-4 * count
        count += 1
