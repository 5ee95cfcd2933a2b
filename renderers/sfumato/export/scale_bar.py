"""A scale bar of true length, drawn at the resolution of the print.

Only an orthographic picture has one scale; in perspective, what is nearer is larger.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..scene import Camera
from .ink import draw_over

#: Share of the picture's width that the bar fills at most.
SHARE = 0.25
#: Height of capitals: 5 points in print (a font of 7 points), else a share of the picture's shorter side.
POINTS, LETTERS = 5.0, 1 / 48
_LEAST_LETTERS = 11.0


@dataclass(frozen=True)
class ScaleBar:
    """A bar for the lower right corner.

    Attributes
    ----------
    length : float
        mm.
    pixels : float
        The same in pixels of the picture.
    label : str
        Its length in words.
    ink : ndarray, shape (height, width, 2), float32
        Coverage of the white bar and its label, and of the black rim around both, in [0, 1].
    place : (int, int)
        Pixels of the ink's left upper corner, from the left and the top.
    """

    length: float
    pixels: float
    label: str
    ink: np.ndarray
    place: tuple[int, int]

    @staticmethod
    def for_picture(camera: Camera, size: tuple[int, int], dpi: float | None = None) -> ScaleBar:
        """Return the bar of a picture.

        Raises
        ------
        SceneError
            If the view is in perspective, or the picture too small.
        """
        if not camera.parallel_projection:
            raise SceneError(
                "camera.parallel_projection", False, "a scale bar needs an orthographic view (True)"
            )
        width, height = size
        per_pixel = 2 * camera.parallel_scale / height
        length = round_length(SHARE * width * per_pixel)
        letters = max(_LEAST_LETTERS, POINTS / 72 * dpi if dpi else LETTERS * min(size))
        label = words_for(length)
        ink = _ink(length / per_pixel, label, letters)
        margin = round(letters)
        place = width - ink.shape[1] - margin, height - ink.shape[0] - margin
        if min(place) < 0:
            raise SceneError("size", size, "a larger picture is needed for a scale bar")
        return ScaleBar(length, length / per_pixel, label, ink, place)

    def draw_on(self, rows: np.ndarray, top: int) -> None:
        """Draw the part that lies in some rows of the picture, of which the first is row ``top``.

        Parameters
        ----------
        rows : ndarray, shape (n, width, 4), uint8 or uint16
            sRGB, straight alpha; changed in place.
        """
        white, rim = self.ink[..., :1], self.ink[..., 1:]
        draw_over(rows, top, self.place, white, np.maximum(white, rim))


def round_length(most: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is not above a length."""
    power = 10.0 ** math.floor(math.log10(most))
    return max(k * power for k in (1.0, 2.0, 5.0) if k * power <= most * (1 + 1e-9))


def words_for(millimetres: float) -> str:
    """Return a length in mm, from 1 cm on in cm."""
    return f"{millimetres / 10:g} cm" if millimetres >= 10 else f"{millimetres:g} mm"


def _ink(pixels: float, label: str, letters: float) -> np.ndarray:
    """Return the coverage of bar and label, and of their rim."""
    from PIL import Image, ImageDraw, ImageFont

    rim = max(1, round(letters / 9))
    thick = max(2, round(letters / 5))
    font = ImageFont.load_default(letters / 0.72)  # the height of capitals is about 0.72 of a font's size
    box = font.getbbox(label, stroke_width=rim)
    width = math.ceil(max(pixels + 2 * rim, box[2] - box[0])) + 1
    height = math.ceil(box[3] - box[1]) + rim + thick + 2 * rim
    ink = np.zeros((height, width, 2), dtype=np.float32)
    middle = width / 2
    for channel, stroke in ((0, 0), (1, rim)):
        mask = Image.new("L", (width, height))
        at = (middle - (box[0] + box[2]) / 2, -box[1])
        ImageDraw.Draw(mask).text(at, label, 255, font=font, stroke_width=stroke)
        ink[..., channel] = np.asarray(mask) / np.float32(255)
    _add_bar(ink[..., 0], middle, pixels, height - rim - thick, height - rim)
    _add_bar(ink[..., 1], middle, pixels + 2 * rim, height - thick - 2 * rim, height)
    return ink


def _add_bar(mask: np.ndarray, middle: float, length: float, top: int, bottom: int) -> None:
    """Add a bar whose ends may lie within a pixel."""
    edges = np.arange(mask.shape[1])
    covered = np.minimum(edges + 1, middle + length / 2) - np.maximum(edges, middle - length / 2)
    mask[top:bottom] = np.maximum(mask[top:bottom], np.clip(covered, 0, 1))
