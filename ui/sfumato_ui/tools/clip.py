"""The Clip tool: crop box and clip planes by their handles; beside them a drag turns the subject."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import Qt
from qtpy.QtGui import QPainter

from ..clip_planes import CROP, MOVE, TILT, Axis, ClipPlanes
from ..editing import Editor
from . import crop, planes
from .handles import Handle, HandleTool, draw_line
from .view import PictureView, Place

_Grip = crop.FaceGrip | planes.MoveGrip | planes.TiltGrip


class ClipTool(HandleTool):
    """Six faces of the crop box, and two handles for each plane."""

    cursor = Qt.CursorShape.ArrowCursor

    def __init__(self, editor: Editor, clips: ClipPlanes) -> None:
        super().__init__()
        self._editor, self._clips = editor, clips
        self._grip: _Grip | None = None

    def handles(self, view: PictureView) -> list[Handle]:
        """Planes lie before faces."""
        scene = self._editor.scene
        if scene.volume is None:
            return []
        held = self._grip if self.taken and isinstance(self._grip, crop.FaceGrip) else None
        return planes.handles(scene, view) + crop.handles(scene, view, held)

    def begin(self, handle: Handle, view: PictureView, at: Place) -> str:
        """Take a face or a plane; the plane is selected."""
        scene, (kind, index, part) = self._editor.scene, handle.key.split(".")
        if kind == "crop":
            self._grip = crop.FaceGrip(scene, view, handle, at)
            return CROP
        self._clips.select(int(index))
        grip = planes.MoveGrip if part == "move" else planes.TiltGrip
        self._grip = grip(scene, view, int(index), at)
        return MOVE if part == "move" else TILT

    def drag(self, view: PictureView, at: Place) -> None:
        """Move what is in the hand."""
        grip = self._grip
        if isinstance(grip, crop.FaceGrip):
            self._editor.change(CROP, True, crop=grip.moved(view, at))
        elif grip is not None:
            _, index, part = self.taken.split(".")
            label = MOVE if part == "move" else TILT
            self._editor.change(label, True, **{f"clip.{index}": grip.moved(view, at)})

    def nudge(self, view: PictureView, right: int, up: int, large: bool) -> bool:
        """Move the focused handle by a voxel or a degree, with Shift by ten, as the arrow points."""
        handle = next((h for h in self.handles(view) if h.key == self.focused), None)
        scene = self._editor.scene
        if handle is None or scene.volume is None:
            return False
        kind, index, part = handle.key.split(".")
        times = 10.0 if large else 1.0
        if part == "tilt":
            plane = planes.tilted_by(scene, view, int(index), right * times, up * times)
            return self._editor.change(TILT, True, **{f"clip.{index}": plane})
        steps = times * _sign_along(handle, right, up)
        if kind == "plane":
            grip = planes.MoveGrip(scene, view, int(index), handle.at)
            plane = grip.travelled(steps * scene.volume.min_spacing)
            return self._editor.change(MOVE, True, **{f"clip.{index}": plane})
        axis = Axis(scene.volume, int(index))
        travel = steps * scene.volume.spacing[axis.index]
        return self._editor.change(CROP, True, crop=crop.with_face(scene.crop, axis, part == "1", travel))

    def paint(self, painter: QPainter, view: PictureView) -> None:
        """Draw box, outlines and handles."""
        scene = self._editor.scene
        if scene.volume is None:
            return
        for a, b in crop.edges(scene, view):
            draw_line(painter, a, b)
        for i, plane in enumerate(scene.clip):
            if not plane.enabled:
                continue
            corners = planes.outline(scene, plane)
            around = np.stack([np.arange(len(corners)) - 1, np.arange(len(corners))], axis=-1)
            for a, b in view.segments(corners, around):
                draw_line(painter, a, b, strong=i == self._clips.selected)
            middle = view.place(planes.pivot(scene, view, plane))
            if middle is not None:
                draw_line(painter, middle, planes.arm_place(view, middle, plane))
        self.paint_handles(painter, view)


def _sign_along(handle: Handle, right: int, up: int) -> float:
    """Return 1 or -1: whether an arrow points along a handle's way; right and up count as forth if neither."""
    along = handle.along or (1.0, 0.0)
    way = along[0] * right + along[1] * up
    return (1.0 if way > 0 else -1.0) if abs(way) > 0.2 else float(right + up)
