"""The page about accuracy, in Markdown."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from sfumato import SfumatoError

from .measure import COPY_SCALE, Result
from .plot import save_plot
from .report import Report, goals
from .sheet import draw_sheet
from .trials import Trial
from .truth import BORDER, Truth

SHEET, PLOT, DATA = "sheet.png", "cost.png", "numbers.json"
_HEAD = """# Accuracy of the shadows

Drawn by `{command}` on {day} with {renderer} ({cpu}, {cores} cores).

Each scene stands before a plain pale wall, or on a floor. The truth is the ray-traced cone integral in float64,
{directions} directions a lamp, {side} × {side} pixels. *Brightness* is the wall's luminance over that of the same wall
with nothing before it: 1 is unshadowed. Errors are root mean squares of the difference in brightness over all pixels
whose first opaque thing is the wall, {border} voxels and more away from its borders.

![Truth, techniques and their errors]({folder}/{sheet})

The pictures show {most} accumulated frames. Maps: blue is too dark, red too bright, grey is not bare wall.

## Error
"""
_COPIES = """
## Copies of shadows

Detail of the difference over the detail of the truth, detail being what a Gaussian blur of {scale:g} % of the
picture's side takes away. Edges within a smooth penumbra, as the copies are that a few directions leave, count here.
Exact rays along 8, 16 and 64 directions instead of a cone have 4.4, 2.8 and 1.0 in `shapes`, 0.9, 0.5 and 0.1 in
`hand`.

"""
_SLICES = """
## Slices

Largest mean difference of the shadows (brightness over that of the wall alone, cut alike) between {numbers} slices (at
most 20 a voxel), in 1/255.

"""
_COST = """
## Error over cost

CPU time of all threads, a first frame with the lamp just moved, {side} × {side} pixels.

![Error over cost]({folder}/{plot})

All numbers: [{data}]({folder}/{data}).
"""
_SCENES = """
## Scenes

| scene | data | tilt/aperture | view | bare wall | mean brightness | CPU time of the truth |
|---|---|---|---|---|---|---|
"""


def page(report: Report, folder: str, command: str) -> str:
    """Return the page's text.

    Parameters
    ----------
    folder : str
        Where pictures and numbers lie, as seen from the page.
    command : str
        That draws it.
    """
    m, frames = report.machine, sorted({n for _, n in report.rows})
    fields = {
        "command": command, "day": m["date"][:10], "renderer": m["gl_renderer"], "cpu": m["cpu"], "cores": m["cores"],
        "directions": report.directions, "side": report.side, "border": f"{BORDER:g}", "folder": folder, "sheet": SHEET,
        "plot": PLOT, "data": DATA, "most": frames[-1], "scale": COPY_SCALE * 100,
    }  # fmt: skip
    parts = [_HEAD.format(**fields), "\n", *_table(report, "rmse"), *_goals(report)]
    parts += [_COPIES.format(**fields), *_table(report, "copies")]
    cut = [r for r in report.results if r.slices_spread is not None]
    if cut:
        numbers = ", ".join(map(str, cut[0].slices))
        parts += [_SLICES.format(numbers=numbers), *_table(report, "slices")]
    parts += [_COST.format(**fields), _SCENES]
    parts += [_scene(t, truth) for t, truth in zip(report.trials, report.truths, strict=True)]
    return "".join(parts)


def _table(report: Report, what: str) -> list[str]:
    heads = [
        "technique",
        "quality",
        "frames",
        *(t.id for t in report.trials),
        "mean",
        "worst",
        "CPU ms a frame",
    ]
    lines = [_row(heads), "|" + "---|" * len(heads) + "\n"]
    for contestant, n in report.rows:
        mine = {r.trial.id: r for r in report.of(contestant)}
        numbers = [_number(mine[t.id], n, what) if t.id in mine else None for t in report.trials]
        known = [x for x in numbers if x is not None]
        cells = ["–" if x is None else f"{x:.3f}" for x in (*numbers, np.mean(known), max(known))]
        cpu = np.mean([r.cpu for r in mine.values()])
        lines.append(_row([f"`{contestant.id}`", contestant.quality_name, str(n), *cells, f"{cpu:.0f}"]))
    return lines


def _number(result: Result, frames: int, what: str) -> float:
    if what == "slices":
        return (result.slices_spread or 0.0) * 255
    return float(getattr(result.errors[frames], what))


def _row(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |\n"


def _goals(report: Report) -> list[str]:
    return ["\n", *(f"- {'met' if met else '**missed**'}: {text}\n" for text, met in goals(report))]


def _scene(trial: Trial, truth: Truth) -> str:
    view = "perspective" if trial.placing.perspective else "orthographic"
    view += ", on a floor" if trial.placing.elevation is not None else ""
    share, mean = truth.mask.mean(), truth.shadow[truth.mask].mean()
    cells = [
        trial.id,
        f"`{trial.source}`",
        trial.angles,
        view,
        f"{share:.0%}",
        f"{mean:.2f}",
        f"{truth.seconds:.0f} s",
    ]
    return _row(cells)


def write(report: Report, folder: Path, command: str) -> Path:
    """Write pictures, plot and numbers to a folder and the page beside it; return the page's path.

    Raises
    ------
    SfumatoError
        If something cannot be written.
    """
    target = folder.with_suffix(".md")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        draw_sheet(report).save(folder / SHEET, optimize=True)
        (folder / DATA).write_text(json.dumps(report.to_json(), indent=1) + "\n", encoding="utf-8")
        target.write_text(page(report, folder.name, command), encoding="utf-8")
        save_plot(report, folder / PLOT)
    except OSError as error:
        raise SfumatoError(f"{folder}: could not be written: {error.strerror or error}") from None
    except ImportError:
        raise SfumatoError("the plot needs matplotlib; the page is written without it") from None
    return target
