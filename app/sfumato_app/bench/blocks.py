"""Local occlusion over blocks: what data reduction and fewer directions cost in colour, and save in time (Hernell2007).

The paper's section 5, measured again on the benchmark's chest: seconds to gather light from one direction against
data reduction (its Fig. 5), and the mean colour difference of the pictures against the finest reduction (Fig. 6) and
against 128 directions (Fig. 7). A colour difference of 100 in CIELAB counts as 100 %; the mean is over the subject.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

import sfumato
from sfumato.colorimetry import cielab
from sfumato.renderer import FULL
from sfumato.techniques.frame import Frame
from sfumato.techniques.local_occlusion.blocks import prepare_blocks
from sfumato.techniques.local_occlusion.gather import Gatherer
from sfumato.techniques.local_occlusion.params import LocalOcclusionParams
from sfumato.techniques.marcher import prepare_material

from . import machine
from .setting import Setting

#: Data reductions, and the paper's mean errors in percent against the first.
REDUCTIONS = {8.5: 0.0, 15.7: 0.6, 31.4: 1.2, 92.8: 1.6}
#: Directions, and the paper's mean errors in percent against the first.
DIRECTIONS = {128: 0.0, 64: 0.3, 16: 0.7, 8: 0.9}
#: Directions of the pictures whose reductions are compared, and the reduction of those whose directions are.
SHOWN, REDUCED = 8, 31.4
#: Samples along a ray at the finest level and its length in voxels: a block, as in the paper.
SAMPLES, RADIUS = 15, 16
#: Directions gathered for a time.
TIMED = 3
FORMAT_VERSION = 1


@dataclass(frozen=True)
class Step:
    """A data reduction (voxels a texel) as it came out, CPU seconds a direction, and error in percent."""

    wanted: float
    reduction: float
    texels: int
    seconds: float
    error: float
    paper: float


@dataclass(frozen=True)
class BlocksReport:
    """What was measured; `directions` holds count, error in percent, and the paper's."""

    machine: dict[str, Any]
    setting: Setting
    steps: list[Step]
    directions: list[tuple[int, float, float]]

    def to_json(self) -> dict[str, Any]:
        """Return everything as JSON data."""
        return {"sfumato_blocks": FORMAT_VERSION, **asdict(self), "setting": self.setting.to_json()}

    def text(self) -> str:
        """Return the tables for people."""
        m, first = self.machine, self.steps[0]
        lines = [
            f"sfumato bench --blocks, {m['date']}",
            f"machine   {m['cpu']}, {m['cores']} cores, load {' '.join(map(str, m['load_average'] or []))}",
            f"graphics  {m['gl_renderer']}, OpenGL {m['gl_version']}",
            f"task      {self.setting}; rays of {RADIUS} voxels, {SAMPLES} samples at the finest level",
            "",
            f"{'reduction':>12}{'texels':>10}{'CPU s a direction':>20}{'times as fast':>15}{'error %':>9}{'paper':>7}",
        ]
        for s in self.steps:
            lines.append(
                f"{s.reduction:>10.1f}:1{s.texels:>10}{s.seconds:>20.3f}{first.seconds / s.seconds:>15.2f}"
                f"{s.error:>9.2f}{s.paper:>7.1f}"
            )
        lines += ["", f"{'directions':>12}{'error %':>9}{'paper':>7}"]
        lines += [f"{n:>12}{error:>9.2f}{paper:>7.1f}" for n, error, paper in self.directions]
        return "\n".join(lines)


def measure_blocks(setting: Setting, tell: Callable[[str], None] = lambda text: None) -> BlocksReport:
    """Measure times and errors.

    Raises
    ------
    GpuError
        If there is no device to draw on.
    """
    renderer = sfumato.Renderer()
    gatherer = Gatherer(renderer.device)
    try:
        scene = setting.scene("local-occlusion").with_(technique=_params(setting))
        steps, finest = [], None
        for reduction, paper in REDUCTIONS.items():
            tell(f"reduction {reduction:g} : 1")
            wanted = scene.with_({"technique.reduction": reduction})
            size, texels, seconds = _gathering(renderer, gatherer, wanted)
            picture = _picture(renderer, wanted, setting)
            finest = picture if finest is None else finest
            steps.append(Step(reduction, size, texels, seconds, colour_error(picture, finest), paper))
        directions, best = [], None
        for count, paper in DIRECTIONS.items():
            tell(f"{count} directions")
            wanted = scene.with_({"technique.directions": count, "technique.reduction": REDUCED})
            picture = _picture(renderer, wanted, setting)
            best = picture if best is None else best
            directions.append((count, colour_error(picture, best), paper))
        tell("")
        return BlocksReport(machine.describe(renderer.name, renderer.version), setting, steps, directions)
    finally:
        gatherer.release()
        renderer.close()


def _params(setting: Setting) -> LocalOcclusionParams:
    voxel = setting.scene("local-occlusion").volume.unit_distance  # type: ignore[union-attr]
    return LocalOcclusionParams(
        directions=SHOWN, samples=SAMPLES, radius=RADIUS * voxel, lamps="off", coarsest=0, adaptive=False
    )


def _gathering(
    renderer: sfumato.Renderer, gatherer: Gatherer, scene: sfumato.Scene
) -> tuple[float, int, float]:
    """Return the data reduction, its texels, and the least CPU seconds of a direction."""
    frame = Frame(renderer.device, scene, (8, 8), None, replace(FULL, progressive=True))  # type: ignore[arg-type]
    material = prepare_material(frame)
    blocks = prepare_blocks(frame, material)
    light, times = gatherer.light_map(frame, material, blocks), []
    for number in range(1 + TIMED):  # the first compiles
        began = time.process_time()
        for _ in gatherer.gather(frame, material, blocks, light, number + 1, 0.0):
            pass
        times.append(time.process_time() - began)
    return blocks.packing.reduction, blocks.packing.texels, min(times[1:])


def _picture(renderer: sfumato.Renderer, scene: sfumato.Scene, setting: Setting) -> np.ndarray:
    """Return a finished picture in linear light, shape (height, width, 3)."""
    job = renderer.begin(scene, setting.picture_size)
    try:
        for _ in job.add_frame():
            pass
        return job.linear()[..., :3]
    finally:
        job.release()


def colour_error(picture: np.ndarray, truth: np.ndarray) -> float:
    """Return the mean colour difference (CIELAB) over the subject, which is all that is not black, in percent."""
    subject = truth.max(axis=-1) > 0
    away = np.linalg.norm(cielab(np.clip(picture, 0, 1)) - cielab(np.clip(truth, 0, 1)), axis=-1)
    return float(away[subject].mean()) if subject.any() else 0.0
