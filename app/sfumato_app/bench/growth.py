"""How the cost of a frame grows: one of volume, viewport, slices and lights at a time, around one task.

The lamp moves at every frame, so that nothing kept of it helps. Beside the time stands the fraction of the
device's fetch ceiling that a technique reaches: the time that its counted fetches (`fetches`) would take at
the ceilings measured in the same run (`ceilings`), over its time.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import sfumato

from . import machine
from .ceilings import fetch_ceilings
from .contender import Unavailable
from .fetches import FetchCounter, seconds_at_ceiling
from .ours import MovingLight, Ours
from .setting import Setting

TECHNIQUES = ("raycast", "multidirectional", "cone")
FORMAT_VERSION = 1
#: Frames measured of each technique at each point.
FRAMES = 3
#: Where a frame takes longer than so many seconds, one is enough.
SLOW_SECONDS = 2.0
#: Pixels along a side of the picture that is drawn before: it uploads and compiles all that a large one needs.
WARM_UP = 64


@dataclass(frozen=True)
class Point:
    """One task: voxels and pixels along a side, slices through the volume's depth, lamps."""

    volume: int
    viewport: int
    slices: int
    lights: int

    @property
    def setting(self) -> Setting:
        """The benchmark's setting for it."""
        return Setting.sliced(self.volume, self.viewport, self.slices, self.lights)


BASE = Point(128, 256, 256, 1)
FACTORS: dict[str, tuple[int, ...]] = {
    "volume": (64, 128, 256, 512),
    "viewport": (256, 512, 1024, 2048),
    "slices": (64, 128, 256, 512, 1024),
    "lights": (1, 2, 3, 4),
}
#: What is measured with ``--quick``.
QUICK_BASE = Point(32, 64, 64, 1)
QUICK_FACTORS: dict[str, tuple[int, ...]] = {
    "volume": (32, 64), "viewport": (64, 128), "slices": (64, 128), "lights": (1, 2),
}  # fmt: skip


@dataclass(frozen=True)
class Sample:
    """What a technique's frame took at a point.

    Attributes
    ----------
    cpu_ms, wall_ms : float
        Medians.
    fetches : dict of int
        By kind; empty where they cannot be counted.
    fraction : float or None
        Of the fetch ceiling.
    missing : str
        Why there is nothing; empty if there is.
    """

    point: Point
    technique: str
    cpu_ms: float = 0.0
    wall_ms: float = 0.0
    fetches: dict[str, int] | None = None
    fraction: float | None = None
    missing: str = ""


@dataclass(frozen=True)
class Growth:
    """The whole table."""

    machine: dict[str, Any]
    clock: str
    base: Point
    factors: dict[str, tuple[int, ...]]
    ceilings: dict[str, float]
    techniques: tuple[str, ...]
    samples: Sequence[Sample]
    seconds: float

    def of(self, factor: str, value: int, technique: str) -> Sample:
        """Return a technique's sample where a factor has a value."""
        point = replace(self.base, **{factor: value})
        return next(s for s in self.samples if s.point == point and s.technique == technique)

    def milliseconds(self, sample: Sample) -> float:
        """Return a frame's time by the clock that counts."""
        return sample.cpu_ms if self.clock == "cpu" else sample.wall_ms

    def to_json(self) -> dict[str, Any]:
        """Return everything as JSON data."""
        return {
            "sfumato_growth": FORMAT_VERSION,
            "machine": self.machine,
            "clock": self.clock,
            "base": asdict(self.base),
            "factors": self.factors,
            "fetches_per_second": self.ceilings,
            "seconds": self.seconds,
            "samples": [asdict(sample) for sample in self.samples],
        }

    def text(self) -> str:
        """Return the table for people."""
        m = self.machine
        word = "CPU" if self.clock == "cpu" else "wall"
        ceilings = ", ".join(f"{kind} {value / 1e6:.0f}" for kind, value in self.ceilings.items())
        base = f"{self.base.volume}^3 uint8, {self.base.viewport} x {self.base.viewport} pixels, "
        lines = [
            f"sfumato bench --growth, {m['date']}",
            f"machine   {m['cpu']}, {m['cores']} cores, load {' '.join(map(str, m['load_average'] or []))}",
            f"graphics  {m['gl_renderer']}, OpenGL {m['gl_version']}",
            f"base      {base}{self.base.slices} slices, {self.base.lights} light",
            f"runs      lights move from frame to frame; {self.seconds:.0f} s in all",
            f"ceilings  million fetches a second ({word} time): {ceilings}",
            f"columns   {word} ms a frame, million fetches a frame, fraction of the fetch ceiling",
            "",
            f"{'':16}" + "".join(f"{technique:>30}" for technique in self.techniques),
        ]
        for factor, values in self.factors.items():
            lines += [f"{factor:9}{value:>5}  " + self._cells(factor, value) for value in values] + [""]
        return "\n".join(lines[:-1])

    def _cells(self, factor: str, value: int) -> str:
        return "".join(f"{self._cell(self.of(factor, value, t)):>30}" for t in self.techniques)

    def _cell(self, sample: Sample) -> str:
        if sample.missing:
            return "left out"
        count = f"{sum(sample.fetches.values()) / 1e6:9.1f}" if sample.fetches else f"{'-':>9}"
        share = f"{sample.fraction:7.0%}" if sample.fraction is not None else f"{'-':>7}"
        return f"{self.milliseconds(sample):9.1f}{count}{share}"


def points(base: Point, factors: dict[str, tuple[int, ...]]) -> list[Point]:
    """Return all tasks, each once; those of one volume follow each other."""
    found = {replace(base, **{factor: value}) for factor, values in factors.items() for value in values}
    return sorted(found, key=lambda p: (p.volume, p.viewport, p.slices, p.lights))


def measure_growth(
    base: Point = BASE,
    factors: dict[str, tuple[int, ...]] = FACTORS,
    tell: Callable[[str], None] = lambda text: None,
    techniques: tuple[str, ...] = TECHNIQUES,
) -> Growth:
    """Measure ceilings and all points.

    Raises
    ------
    GpuError
        If there is no device to draw on.
    """
    began = time.perf_counter()
    renderer, counter = sfumato.Renderer(), FetchCounter()
    try:
        found = machine.describe(renderer.name, renderer.version)
        clock = "cpu" if found["software_renderer"] else "wall"
        tell("ceilings")
        ceilings = fetch_ceilings(renderer, clock)
        samples = []
        for point in points(base, factors):
            tell(str(point))
            samples += [_sample(point, t, renderer, counter, clock, ceilings) for t in techniques]
        tell("")
        return Growth(found, clock, base, factors, ceilings, techniques, samples, time.perf_counter() - began)
    finally:
        counter.close()
        renderer.close()


def _contender(renderer: sfumato.Renderer, setting: Setting, technique: str) -> Ours:
    if technique == "raycast":
        return Ours(renderer, setting, technique)
    return MovingLight(renderer, setting, technique, "rotation")


def _sample(
    point: Point,
    technique: str,
    renderer: sfumato.Renderer,
    counter: FetchCounter,
    clock: str,
    ceilings: dict[str, float],
) -> Sample:
    try:
        small = replace(point, viewport=min(point.viewport, WARM_UP))
        _contender(renderer, small.setting, technique).draw()
        contender = _contender(renderer, point.setting, technique)
        times = _times(contender)
        counts = _counts(counter, point, technique)
    except (Unavailable, sfumato.SfumatoError) as error:
        return Sample(point, technique, missing=str(error))
    cpu, wall = (statistics.median(column) for column in zip(*times, strict=True))
    seconds = cpu if clock == "cpu" else wall
    fraction = seconds_at_ceiling(counts, ceilings) / max(seconds, 1e-9) if counts else None
    return Sample(point, technique, cpu * 1000, wall * 1000, counts, fraction)


def _times(contender: Ours) -> list[tuple[float, float]]:
    """Return processor and wall seconds of some frames."""
    times = [_timed(contender)]
    while len(times) < FRAMES and times[0][1] < SLOW_SECONDS:
        times.append(_timed(contender))
    return times


def _timed(contender: Ours) -> tuple[float, float]:
    cpu, wall = time.process_time(), time.perf_counter()
    contender.draw()
    return time.process_time() - cpu, time.perf_counter() - wall


def _counts(counter: FetchCounter, point: Point, technique: str) -> dict[str, int]:
    if counter.renderer is None:
        return {}
    contender = _contender(counter.renderer, point.setting, technique)
    counter.begin()
    contender.draw()
    return counter.counts()


def save_growth_plot(growth: Growth, path: Path) -> None:
    """Write one panel a factor; ImportError without matplotlib."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 7), layout="constrained")
    for axes, (factor, values) in zip(figure.subplots(2, 2).flat, growth.factors.items(), strict=False):
        for technique in growth.techniques:
            shown = [(v, s) for v in values if not (s := growth.of(factor, v, technique)).missing]
            axes.plot(
                [v for v, _ in shown], [growth.milliseconds(s) for _, s in shown], "o-", label=technique
            )
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xticks(values, [str(v) for v in values])
        axes.set_xlabel(
            {"volume": "voxels along a side", "viewport": "pixels along a side"}.get(factor, factor)
        )
        axes.set_ylabel(f"{'CPU' if growth.clock == 'cpu' else 'wall'} ms a frame")
        axes.grid(True, alpha=0.3)
    figure.axes[0].legend()
    m = growth.machine
    figure.suptitle(f"{m['cpu']}, {m['cores']} cores; {m['gl_renderer']}; {m['date'][:10]}", fontsize=9)
    figure.savefig(path, dpi=120)
