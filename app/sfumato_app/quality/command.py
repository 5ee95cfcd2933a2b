"""``sfumato quality``: options, and the way from them to a report."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, Parameter
from rich.console import Console

from sfumato import Renderer, SfumatoError

from ..bench.machine import describe
from ..errors import UsageError
from .contestants import Contestant, contestants
from .measure import Result, measured
from .page import write
from .report import Report
from .trials import TRIALS, Trial
from .truth import DIRECTIONS, default_folder, truth

SIDE = 128
#: Numbers of slices between which a picture should not change.
SLICES = (128, 256, 512, 1024)

_program = App(
    name="sfumato quality",
    help="Measure how near shadows are to the ray-traced cone, on plain walls behind our samples and real data.",
    help_format="plaintext",
    result_action="return_value",
)


@_program.default
def _command(
    *,
    scenes: Annotated[
        str, Parameter(help=f"Of {', '.join(TRIALS)}; all that are here, if none is named.")
    ] = "",
    techniques: Annotated[
        str, Parameter(help="As in cone,cone:directions=16,multidirectional (parameters after colons).")
    ] = "",
    frames: Annotated[str, Parameter(help="Numbers of accumulated frames.")] = "1,16",
    quality: Annotated[
        str, Parameter(help="full, drag, or fields as in step=2:light=2; several by commas.")
    ] = "full",
    slices: Annotated[bool, Parameter(negative="", help="Also compare 128 to 1024 slices (slow).")] = False,
    side: Annotated[int, Parameter(help="Of the square pictures, in pixels.")] = SIDE,
    directions: Annotated[int, Parameter(help="Of the truth, in each cone.")] = DIRECTIONS,
    cache: Annotated[Path | None, Parameter(help="Folder in which truths are kept.")] = None,
    json_: Annotated[Path | None, Parameter(name="--json", help="Write all numbers.")] = None,
    output: Annotated[
        Path | None,
        Parameter(
            name=["--output", "-o"],
            help="Folder of pictures, plot and numbers, as docs/accuracy; the page lies beside it.",
        ),
    ] = None,
) -> int:
    if not (16 <= side <= 1024 and 1 <= directions <= 4096):
        raise UsageError("--side 16 to 1024 and --directions 1 to 4096 are possible")
    report = measure(
        chosen(scenes),
        contestants(techniques, quality),
        _numbers("--frames", frames),
        SLICES if slices else (),
        side,
        directions,
        cache or default_folder(),
    )
    report.show(_console())
    if json_ is not None:
        _write(json_, json.dumps(report.to_json(), indent=1) + "\n")
    if output is not None:
        given = {"--scenes": scenes, "--techniques": techniques, "--frames": frames, "--quality": quality}
        words = [f"{name} {value}" for name, value in given.items() if value]
        print(
            write(
                report, output, " ".join(["sfumato quality", *words, *["--slices"] * slices, f"-o {output}"])
            )
        )
    return 0


def measure(
    trials: Sequence[Trial],
    lineup: Sequence[Contestant],
    frames: Sequence[int],
    slices: Sequence[int],
    side: int,
    directions: int,
    cache: Path,
) -> Report:
    """Measure contestants in scenes.

    Raises
    ------
    GpuError
        If there is no device to draw on.
    """
    truths = [truth(trial, side, cache, directions, _tell) for trial in trials]
    renderer, results = Renderer(), list[Result]()
    try:
        machine = describe(renderer.name, renderer.version)
        for trial, true in zip(trials, truths, strict=True):
            for contestant in lineup:
                if contestant.takes_part(trial):
                    _tell(f"{trial.id}: {contestant.id}, {contestant.quality_name}")
                    results.append(measured(renderer, trial, contestant, true, frames, slices))
    finally:
        renderer.close()
        _tell("")
    return Report(machine, side, directions, trials, truths, results)


def chosen(names: str) -> tuple[Trial, ...]:
    """Return the scenes asked for; if none is named, all whose data are here.

    Raises
    ------
    UsageError
        If there is no such scene.
    """
    words = names.replace(",", " ").split()
    unknown = [word for word in words if word not in TRIALS]
    if unknown:
        raise UsageError(f"--scenes: there is no {unknown[0]}; known: {', '.join(TRIALS)}")
    if words:
        return tuple(TRIALS[word] for word in words)
    return tuple(trial for trial in TRIALS.values() if trial.available)


def _numbers(option: str, text: str) -> tuple[int, ...]:
    words = text.replace(",", " ").split()
    if not words or not all(word.isdecimal() and 1 <= int(word) <= 1024 for word in words):
        raise UsageError(f"{option} {text}: whole numbers from 1 to 1024 are needed")
    return tuple(sorted({int(word) for word in words}))


def _console() -> Console:
    """Return a console that does not squeeze what goes to a file or a pipe."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=200)


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise SfumatoError(f"{path}: could not be written: {error.strerror or error}") from None


def _tell(text: str) -> None:
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def main(arguments: Sequence[str]) -> int:
    """Run the command and return its exit status."""
    status: Any = _program(list(arguments), exit_on_error=False, print_error=False)
    return status if isinstance(status, int) else 0
