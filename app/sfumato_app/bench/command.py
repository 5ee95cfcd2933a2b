"""``sfumato bench``: options, and the way from them to a report."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import sfumato

from . import machine
from .blocks import measure_blocks
from .drag import measure_drag
from .growth import BASE, FACTORS, QUICK_BASE, QUICK_FACTORS, measure_growth, save_growth_plot
from .measure import run, warm_up
from .plot import save_plot
from .ratios import outcomes
from .report import Report, save_pictures
from .rows import Row, Stage, rows, tube_rows
from .setting import Setting
from .tracts import LINES, measure_tracts

#: What ``--quick`` asks for in place of the defaults.
QUICK = {"rounds": 3, "size": 128, "viewport": 256}
DEFAULTS = {"rounds": 7, "size": 256, "viewport": 512}


def main(argv: Sequence[str]) -> int:
    """Run the benchmark.

    Parameters
    ----------
    argv : sequence of str
        Options, without the program's name.

    Returns
    -------
    int
        Exit status: 0 done, whether goals were met or not; 1 no device, or a file that cannot be written;
        2 wrong usage.
    """
    try:
        options = _parser().parse_args(list(argv))
        chosen = _chosen(options)
    except SystemExit as stop:  # argparse's way to say that it has said all
        return int(stop.code or 0)
    try:
        if options.growth:
            return _growth(options)
        if options.drag:
            return _drag(options)
        if options.blocks:
            return _blocks(options)
        if options.tracts:
            return _tracts(options)
        report = measure(chosen, options.rounds, sys.stderr.isatty())
        print(report.text())
        _write(report, options)
    except (sfumato.SfumatoError, OSError) as error:
        print(f"sfumato bench: {error}", file=sys.stderr)
        return 1
    return 0


def measure(chosen: Sequence[Row], rounds: int, talkative: bool = False) -> Report:
    """Measure rows in interleaved rounds.

    Parameters
    ----------
    chosen : sequence of Row
        At least one.
    rounds : int
        How often each has its turn.
    talkative : bool
        Tell on stderr how far it is.

    Raises
    ------
    GpuError
        If there is no device to draw on.
    """
    stage = Stage()
    try:
        found = machine.describe(stage.renderer.name, stage.renderer.version)
        tell = _tell if talkative else _say_nothing
        lineup = warm_up(chosen, stage, tell)
        run(lineup, rounds, tell)
        tell("")
        results = [result for result, _ in lineup]
        software = bool(found["software_renderer"])
        clock = "cpu" if software else "wall"
        ratios = outcomes(results, clock, on_gpu=not software)
        return Report(found, chosen[0].setting, rounds, clock, results, ratios, stage.peer_device)
    finally:
        stage.close()


def _growth(options: argparse.Namespace) -> int:
    """Measure how cost grows, print it, and write what was asked for."""
    task = (QUICK_BASE, QUICK_FACTORS) if options.quick else (BASE, FACTORS)
    growth = measure_growth(*task, _tell if sys.stderr.isatty() else _say_nothing)
    print(growth.text())
    if options.json is not None:
        options.json.write_text(json.dumps(growth.to_json(), indent=1) + "\n", encoding="utf-8")
    _plot(lambda path: save_growth_plot(growth, path), options.plot)
    return 0


def _drag(options: argparse.Namespace) -> int:
    """Measure the steps of a drag, print them, and write what was asked for."""
    tell = _tell if sys.stderr.isatty() else _say_nothing
    drag = measure_drag(Setting(size=options.size), options.technique, tell=tell)
    print(drag.text())
    if options.json is not None:
        options.json.write_text(json.dumps(drag.to_json(), indent=1) + "\n", encoding="utf-8")
    return 0


def _blocks(options: argparse.Namespace) -> int:
    """Measure local occlusion over blocks, print it, and write what was asked for."""
    tell = _tell if sys.stderr.isatty() else _say_nothing
    report = measure_blocks(Setting(size=options.size, viewport=options.viewport), tell)
    print(report.text())
    if options.json is not None:
        options.json.write_text(json.dumps(report.to_json(), indent=1) + "\n", encoding="utf-8")
    return 0


def _tracts(options: argparse.Namespace) -> int:
    """Measure how long a large tractogram takes to open, print it, and write what was asked for."""
    tell = _tell if sys.stderr.isatty() else _say_nothing
    report = measure_tracts(LINES // 20 if options.quick else LINES, tell)
    print(report.text())
    if options.json is not None:
        options.json.write_text(json.dumps(report.to_json(), indent=1) + "\n", encoding="utf-8")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="sfumato bench",
        description="Measure how long a frame takes, ours and our peers', in interleaved runs.",
    )
    numbers = {
        "rounds": (_whole_number(1, 1000), "turns of each contender"),
        "size": (_whole_number(16, 1024), "voxels along a side"),
        "viewport": (_whole_number(16, 4096), "pixels along a side"),
    }
    for name, (kind, meaning) in numbers.items():
        text = f"{meaning} (default {DEFAULTS[name]}, quick {QUICK[name]})"
        parser.add_argument(f"--{name}", type=kind, metavar="N", help=text)
    ids = ", ".join(row.id for row in rows(Setting()))
    parser.add_argument("--quick", action="store_true", help="a smaller task and fewer rounds")
    parser.add_argument(
        "--growth",
        action="store_true",
        help="how the cost of a frame grows with volume, viewport, slices and lights, and how near to the "
        "device's fetch ceiling techniques come",
    )
    parser.add_argument(
        "--drag",
        action="store_true",
        help="the whole step of a drag in a real window: slider event to shown picture (needs a display)",
    )
    parser.add_argument(
        "--blocks",
        action="store_true",
        help="local occlusion: time of a direction and error of the picture against data reduction and "
        "number of directions",
    )
    parser.add_argument(
        "--tubes",
        action="store_true",
        help="the rows of geometry in the volume: combined beside the volume alone, by number of triangles",
    )
    parser.add_argument(
        "--tracts",
        action="store_true",
        help=f"from a tractogram of {LINES} lines to its first picture in a real window (needs a display)",
    )
    parser.add_argument(
        "--technique", default="cone", metavar="ID", help="the technique of --drag (default cone)"
    )
    parser.add_argument("--only", metavar="ID,...", help=f"only these rows: {ids}")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all measurements")
    parser.add_argument("--plot", type=Path, metavar="FILE.png", help="draw the medians (needs matplotlib)")
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="write what each row drew")
    return parser


def _whole_number(low: int, high: int) -> Callable[[str], int]:
    def number(text: str) -> int:
        value = int(text) if text.isdecimal() else -1
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text}: a whole number from {low} to {high} is needed")
        return value

    return number


def _chosen(options: argparse.Namespace) -> tuple[Row, ...]:
    """Fill in what was not given and return the rows asked for."""
    for name, value in (QUICK if options.quick else DEFAULTS).items():
        if getattr(options, name) is None:
            setattr(options, name, value)
    setting = Setting(size=options.size, viewport=options.viewport)
    table = tube_rows(setting) if options.tubes else rows(setting)
    if options.only is None:
        return table
    wanted = [name.strip() for name in options.only.split(",")]
    unknown = sorted(set(wanted) - {row.id for row in table})
    if unknown:
        print(f"sfumato bench: --only: no such row: {', '.join(unknown)}", file=sys.stderr)
        raise SystemExit(2)
    return tuple(row for row in table if row.id in wanted)


def _write(report: Report, options: argparse.Namespace) -> None:
    if options.json is not None:
        options.json.write_text(json.dumps(report.to_json(), indent=1) + "\n", encoding="utf-8")
    if options.pictures is not None:
        save_pictures(report.results, options.pictures)
    _plot(lambda path: save_plot(report, path), options.plot)


def _plot(save: Callable[[Path], None], path: Path | None) -> None:
    try:
        if path is not None:
            save(path)
    except ImportError:
        print("no plot: matplotlib is not installed", file=sys.stderr)


def _tell(text: str) -> None:
    print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def _say_nothing(text: str) -> None:
    del text
