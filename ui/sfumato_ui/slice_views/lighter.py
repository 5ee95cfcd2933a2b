"""Shows how much light reaches each place of a slice; worked out coarsely, in a thread of its own.

The slice is darkened where little light arrives, to no less than `DARKEST`, so that what lies in the dark can still
be read; what is lit glows in the lamps' colours, so that light is seen in dark tissue and in air, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from qtpy.QtCore import QObject, Signal
from qtpy.QtGui import QImage
from scipy.ndimage import distance_transform_edt

from sfumato import Scene
from sfumato.export.encode import srgb
from sfumato.slicing import ExtinctionGrid, Frame, extinction_grid, light_at, sample

from .newest import NewestFirst
from .slicer import packed_image

#: Places of a view at which the light is worked out.
PLACES = 5000
#: What is left of a slice's brightness where no light arrives, and how much the light glows by itself.
DARKEST, GLOW = 0.32, 0.14


@dataclass(frozen=True)
class LightRequest:
    """A view wants the light on this part of a slice."""

    scene: Scene
    frame: Frame

    @property
    def causes(self) -> tuple[object, ...]:
        """All that it depends on; another technique or exposure is no reason to work it out again."""
        scene = self.scene
        moving = any(not light.placed and light.attached == "viewer" for light in scene.active_lights)
        seen = scene.camera.basis() if moving and scene.camera is not None else None
        return id(scene.volume), scene.active_lights, scene.transfer, scene.crop, scene.clip, seen, self.frame


@dataclass(frozen=True)
class LightImages:
    """What was wanted: a picture by which the slice is multiplied, and one that is added to it."""

    request: LightRequest
    times: QImage
    plus: QImage


class Lighter(NewestFirst[LightRequest]):
    """Works out the light on slices."""

    #: A slice's light is there (`LightImages`).
    lit = Signal(object)
    _thread_name = "sfumato-slices-light"

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        #: The newest scene that was asked for, and its grid.
        self._grid: tuple[Scene, ExtinctionGrid] | None = None

    def want(self, request: LightRequest) -> None:
        """Ask for the light on a slice instead of what the same view asked for before."""
        self._add(request.frame.cut.id, request)

    def _do(self, wish: LightRequest) -> None:
        scene, frame = wish.scene, wish.frame
        assert scene.volume is not None
        inside = np.isfinite(sample(scene.volume, frame))
        light = np.zeros((frame.height, frame.width, 3))
        rows, columns = np.nonzero(inside)
        if len(rows):
            corner = frame.point(0.5, 0.5)
            right, down = frame.point(1.5, 0.5) - corner, frame.point(0.5, 1.5) - corner
            points = corner + columns[:, None] * right + rows[:, None] * down
            light[rows, columns] = light_at(scene, self._grid_of(scene), points)
        self._tell(self.lit, LightImages(wish, *light_images(light, inside)))

    def _grid_of(self, scene: Scene) -> ExtinctionGrid:
        kept = self._grid
        if kept is not None and _same_tissue(kept[0], scene):
            return kept[1]
        grid = extinction_grid(scene)
        self._grid = scene, grid
        return grid

    def forget(self) -> None:
        """Keep no grid, either."""
        super().forget()
        self._grid = None


def _same_tissue(a: Scene, b: Scene) -> bool:
    """Tell whether two scenes take the same of light on its way."""
    return a.volume is b.volume and (a.transfer, a.crop, a.clip) == (b.transfer, b.crop, b.clip)


def light_images(light: np.ndarray, inside: np.ndarray) -> tuple[QImage, QImage]:
    """Return light, linear RGB of shape (height, width, 3), as the two pictures.

    Outside of the volume it is as at the nearest place inside, so that enlarging them blurs no edge into it.
    """
    if inside.any():
        rows, columns = distance_transform_edt(~inside, return_distances=False, return_indices=True)
        light = light[rows, columns]
    shown = srgb(np.clip(light, 0, 1))
    return _image(DARKEST + (1 - DARKEST) * shown), _image(GLOW * shown)


def _image(rgb: np.ndarray) -> QImage:
    red, green, blue = np.rint(255 * np.moveaxis(rgb, -1, 0)).astype(np.uint32)
    return packed_image(np.uint32(0xFF000000) | red << 16 | green << 8 | blue)


__all__ = ["LightImages", "LightRequest", "Lighter", "light_images"]
