"""Where points of the world lie in the picture, and how far a hand's move is in the world. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sfumato import Camera
from sfumato.scene.picking import ray_through

Place = tuple[float, float]

#: Cosine of the angle to the line of sight above which an axis counts as pointing at the eye (15 degrees).
FACING = 0.966
#: Distance from the picture's edge in pixels within which a handle could not be taken.
MARGIN = 14.0
#: What counts as endlessly far, in mm.
FARTHEST = 1e9
#: Nearest depth at which a point is drawn, as a fraction of the distance to the focal point.
NEAR = 0.01


@dataclass(frozen=True)
class PictureView:
    """A camera and the picture's size in widget pixels; places have y down, as Qt has it."""

    camera: Camera
    width: float
    height: float

    @cached_property
    def _eye(self) -> np.ndarray:
        return np.asarray(self.camera.position, dtype=float)

    @cached_property
    def _axes(self) -> np.ndarray:
        """Right, up and forward."""
        basis = self.camera.basis()
        return np.array([basis.right, basis.up, basis.forward])

    @cached_property
    def _half(self) -> np.ndarray:
        return np.array(self.camera.half_extent(self.width / self.height))

    @cached_property
    def _near(self) -> float:
        return NEAR * self.camera.distance

    @property
    def camera_axes(self) -> np.ndarray:
        """The camera's axes right, up and back in world space, as rows."""
        return np.asarray(self._axes * [[1], [1], [-1]])

    def places(self, points: np.ndarray) -> np.ndarray:
        """Return where world points (n, 3) lie in the picture; (n, 2), NaN if behind the eye."""
        x, y, depth = self._axes @ (np.asarray(points, dtype=float) - self._eye).T
        if self.camera.parallel_projection:
            scale = np.ones_like(depth)
        else:
            scale = np.where(depth < self._near, np.nan, depth)
        x = x / (self._half[0] * scale) - self.camera.window_center[0]
        y = y / (self._half[1] * scale) - self.camera.window_center[1]
        return np.stack([(x + 1) / 2 * self.width, (1 - y) / 2 * self.height], axis=-1)

    def place(self, point: np.ndarray) -> Place | None:
        """Return where a world point lies in the picture, or None if it is behind the eye."""
        x, y = self.places(np.asarray(point)[None])[0]
        return None if np.isnan(x) else (float(x), float(y))

    def shows(self, points: np.ndarray) -> np.ndarray:
        """Tell which world points (n, 3) lie in the picture, clear of its edge."""
        at = self.places(points)
        inside = (at >= MARGIN) & (at <= np.array([self.width, self.height]) - MARGIN)
        return np.asarray(inside.all(axis=-1))

    def segments(self, corners: np.ndarray, pairs: np.ndarray) -> list[tuple[Place, Place]]:
        """Return the visible parts of the segments between corners (n, 3), given by pairs of indices (m, 2)."""
        at = self.places(corners)
        if np.isfinite(at).all():
            spots = [(float(x), float(y)) for x, y in at]
            return [(spots[a], spots[b]) for a, b in pairs]
        found = [self.segment(corners[a], corners[b]) for a, b in pairs]
        return [segment for segment in found if segment is not None]

    def segment(self, a: np.ndarray, b: np.ndarray) -> tuple[Place, Place] | None:
        """Return where the part of a segment that is before the eye lies."""
        near = self._near * 1.001
        ends = [np.asarray(p, dtype=float) for p in (a, b)]
        depths = [self.depth(p) - near for p in ends]
        if not self.camera.parallel_projection and min(depths) < 0:
            if max(depths) <= 0:
                return None
            behind = int(depths[1] < 0)
            share = depths[1 - behind] / (depths[1 - behind] - depths[behind])
            ends[behind] = ends[1 - behind] + share * (ends[behind] - ends[1 - behind])
        first, second = self.place(ends[0]), self.place(ends[1])
        return (first, second) if first is not None and second is not None else None

    def depth(self, point: np.ndarray) -> float:
        """Return how far before the eye a world point lies, in mm along the view."""
        return float(self.depths(np.asarray(point)[None])[0])

    def depths(self, points: np.ndarray) -> np.ndarray:
        """Return how far before the eye world points (n, 3) lie, in mm along the view."""
        return np.asarray((np.asarray(points, dtype=float) - self._eye) @ self._axes[2])

    def fractions(self, place: Place) -> Place:
        """Return a place in half widths and half heights from the centre, y up."""
        return 2 * place[0] / self.width - 1, 1 - 2 * place[1] / self.height

    def ray(self, place: Place) -> tuple[np.ndarray, np.ndarray]:
        """Return start and unit direction of the ray through a place."""
        return ray_through(self.camera, *self.fractions(place), self.width / self.height)

    def mm_per_pixel(self, point: np.ndarray) -> float:
        """Return how many mm across the view one pixel is at a world point's depth."""
        across = float(2 * self._half[1] / self.height)
        if self.camera.parallel_projection:
            return across
        return across * max(self.depth(point), self._near)

    def sight(self, point: np.ndarray) -> np.ndarray:
        """Return the unit direction in which the eye sees a world point."""
        if self.camera.parallel_projection:
            return np.asarray(self._axes[2])
        arm = np.asarray(point) - self._eye
        return np.asarray(arm / np.linalg.norm(arm))

    def faces(self, point: np.ndarray, axis: np.ndarray) -> bool:
        """Tell whether a unit axis at a point runs so much along the sight that it cannot be followed."""
        return abs(float(axis @ self.sight(point))) > FACING

    def travel(self, origin: np.ndarray, axis: np.ndarray, start: Place, now: Place) -> float:
        """Return how far in mm a hand has moved a point along a unit axis.

        An axis that can be seen is followed: the point stays under the hand. Of one that faces the eye,
        upwards is away from the eye.
        """
        if self.faces(origin, axis):
            away = 1.0 if float(axis @ self.sight(origin)) >= 0 else -1.0
            return away * (start[1] - now[1]) * self.mm_per_pixel(origin)
        return self._nearest_on(origin, axis, now) - self._nearest_on(origin, axis, start)

    def _nearest_on(self, origin: np.ndarray, axis: np.ndarray, place: Place) -> float:
        """Return where on a line the point nearest to a place's ray is, in mm from its origin."""
        start, along = self.ray(place)
        between = start - origin
        cosine = float(axis @ along)
        apart = max(1 - cosine**2, 1e-6)
        if (cosine * float(axis @ between) - float(along @ between)) / apart <= 0:
            # Beyond the line's vanishing point: as far as one can see.
            return FARTHEST if cosine > 0 else -FARTHEST
        return (float(axis @ between) - cosine * float(along @ between)) / apart
