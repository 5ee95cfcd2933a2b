"""The scene's clip planes and crop box as the window edits them: which plane is selected, and every edit.

Shared by the View tab and the Clip tool. Lengths are in mm from the middle of the volume.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from qtpy.QtCore import QObject, Signal

from sfumato import Scene, Volume
from sfumato.scene import MAX_CLIP_PLANES, ClipPlane, CropBox

from .editing import Editor

#: Cosine of the angle below which two planes do not cut alike.
ALIKE = 0.95
#: Thinnest slab that the crop box leaves, as a fraction of the volume.
THINNEST = 0.01
_ANATOMY = ("Right – left", "Front – back", "Bottom – top")
_CUTS = ("Sagittal", "Coronal", "Axial")
#: Names of a cut's two sides, low and high, along the patient's axes (LPS).
_SIDES = (("right", "left"), ("front", "back"), ("bottom", "top"))


def unit(vector: object) -> np.ndarray:
    """Return a vector scaled to length 1."""
    array = np.asarray(vector, dtype=float)
    return np.asarray(array / np.linalg.norm(array))


def vec(values: np.ndarray) -> tuple[float, float, float]:
    """Return an array as the scene keeps it."""
    x, y, z = (float(v) for v in values)
    return x, y, z


class Axis:
    """One axis of a volume's array, named after the patient's where that is known.

    Parameters
    ----------
    volume : Volume
    index : int
        0 to 2 for the array's x, y, z.
    """

    def __init__(self, volume: Volume, index: int) -> None:
        self.index = index
        self.direction = np.asarray(volume.direction, dtype=float)[:, index]
        self.length = volume.dims[index] * volume.spacing[index]
        nearest = int(np.argmax(np.abs(self.direction)))
        known = volume.info.orientation_known
        #: Whether mm are counted against the array's axis, so that they run as the name says.
        self.flipped = bool(known and self.direction[nearest] < 0)
        self.name = _ANATOMY[nearest] if known else "xyz"[index]
        self.order = nearest if known else index
        self._sides = _SIDES[nearest] if known else (f"{'xyz'[index]} low", f"{'xyz'[index]} high")

    def side(self, high: bool) -> str:
        """Return the name of the face at the array axis's low or high end."""
        return self._sides[int(high != self.flipped)]

    def to_mm(self, low: float, high: float) -> tuple[float, float]:
        """Return bounds in mm, as named, of bounds in fractions of the array."""
        low, high = (1 - high, 1 - low) if self.flipped else (low, high)
        return low * self.length, high * self.length

    def to_fractions(self, low: float, high: float) -> tuple[float, float]:
        """Return bounds in fractions of the array, 0 to 1 and not too thin, of bounds in mm."""
        low, high = (min(1.0, max(0.0, v / self.length)) for v in (low, high))
        return (1 - high, 1 - low) if self.flipped else (low, high)


def axes_of(volume: Volume) -> list[Axis]:
    """Return the axes of a volume, in the patient's order where it is known."""
    return sorted((Axis(volume, i) for i in range(3)), key=lambda axis: axis.order)


class ClipPlanes(QObject):
    """Edits clip planes and crop box through the editor; remembers the selected plane."""

    #: Another plane was selected.
    selected_changed = Signal()
    #: A plane was added: the user will want its handles.
    added = Signal()

    def __init__(self, editor: Editor) -> None:
        super().__init__(editor)
        self._editor = editor
        self._selected = 0

    # -- which ------------------------------------------------------------------------------------
    @property
    def planes(self) -> tuple[ClipPlane, ...]:
        """The scene's planes."""
        return self._editor.scene.clip

    @property
    def selected(self) -> int:
        """Index of the selected plane; 0 if there is none."""
        return max(0, min(self._selected, len(self.planes) - 1))

    @property
    def plane(self) -> ClipPlane | None:
        """The selected plane."""
        return self.planes[self.selected] if self.planes else None

    def select(self, index: int) -> None:
        """Select a plane."""
        if index != self._selected:
            self._selected = index
            self.selected_changed.emit()

    # -- planes -----------------------------------------------------------------------------------
    def add(self) -> None:
        """Add a plane through the middle of what the crop box leaves.

        It cuts across the axis that faces the eye, or the next one across which no plane cuts yet.
        """
        scene = self._editor.scene
        if scene.volume is None or scene.camera is None or len(self.planes) >= MAX_CLIP_PLANES:
            return
        forward = np.asarray(scene.camera.basis().forward)
        axes = sorted(cut_normals(scene)[:3], key=lambda axis: -abs(float(forward @ axis)))
        used = [unit(plane.normal) for plane in self.planes]
        free = (axis for axis in axes if all(abs(float(axis @ other)) < ALIKE for other in used))
        middle = scene.volume.corners(scene.crop.low, scene.crop.high).mean(axis=0)
        plane = ClipPlane(vec(middle), self._away_from_eye(next(free, axes[0])))
        if self._editor.change("Add a clip plane", clip=(*self.planes, plane)):
            self.select(len(self.planes) - 1)
            self.added.emit()

    def remove(self) -> None:
        """Remove the selected plane."""
        gone = self.selected
        kept = tuple(plane for i, plane in enumerate(self.planes) if i != gone)
        if len(kept) < len(self.planes) and self._editor.change("Remove the clip plane", clip=kept):
            self.select(max(0, min(gone, len(kept) - 1)))

    def flip(self) -> None:
        """Keep the other side of the selected plane."""
        if self.plane is not None:
            self._change("Flip the clip plane", normal=vec(-np.asarray(self.plane.normal)))

    def enable(self, on: bool) -> None:
        """Let the selected plane cut, or not."""
        self._change("Switch the clip plane", enabled=on)

    def turn_to(self, cut: int) -> None:
        """Turn the selected plane across an axis (0 to 2) or towards the eye (3), at the same offset."""
        scene, plane = self._editor.scene, self.plane
        if scene.volume is None or plane is None:
            return
        offset = self.offset()
        normal = self._away_from_eye(cut_normals(scene)[cut])
        point = np.asarray(scene.volume.center) + offset * np.asarray(normal)
        self._change("Turn the clip plane", point=vec(point), normal=normal)

    def offset(self, plane: ClipPlane | None = None) -> float:
        """Return how far a plane (the selected one) lies from the volume's middle along its normal, in mm."""
        plane, volume = plane or self.plane, self._editor.scene.volume
        if plane is None or volume is None:
            return 0.0
        return float(unit(plane.normal) @ np.subtract(plane.point, volume.center))

    def offset_range(self, plane: ClipPlane | None = None) -> tuple[float, float]:
        """Return the offsets at which a plane (the selected one) touches the volume's corners, in mm."""
        plane, volume = plane or self.plane, self._editor.scene.volume
        if plane is None or volume is None:
            return -1.0, 1.0
        along = (volume.corners() - np.asarray(volume.center)) @ unit(plane.normal)
        return float(along.min()), float(along.max())

    def set_offset(self, offset: float, merge: bool = False) -> None:
        """Move the selected plane along its normal."""
        plane = self.plane
        if plane is not None:
            self._change(MOVE, merge, point=vec(moved_to(plane, offset, self.offset())))

    def _change(self, label: str, merge: bool = False, /, **fields: object) -> None:
        if self.plane is not None:
            prefix = f"clip.{self.selected}."
            self._editor.change(label, merge, **{prefix + name: value for name, value in fields.items()})

    def _away_from_eye(self, normal: np.ndarray) -> tuple[float, float, float]:
        """Return the normal pointed so that the near side goes and the cut faces the eye."""
        camera = self._editor.scene.camera
        facing = camera is None or float(normal @ np.asarray(camera.basis().forward)) >= 0
        return vec(normal if facing else -normal)

    # -- crop box ---------------------------------------------------------------------------------
    def set_crop(self, axis: Axis, low_mm: float, high_mm: float, merge: bool = False) -> None:
        """Crop along an axis, in mm as `Axis` counts them."""
        low, high = axis.to_fractions(low_mm, high_mm)
        self._editor.change(CROP, merge, crop=cropped(self._editor.scene.crop, axis.index, low, high))

    def reset_crop(self) -> None:
        """Show the whole volume again."""
        self._editor.change("Reset the crop box", crop=CropBox())


MOVE, TILT, CROP = "Move the clip plane", "Tilt the clip plane", "Move the crop box"


def cropped(crop: CropBox, index: int, low: float, high: float) -> CropBox:
    """Return the crop box with other bounds along one array axis; the bound that moved gives way."""
    if high - low < THINNEST:
        if low != crop.low[index]:
            low = max(0.0, high - THINNEST)
            high = max(high, low + THINNEST)
        else:
            high = min(1.0, low + THINNEST)
            low = min(low, high - THINNEST)
    lows, highs = list(crop.low), list(crop.high)
    lows[index], highs[index] = low, high
    return replace(crop, low=tuple(lows), high=tuple(highs))  # type: ignore[arg-type]


def moved_to(plane: ClipPlane, wanted: float, now: float) -> np.ndarray:
    """Return the plane's point moved along its normal from one offset to another."""
    return np.asarray(np.asarray(plane.point) + (wanted - now) * unit(plane.normal))


def cut_names(scene: Scene) -> tuple[str, ...]:
    """Return the names of the standard cuts: the patient's where they are known, and the eye's."""
    known = scene.volume is not None and scene.volume.info.orientation_known
    return (*(_CUTS if known else ("x", "y", "z")), "View")


def cut_normals(scene: Scene) -> list[np.ndarray]:
    """Return the unit normals of the standard cuts: the patient's or the array's axes, and the view."""
    volume, camera = scene.volume, scene.camera
    assert volume is not None
    assert camera is not None
    axes = np.eye(3) if volume.info.orientation_known else np.asarray(volume.direction).T
    return [*(unit(axis) for axis in axes), np.asarray(camera.basis().forward)]
