"""The rectangle of a slice that is seen."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..scene.camera import Camera
from ..scene.vectors import Vec3, vec3
from ..scene.volume import Volume
from .cuts import Cut


@dataclass(frozen=True)
class Frame:
    """A rectangle of pixels on a slice.

    Attributes
    ----------
    cut : Cut
        Which way it lies.
    middle : (float, float, float)
        World place in mm of the rectangle's middle; it says which slice it is, too.
    mm_per_pixel : float
        Size of a pixel, the same both ways.
    width, height : int
        Of the rectangle in pixels.
    """

    cut: Cut
    middle: Vec3
    mm_per_pixel: float
    width: int
    height: int

    def point(self, x: float, y: float) -> np.ndarray:
        """Return the world point, mm, at a place in pixels from the upper left corner, y down."""
        right, up = (x - self.width / 2) * self.mm_per_pixel, (self.height / 2 - y) * self.mm_per_pixel
        return np.asarray(self.middle) + right * np.asarray(self.cut.right) + up * np.asarray(self.cut.up)

    @property
    def camera(self) -> Camera:
        """The orthographic camera that sees the rectangle as its whole picture."""
        # How far away it stands does not matter; it must only not stand on the slice itself.
        away = np.asarray(self.middle) + self.height * self.mm_per_pixel * self.cut.back
        return Camera(
            vec3(away), self.middle, self.cut.up, parallel_projection=True,
            parallel_scale=self.height * self.mm_per_pixel / 2,
        )  # fmt: skip


def fitting_scale(volume: Volume, panes: Iterable[tuple[Cut, float, float]]) -> float:
    """Return the mm per pixel at which a volume fits into every one of some panes.

    Parameters
    ----------
    panes : iterable of (Cut, float, float)
        What each shows, and its width and height in pixels.
    """
    corners, scale = volume.corners(), 0.0
    for cut, width, height in panes:
        wide, high, _ = np.ptp(corners @ cut.axes.T, axis=0)
        scale = max(scale, float(wide) / max(width, 1.0), float(high) / max(height, 1.0))
    return scale or volume.min_spacing


__all__ = ["Frame", "fitting_scale"]
