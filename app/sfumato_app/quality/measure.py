"""How near a technique's picture is to the truth, and what it costs."""

from __future__ import annotations

import itertools
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import ndimage

from sfumato import Renderer, Scene

from .contestants import Contestant
from .trials import Trial
from .truth import LUMINANCE, Truth

#: Copies of a shadow are edges that the truth has not; blurred is by this share of the picture's side.
COPY_SCALE = 0.03
#: Detail of brightness (root mean square) that the truth is taken to have at least, so that where all is soft
#: a trace of noise is no copy.
LEAST_DETAIL = 0.01
#: Brightness that a wall without shadows is taken to have at least.
LEAST_SKIN = 0.05
#: Degrees by which the lamp moves between timed frames, so that nothing kept from the last one helps.
NUDGE = 1e-3
TIMED = 3
#: Least sampling distance in voxels that a scene may have; 1024 slices of a flat stage would be thinner.
THINNEST = 0.05


@dataclass(frozen=True)
class Error:
    """One picture against the truth, on bare wall; brightness, unshadowed = 1.

    Attributes
    ----------
    rmse, bias, p99 : float
        Root mean square, mean, and 99th percentile of the absolute difference.
    fringe : float
        Fine structure of the difference (root mean square; see `detail`).
    copies : float
        The same over that of the truth (see `copies`).
    """

    rmse: float
    bias: float
    p99: float
    fringe: float
    copies: float


@dataclass
class Result:
    """What was measured of one contestant in one scene.

    Attributes
    ----------
    errors : dict
        By number of frames.
    cpu : float
        Milliseconds of CPU time a frame, all threads, the light moving; median.
    slices : dict
        Number of slices -> mean absolute difference of the shadows on the wall to those at the most slices.
    slices_spread : float or None
        Largest mean absolute difference of shadows (brightness over that of the same wall without occluders,
        drawn with as many slices) between two numbers of slices.
    skin_spread : float or None
        The same for the brightness itself: how bright a leaning skin is depends on how thinly it is cut.
    pictures : dict
        Linear pictures by number of frames, at the truth's size.
    """

    trial: Trial
    contestant: Contestant
    errors: dict[int, Error] = field(default_factory=dict)
    cpu: float = 0.0
    slices: dict[int, float] = field(default_factory=dict)
    slices_spread: float | None = None
    skin_spread: float | None = None
    pictures: dict[int, np.ndarray] = field(default_factory=dict)


def measured(
    renderer: Renderer,
    trial: Trial,
    contestant: Contestant,
    truth: Truth,
    frames: Sequence[int],
    slices: Sequence[int] = (),
) -> Result:
    """Draw a scene and compare.

    Parameters
    ----------
    frames : sequence of int
        Numbers of accumulated frames to look at.
    slices : sequence of int
        Numbers of slices between which the picture should not change; none: not measured.
    """
    side = len(truth.mask)
    scene = contestant.scene(trial.scene())
    result = Result(trial, contestant)
    result.pictures = draw(renderer, scene, side, contestant, frames)
    result.errors = {n: error(picture, truth) for n, picture in result.pictures.items()}
    result.cpu = frame_cpu(renderer, scene, side, contestant)
    if slices:
        _compare_slices(renderer, result, truth, frames=min(frames), slices=slices)
    return result


def _compare_slices(
    renderer: Renderer, result: Result, truth: Truth, frames: int, slices: Sequence[int]
) -> None:
    """Draw the scene cut into numbers of slices, with its occluders and without."""
    contestant, side = result.contestant, len(truth.mask)
    with_all, bare = (contestant.scene(result.trial.scene(bare=without)) for without in (False, True))

    def shown(scene: Scene, count: int) -> np.ndarray:
        picture = draw(renderer, _cut(scene, count), side, contestant, (frames,))[frames]
        return np.asarray(truth.brightness(picture)[truth.mask])

    skins = [shown(with_all, n) for n in slices]
    shadows = [skin / np.maximum(shown(bare, n), LEAST_SKIN) for skin, n in zip(skins, slices, strict=True)]
    result.slices = {n: _apart(s, shadows[-1]) for n, s in zip(slices, shadows, strict=True)}
    result.slices_spread, result.skin_spread = (
        max((_apart(a, b) for a, b in itertools.combinations(seen, 2)), default=0.0)
        for seen in (shadows, skins)
    )


def draw(
    renderer: Renderer, scene: Scene, side: int, contestant: Contestant, frames: Sequence[int]
) -> dict[int, np.ndarray]:
    """Return linear pictures (side, side, 4) after each of some numbers of frames."""
    job = renderer.begin(scene, (side, side), contestant.quality)
    taken = {}
    try:
        for n in range(1, max(frames) + 1):
            for _ in job.add_frame():
                pass
            if n in frames:
                taken[n] = enlarged(job.linear().astype(np.float64), side)
    finally:
        job.release()
    return taken


def enlarged(picture: np.ndarray, side: int) -> np.ndarray:
    """Return a picture drawn at a lower scale as it is shown: at full size, bilinear."""
    if len(picture) == side:
        return picture
    zoom = (side / picture.shape[0], side / picture.shape[1], 1)
    return np.asarray(ndimage.zoom(picture, zoom, order=1, mode="nearest", grid_mode=True))


def frame_cpu(renderer: Renderer, scene: Scene, side: int, contestant: Contestant) -> float:
    """Return the CPU time of a first frame with the light just moved, in ms: median of some."""
    times = []
    for n in range(TIMED):
        # The aperture too: a headlamp has no rotation.
        light, by = scene.lights[0], NUDGE * (n + 1)
        moved = scene.with_(
            {"lights.0.rotation": light.rotation + by, "lights.0.aperture": light.aperture + by}
        )
        began = time.process_time()
        job = renderer.begin(moved, (side, side), contestant.quality)
        for _ in job.add_frame():
            pass
        times.append((time.process_time() - began) * 1000)
        job.release()
    return float(np.median(times))


def error(picture: np.ndarray, truth: Truth) -> Error:
    """Compare a linear picture with the truth."""
    difference = truth.brightness(picture) - truth.shadow
    inside = difference[truth.mask]
    return Error(
        float(np.sqrt(np.mean(inside**2))),
        float(inside.mean()),
        float(np.percentile(np.abs(inside), 99)),
        detail(difference, truth.mask),
        copies(difference, truth),
    )


def copies(difference: np.ndarray, truth: Truth) -> float:
    """Return how much detail a difference of brightness has, relative to the detail of the truth.

    Detail is what a Gaussian blur within the mask takes away. A shadow that is merely too soft or too dark on
    the whole hardly counts; edges where the truth has a smooth penumbra do. For comparison, exact rays along
    8, 16 and 64 directions instead of a cone have 4.4, 2.8 and 1.0 (shapes, 0/30), 0.9, 0.5 and 0.1 (hand, 35/15).
    """
    return detail(difference, truth.mask) / max(detail(truth.shadow, truth.mask), LEAST_DETAIL)


def detail(image: np.ndarray, mask: np.ndarray) -> float:
    """Return the root mean square of an image's fine structure within a mask."""
    sigma, share = COPY_SCALE * len(mask), mask.astype(np.float64)
    blurred = ndimage.gaussian_filter(image * share, sigma) / np.maximum(
        ndimage.gaussian_filter(share, sigma), 1e-9
    )
    return float(np.sqrt(np.mean((image - blurred)[mask] ** 2)))


def luminance(picture: np.ndarray) -> np.ndarray:
    """Return the luminance of a linear picture."""
    return np.asarray(picture[..., :3] @ LUMINANCE)


def _apart(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).mean())


def _cut(scene: Scene, slices: int) -> Scene:
    """Return a scene whose volume is cut into a number of slices across the view, if they can be so thin."""
    assert scene.camera is not None
    assert scene.volume is not None
    depth = np.ptp(scene.volume.corners() @ np.array(scene.camera.basis().back))
    return scene.with_(step=max(THINNEST, float(depth) / slices / scene.volume.min_spacing))
