"""The three cuts: their axes in the world, and what lies at their edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..scene.vectors import Vec3, vec3
from ..scene.volume import Volume


@dataclass(frozen=True)
class Cut:
    """A direction of slices.

    Attributes
    ----------
    id : str
        ``axial``, ``coronal`` or ``sagittal``; of a volume whose orientation is not known, the same by its array.
    title : str
        Its name for people.
    right, up : (float, float, float)
        Unit vectors of the world that are seen to the right and upwards.
    left_side, right_side, top_side, bottom_side : str
        What lies at the picture's edges: the patient's sides, or where an axis of the array grows; may be empty.
    """

    id: str
    title: str
    right: Vec3
    up: Vec3
    left_side: str
    right_side: str
    top_side: str
    bottom_side: str

    @property
    def back(self) -> np.ndarray:
        """Unit vector out of the picture, towards the viewer."""
        return np.cross(self.right, self.up)

    @property
    def axes(self) -> np.ndarray:
        """Right, up and back as rows, shape (3, 3)."""
        return np.array([self.right, self.up, self.back])

    @property
    def letters(self) -> dict[str, str]:
        """What lies at each edge that has a name: ``left``, ``right``, ``top``, ``bottom``."""
        sides = {
            "left": self.left_side, "right": self.right_side, "top": self.top_side, "bottom": self.bottom_side,
        }  # fmt: skip
        return {edge: side for edge, side in sides.items() if side}


#: The patient's cuts (LPS: +x left, +y posterior, +z superior).
CUTS = (
    Cut("axial", "Axial", (1, 0, 0), (0, -1, 0), "R", "L", "A", "P"),
    Cut("coronal", "Coronal", (1, 0, 0), (0, 0, 1), "R", "L", "S", "I"),
    Cut("sagittal", "Sagittal", (0, 1, 0), (0, 0, 1), "A", "P", "S", "I"),
)


def cuts_of(volume: Volume) -> tuple[Cut, Cut, Cut]:
    """Return a volume's cuts: the patient's, or along the array where the patient's sides are not known.

    Along the array, its first row is at the top of the slice across z, as in any viewer of pictures.
    """
    if volume.info.orientation_known:
        return CUTS
    x, y, z = (vec3(axis) for axis in np.asarray(volume.direction).T)
    down = vec3(-np.asarray(y))
    return (
        Cut("axial", "Across z", x, down, "", "x", "", "y"),
        Cut("coronal", "Across y", x, z, "", "x", "z", ""),
        Cut("sagittal", "Across x", y, z, "", "y", "z", ""),
    )


def step_along(volume: Volume, way: object) -> float:
    """Return how far in mm it is to the next voxel in a direction: the spacing of the array's nearest axis."""
    nearest = int(np.argmax(np.abs(np.asarray(way) @ np.asarray(volume.direction))))
    return volume.spacing[nearest]


def first_point(volume: Volume) -> Vec3:
    """Return the voxel centre, world mm, that is nearest to the middle: slices through it show voxels as they are."""
    index = np.array([n // 2 for n in volume.dims])
    axes = np.asarray(volume.direction) * np.asarray(volume.spacing)
    return vec3(np.asarray(volume.origin) + axes @ index)


__all__ = ["CUTS", "Cut", "cuts_of", "first_point", "step_along"]
