"""The shadow audit: what shadows darken so much that it may escape notice, in false colours, and how much it is.

A pixel's visibility is what the picture shows of it, shadow floor included, over what it would show if nothing were
in the way of any light: same lamps, technique, camera and transfer function. Where it is below a threshold, its colour
says how far below, with hatching, so that it cannot be taken for tissue; the rest of the picture is grey.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .colorimetry import LUMINANCE
from .export.encode import srgb
from .geometry import ColorBar
from .geometry.color import color_table
from .geometry.color_bar import round_ticks

#: Share of its unshadowed brightness below which a pixel counts as dark, unless another is asked for.
THRESHOLD = 0.25
#: Perceptually uniform; what is darkest is the lightest in it.
MAP = "plasma_r"
#: Opacity from which on a pixel counts as showing something.
SHOWN = 0.05
#: Hatching: width of a pair of stripes in pixels, and what the darker one keeps of its colour.
PAIR, DARKER = 8, 0.55


@dataclass(frozen=True)
class Audit:
    """What an audit found.

    Attributes
    ----------
    picture : ndarray, shape (height, width, 4), uint8
        False colours over the picture in grey, sRGB, straight alpha, row 0 on top.
    share : float
        Dark pixels over all that show something, 0 to 1.
    threshold : float
        Share of its unshadowed brightness below which a pixel counts as dark, 0 to 1.
    """

    picture: np.ndarray
    share: float
    threshold: float

    @property
    def bar(self) -> ColorBar:
        """The legend of the colours, in percent of the brightness without shadows."""
        high = 100 * self.threshold
        return ColorBar("Light that arrives (%)", 0.0, high, round_ticks(0.0, high), color_table(MAP))


def visibility(lit: np.ndarray, unshadowed: np.ndarray) -> np.ndarray:
    """Return the share of its unshadowed brightness that each pixel has; 1 where nothing is shown.

    Parameters
    ----------
    lit, unshadowed : ndarray, shape (height, width, 4), float32
        The same picture with and without shadows: linear, premultiplied, without background.
    """
    have, could = lit[..., :3] @ LUMINANCE, unshadowed[..., :3] @ LUMINANCE
    shown = (unshadowed[..., 3] >= SHOWN) & (could > 0)
    return np.where(shown, have / np.where(shown, could, 1), 1.0)


def audited(lit: np.ndarray, unshadowed: np.ndarray, picture: np.ndarray, threshold: float) -> Audit:
    """Return an audit of a picture.

    Parameters
    ----------
    lit, unshadowed : ndarray
        As in `visibility`.
    picture : ndarray, shape (height, width, 4), uint8
        What the user sees, sRGB, straight alpha.
    threshold : float
        Share of its unshadowed brightness below which a pixel counts as dark, 0 to 1.
    """
    kept = visibility(lit, unshadowed)
    dark = kept < threshold
    shown = int((unshadowed[..., 3] >= SHOWN).sum())
    result = picture.copy()
    result[..., :3] = np.rint(picture[..., :3] @ LUMINANCE).astype(np.uint8)[..., None]
    table = np.rint(255 * srgb(color_table(MAP))).astype(np.uint8)
    place = np.clip(kept[dark] / max(threshold, 1e-6), 0, 1) * (len(table) - 1)
    result[dark, :3] = table[place.astype(np.int32)] * _hatching(dark)[:, None]
    result[dark, 3] = 255
    return Audit(result, float(dark.sum()) / max(shown, 1), threshold)


def _hatching(dark: np.ndarray) -> np.ndarray:
    """Return what each of the marked pixels keeps of its colour, so that slanting stripes are seen."""
    rows, columns = np.nonzero(dark)
    return np.where((rows + columns) % PAIR < PAIR // 2, 1.0, DARKER)


__all__ = ["THRESHOLD", "Audit", "audited", "visibility"]
