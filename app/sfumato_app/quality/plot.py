"""The plot of error over cost."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .report import OURS, PUBLISHED, Report

_COLORS = {OURS: "#c8643c", PUBLISHED: "#7a8794"}
_OTHER = "#5b8c5a"


def save_plot(report: Report, path: Path) -> None:
    """Write the plot in the format that the file's name asks for; ImportError without matplotlib."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 5), layout="constrained")
    axes = figure.subplots()
    for contestant in dict.fromkeys(contestant for contestant, _ in report.rows):
        results = report.of(contestant)
        frames = sorted(results[0].errors)
        errors = [[r.errors[n].rmse for r in results] for n in frames]
        mean, worst = np.mean(errors, axis=1), np.max(errors, axis=1)
        cost = np.mean([r.cpu for r in results]) * np.array(frames)
        color = _COLORS.get(contestant.technique, _OTHER)
        label = f"{contestant.id}, {contestant.quality_name}"
        axes.errorbar(cost, mean, yerr=[0 * mean, worst - mean], color=color, marker="o", capsize=3)
        axes.annotate(label, (cost[0], mean[0]), (5, 5), textcoords="offset points", fontsize=8, color=color)
    axes.set_xscale("log")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("CPU ms of a picture (points: " + _and([str(n) for n in frames]) + " frames)")
    axes.set_ylabel("RMSE of brightness (mean of the scenes; bar: worst)")
    m = report.machine
    axes.set_title(
        f"{report.side} x {report.side} pixels; {m['cpu']}; {m['gl_renderer']}; {m['date'][:10]}", fontsize=8
    )
    figure.savefig(path, dpi=120)


def _and(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else words[0]
