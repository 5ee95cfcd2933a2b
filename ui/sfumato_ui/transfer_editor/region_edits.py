"""Edits of the selected shape and of the list of shapes, each as a step of the history."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from qtpy.QtCore import QPointF

from sfumato import Region, SceneError, TransferFunction
from sfumato.scene import region_edit

from .new_shapes import LEAST, aside, new_region
from .region_canvas import NAMES, RegionCanvas


class RegionEdits(RegionCanvas):
    """What can be done to the regions of the scene's function, however the user asks for it."""

    def change_region(self, label: str, merge: bool = True, /, **fields: Any) -> None:
        """Change fields of the selected region."""
        if self.region is not None:
            self.put_region(label, replace(self.region, **fields), merge)

    def put_region(self, label: str, region: Region, merge: bool = False) -> None:
        """Put another region in the place of the selected one."""
        if self.transfer is not None:
            changed = region_edit.with_region(self.transfer, self.selected, region)
            self._apply(label, changed, self.selected, merge)

    def stretch(self, label: str, value: tuple[float, float], gradient: tuple[float, float]) -> None:
        """Give the selected region other extents, if they are any."""
        if self.region is not None:
            try:
                stretched = region_edit.with_extent(self.region, value, gradient)
            except SceneError as error:
                self._editor.rejected.emit(str(error))
            else:
                self.put_region(label, stretched, True)

    def add_shape(self, shape: str, at: QPointF | None = None) -> None:
        """Add a region of a shape at a place, else at what was picked, else in the middle; or begin to draw one."""
        if shape == "polygon":
            self.drawing = True
            self.setFocus()
            self.update()
            return
        volume = self._volume
        if volume is not None and self.transfer is not None:
            plane = self.plane
            about = plane.rect.center() if self.picked is None else plane.clamped(plane.at(*self.picked))
            region = (
                region_edit.whole_curve(volume)
                if shape == "curve"
                else new_region(shape, plane, about if at is None else at, self.regions)
            )
            self._apply(
                f"Add a {NAMES[shape].lower()}", *region_edit.with_region_added(self.transfer, region)
            )

    def remove_region(self) -> None:
        """Remove the selected region; the last one stays."""
        if self.transfer is not None:
            changed = region_edit.without_region(self.transfer, self.selected)
            self._apply("Remove the shape", changed, min(self.selected, len(changed.regions) - 1))

    def duplicate_region(self) -> None:
        """Add a copy of the selected region, a little aside, over it."""
        if self.transfer is None or self.region is None:
            return
        copy = aside(self.region, self.plane)
        changed, index = region_edit.with_region_added(self.transfer, copy, self.selected + 1)
        self._apply("Duplicate the shape", changed, index)

    def reorder_region(self, by: int) -> None:
        """Lay the selected region over (1) or under (-1) its neighbour."""
        if self.transfer is not None:
            self._apply(
                "Lay the shape over others" if by > 0 else "Lay the shape under others",
                *region_edit.reordered(self.transfer, self.selected, by),
            )

    def _apply(self, label: str, transfer: TransferFunction, index: int, merge: bool = False) -> None:
        if transfer == self.transfer or self._editor.change(label, merge, transfer=transfer):
            self.select(index)

    def _least(self) -> tuple[float, float]:
        across, up = self.plane.per_pixel
        return LEAST * across, LEAST * up
