"""What the measurement tells: tables, goals and JSON."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from .contestants import Contestant
from .measure import Result
from .trials import Trial
from .truth import Truth

FORMAT_VERSION = 1
#: Ours and the published technique, between which the goals are set.
OURS, PUBLISHED = "cone", "multidirectional"
MEAN_ONE, MEAN_STILL, WORST, SHARE, UNCHANGED = 0.04, 0.03, 0.05, 0.5, 1 / 255
#: What the truth's own detail is: more that it has not, and copies of shadows are seen.
COPIES = 1.0


@dataclass(frozen=True)
class Report:
    """Everything that was found out."""

    machine: dict[str, Any]
    side: int
    directions: int
    trials: Sequence[Trial]
    truths: Sequence[Truth]
    results: Sequence[Result]

    @property
    def rows(self) -> list[tuple[Contestant, int]]:
        """Contestants and numbers of frames, in the order of measuring."""
        found = {(id(r.contestant), n): (r.contestant, n) for r in self.results for n in r.errors}
        return list(found.values())

    def of(self, contestant: Contestant) -> list[Result]:
        """Return the results of a contestant."""
        return [r for r in self.results if r.contestant is contestant]

    def to_json(self) -> dict[str, Any]:
        """Return the report as JSON data."""
        return {
            "sfumato_quality": FORMAT_VERSION,
            "machine": self.machine,
            "side": self.side,
            "directions": self.directions,
            "scenes": [_scene(t, truth) for t, truth in zip(self.trials, self.truths, strict=True)],
            "results": [_result(r) for r in self.results],
            "goals": [{"goal": text, "met": met} for text, met in goals(self)],
        }

    def show(self, console: Console) -> None:
        """Print tables and goals."""
        console.print(f"brightness on bare wall against the ray-traced cone ({self.directions} directions), "
                      f"{self.side} x {self.side} pixels; unshadowed = 1")  # fmt: skip
        console.print(self._table("RMSE", lambda r, n: r.errors[n].rmse, "{:.3f}"))
        console.print(self._table("copies", lambda r, n: r.errors[n].copies, "{:.2f}"))
        if any(r.slices_spread is not None for r in self.results):
            console.print(self._table("slices", lambda r, n: (r.slices_spread or 0.0) * 255, "{:.2f}"))
            console.print(self._table("skin", lambda r, n: (r.skin_spread or 0.0) * 255, "{:.2f}"))
        for text, met in goals(self):
            console.print(("met    " if met else "missed ") + text)

    def _table(self, title: str, value: Callable[[Result, int], float], form: str) -> Table:
        table = Table(title=_TITLES[title], title_justify="left", box=None, pad_edge=False)
        for head in ("technique", "quality", "frames"):
            table.add_column(head)
        for head in (*(f"{t.id}\n{t.angles}" for t in self.trials), "mean", "worst", "CPU ms\na frame"):
            table.add_column(head, justify="right")
        for contestant, n in self.rows:
            mine = {r.trial.id: r for r in self.of(contestant)}
            numbers = [value(mine[t.id], n) if t.id in mine else None for t in self.trials]
            known = [x for x in numbers if x is not None]
            cpu = float(np.mean([r.cpu for r in mine.values()]))
            cells = ["-" if x is None else form.format(x) for x in numbers]
            ends = [form.format(np.mean(known)), form.format(max(known)), f"{cpu:.0f}"]
            table.add_row(contestant.id, contestant.quality_name, str(n), *cells, *ends)
        return table


_TITLES = {
    "RMSE": "Error of the brightness (RMSE)",
    "copies": "Detail that the truth has not, over the truth's (copies of shadows)",
    "slices": "Largest mean difference of the shadows between numbers of slices, in 1/255",
    "skin": "The same of the brightness itself, in 1/255",
}


def goals(report: Report) -> list[tuple[str, bool]]:
    """Return what was wished of our technique and whether it is so; empty if it was not measured."""
    found = []
    for contestant, n in report.rows:
        if contestant.technique != OURS:
            continue
        errors = {r.trial.id: r.errors[n].rmse for r in report.of(contestant)}
        mean, worst, limit = np.mean(list(errors.values())), max(errors.values()), _limit(n)
        name = f"{contestant.id} ({contestant.quality_name}, {n} frames):"
        found.append((f"{name} mean {mean:.3f} <= {limit:g}", bool(mean <= limit)))
        found.append((f"{name} worst {worst:.3f} <= {WORST:g}", bool(worst <= WORST)))
        shares = [e / p for key, e in errors.items() if (p := _published(report, key, n)) is not None]
        if shares:
            text = f"{name} at most {max(shares):.2f} of the published error <= {SHARE:g}"
            found.append((text, max(shares) <= SHARE))
        seen = max(r.errors[n].copies for r in report.of(contestant))
        found.append((f"{name} copies {seen:.2f} <= {COPIES:g}", seen <= COPIES))
        spreads = [r.slices_spread for r in report.of(contestant) if r.slices_spread is not None]
        if spreads and n == min(frames for _, frames in report.rows):
            text = f"{name} between numbers of slices {max(spreads) * 255:.2f}/255 <= 1/255"
            found.append((text, max(spreads) <= UNCHANGED))
    return found


def _limit(frames: int) -> float:
    return MEAN_ONE if frames == 1 else MEAN_STILL


def _published(report: Report, trial: str, frames: int) -> float | None:
    """Return the published technique's smallest error in a scene after so many frames."""
    errors = [
        r.errors[frames].rmse
        for r in report.results
        if r.contestant.technique == PUBLISHED and r.trial.id == trial and frames in r.errors
    ]
    return min(errors) if errors else None


def _scene(trial: Trial, truth: Truth) -> dict[str, Any]:
    return {
        "id": trial.id,
        "source": trial.source,
        "lights": [{"tilt": lamp.tilt, "aperture": lamp.aperture} for lamp in trial.lights],
        "perspective": trial.placing.perspective,
        "floor": trial.placing.elevation is not None,
        "wall_pixels": int(truth.mask.sum()),
        "mean_brightness": float(truth.shadow[truth.mask].mean()),
        "truth_cpu_s": truth.seconds,
    }


def _result(result: Result) -> dict[str, Any]:
    return {
        "scene": result.trial.id,
        "technique": result.contestant.technique,
        "parameters": result.contestant.changes,
        "quality": asdict(result.contestant.quality),
        "cpu_ms_a_frame": result.cpu,
        "errors": {str(n): asdict(e) for n, e in result.errors.items()},
        "slices": {str(n): d for n, d in result.slices.items()},
        "slices_spread": result.slices_spread,
        "skin_spread": result.skin_spread,
    }
