"""The crop box in the picture: its edges, and a handle on each face that moves along the face's normal."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from sfumato import Scene
from sfumato.scene import CropBox

from ..clip_planes import THINNEST, Axis, axes_of, cropped
from .handles import Handle
from .view import PictureView, Place

#: The box's edges as two rows of corners. Corners are counted in binary: an edge joins two that differ in one bit.
EDGES = np.array([(a, b) for a, b in combinations(range(8), 2) if (a ^ b).bit_count() == 1]).T
#: Places on a face that looks at the eye (low face, high face), as fractions of its sides: before and behind
#: each other as the two faces are, their handles must not be.
_ASIDE = (0.25, 0.75)
_GRID = np.array([(u / 10, v / 10) for u in range(1, 10) for v in range(1, 10)])


def edges(scene: Scene, view: PictureView) -> list[tuple[Place, Place]]:
    """Return the visible parts of the box's twelve edges."""
    assert scene.volume is not None
    corners = scene.volume.corners(scene.crop.low, scene.crop.high)
    return view.segments(corners, EDGES.T)


def handles(scene: Scene, view: PictureView, held: FaceGrip | None = None) -> list[Handle]:
    """Return the handles of the six faces, the nearest first; a held one stays at its place on the face."""
    volume = scene.volume
    assert volume is not None
    made: list[tuple[float, Handle]] = []
    for axis in axes_of(volume):
        low_mm, high_mm = axis.to_mm(scene.crop.low[axis.index], scene.crop.high[axis.index])
        for high in (False, True):
            key = f"crop.{axis.index}.{int(high)}"
            spot = held.spot if held is not None and held.key == key else face_spot(scene, view, axis, high)
            point = on_face(scene, axis, high, *spot)
            place = view.place(point)
            if place is None:
                continue
            value = high_mm if high != axis.flipped else low_mm
            name = f"Crop {axis.side(high)}: {value:.1f} mm"
            handle = Handle(key, name, place, along(view, point, axis.direction))
            made.append((view.depth(point), handle))
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


def face_spot(scene: Scene, view: PictureView, axis: Axis, high: bool) -> Place:
    """Return where on a face, in fractions of its sides, its handle sits.

    In the middle, aside if the face looks at the eye, and elsewhere on the face if that is outside the picture.
    """
    share = _ASIDE[high] if view.faces(on_face(scene, axis, high, 0.5, 0.5), axis.direction) else 0.5
    wanted = np.array([share, share])
    if view.shows(on_face(scene, axis, high, share, share)[None])[0]:
        return share, share
    order = np.argsort(np.linalg.norm(_GRID - wanted, axis=1), kind="stable")
    corners = [on_face(scene, axis, high, u, v) for u, v in ((0, 0), (1, 0), (0, 1))]
    sides = np.array([corners[1] - corners[0], corners[2] - corners[0]])
    shown = view.shows(corners[0] + _GRID[order] @ sides)
    u, v = _GRID[order[int(np.argmax(shown))]] if shown.any() else wanted
    return float(u), float(v)


def on_face(scene: Scene, axis: Axis, high: bool, u: float, v: float) -> np.ndarray:
    """Return a point of a face in world mm, by fractions of the face's two sides."""
    volume, crop = scene.volume, scene.crop
    assert volume is not None
    share = np.insert(np.array([u, v], dtype=float), axis.index, float(high))
    matrix = volume.world_from_texture
    at = np.asarray(crop.low) + share * np.subtract(crop.high, crop.low)
    return np.asarray(matrix[:3, :3] @ at + matrix[:3, 3])


class FaceGrip:
    """A face in the hand."""

    def __init__(self, scene: Scene, view: PictureView, handle: Handle, at: Place) -> None:
        assert scene.volume is not None
        self.key = handle.key
        _, index, high = handle.key.split(".")
        self._axis, self._high, self._start = Axis(scene.volume, int(index)), bool(int(high)), at
        self._crop = scene.crop
        self.spot = face_spot(scene, view, self._axis, self._high)
        self._point = on_face(scene, self._axis, self._high, *self.spot)

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
