"""Truth, the published technique and ours side by side, each with a map of its error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from cmap import Colormap
from PIL import Image, ImageDraw, ImageFont

from .measure import Result
from .report import OURS, PUBLISHED, Report
from .trials import Trial
from .truth import Truth

#: Perceptually uniform, dark and light alike far from nothing; blue is too dark, red too light.
MAP = "crameri:vik"
#: Brightness at the map's ends.
REACH = 0.3
CELL, GAP, HEAD, LEFT, LEGEND = 190, 4, 24, 96, 46
SHEET, INK, ELSEWHERE = (255, 255, 255), (40, 40, 44), (96, 96, 98)


def draw_sheet(report: Report) -> Image.Image:
    """Draw a row for each scene; columns: truth, then picture and error map of each technique shown."""
    shown = [c for name in (PUBLISHED, OURS) if (c := _first(report, name)) is not None]
    heads = ["truth", *(text for name, _ in shown for text in (name, "its error"))]
    width = LEFT + len(heads) * (CELL + GAP)
    sheet = Image.new("RGB", (width, HEAD + len(report.trials) * (CELL + GAP) + LEGEND), SHEET)
    pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(14)
    for column, text in enumerate(heads):
        pen.text((LEFT + column * (CELL + GAP) + CELL / 2, HEAD / 2), text, INK, font, "mm")
    for row, (trial, truth) in enumerate(zip(report.trials, report.truths, strict=True)):
        top = HEAD + row * (CELL + GAP)
        pen.text((LEFT - 8, top + CELL / 2), f"{trial.id}\n{trial.angles}", INK, font, "rm", align="right")
        for column, cell in enumerate(_cells(trial, truth, [results for _, results in shown])):
            if cell is not None:
                sheet.paste(cell, (LEFT + column * (CELL + GAP), top))
    _legend(pen, font, (LEFT, sheet.height - LEGEND + 12), width - LEFT - GAP)
    return sheet


def _first(report: Report, technique: str) -> tuple[str, Sequence[Result]] | None:
    """Return the name and results of a technique as it was asked for first."""
    for contestant, _ in report.rows:
        if contestant.technique == technique:
            return contestant.id, report.of(contestant)
    return None


def _cells(trial: Trial, truth: Truth, shown: Sequence[Sequence[Result]]) -> list[Image.Image | None]:
    cells: list[Image.Image | None] = [_picture(truth.picture)]
    for results in shown:
        result = next((r for r in results if r.trial is trial), None)
        if result is None:
            cells += [None, None]
            continue
        picture = result.pictures[max(result.pictures)]
        cells += [_picture(picture), _map(truth.brightness(picture) - truth.shadow, truth.mask)]
    return cells


def _picture(linear: np.ndarray) -> Image.Image:
    light = np.clip(linear[..., :3], 0, 1)
    encoded = np.where(
        light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
    )
    return Image.fromarray(np.rint(encoded * 255).astype(np.uint8)).resize(
        (CELL, CELL), Image.Resampling.BICUBIC
    )


def _map(difference: np.ndarray, mask: np.ndarray) -> Image.Image:
    colors = np.asarray(Colormap(MAP)(np.clip(0.5 + difference / (2 * REACH), 0, 1)))[..., :3] * 255
    colors[~mask] = ELSEWHERE
    return Image.fromarray(np.rint(colors).astype(np.uint8)).resize((CELL, CELL), Image.Resampling.NEAREST)


def _legend(pen: ImageDraw.ImageDraw, font: object, at: tuple[int, int], width: int) -> None:
    bar = min(420, width)
    colors = np.rint(np.asarray(Colormap(MAP)(np.linspace(0, 1, bar)))[:, :3] * 255).astype(int)
    for k, color in enumerate(colors):
        pen.line([(at[0] + k, at[1]), (at[0] + k, at[1] + 12)], tuple(int(c) for c in color))
    texts = ((0.0, f"-{REACH:g} too dark"), (0.5, "0"), (1.0, f"too bright {REACH:g}"))
    for (share, text), anchor in zip(texts, ("la", "ma", "ra"), strict=True):
        pen.text((at[0] + share * bar, at[1] + 15), text, INK, font, anchor)  # type: ignore[arg-type]
    if width > bar + 160:
        pen.text((at[0] + bar + 16, at[1] + 6), "grey: not bare wall", INK, font, "lm")  # type: ignore[arg-type]
