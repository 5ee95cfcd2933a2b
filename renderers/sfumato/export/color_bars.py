"""The colour bars of a picture's geometry, drawn at the resolution of the print into its lower left corner."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.color_bar import ColorBar, color_bars
from ..scene import Scene
from .ink import draw_over
from .scale_bar import LETTERS, POINTS

_LEAST_LETTERS = 9.0
#: Height of a strip as a part of the picture's, and its width and the gaps in heights of capitals.
HEIGHT, WIDTH, GAP = 0.28, 1.6, 0.8
#: Ground below strip and letters, so that they can be read on anything: black, with this coverage.
SHADE = 0.55


@dataclass(frozen=True)
class BarsInk:
    """Colour bars as a small picture of their own.

    Attributes
    ----------
    pixels : ndarray, shape (height, width, 4), float32
        sRGB and coverage in [0, 1].
    place : (int, int)
        Pixels of the left upper corner, from the left and the top.
    """

    pixels: np.ndarray
    place: tuple[int, int]

    @staticmethod
    def for_picture(scene: Scene, size: tuple[int, int], dpi: float | None = None) -> BarsInk | None:
        """Return the bars of a picture; None if no scalar colours its geometry, or they do not fit."""
        bars = color_bars(scene)
        if not bars:
            return None
        letters = max(_LEAST_LETTERS, POINTS / 72 * dpi if dpi else LETTERS * min(size))
        pixels = _beside([_drawn(bar, HEIGHT * size[1], letters) for bar in bars], round(GAP * letters))
        margin = round(letters)
        top = size[1] - pixels.shape[0] - margin
        fits = top >= 0 and pixels.shape[1] + margin <= size[0]
        return BarsInk(pixels, (margin, top)) if fits else None

    def draw_on(self, rows: np.ndarray, top: int) -> None:
        """Draw the part that lies in some rows of the picture, of which the first is row ``top``.

        Parameters
        ----------
        rows : ndarray, shape (n, width, 4), uint8 or uint16
            sRGB, straight alpha; changed in place.
        """
        cover = self.pixels[..., 3:]
        draw_over(rows, top, self.place, cover * self.pixels[..., :3], cover)


def _beside(pictures: Sequence[np.ndarray], gap: int) -> np.ndarray:
    height = max(p.shape[0] for p in pictures)
    whole = np.zeros((height, sum(p.shape[1] for p in pictures) + gap * (len(pictures) - 1), 4), np.float32)
    left = 0
    for picture in pictures:
        whole[height - picture.shape[0] :, left : left + picture.shape[1]] = picture
        left += picture.shape[1] + gap
    return whole


def _drawn(bar: ColorBar, height: float, letters: float) -> np.ndarray:
    """Return one bar: title above, strip, and ticks with their values beside it."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(letters / 0.72)  # the height of capitals is about 0.72 of a font's size
    gap, strip = round(GAP * letters), round(WIDTH * letters)
    tick = max(2, round(0.35 * letters))
    wide = max(font.getlength(t) for _, t in bar.ticks)
    width = math.ceil(max(strip + tick + gap / 2 + wide, font.getlength(bar.title))) + 2 * gap
    line, rows = round(1.5 * letters), max(2, round(height))
    above = gap + line + gap // 2
    image = Image.new("L", (width, above + rows + gap))
    draw = ImageDraw.Draw(image)
    draw.text((gap, gap + line / 2), bar.title, 255, font=font, anchor="lm")
    for value, text in bar.ticks:
        y = above + rows * (1 - (value - bar.low) / (bar.high - bar.low))
        draw.line((gap + strip, y, gap + strip + tick, y), 255, max(1, round(letters / 9)))
        draw.text((gap + strip + tick + gap / 2, y), text, 255, font=font, anchor="lm")
    ink = np.asarray(image, np.float32) / 255
    made = np.zeros((*ink.shape, 4), np.float32)
    made[..., 3] = np.maximum(ink, SHADE)
    made[..., :3] = (ink / made[..., 3])[..., None]  # white letters over the black shade
    picked = bar.colors[np.linspace(len(bar.colors) - 1, 0, rows).astype(int)]
    coded = np.where(picked > 0.0031308, 1.055 * np.maximum(picked, 0) ** (1 / 2.4) - 0.055, 12.92 * picked)
    made[above : above + rows, gap : gap + strip, :3] = coded[:, None]
    made[above : above + rows, gap : gap + strip, 3] = 1
    return made
