"""The crop box in the picture: its edges, and a handle on each face that moves along the face's normal."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from sfumato import Scene, Volume
from sfumato.scene import CropBox

from ..clip_planes import THINNEST, Axis, axes_of, cropped
from .handles import Handle
from .view import PictureView, Place

#: Places on a face that looks at the eye (low face, high face), as fractions of its sides: before and behind
#: each other as the two faces are, their handles must not be.
_ASIDE = (0.25, 0.75)


def edges(scene: Scene, view: PictureView) -> list[tuple[Place, Place]]:
    """Return the visible parts of the box's twelve edges."""
    assert scene.volume is not None
    corners = scene.volume.corners(scene.crop.low, scene.crop.high)
    # Corners are counted in binary, so an edge joins two whose numbers differ in one bit.
    pairs = [(a, b) for a, b in combinations(range(8), 2) if (a ^ b).bit_count() == 1]
    found = [view.segment(corners[a], corners[b]) for a, b in pairs]
    return [segment for segment in found if segment is not None]


def handles(scene: Scene, view: PictureView) -> list[Handle]:
    """Return the handles of the six faces, the nearest first."""
    volume = scene.volume
    assert volume is not None
    made: list[tuple[float, Handle]] = []
    for axis in axes_of(volume):
        low_mm, high_mm = axis.to_mm(scene.crop.low[axis.index], scene.crop.high[axis.index])
        for high in (False, True):
            point = face_point(scene, view, axis, high)
            place = view.place(point)
            if place is None:
                continue
            value = high_mm if high != axis.flipped else low_mm
            name = f"Crop {axis.side(high)}: {value:.1f} mm"
            depth = float(
                (point - np.asarray(view.camera.position)) @ np.asarray(view.camera.basis().forward)
            )
            made.append(
                (
                    depth,
                    Handle(f"crop.{axis.index}.{int(high)}", name, place, along(view, point, axis.direction)),
                )
            )
    return [handle for _, handle in sorted(made, key=lambda pair: pair[0])]


def along(view: PictureView, point: np.ndarray, axis: np.ndarray) -> Place:
    """Return the direction in the picture, y up, in which a hand moves a point along a unit axis."""
    if view.faces(point, axis):
        return 0.0, 1.0 if float(axis @ view.sight(point)) >= 0 else -1.0
    step = 10 * view.mm_per_pixel(point)
    a, b = view.place(point), view.place(point + step * axis)
    if a is None or b is None:
        return 0.0, 1.0
    length = max(float(np.hypot(b[0] - a[0], b[1] - a[1])), 1e-9)
    return (b[0] - a[0]) / length, (a[1] - b[1]) / length


def face_point(scene: Scene, view: PictureView, axis: Axis, high: bool) -> np.ndarray:
    """Return where on a face, in world mm, its handle sits: in the middle unless the face looks at the eye."""
    volume, crop = scene.volume, scene.crop
    assert volume is not None
    at = (np.asarray(crop.low) + np.asarray(crop.high)) / 2
    at[axis.index] = (crop.low, crop.high)[high][axis.index]
    if view.faces(_to_world(volume, at), axis.direction):
        share = _ASIDE[high]
        others = [i for i in range(3) if i != axis.index]
        at[others] = [crop.low[i] + share * (crop.high[i] - crop.low[i]) for i in others]
    return _to_world(volume, at)


def _to_world(volume: Volume, at: np.ndarray) -> np.ndarray:
    matrix = volume.world_from_texture
    return np.asarray(matrix[:3, :3] @ at + matrix[:3, 3])


class FaceGrip:
    """A face in the hand."""

    def __init__(self, scene: Scene, view: PictureView, handle: Handle, at: Place) -> None:
        assert scene.volume is not None
        _, index, high = handle.key.split(".")
        self._axis, self._high, self._start = Axis(scene.volume, int(index)), bool(int(high)), at
        self._crop = scene.crop
        self._point = face_point(scene, view, self._axis, self._high)

    def moved(self, view: PictureView, at: Place) -> CropBox:
        """Return the crop box for a place of the pointer."""
        travel = view.travel(self._point, self._axis.direction, self._start, at)
        return with_face(self._crop, self._axis, self._high, travel)


def with_face(crop: CropBox, axis: Axis, high: bool, travel: float) -> CropBox:
    """Return the crop box with one face moved by some mm along the array's axis, never past the other face."""
    i = axis.index
    wanted = (crop.high if high else crop.low)[i] + travel / axis.length
    if high:
        return cropped(crop, i, crop.low[i], min(1.0, max(crop.low[i] + THINNEST, wanted)))
    return cropped(crop, i, max(0.0, min(crop.high[i] - THINNEST, wanted)), crop.high[i])
