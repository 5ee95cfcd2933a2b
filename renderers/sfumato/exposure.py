"""Automatic exposure: how many stops bring what a scene's lamps show to the brightness of the tissue's own colours.

The lit picture is compared with the same one without light (`raycast`), in which everything has its own colour. Its
bright parts, not its mean: shadows are meant to be dark.
"""

from __future__ import annotations

import math
from collections.abc import Generator
from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from .colorimetry import LUMINANCE
from .pieces import finished
from .scene import Scene
from .techniques.frame import Quality

if TYPE_CHECKING:
    from .renderer import Renderer

#: Share of the pixels that are darker than what is compared.
BRIGHT = 0.95
#: Stops that nobody sees: so little is left alone.
UNSEEN = 0.25
#: Most stops, up or down.
MOST = 5.0
#: Stops are round numbers of these.
STEP = 0.05
#: Size in pixels of the pictures that are compared, and their quality.
SIZE, QUALITY = (96, 64), Quality(step=3.0, light=3.0)
#: Opacity from which on a pixel counts as showing something.
SHOWN = 0.05


def exposure_for(lit: np.ndarray, unlit: np.ndarray) -> float:
    """Return the exposure in stops for a lit picture and the same without light.

    Parameters
    ----------
    lit, unlit : ndarray, shape (height, width, 4), float32
        Linear, premultiplied, before exposure.
    """
    shown = unlit[..., 3] >= SHOWN
    if not shown.any():
        return 0.0
    have, own = (float(np.quantile(p[shown, :3] @ LUMINANCE, BRIGHT)) for p in (lit, unlit))
    if have <= 0 or own <= 0:
        return 0.0
    stops = max(-MOST, min(MOST, math.log2(own / have)))
    return 0.0 if abs(stops) < UNSEEN else round(round(stops / STEP) * STEP, 2)


def measured_exposure(
    renderer: Renderer, scene: Scene, size: tuple[int, int] = SIZE, quality: Quality = QUALITY
) -> Generator[float, None, float]:
    """Draw a scene small, lit and unlit, yielding progress (0 to 1); returns its automatic exposure in stops."""
    if scene.volume is None:  # geometry alone has no picture without light
        return 0.0
    lit = yield from _drawn(renderer, scene, size, quality, 0.0)
    unlit = yield from _drawn(
        renderer, scene.with_(technique="raycast"), size, replace(quality, light=1.0), 0.5
    )
    return exposure_for(lit, unlit)


def _drawn(
    renderer: Renderer, scene: Scene, size: tuple[int, int], quality: Quality, start: float
) -> Generator[float, None, np.ndarray]:
    job = renderer.begin(scene, size, quality=quality)
    try:
        with closing(job.add_frame()) as pieces:
            for done in pieces:
                yield start + 0.5 * done
        return job.foreground()
    finally:
        job.release()
        renderer.device.collect()


def automatic_exposure(scene: Scene) -> float:
    """Return a scene's automatic exposure in stops, measured by the calling thread's own renderer.

    Raises
    ------
    SceneError
        If the scene has nothing to draw.
    GpuError
        If the device cannot do it.
    """
    from .renderer import renderer_of_this_thread

    return finished(measured_exposure(renderer_of_this_thread(), scene))


__all__ = ["automatic_exposure", "exposure_for", "measured_exposure"]
