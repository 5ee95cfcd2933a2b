"""Where points of the world lie in the picture, and how far a hand's move is in the world. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sfumato import Camera
from sfumato.scene.picking import ray_through

Place = tuple[float, float]

#: Sine of the angle to the line of sight below which an axis counts as pointing at the eye (15 degrees).
FACING = 0.26
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

    def place(self, point: np.ndarray) -> Place | None:
        """Return where a world point lies in the picture, or None if it is behind the eye."""
        camera, basis = self.camera, self.camera.basis()
        arm = np.asarray(point, dtype=float) - np.asarray(camera.position)
        depth = float(arm @ np.asarray(basis.forward))
        if not camera.parallel_projection and depth < NEAR * camera.distance:
            return None
        half_x, half_y = camera.half_extent(self.width / self.height)
        scale = 1.0 if camera.parallel_projection else depth
        x = float(arm @ np.asarray(basis.right)) / (half_x * scale) - camera.window_center[0]
        y = float(arm @ np.asarray(basis.up)) / (half_y * scale) - camera.window_center[1]
        return (x + 1) / 2 * self.width, (1 - y) / 2 * self.height

    def shows(self, point: np.ndarray) -> bool:
        """Tell whether a world point lies in the picture, clear of its edge."""
        place = self.place(point)
        return (
            place is not None
            and MARGIN <= place[0] <= self.width - MARGIN
            and MARGIN <= place[1] <= self.height - MARGIN
        )

    def segment(self, a: np.ndarray, b: np.ndarray) -> tuple[Place, Place] | None:
        """Return where the part of a segment that is before the eye lies."""
        near = NEAR * self.camera.distance * 1.001
        forward = np.asarray(self.camera.basis().forward)
        ends = [np.asarray(p, dtype=float) for p in (a, b)]
        depths = [float((p - np.asarray(self.camera.position)) @ forward) - near for p in ends]
        if not self.camera.parallel_projection and min(depths) < 0:
            if max(depths) <= 0:
                return None
            behind = int(depths[1] < 0)
            share = depths[1 - behind] / (depths[1 - behind] - depths[behind])
            ends[behind] = ends[1 - behind] + share * (ends[behind] - ends[1 - behind])
        first, second = self.place(ends[0]), self.place(ends[1])
        return (first, second) if first is not None and second is not None else None

    def fractions(self, place: Place) -> Place:
        """Return a place in half widths and half heights from the centre, y up."""
        return 2 * place[0] / self.width - 1, 1 - 2 * place[1] / self.height

    def ray(self, place: Place) -> tuple[np.ndarray, np.ndarray]:
        """Return start and unit direction of the ray through a place."""
        return ray_through(self.camera, *self.fractions(place), self.width / self.height)

    def mm_per_pixel(self, point: np.ndarray) -> float:
        """Return how many mm across the view one pixel is at a world point's depth."""
        half = self.camera.half_extent(self.width / self.height)[1]
        if self.camera.parallel_projection:
            return 2 * half / self.height
        arm = np.asarray(point) - np.asarray(self.camera.position)
        depth = max(float(arm @ np.asarray(self.camera.basis().forward)), NEAR * self.camera.distance)
        return 2 * half * depth / self.height

    def sight(self, point: np.ndarray) -> np.ndarray:
        """Return the unit direction in which the eye sees a world point."""
        if self.camera.parallel_projection:
            return np.asarray(self.camera.basis().forward)
        arm = np.asarray(point) - np.asarray(self.camera.position)
        return np.asarray(arm / np.linalg.norm(arm))

    def faces(self, point: np.ndarray, axis: np.ndarray) -> bool:
        """Tell whether a unit axis at a point runs so much along the sight that it cannot be followed."""
        return float(np.linalg.norm(np.cross(axis, self.sight(point)))) < FACING

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
