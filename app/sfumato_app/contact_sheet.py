"""``sfumato contact-sheet``: the first picture of every volume in a folder on one sheet, with figures."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from cyclopts import App, Parameter
from PIL import Image, ImageDraw, ImageFont
from rich.console import Console
from rich.table import Table

from sfumato import LoadError, Scene, SfumatoError, Volume, load

from .errors import UsageError
from .first_picture import Figures, look_at, srgb

#: Linear colour behind the pictures: dark, but not the black of a shadow.
BACKGROUND = np.array([0.014, 0.016, 0.019], dtype=np.float32)
#: Paper and ink of the labels.
INK = ((16, 17, 18), (225, 225, 225))
LABEL_LINES = 4
NO_VOLUMES = {
    ".json",
    ".png",
    ".jpg",
    ".txt",
    ".md",
    ".trk",
    ".trx",
    ".tck",
    ".stl",
    ".ply",
    ".vol",
    ".pvm",
    ".raw",
}


@dataclass(frozen=True)
class Result:
    """What came of one data set."""

    name: str
    preset: str = ""
    figures: Figures | None = None
    picture: np.ndarray | None = None
    problem: str = ""

    @property
    def verdict(self) -> str:
        """``good``, or what is wrong."""
        return self.figures.verdict if self.figures is not None else self.problem


def find_volumes(folder: Path) -> list[Path]:
    """Return what to load of each data set in a folder, or of the folder itself if it is one.

    A set's META.json may say in ``load`` what to open: file names, or a pattern for a series of slices,
    which means the set's folder. Files of the same kind beside a named one are volumes too.
    """
    if not folder.is_dir():
        raise LoadError(folder, "there is no such folder", "name a folder of data sets")
    sets = sorted(p for p in folder.iterdir() if p.is_dir() and p.suffix != ".zarr")
    found: list[Path] = []
    for place in sets:
        found += _volumes_of(place)
    loose = (
        []
        if any((p / "META.json").exists() for p in sets)
        else [p for p in sorted(folder.iterdir()) if _may_be_volume(p)]
    )
    return found + loose


def _volumes_of(place: Path) -> list[Path]:
    words = _load_entry(place).replace(",", " ").split()
    if any("*" in word for word in words):
        return [place]
    named = [place / word for word in words if (place / word).exists()]
    kinds = {_kind(p) for p in named}
    beside = [
        p
        for p in sorted(place.iterdir())
        if _may_be_volume(p) and (not named or _kind(p) in kinds) and p not in named
    ]
    if (
        not named
        and len({_kind(p) for p in beside}) == 1
        and len(beside) > 1
        and beside[0].suffix in (".dcm", ".tif", ".tiff", "")
    ):
        return [place]
    return named + beside


def _load_entry(place: Path) -> str:
    try:
        meta = json.loads((place / "META.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return ""
    entry = meta.get("load") if isinstance(meta, dict) else None
    return entry if isinstance(entry, str) else ""


def _kind(path: Path) -> str:
    return "".join(path.suffixes[-2:]) if path.suffix == ".gz" else path.suffix


def _may_be_volume(path: Path) -> bool:
    return path.suffix.lower() not in NO_VOLUMES and not path.name.startswith(".")


def draw_all(folder: Path, size: int, frames: int) -> Iterator[Result]:
    """Load and draw one data set after the other."""
    seen: dict[str, str] = {}
    for path in find_volumes(folder):
        name = path.relative_to(folder).as_posix()
        try:
            volume = load(path)
            twin = seen.setdefault(volume.key, name)
            if twin != name:
                yield Result(name, problem=f"not drawn: the same voxels as {twin}")
            elif min(volume.dims) < 2:
                yield Result(name, problem="not drawn: a single slice is no volume")
            else:
                yield _draw(name, volume, size, frames)
        except SfumatoError as error:
            text = str(error).removeprefix(f"{path}: ")
            yield Result(name, problem=f"not loaded: {text}" if isinstance(error, LoadError) else text)


def _draw(name: str, volume: Volume, size: int, frames: int) -> Result:
    scene = Scene(volume=volume, frames=frames)
    lit, figures = look_at(scene, (size, size))
    assert scene.transfer is not None
    return Result(name, scene.transfer.name, figures, lit)


def write_sheet(results: Sequence[Result], out: Path, size: int) -> None:
    """Write the pictures, each above its name and figures, and below them what was not drawn, as one PNG."""
    drawn = [r for r in results if r.picture is not None]
    other = [f"{r.name}: {r.verdict}" for r in results if r.picture is None]
    columns = max(1, round((len(drawn) * 1.6) ** 0.5))
    line = max(11, size // 18)
    font = ImageFont.load_default(round(line * 0.75))
    height = size + LABEL_LINES * line + line // 2
    rows = -(-len(drawn) // columns)
    notes = [text for full in other for text in textwrap.wrap(full, max(20, columns * size * 2 // line))]
    sheet = Image.new("RGB", (columns * size, rows * height + (len(notes) + 1) * line), INK[0])
    pen = ImageDraw.Draw(sheet)
    for number, result in enumerate(drawn):
        x, y = number % columns * size, number // columns * height
        assert result.picture is not None
        sheet.paste(_tile(result.picture), (x, y))
        for row, text in enumerate(_label(result, size * 2 // line)):
            pen.text((x + line // 2, y + size + row * line), text, fill=INK[1], font=font)
    for row, text in enumerate(notes):
        pen.text((line // 2, rows * height + row * line), text, fill=INK[1], font=font)
    try:
        sheet.save(out)
    except (OSError, ValueError) as error:
        raise LoadError(
            out, f"the sheet could not be written: {error}", "name a .png in a folder that exists"
        ) from None


def _tile(linear: np.ndarray) -> Image.Image:
    light = linear[..., :3] + (1 - linear[..., 3:]) * BACKGROUND
    return Image.fromarray(np.round(255 * srgb(light)).astype(np.uint8))


def _label(result: Result, width: int) -> list[str]:
    """Return the lines below a picture: name and preset, the five figures in two lines, and the verdict."""
    assert result.figures is not None
    f, name = result.figures, result.name if len(result.name) <= width else "…" + result.name[1 - width :]
    figures = f"span {f.span:.0%}   median {f.median:.0f}   {result.preset}"
    return [
        name,
        figures,
        f"clipped {f.clipped:.1%}   shadowed {f.shadowed:.0%}",
        *textwrap.wrap(result.verdict, width),
    ][:LABEL_LINES]


def print_table(results: Sequence[Result]) -> None:
    """Print the figures of all sets, and why each that failed did."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=200)
    table = Table("data set", "preset", "span", "median", "clipped", "shadowed", "verdict")
    for column in table.columns[2:6]:
        column.justify = "right"
    for result in results:
        f = result.figures
        cells = (
            ["", "", "", ""]
            if f is None
            else [f"{f.span:.0%}", f"{f.median:.0f}", f"{f.clipped:.2%}", f"{f.shadowed:.0%}"]
        )
        table.add_row(result.name, result.preset, *cells, result.verdict)
    console.print(table)


def contact_sheet(folder: Path, out: Path, size: int = 384, frames: int = 4) -> list[Result]:
    """Draw every volume in a folder of data sets, print the figures and write one labelled PNG.

    Parameters
    ----------
    folder : Path
        Folder of data sets, each a folder or a file.
    out : Path
        The PNG to write.
    size : int
        Side of each picture in pixels.
    frames : int
        Jittered frames of each picture.

    Raises
    ------
    LoadError
        If there is nothing to draw, or the sheet cannot be written.
    """
    results = []
    for result in draw_all(folder, size, frames):
        Console(stderr=True, highlight=False).print(
            f"{result.name}: {result.verdict}", markup=False, soft_wrap=True
        )
        results.append(result)
    if not results:
        raise LoadError(folder, "there are no volumes in this folder", "name a folder of data sets")
    print_table(results)
    write_sheet(results, out, size)
    return results


_program = App(
    name="sfumato contact-sheet",
    help="Draw every volume in a folder of data sets to one labelled sheet.",
    help_format="plaintext",
    result_action="return_value",
)


@_program.default
def _command(
    folder: Annotated[Path, Parameter(help="Folder of data sets.")],
    /,
    *,
    output: Annotated[Path, Parameter(name=["--output", "-o"], help="The PNG to write.")] = Path(
        "contact-sheet.png"
    ),
    size: Annotated[int, Parameter(help="Side of each picture in pixels.")] = 384,
    frames: Annotated[int, Parameter(help="Jittered frames of each picture.")] = 4,
) -> int:
    if not 32 <= size <= 2048 or not 1 <= frames <= 256:
        raise UsageError("--size 32 to 2048 and --frames 1 to 256 are possible")
    contact_sheet(folder, output, size, frames)
    print(output)
    return 0


def main(arguments: Sequence[str]) -> int:
    """Run the command and return its exit status."""
    status: Any = _program(list(arguments), exit_on_error=False, print_error=False)
    return status if isinstance(status, int) else 0
