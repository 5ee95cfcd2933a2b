"""What the slice views share: the cross-hair, the part that is seen, window and level. No part of the scene."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QObject, Signal

from sfumato import Scene, Volume
from sfumato.scene.presets.values import hounsfield_zero
from sfumato.slicing import CUTS, Cut, NamedWindow, ValueWindow, cuts_of, first_point, step_along

#: How far in one can zoom, and out.
CLOSEST, FARTHEST = 60.0, 0.5


class SliceState(QObject):
    """One cross-hair, one zoom and one window for all three views."""

    #: The cross-hair, or the part that is seen, is another: slices may have to be made anew.
    moved = Signal()
    #: Window and level, or those to choose from, are others.
    windowed = Signal()
    #: Another volume is shown, or none.
    replaced = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.volume: Volume | None = None
        self.cuts: tuple[Cut, ...] = CUTS
        #: World places in mm: of the cross-hair, and of what is in the middle of all views.
        self.cross, self.middle = np.zeros(3), np.zeros(3)
        self.zoom = 1.0
        #: mm per pixel at which the volume fits into all views.
        self.fit = 1.0
        #: None until the volume's windows are known.
        self.window: ValueWindow | None = None
        self.windows: tuple[NamedWindow, ...] = ()
        #: Stored value of 0 HU; None if the values are no Hounsfield units, or it is not known yet.
        self.zero: float | None = None
        self._bounds = np.zeros((2, 3))

    # -- the volume -------------------------------------------------------------------------------
    def show(self, scene: Scene) -> None:
        """Show a scene's volume; one in the same place as the last (a time step) keeps cross-hair, part and window."""
        before, volume = self.volume, scene.volume
        if volume is before:
            return
        self.volume = volume
        self.windows, self.zero = (), None
        if volume is not None and not (before is not None and same_place(before, volume)):
            corners = volume.corners()
            self._bounds = np.stack([corners.min(axis=0), corners.max(axis=0)])
            self.cuts, self.cross = cuts_of(volume), np.asarray(first_point(volume))
            self.window = None
            self._show_all()
        self.replaced.emit()
        self.moved.emit()

    def offer(self, volume: Volume, windows: tuple[NamedWindow, ...]) -> None:
        """Take the windows that suit a volume, unless another is open by now; a first window is chosen."""
        if volume is self.volume:
            self.windows, self.zero = windows, hounsfield_zero(volume)
            if self.window is None:
                self.window = windows[0].window
            self.windowed.emit()

    # -- the cross-hair ---------------------------------------------------------------------------
    def go_to(self, point: object) -> None:
        """Move the cross-hair to a world point, or the nearest one in the volume's box."""
        wanted = np.clip(np.asarray(point, dtype=float), *self._bounds)
        if self.volume is not None and not np.array_equal(wanted, self.cross):
            self.cross = wanted
            self.moved.emit()

    def step(self, cut: Cut, right: float, up: float, away: float) -> None:
        """Move the cross-hair by slices to the right, upwards and away from the viewer of a cut."""
        if self.volume is None:
            return
        ways = ((right, cut.right), (up, cut.up), (away, -cut.back))
        move = [count * step_along(self.volume, way) * np.asarray(way) for count, way in ways if count]
        self.go_to(self.cross + sum(move, np.zeros(3)))

    # -- the part that is seen --------------------------------------------------------------------
    @property
    def mm_per_pixel(self) -> float:
        """Scale of all views."""
        return self.fit / self.zoom

    def middle_of(self, cut: Cut) -> np.ndarray:
        """Return the point of a cut's slice, world mm, that is in the middle of its view."""
        return np.asarray(self.middle + cut.back * float(cut.back @ (self.cross - self.middle)))

    def set_fit(self, fit: float) -> None:
        """Take the scale at which the volume fits into the views."""
        if fit != self.fit:
            self.fit = fit
            self.moved.emit()

    def pan(self, shift: np.ndarray) -> None:
        """Move what is seen by a vector of the world in mm; its middle stays in the volume's box."""
        self.middle = np.clip(self.middle - shift, *self._bounds)
        self.moved.emit()

    def zoom_about(self, point: np.ndarray, factor: float) -> None:
        """Zoom by a factor; a world point stays where it is seen."""
        zoom = min(max(self.zoom * factor, FARTHEST), CLOSEST)
        factor, self.zoom = zoom / self.zoom, zoom
        self.middle = np.clip(point + (self.middle - point) / factor, *self._bounds)
        self.moved.emit()

    @property
    def is_whole(self) -> bool:
        """Whether the whole volume is seen, as it was at first."""
        return self.zoom == 1.0 and np.allclose(self.middle, self._bounds.mean(axis=0))

    def show_whole(self) -> None:
        """Take zoom and pan back."""
        self._show_all()
        self.moved.emit()

    def _show_all(self) -> None:
        self.zoom, self.middle = 1.0, self._bounds.mean(axis=0)

    # -- window and level -------------------------------------------------------------------------
    def set_window(self, window: ValueWindow) -> None:
        """Show other values as black and white."""
        if window != self.window:
            self.window = window
            self.windowed.emit()

    def drag_window(self, start: ValueWindow, right: float, up: float) -> None:
        """Take the window of a drag; lengths as in `ValueWindow.dragged`."""
        if self.volume is not None:
            self.set_window(start.dragged(right, up).limited(self.volume))

    def reset_window(self) -> None:
        """Take the window that suits the volume best."""
        if self.windows:
            self.set_window(self.windows[0].window)

    @property
    def window_name(self) -> str:
        """Name of the window, if it is one of those to choose from."""
        return next((named.name for named in self.windows if named.window == self.window), "")


def same_place(a: Volume, b: Volume) -> bool:
    """Tell whether two volumes have the same voxels' places."""
    return a.dims == b.dims and np.array_equal(a.world_from_texture, b.world_from_texture)


__all__ = ["SliceState", "same_place"]
