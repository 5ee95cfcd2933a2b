"""From a tractogram of tens of thousands of lines to its first picture, in a real window.

A file of as many lines as asked for is written, then opened in the window, as by *Open*. Beside the times
stands how long the window's thread was away at most: a progress bar that stands still is no progress.
"""

from __future__ import annotations

import importlib
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import machine
from .drag import SIZE, _run_until, bench_window

LINES = 36_000
#: Points of a line, and the millimetres between them: those of a tracked fibre.
POINTS, STEP = 97, 1.0
#: A gap between two turns of the window's event loop that counts, in seconds.
GAP = 0.2
FORMAT_VERSION = 1


@dataclass(frozen=True)
class Tracts:
    """What opening took, in seconds from the wish.

    Attributes
    ----------
    steps : int
        How often progress was told.
    longest_step : float
        Between two of them.
    longest_gap : float
        Longest time for which the window's thread did nothing else.
    gaps : int
        How many were longer than `GAP`.
    """

    machine: dict[str, Any]
    lines: int
    points: int
    drawn: int
    triangles: int
    loaded: float
    first_picture: float
    full_picture: float
    steps: int
    longest_step: float
    longest_gap: float
    gaps: int

    def to_json(self) -> dict[str, Any]:
        """Return everything as JSON data."""
        return {"sfumato_tracts": FORMAT_VERSION, **asdict(self)}

    def text(self) -> str:
        """Return the figures for people."""
        m = self.machine
        return "\n".join(
            [
                f"sfumato bench --tracts, {m['date']}",
                f"machine   {m['cpu']}, {m['cores']} cores, load {' '.join(map(str, m['load_average'] or []))}",
                f"graphics  {m['gl_renderer']}, OpenGL {m['gl_version']}",
                f"task      TRK of {self.lines} lines, {self.points} points; window {SIZE[0]} x {SIZE[1]}",
                f"drawn     {self.drawn} lines, {self.triangles} triangles",
                f"read and built                  {self.loaded:6.1f} s, told in {self.steps} steps, "
                f"{self.longest_step:.2f} s at most between two",
                f"first picture                   {self.first_picture:6.1f} s",
                f"first picture in full quality   {self.full_picture:6.1f} s",
                f"window's thread away            {self.longest_gap:6.2f} s at most, "
                f"{self.gaps} times more than {GAP} s",
            ]
        )


def write_tracts(path: Path, lines: int) -> int:
    """Write a bundle of wavy fibres as TRK; returns its number of points."""
    streamlines: Any = importlib.import_module("nibabel.streamlines")
    random = np.random.default_rng(0)
    t = np.arange(POINTS) * STEP
    made = []
    for _ in range(lines):
        bow, wave = random.uniform(20, 60), random.uniform(0, 2 * np.pi, 3)
        x, y = t - t.mean(), bow * (1 - ((t - t.mean()) / t.mean()) ** 2)
        line = np.stack([x, y, 0 * t], axis=1) + random.normal(0, 8, 3)
        made.append((line + 0.6 * np.sin(t[:, None] / 3 + wave)).astype(np.float32))
    streamlines.TrkFile(streamlines.Tractogram(made, affine_to_rasmm=np.eye(4))).save(str(path))
    return lines * POINTS


def measure_tracts(lines: int = LINES, tell: Callable[[str], None] = lambda text: None) -> Tracts:
    """Write a tractogram, open it in a window, and tell how long that took.

    Raises
    ------
    SfumatoError
        If there is no display, Qt is missing, or no picture comes.
    """
    with bench_window("this", "--tracts") as window, tempfile.TemporaryDirectory() as folder:
        tell("writing")
        path = Path(folder) / "tracts.trk"
        points = write_tracts(path, lines)
        try:
            window.resize(*SIZE)
            window.show()
            tell("opening")
            return _open(window, path, lines, points)
        finally:
            tell("")


def _open(window: Any, path: Path, lines: int, points: int) -> Tracts:
    from qtpy.QtCore import QTimer

    from sfumato.geometry import mesh_of

    ticks, steps = [time.perf_counter()], [time.perf_counter()]
    clock = QTimer(window)
    clock.setInterval(5)
    clock.timeout.connect(lambda: ticks.append(time.perf_counter()))
    clock.start()
    window.files.loader.progress.connect(lambda done, text: steps.append(time.perf_counter()))
    _run_until(lambda: len(ticks) > 20, "the window")
    began = time.perf_counter()
    ticks[:], steps[:] = [began], [began]
    window.files.open(str(path))
    _run_until(lambda: bool(window.editor.scene.geometry), "the tractogram")
    loaded = time.perf_counter() - began
    _run_until(lambda: window.viewport.picture is not None, "the first picture")
    first = time.perf_counter() - began
    _run_until(lambda: not window.viewport.picture.interactive, "the picture in full quality")
    full = time.perf_counter() - began
    gaps = np.diff(ticks)
    renderer = window.worker._renderer
    mesh = mesh_of(window.editor.scene.geometry[0])
    return Tracts(
        machine.describe(renderer.name, renderer.version), lines, points, mesh.shown, len(mesh.triangles),
        loaded, first, full, len(steps) - 1, float(np.diff(steps).max()), float(gaps.max()), int((gaps > GAP).sum()),
    )  # fmt: skip
