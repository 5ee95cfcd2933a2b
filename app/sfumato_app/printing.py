"""The command line's words about a picture file: its size in pixels or on paper, its depth, its scale bar."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated

from cyclopts import Group, Parameter

from sfumato.export.picture import PictureSpec

from .errors import UsageError
from .flags import parse_size
from .numbers import whole

#: Resolution of a picture whose size is given in mm alone.
DPI = 300.0
DEFAULT_SIZE = "1024x1024"
PRINT = Group("The picture file", help="PNG or TIFF, of any size; large ones are drawn by tiles.")


@Parameter(name="*")
@dataclass(frozen=True)
class PrintFlags:
    """What the picture file shall be."""

    size: Annotated[
        str | None, Parameter(help=f"Width and height in pixels ({DEFAULT_SIZE}).", group=PRINT)
    ] = None
    mm: Annotated[
        str | None, Parameter(help="Width and height on paper in mm, instead of --size.", group=PRINT)
    ] = None
    dpi: Annotated[
        float | None,
        Parameter(help=f"Pixels per inch, written into the file (with --mm {DPI:g}).", group=PRINT),
    ] = None
    bits: Annotated[
        int | None, Parameter(converter=whole, help="8 or 16 for each channel (8).", group=PRINT)
    ] = None
    scale_bar: Annotated[
        bool,
        Parameter(negative="", help="Draw a scale bar; needs an orthographic view.", group=PRINT),
    ] = False
    color_bar: Annotated[
        bool,
        Parameter(negative="", help="Draw the colour bars of tracts and meshes.", group=PRINT),
    ] = False
    orientation_cube: Annotated[
        bool,
        Parameter(negative="", help="Draw a cube that tells the patient's sides.", group=PRINT),
    ] = False

    def spec(self) -> PictureSpec:
        """Return the picture file.

        Raises
        ------
        UsageError
            If sizes are given twice or are none.
        SceneError
            If a value is not possible.
        """
        bits = 8 if self.bits is None else self.bits
        over = {
            "scale_bar": self.scale_bar, "color_bars": self.color_bar, "orientation_cube": self.orientation_cube
        }  # fmt: skip
        if self.mm is None:
            return PictureSpec(parse_size(self.size or DEFAULT_SIZE), bits, dpi=self.dpi, **over)
        if self.size is not None:
            raise UsageError("--size and --mm: one of them is enough")
        dpi = self.dpi or DPI
        return PictureSpec.printed(parse_millimetres(self.mm), dpi, bits=bits, **over)

    @property
    def only_for_print(self) -> list[str]:
        """The flags given that linear pictures do not know."""
        given = {
            "--dpi": self.dpi, "--bits": self.bits, "--scale-bar": self.scale_bar or None,
            "--color-bar": self.color_bar or None, "--orientation-cube": self.orientation_cube or None,
        }  # fmt: skip
        return [name for name, value in given.items() if value is not None]


def parse_millimetres(text: str) -> tuple[float, float]:
    """Return (width, height) in mm from a text like ``85x60.5``.

    Raises
    ------
    UsageError
        If it is none.
    """
    number = r"(\d{1,5}(?:\.\d{1,3})?)"
    match = re.fullmatch(f"{number}[xX×]{number}", text)
    if match is None or not (float(match[1]) and float(match[2])):
        raise UsageError(f"--mm {text}: WIDTHxHEIGHT is needed, as in 85x60")
    return float(match[1]), float(match[2])
