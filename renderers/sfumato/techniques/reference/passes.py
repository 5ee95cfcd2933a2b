"""Painter of `reference`: the CPU's picture, uploaded as it grows."""

from __future__ import annotations

from collections.abc import Generator
from typing import TYPE_CHECKING, Any

import numpy as np

from ...reference import cone

if TYPE_CHECKING:
    from ..frame import Frame


class ReferencePainter:
    """Runs the ray-traced cone integral some rows at a time; keeps nothing on the device."""

    def __init__(self, device: Any) -> None:
        self.device = device

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw into the frame's target, yielding progress (0 to 1) after each batch of rows."""
        width, height = frame.size
        picture = np.zeros((height, width, 4))
        scene = frame.scene.with_(
            camera=frame.part_camera, step=min(16.0, frame.scene.step * frame.quality.step)
        )
        params = frame.params
        yield from cone.passes(
            scene,
            frame.size,
            picture,
            params.directions,
            params.light_step * frame.quality.step,
            frame.index,
            unshadowed=frame.unshadowed,
        )
        frame.target.write(picture.astype(np.float32))

    def release(self) -> None:
        """Free the GPU objects: there are none."""
