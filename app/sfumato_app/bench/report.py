"""What the benchmark tells: a table, JSON, and the pictures that were drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .measure import Result, Spread
from .ratios import Outcome
from .setting import Setting

FORMAT_VERSION = 1


@dataclass(frozen=True)
class Report:
    """Everything that was found out.

    Attributes
    ----------
    clock : str
        ``cpu`` (software renderers) or ``wall`` (GPUs): the time by which goals are judged.
    """

    machine: dict[str, Any]
    setting: Setting
    rounds: int
    clock: str
    results: Sequence[Result]
    outcomes: Sequence[Outcome]
    peer_device: str

    def to_json(self) -> dict[str, Any]:
        """Return the report as JSON data, with every single measurement."""
        return {
            "sfumato_bench": FORMAT_VERSION,
            "machine": self.machine,
            "peer_gl_renderer": self.peer_device,
            "setting": self.setting.to_json(),
            "rounds": self.rounds,
            "clock": self.clock,
            "rows": [self._row(result) for result in self.results],
            "ratios": [_ratio(outcome) for outcome in self.outcomes],
        }

    def _row(self, result: Result) -> dict[str, Any]:
        row = result.row
        head: dict[str, Any] = {"id": row.id, "label": row.label, "peer": row.peer, "missing": result.missing}
        if result.missing:
            return head
        return {
            **head,
            "setting": row.setting.to_json(),
            "frames_a_turn": result.frames,
            "cpu_ms": {**asdict(Spread.of(result.cpu)), "all": result.cpu},
            "wall_ms": {**asdict(Spread.of(result.wall)), "all": result.wall},
            "psnr_to_raycast_db": psnr(result, self.results, "raycast"),
        }

    def text(self) -> str:
        """Return the report as a table for people."""
        return "\n".join([*self._head(), "", *self._rows(), "", *self._ratios()])

    def _head(self) -> list[str]:
        m = self.machine
        load = " ".join(map(str, m["load_average"])) if m["load_average"] else "unknown"
        packages = ", ".join(f"{name} {version}" for name, version in m["packages"].items() if version)
        lines = [
            f"sfumato bench, {m['date']}",
            f"machine   {m['cpu']}, {m['cores']} cores, {m['system']}, load {load}",
            f"graphics  {m['gl_renderer']}, OpenGL {m['gl_version']}",
            f"software  Python {m['python']}, {packages}",
            f"task      {self.setting}",
            f"runs      {self.rounds} interleaved rounds; median [quartiles]; goals: {_CLOCKS[self.clock]}",
        ]
        if self.peer_device and self.peer_device != m["gl_renderer"]:
            lines.insert(3, f"NOTE      VTK drew on another device: {self.peer_device}")
        return lines

    def _rows(self) -> list[str]:
        lines = [f"{'':27}{'CPU ms a frame':>28}{'wall ms a frame':>28}"]
        for result in self.results:
            if result.missing:
                lines.append(f"{result.row.id:27}  left out: {result.missing}")
            else:
                cpu, wall = _spread(Spread.of(result.cpu), 1), _spread(Spread.of(result.wall), 1)
                lines.append(f"{result.row.id:27}{cpu:>28}{wall:>28}")
        return lines

    def _ratios(self) -> list[str]:
        if not self.outcomes:
            return ["no ratios: they need more of the rows"]
        lines = [f"{'':47}{'CPU':>22}{'wall':>22}  {'goal':14}"]
        for outcome in self.outcomes:
            goal = str(outcome.ratio.goal or "")
            cpu, wall = _spread(outcome.cpu, 3), _spread(outcome.wall, 3)
            lines.append(f"{outcome.ratio.id:47}{cpu:>22}{wall:>22}  {goal:14}{outcome.verdict}")
        return lines


_CLOCKS = {"cpu": "CPU time of all threads", "wall": "wall time"}


def _spread(spread: Spread, digits: int) -> str:
    return f"{spread.median:.{digits}f} [{spread.q1:.{digits}f} {spread.q3:.{digits}f}]"


def _ratio(outcome: Outcome) -> dict[str, Any]:
    ratio, goal = outcome.ratio, outcome.ratio.goal
    limit = None if goal is None else {"limit": goal.limit, "at_least": goal.at_least, "gpu_only": goal.gpu}
    return {
        "id": ratio.id,
        "label": ratio.label,
        "above": ratio.above,
        "below": ratio.below,
        "goal": limit,
        "verdict": outcome.verdict,
        "cpu": asdict(outcome.cpu),
        "wall": asdict(outcome.wall),
    }


def psnr(result: Result, results: Sequence[Result], reference: str) -> float | None:
    """Return how far a row's picture agrees with another's, in dB on linear light; None for the same picture.

    Between unlit rows this shows that volume, view and transfer function are the same; lit rows differ by
    their light, which is what they are for.
    """
    other = next((r.picture for r in results if r.row.id == reference), None)
    if result.picture is None or other is None or result.picture.shape != other.shape:
        return None
    error = float(np.mean((result.picture - other) ** 2))
    return None if error == 0 else float(-10 * np.log10(error))


def save_pictures(results: Sequence[Result], folder: Path) -> None:
    """Write each row's picture as ``<id>.png``, sRGB."""
    from PIL import Image

    folder.mkdir(parents=True, exist_ok=True)
    for result in results:
        if result.picture is not None:
            Image.fromarray(_srgb(result.picture)).save(folder / f"{result.row.id}.png")


def _srgb(light: np.ndarray) -> np.ndarray:
    """Encode linear light in [0, 1] as sRGB bytes (IEC 61966-2-1)."""
    curve = 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
    encoded = np.where(light <= 0.0031308, 12.92 * light, curve)
    return np.asarray(np.rint(encoded * 255), dtype=np.uint8)
