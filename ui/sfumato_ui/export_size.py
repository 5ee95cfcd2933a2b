"""The size of an exported picture: pixels, or millimetres at dpi, each following from the other."""

from __future__ import annotations

from dataclasses import dataclass, replace

from sfumato.export.picture import MAX_PIXELS, MAX_SIDE, MM_PER_INCH, pixels_of

LEAST_SIDE = 16


@dataclass(frozen=True)
class Preset:
    """A proposed size: in pixels or in mm; a height of 0 follows from the picture's proportions."""

    title: str
    pixels: tuple[int, int] | None = None
    paper: tuple[float, float] | None = None


AS_SEEN, OWN = "As in the window", "Own size"
PRESETS = (
    Preset(AS_SEEN),
    Preset("Screen, 1920 × 1080", pixels=(1920, 1080)),
    Preset("Screen, 3840 × 2160", pixels=(3840, 2160)),
    Preset("One column, 85 mm wide", paper=(85.0, 0.0)),
    Preset("Two columns, 175 mm wide", paper=(175.0, 0.0)),
    Preset("A5, 148 × 210 mm", paper=(148.0, 210.0)),
    Preset("A5 across, 210 × 148 mm", paper=(210.0, 148.0)),
    Preset("A4, 210 × 297 mm", paper=(210.0, 297.0)),
    Preset("A4 across, 297 × 210 mm", paper=(297.0, 210.0)),
)


@dataclass(frozen=True)
class ExportSize:
    """Pixels and dpi; with `paper` (width and height in mm) the pixels follow from it.

    Attributes
    ----------
    aspect : float
        Width over height that is kept while `locked`.
    """

    pixels: tuple[int, int]
    dpi: float = 300.0
    paper: tuple[float, float] | None = None
    locked: bool = True
    aspect: float = 1.0

    @property
    def millimetres(self) -> tuple[float, float]:
        """Width and height on paper."""
        if self.paper is not None:
            return self.paper
        return self.pixels[0] / self.dpi * MM_PER_INCH, self.pixels[1] / self.dpi * MM_PER_INCH

    @property
    def possible(self) -> bool:
        """Whether a picture may be so large."""
        return max(self.pixels) <= MAX_SIDE and self.pixels[0] * self.pixels[1] <= MAX_PIXELS

    def with_side(self, axis: int, pixels: int) -> ExportSize:
        """Return it with another width (axis 0) or height (1) in pixels."""
        sides = list(self.pixels)
        sides[axis] = pixels
        if self.locked:
            sides[1 - axis] = max(
                LEAST_SIDE, round(pixels / self.aspect if axis == 0 else pixels * self.aspect)
            )
        return replace(self, pixels=(sides[0], sides[1]), paper=None)

    def with_length(self, axis: int, millimetres: float) -> ExportSize:
        """Return it with another width or height in mm."""
        sides = list(self.millimetres)
        sides[axis] = millimetres
        if self.locked:
            sides[1 - axis] = millimetres / self.aspect if axis == 0 else millimetres * self.aspect
        return replace(self, paper=(sides[0], sides[1]))._from_paper()

    def with_dpi(self, dpi: float) -> ExportSize:
        """Return it with another resolution: what was given, mm or pixels, stays."""
        return replace(self, dpi=dpi)._from_paper()

    def with_lock(self, locked: bool) -> ExportSize:
        """Return it with its present proportions kept, or free."""
        return replace(self, locked=locked, aspect=self.pixels[0] / self.pixels[1])

    def with_preset(self, preset: Preset, seen: tuple[int, int]) -> ExportSize:
        """Return a proposed size; `seen` is the picture's size in the window in pixels."""
        aspect = seen[0] / seen[1]
        if preset.paper is not None:
            width, height = preset.paper
            size = replace(self, paper=(width, height or width / aspect))._from_paper()
        else:
            size = replace(self, pixels=preset.pixels or seen, paper=None)
        return replace(size, aspect=size.pixels[0] / size.pixels[1])

    def _from_paper(self) -> ExportSize:
        if self.paper is None:
            return self
        width, height = (max(LEAST_SIDE, pixels_of(length, self.dpi)) for length in self.paper)
        return replace(self, pixels=(width, height))


def duration_words(seconds: float) -> str:
    """Return a rough duration in words."""
    if seconds < 60:
        return f"about {max(1, round(seconds))} s"
    minutes = seconds / 60
    return f"about {round(minutes)} min" if minutes < 90 else f"about {minutes / 60:.1f} h"


def memory_words(size: int) -> str:
    """Return bytes in words."""
    mib = size / 2**20
    return f"{mib / 1024:.1f} GiB" if mib >= 1000 else f"{max(1, round(mib))} MiB"
