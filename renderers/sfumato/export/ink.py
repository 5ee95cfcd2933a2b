"""What is drawn over the rows of a picture for print: bars and letters, which have a coverage of their own."""

from __future__ import annotations

from typing import Protocol

import numpy as np


class Ink(Protocol):
    """What is drawn over a picture file."""

    def draw_on(self, rows: np.ndarray, top: int) -> None:
        """Draw the part that lies in some rows of the picture, of which the first is row ``top``."""


def draw_over(
    rows: np.ndarray, top: int, place: tuple[int, int], light: np.ndarray, cover: np.ndarray
) -> None:
    """Draw the part of a small picture that lies in some rows of a larger one, of which the first is row ``top``.

    Parameters
    ----------
    rows : ndarray, shape (n, width, 4), uint8 or uint16
        sRGB, straight alpha; changed in place.
    place : (int, int)
        Pixels of the small picture's left upper corner, from the left and the top of the larger one.
    light, cover : ndarray, shape (height, width, 3 or 1), and (height, width, 1), float32
        sRGB times coverage, and coverage, in [0, 1].
    """
    left, first = place
    begin, end = max(first, top), min(first + len(cover), top + len(rows))
    if begin >= end:
        return
    light, cover = light[begin - first : end - first], cover[begin - first : end - first]
    part = rows[begin - top : end - top, left : left + cover.shape[1]]
    full = float(np.iinfo(rows.dtype).max)
    below = part[..., 3:] / full * (1 - cover)
    alpha = cover + below
    color = (light * full + below * part[..., :3]) / np.maximum(alpha, 1e-6)
    part[..., :3] = np.rint(np.clip(color, 0, full))
    part[..., 3:] = np.rint(alpha * full)


__all__ = ["Ink", "draw_over"]
