"""The camera, as VTK defines it, so that both views of the window can share one."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Annotated

import numpy as np

from ..errors import SceneError
from .params import Param, check
from .vectors import box_corners

if TYPE_CHECKING:
    from .volume import Volume

Vec3 = tuple[float, float, float]

#: Longest name of a bookmark.
MAX_NAME = 60
#: Where the camera stands, seen from the subject, and what is up (LPS: +x left, +y posterior, +z superior).
STANDARD_VIEWS: dict[str, tuple[Vec3, Vec3]] = {
    "front": ((0, -1, 0), (0, 0, 1)),
    "back": ((0, 1, 0), (0, 0, 1)),
    "left": ((1, 0, 0), (0, 0, 1)),
    "right": ((-1, 0, 0), (0, 0, 1)),
    "top": ((0, 0, 1), (0, -1, 0)),
    "bottom": ((0, 0, -1), (0, -1, 0)),
}


@dataclass(frozen=True)
class Basis:
    """Right-handed orthonormal axes of a camera in world space; ``back`` points against the view."""

    right: Vec3
    up: Vec3
    back: Vec3

    @property
    def forward(self) -> Vec3:
        """Viewing direction."""
        return (-self.back[0], -self.back[1], -self.back[2])


@dataclass(frozen=True)
class Camera:
    """Position and projection, with the meaning of the fields as in VTK.

    Raises
    ------
    SceneError
        If the position and the focal point coincide, or ``view_up`` is parallel to the view.
    """

    position: Annotated[Vec3, Param("Place of the eye, world space", unit="mm")] = (0.0, -1000.0, 0.0)
    focal_point: Annotated[Vec3, Param("Point in the middle of the picture", unit="mm")] = (0.0, 0.0, 0.0)
    view_up: Annotated[Vec3, Param("Direction that is up in the picture")] = (0.0, 0.0, 1.0)
    view_angle: Annotated[
        float,
        Param(
            "Vertical opening of a perspective view",
            label="Lens",
            unit="deg",
            gt=0,
            lt=170,
            soft=(5, 90),
            tab="view",
        ),
    ] = 30.0
    parallel_projection: Annotated[
        bool, Param("Orthographic instead of perspective", label="Orthographic", tab="view")
    ] = False
    parallel_scale: Annotated[
        float, Param("Half the picture's height in an orthographic view", unit="mm", gt=0)
    ] = 1.0
    window_center: Annotated[
        tuple[float, float], Param("Centre of the picture in half widths and heights, for crops and tiles")
    ] = (0.0, 0.0)

    def __post_init__(self) -> None:
        check(self)
        view = np.subtract(self.focal_point, self.position)
        if not np.linalg.norm(view) > 0:
            raise SceneError("focal_point", self.focal_point, "it must differ from the camera's position")
        if np.linalg.norm(np.cross(view / np.linalg.norm(view), self.view_up)) < 1e-6 * max(
            1e-30, float(np.linalg.norm(self.view_up))
        ):
            raise SceneError("view_up", self.view_up, "it must not be zero or parallel to the view")

    @property
    def distance(self) -> float:
        """Distance from the eye to the focal point in mm."""
        return float(np.linalg.norm(np.subtract(self.focal_point, self.position)))

    def basis(self) -> Basis:
        """Return the camera's axes in world space."""
        back = np.subtract(self.position, self.focal_point)
        back = back / np.linalg.norm(back)
        right = np.cross(self.view_up, back)
        right = right / np.linalg.norm(right)
        up = np.cross(back, right)
        return Basis(*(tuple(float(c) for c in axis) for axis in (right, up, back)))  # type: ignore[arg-type]

    def half_extent(self, aspect: float) -> tuple[float, float]:
        """Return half the picture's width and height: in mm (orthographic) or as tangents (perspective)."""
        half = (
            self.parallel_scale if self.parallel_projection else math.tan(math.radians(self.view_angle) / 2)
        )
        return half * aspect, half

    def cropped(self, left: float, bottom: float, right: float, top: float) -> Camera:
        """Return the camera whose whole picture is a part of this one's picture.

        Parameters
        ----------
        left, bottom, right, top : float
            The part's edges in fractions of the picture, from the lower left corner.
        """
        fraction = top - bottom
        width = right - left
        if not (fraction > 0 and width > 0):
            raise SceneError("window_center", (left, bottom, right, top), "the crop must not be empty")
        x = (self.window_center[0] + left + right - 1) / width
        y = (self.window_center[1] + bottom + top - 1) / fraction
        if self.parallel_projection:
            return replace(self, parallel_scale=self.parallel_scale * fraction, window_center=(x, y))
        tangent = math.tan(math.radians(self.view_angle) / 2) * fraction
        return replace(self, view_angle=math.degrees(2 * math.atan(tangent)), window_center=(x, y))

    @staticmethod
    def fit(
        bounds: np.ndarray,
        view: str | tuple[Vec3, Vec3] = "front",
        *,
        aspect: float = 1.0,
        fill: float = 0.82,
        view_angle: float = 30.0,
        parallel_projection: bool = False,
    ) -> Camera:
        """Return a standard view in which a box fills a fraction of the picture's shorter side.

        Parameters
        ----------
        bounds : ndarray, shape (2, 3) or (n, 3)
            Points in world space, mm: opposite corners of an axis-aligned box, or any points.
        view : str or (side, up)
            A name in `STANDARD_VIEWS`, or two orthogonal unit vectors as they stand there.
        fill : float
            Fraction of the picture that the box's projection spans in the tighter direction.
        """
        if isinstance(view, str) and view not in STANDARD_VIEWS:
            raise SceneError("camera", view, "one of " + ", ".join(STANDARD_VIEWS))
        side, up = STANDARD_VIEWS[view] if isinstance(view, str) else view
        points = np.asarray(bounds, dtype=float)
        if points.shape == (2, 3):
            points = box_corners(points)
        center = (points.min(axis=0) + points.max(axis=0)) / 2
        back = np.asarray(side, dtype=float)
        right = np.cross(up, back)
        rel = points - center
        x, y, z = np.abs(rel @ right), np.abs(rel @ np.asarray(up, dtype=float)), rel @ back
        half = float(max(y.max(), x.max() / aspect, 1e-9)) / fill
        tangent = math.tan(math.radians(view_angle) / 2)
        # Far enough that every point, at its own depth, stays within the wanted fraction of the picture.
        distance = float(np.max(np.maximum(y, x / aspect) / (fill * tangent) + z))
        distance = max(distance, half / tangent * 0.1)
        position = center + back * distance
        return Camera(
            position=tuple(position),
            focal_point=tuple(center),
            view_up=up,
            view_angle=view_angle,
            parallel_projection=parallel_projection,
            parallel_scale=half,
        )

    @staticmethod
    def standard(volume: Volume, view: str = "front", **options: object) -> Camera:
        """Return a standard view of a whole volume; options as in `fit`."""
        return Camera.fit(volume.corners(), view, **options)  # type: ignore[arg-type]


@dataclass(frozen=True)
class Bookmark:
    """A camera that is kept under a name, to come back to."""

    name: Annotated[str, Param("What it is called")] = "View"
    camera: Camera = field(default_factory=Camera)

    def __post_init__(self) -> None:
        check(self)
        if not self.name.strip() or len(self.name) > MAX_NAME:
            raise SceneError("name", self.name, f"a text of 1 to {MAX_NAME} characters is needed here")
