"""The benchmark's plot: times of all rows, and the ratios with their goals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .measure import Spread
from .report import Report

_OURS, _PEER, _GOAL = "#c8643c", "#7a8794", "#222222"


def save_plot(report: Report, path: Path) -> None:
    """Write the plot in the format that the file's name asks for; ImportError without matplotlib."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    measured = sum(not result.missing for result in report.results)
    figure = Figure(figsize=(11, 2.2 + 0.32 * (measured + len(report.outcomes))), layout="constrained")
    times, ratios = figure.subplots(2, 1, height_ratios=[max(measured, 1), max(len(report.outcomes), 1)])
    _plot_times(times, report)
    _plot_ratios(ratios, report)
    m = report.machine
    where = f"{m['cpu']}, {m['cores']} cores; {m['gl_renderer']}; {m['date'][:10]}"
    figure.suptitle(f"{report.setting}\n{where}", fontsize=9)
    figure.savefig(path, dpi=120)


def _plot_times(axes: Any, report: Report) -> None:
    for result in report.results:
        if not result.missing:
            color = _PEER if result.row.peer else _OURS
            _bar(axes, result.row.id, Spread.of(getattr(result, report.clock)), color, "{:.0f}")
    axes.set_xscale("log")
    axes.set_xlabel(f"{'CPU' if report.clock == 'cpu' else 'wall'} ms a frame (median, quartiles)")
    axes.invert_yaxis()


def _plot_ratios(axes: Any, report: Report) -> None:
    for place, outcome in enumerate(report.outcomes):
        spread = getattr(outcome, report.clock)
        _bar(axes, outcome.ratio.id, spread, _OURS if outcome.verdict != "short" else _PEER, "{:.2f}")
        if outcome.ratio.goal is not None:
            axes.plot([outcome.ratio.goal.limit] * 2, [place - 0.45, place + 0.45], color=_GOAL, linewidth=2)
    axes.set_xscale("log")
    axes.set_xlabel("ratio (line: goal)")
    axes.invert_yaxis()


def _bar(axes: Any, name: str, spread: Spread, color: str, form: str) -> None:
    reach = [[spread.median - spread.q1], [spread.q3 - spread.median]]
    bars = axes.barh([name], [spread.median], xerr=reach, color=color, capsize=2)
    axes.bar_label(bars, [form.format(spread.median)], padding=4, fontsize=8)
