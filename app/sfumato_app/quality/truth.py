"""What the brightness of the wall must be, by the ray-traced cone in float64; computed once and kept on disk."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import platformdirs
from scipy import ndimage

from sfumato import Scene, SfumatoError
from sfumato.reference import cone
from sfumato.reference.medium import Medium
from sfumato.reference.rays import Region, view_rays

from .staging import Stage
from .trials import Trial

#: Changes with the code of the reference, so that what an older one computed is not taken for the truth.
VERSION = 1
#: Directions in each cone: on the wall, and for the rest of the picture, which is only looked at.
DIRECTIONS, GLANCE = 256, 16
#: Sampling distance on the wall in voxels. Against half of it, and against four times the directions, brightness
#: changes by 0.001 (root mean square).
STEP = 0.25
#: Most optical depth before bare wall, and how far from the wall's border it lies, in voxels.
CLEAR, BORDER = 1e-3, 4.0
#: Pixels taken off the mask's edge: jittered frames smooth silhouettes by one.
EDGE = 2
#: Luminance of linear Rec. 709 primaries.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True)
class Truth:
    """What one scene should look like.

    Attributes
    ----------
    picture : ndarray, shape (h, w, 4)
        Linear, premultiplied.
    bare : ndarray, shape (h, w)
        Luminance of the wall alone; 1 outside the mask.
    mask : ndarray of bool, shape (h, w)
        Where bare wall is seen.
    seconds : float
        CPU time that it took.
    """

    picture: np.ndarray
    bare: np.ndarray
    mask: np.ndarray
    seconds: float

    def brightness(self, picture: np.ndarray) -> np.ndarray:
        """Return the brightness of a linear picture (h, w, >= 3), unshadowed = 1; 1 outside the mask."""
        return np.where(self.mask, picture[..., :3] @ LUMINANCE / self.bare, 1.0)

    @property
    def shadow(self) -> np.ndarray:
        """The truth's brightness."""
        return self.brightness(self.picture)


def default_folder() -> Path:
    """Return the folder where truths are kept; it need not exist."""
    return Path(platformdirs.user_cache_dir("sfumato", appauthor=False)) / "truth"


def truth(
    trial: Trial,
    side: int,
    folder: Path,
    directions: int = DIRECTIONS,
    tell: Callable[[str], None] = lambda text: None,
) -> Truth:
    """Return a scene's truth, from the folder or computed (tens of seconds).

    Parameters
    ----------
    side : int
        Of the square picture, in pixels.

    Raises
    ------
    SfumatoError
        If nothing of the wall is seen, or Numba is missing.
    """
    path = folder / f"{trial.id}-{_key(trial, side, directions)}.npz"
    kept = _read(path)
    if kept is None:
        tell(f"computing the truth of {trial.id}")
        kept = _compute(trial, side, directions)
        # A folder that cannot be written costs the same time again, nothing more.
        with contextlib.suppress(OSError):
            _write(path, kept)
    return kept


def _key(trial: Trial, side: int, directions: int) -> str:
    data = [VERSION, side, directions, GLANCE, STEP, CLEAR, BORDER, EDGE, trial.scene().to_json()]
    return hashlib.blake2b(json.dumps(data, sort_keys=True).encode(), digest_size=8).hexdigest()


def _compute(trial: Trial, side: int, directions: int) -> Truth:
    began = time.process_time()
    scene, size = trial.scene(), (side, side)
    mask = receiver(scene, trial.stage(), side)
    if not mask.any():
        raise SfumatoError(f"{trial.id}: no bare wall is to be seen")
    wall, rest = np.flatnonzero(mask), np.flatnonzero(~mask)
    picture, bare = np.zeros((side * side, 4)), np.ones(side * side)
    picture[wall] = traced(scene.with_(step=STEP), size, wall, directions)
    picture[rest] = traced(scene, size, rest, GLANCE)
    # Parallel rays meet a facing wall all alike.
    alike = scene.camera is not None and scene.camera.parallel_projection and trial.placing.elevation is None
    alone = traced(trial.scene(bare=True).with_(step=STEP), size, wall[:1] if alike else wall, directions)
    bare[wall] = alone[:, :3] @ LUMINANCE
    square = (side, side)
    return Truth(picture.reshape(*square, 4), bare.reshape(square), mask, time.process_time() - began)


def traced(scene: Scene, size: tuple[int, int], pixels: np.ndarray, directions: int) -> np.ndarray:
    """Return the ray-traced cone integral of some pixels, linear premultiplied; shape (n, 4).

    Raises
    ------
    SfumatoError
        If Numba is missing, without which it would take hours.
    """
    try:
        from sfumato.reference import cone_numba
    except ImportError:
        raise SfumatoError("the truth needs Numba: install sfumato[reference]") from None
    task = cone.prepare(scene, size, directions, 0.5, 0)
    cone_numba.empty_distance(task.medium)  # once, before the threads ask for it
    workers = os.cpu_count() or 1
    parts = [part for part in np.array_split(pixels, 16 * workers) if len(part)]
    with ThreadPoolExecutor(workers) as pool:
        done = list(pool.map(lambda part: cone_numba.integrate(task, part), parts))
    return np.concatenate(done) if done else np.zeros((0, 4))


def receiver(scene: Scene, stage: Stage, side: int) -> np.ndarray:
    """Return where the first thing that a view ray meets is the wall, away from borders and silhouettes."""
    assert scene.camera is not None
    rays = view_rays(scene.camera, (side, side))
    normal, center = np.array(stage.normal), np.array(stage.center)
    rate = rays.slope @ normal
    reach = ((center - rays.start) @ normal) / np.where(np.abs(rate) > 1e-9, rate, np.inf)
    hit = rays.at(reach)
    across = np.abs(hit - center) * (normal == 0)
    seen = (rate < 0) & (reach > 0) & (across.max(axis=1) < stage.half - BORDER)
    # Back along the ray from just before the face: all that stands in the way.
    back = -rays.slope / rays.secant[:, None]
    before = hit + normal * 1.0
    clear = np.zeros(side * side, dtype=bool)
    clear[seen] = _depth(scene, before[seen], back[seen]) < CLEAR
    return np.asarray(ndimage.binary_erosion(clear.reshape(side, side), iterations=EDGE))


def _depth(scene: Scene, points: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Return optical depths from points (n, 3) along unit vectors (n, 3) to the volume's edge."""
    medium, region = Medium(scene), Region(scene)
    length = np.maximum(region.interval(points, towards)[1], 0)
    total, near = np.zeros(len(points)), medium.value(points)
    step = 0.5
    for k in range(int(np.ceil(length.max(initial=0.0) / step))):
        end = np.minimum((k + 1) * step, length)
        far = medium.value(points + towards * end[:, None])
        total += medium.extinction_between(near, far) * np.maximum(end - k * step, 0)
        near = far
    return total


def _read(path: Path) -> Truth | None:
    try:
        with np.load(path, allow_pickle=False) as kept:
            return Truth(kept["picture"], kept["bare"], kept["mask"], float(kept["seconds"]))
    except (OSError, ValueError, EOFError, KeyError):
        return None


def _write(path: Path, made: Truth) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez_compressed(
                file, picture=made.picture, bare=made.bare, mask=made.mask, seconds=made.seconds
            )
        os.replace(temporary, path)
    finally:
        Path(temporary).unlink(missing_ok=True)
