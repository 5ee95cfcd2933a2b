"""An orientation cube: whose side one looks at, drawn at the resolution of screen or print.

Its faces carry the patient's directions (LPS: left, posterior, superior are positive), turned as the camera is. It is
drawn without perspective, so that it looks alike wherever the subject stands in the picture.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..scene import STANDARD_VIEWS, Camera
from .ink import draw_over
from .scale_bar import LETTERS, POINTS

if TYPE_CHECKING:
    from PIL.Image import Image as Mask

#: Side of the square in which the cube turns: in heights of capitals of the picture's other letters, and at least, in
#: pixels.
SIDE, LEAST = 8.0, 48
#: Letter of the face that each standard view looks at, and its name where the patient's sides are unknown.
NAMES = {
    "front": ("A", "-y"), "back": ("P", "+y"), "left": ("L", "+x"), "right": ("R", "-x"),
    "top": ("S", "+z"), "bottom": ("I", "-z"),
}  # fmt: skip
#: Cosine between face and view below which a letter could not be read.
_NARROW = 0.2
#: Half the cube's edge where its corners just stay within the square.
_HALF = 0.97 / math.sqrt(3)
_FACE, _LETTER, _EDGE = (0.62, 0.96), 0.12, 0.25
#: Pixels drawn along each side of one that is shown.
_FINER = 3
_MASK = 96


@dataclass(frozen=True)
class Face:
    """A face that is seen.

    Attributes
    ----------
    view : str
        The standard view that looks at it.
    facing : float
        Cosine between its normal and the direction to the viewer.
    middle, right, up : ndarray, shape (2,)
        Its middle, and half its edges, in half sides of the cube's square; y up.
    """

    view: str
    facing: float
    middle: np.ndarray
    right: np.ndarray
    up: np.ndarray

    def holds(self, x: float, y: float) -> bool:
        """Tell whether a place in the square, from -1 to 1, y up, lies on it."""
        across = np.linalg.solve(np.stack([self.right, self.up], axis=1), np.array([x, y]) - self.middle)
        return bool(np.all(np.abs(across) <= 1))


def faces(camera: Camera) -> list[Face]:
    """Return the faces that a camera sees, one to three."""
    basis = camera.basis()
    flat = np.array([basis.right, basis.up])
    seen = []
    for view, (normal, up) in STANDARD_VIEWS.items():
        facing = float(np.dot(normal, basis.back))
        if facing > 1e-3:
            edges = _HALF * np.array([normal, np.cross(up, normal), up])
            seen.append(Face(view, facing, *(flat @ edge for edge in edges)))
    return seen


def face_at(camera: Camera, x: float, y: float) -> str:
    """Return the standard view whose face lies at a place in the square, from -1 to 1, y up; "" beside the cube."""
    return next((face.view for face in faces(camera) if face.holds(x, y)), "")


def cube_pixels(camera: Camera, side: int, known: bool = True) -> np.ndarray:
    """Draw a cube.

    Parameters
    ----------
    side : int
        Pixels along each side of its square.
    known : bool
        Whether the patient's sides are known; if not, the faces carry the axes of the file.

    Returns
    -------
    ndarray, shape (side, side, 2), float32
        Grey (sRGB) and coverage in [0, 1].
    """
    from PIL import Image, ImageDraw

    wide = side * _FINER
    grey, cover = Image.new("L", (wide, wide)), Image.new("L", (wide, wide))
    for face in faces(camera):
        corners = [
            face.middle + a * face.right + b * face.up for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        outline = [tuple((c * (1, -1) + 1) * wide / 2) for c in corners]
        tone = round(255 * float(np.interp(face.facing, (0, 1), _FACE)))
        line = max(_FINER, wide // 48)
        ImageDraw.Draw(cover).polygon(outline, 255)
        ImageDraw.Draw(grey).polygon(outline, tone)
        ImageDraw.Draw(grey).line([*outline, outline[0]], round(255 * _EDGE), line, joint="curve")
        ImageDraw.Draw(cover).line([*outline, outline[0]], 255, line, joint="curve")
        if face.facing > _NARROW:
            name = NAMES[face.view][0 if known else 1]
            grey.paste(round(255 * _LETTER), (0, 0), _letter_on(face, name, wide))
    both = np.stack([np.asarray(grey, np.float32), np.asarray(cover, np.float32)], axis=-1) / 255
    both[..., 0] *= both[..., 1]
    means = both.reshape(side, _FINER, side, _FINER, 2).mean(axis=(1, 3))
    means[..., 0] /= np.maximum(means[..., 1], 1e-6)
    return np.asarray(means, np.float32)


def _letter_on(face: Face, name: str, wide: int) -> Mask:
    """Return the coverage of a face's letter, as it lies on the face."""
    from PIL import Image

    # From pixels of the picture back to those of the letter's own: an affine map, as there is no perspective.
    to_picture = np.stack([face.right, face.up], axis=1) * [[1.0], [-1.0]] * wide / 2 / (_MASK / 2)
    to_picture[:, 1] *= -1
    back = np.linalg.inv(to_picture)
    middle = (face.middle * (1, -1) + 1) * wide / 2
    shift = _MASK / 2 - back @ middle
    affine = (back[0, 0], back[0, 1], shift[0], back[1, 0], back[1, 1], shift[1])
    return _mask(name).transform((wide, wide), Image.Transform.AFFINE, affine, Image.Resampling.BILINEAR)


@functools.cache
def _mask(name: str) -> Mask:
    """Return a letter in the middle of a square, as an image of coverage."""
    from PIL import Image, ImageDraw, ImageFont

    mask = Image.new("L", (_MASK, _MASK))
    font = ImageFont.load_default(_MASK * (0.8 if len(name) == 1 else 0.6))
    box = font.getbbox(name)
    at = ((_MASK - box[0] - box[2]) / 2, (_MASK - box[1] - box[3]) / 2)
    ImageDraw.Draw(mask).text(at, name, 255, font=font, stroke_width=1)
    return mask


@dataclass(frozen=True)
class CubeInk:
    """A cube for the upper left corner of a picture file.

    Attributes
    ----------
    pixels : ndarray, shape (side, side, 2), float32
        Grey (sRGB) and coverage.
    place : (int, int)
        Pixels of its left upper corner, from the left and the top.
    """

    pixels: np.ndarray
    place: tuple[int, int]

    @staticmethod
    def for_picture(
        camera: Camera, size: tuple[int, int], dpi: float | None = None, known: bool = True
    ) -> CubeInk | None:
        """Return the cube of a picture; None if the picture is too small for it."""
        letters = POINTS / 72 * dpi if dpi else LETTERS * min(size)
        side, margin = max(LEAST, round(SIDE * letters)), round(max(letters, LEAST / SIDE))
        if side + 2 * margin > min(size):
            return None
        return CubeInk(cube_pixels(camera, side, known), (margin, margin))

    def draw_on(self, rows: np.ndarray, top: int) -> None:
        """Draw the part that lies in some rows of the picture, of which the first is row ``top``.

        Parameters
        ----------
        rows : ndarray, shape (n, width, 4), uint8 or uint16
            sRGB, straight alpha; changed in place.
        """
        grey, cover = self.pixels[..., :1], self.pixels[..., 1:]
        draw_over(rows, top, self.place, grey * cover, cover)
