"""The gallery's command line."""

from __future__ import annotations

import time
from collections.abc import Sequence
from datetime import date
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, Parameter

from sfumato import Renderer, SfumatoError

from ..errors import UsageError
from .figure import Figure, file_name
from .figures import FIGURES
from .help import draw_help
from .hero import draw_hero
from .page import write_page
from .sheet import draw_figure, save

FOLDER = Path("docs/gallery")
HERO = "hero.png"

_program = App(
    name="sfumato gallery",
    help="Draw the papers' figures with our samples, and the page that shows them.",
    help_format="plaintext",
    result_action="return_value",
)


def chosen(only: str) -> tuple[int | str, ...]:
    """Return the figures asked for, in the papers' order; all, if none is named.

    Raises
    ------
    UsageError
        If one of them is not among the figures.
    """
    words = only.replace(",", " ").split()
    unknown = [word for word in words if word not in map(str, FIGURES)]
    if unknown:
        raise UsageError(
            f"--only {only}: there is no figure {unknown[0]}; known: {', '.join(map(str, FIGURES))}"
        )
    return tuple(figure for figure in FIGURES if not words or str(figure) in words)


@_program.default
def _command(
    *,
    output: Annotated[
        Path,
        Parameter(name=["--output", "-o"], help="Folder of the pictures; the page lies beside it."),
    ] = FOLDER,
    only: Annotated[
        str, Parameter(help="Figures, as in 1,8,schlegel2011-9; the page is written once all are there.")
    ] = "",
    help_pictures: Annotated[
        bool, Parameter(negative="", help="Draw the pictures of the window's tooltips instead.")
    ] = False,
    hero: Annotated[bool, Parameter(negative="", help="Draw the README's picture instead.")] = False,
    scale: Annotated[float, Parameter(help="Of the pictures' sides.")] = 1.0,
    frames: Annotated[int | None, Parameter(help="Jittered frames of each panel.")] = None,
) -> int:
    if not 0.05 <= scale <= 4 or not (frames is None or 1 <= frames <= 256):
        raise UsageError("--scale 0.05 to 4 and --frames 1 to 256 are possible")
    if help_pictures:
        for key in draw_help(only=only):
            print(key, flush=True)
        return 0
    if hero:
        return _draw_hero(output.parent / HERO, scale, frames)
    numbers = chosen(only)
    _make_folder(output)
    for number in numbers:
        _draw(FIGURES[number](), output, scale, frames)
    if all((output / file_name(number)).exists() for number in FIGURES):
        page = output.with_suffix(".md")
        figures = [figure() for figure in FIGURES.values()]
        write_page(page, {f: output / f.file_name for f in figures}, renderer_name(), date.today())
        print(page)
    return 0


def _draw(figure: Figure, folder: Path, scale: float, frames: int | None) -> None:
    began = time.perf_counter()
    path = folder / figure.file_name
    size = save(draw_figure(figure, scale, frames), path)
    print(f"{path}: {size / 1024:.0f} KiB, {time.perf_counter() - began:.0f} s", flush=True)


def _draw_hero(path: Path, scale: float, frames: int | None) -> int:
    _make_folder(path.parent)
    began = time.perf_counter()
    size = save(draw_hero(scale, frames), path)
    print(f"{path}: {size / 1024:.0f} KiB, {time.perf_counter() - began:.0f} s")
    return 0


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SfumatoError(f"{folder}: the folder could not be made: {error.strerror or error}") from None


def renderer_name() -> str:
    """Return the name of the graphics device, as OpenGL gives it."""
    renderer = Renderer()
    try:
        return renderer.name
    finally:
        renderer.close()


def main(arguments: Sequence[str]) -> int:
    """Run the command and return its exit status."""
    status: Any = _program(list(arguments), exit_on_error=False, print_error=False)
    return status if isinstance(status, int) else 0
