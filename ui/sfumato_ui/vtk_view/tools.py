"""Seeds and regions by VTK's own widgets: a sphere, a line, a plane, a box that the hand moves in the view."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from qtpy.QtCore import QObject, Signal

from sfumato import Roi, Seeds
from sfumato.scene.vectors import vec3

from .stage import VtkStage

#: Of the subject's diagonal: how large a widget is at first.
FIRST_SIZE = 0.12
_WIDGETS = {
    "sphere": "vtkSphereWidget",
    "line": "vtkLineWidget",
    "plane": "vtkPlaneWidget",
    "box": "vtkBoxWidget",
}


class PlacingTool(QObject):
    """One of VTK's widgets at a time; tells where it is once it is let go."""

    #: It was moved by hand, or is there for the first time.
    placed = Signal()

    def __init__(self, stage: VtkStage) -> None:
        super().__init__(stage)
        self._stage = stage
        self._widget: Any = None
        self.kind = ""

    def show(self, kind: str, bounds: np.ndarray) -> None:
        """Show a widget in the middle of a box; the kinds are those of `Seeds`, and ``box``.

        Parameters
        ----------
        bounds : ndarray, shape (2, 3)
            Smallest and largest coordinates in mm.
        """
        self.hide()
        from vtkmodules import vtkInteractionWidgets

        middle = bounds.mean(axis=0)
        half = FIRST_SIZE * float(np.linalg.norm(bounds[1] - bounds[0]))
        widget = getattr(vtkInteractionWidgets, _WIDGETS[kind])()
        widget.SetInteractor(self._stage.view.iren.interactor)
        widget.SetCurrentRenderer(self._stage.view.renderer)
        widget.SetPlaceFactor(1.0)
        _prepare(kind, widget)
        widget.PlaceWidget(*np.stack([middle - half, middle + half], axis=1).ravel().tolist())
        if kind == "sphere":
            widget.SetRadius(half)
        widget.AddObserver("EndInteractionEvent", lambda *_: self.placed.emit())
        widget.On()
        self._widget, self.kind = widget, kind
        self._stage.redraw()

    def hide(self) -> None:
        """Take the widget away."""
        if self._widget is not None:
            self._widget.Off()
            self._widget.RemoveAllObservers()
            self._widget.SetInteractor(None)
            self._widget = None
            self._stage.redraw()
        self.kind = ""

    @property
    def radius(self) -> float:
        """Radius of the sphere in mm."""
        return float(self._widget.GetRadius()) if self.kind == "sphere" else 0.0

    def set_radius(self, radius: float) -> None:
        """Give the sphere another radius."""
        if self.kind == "sphere":
            self._widget.SetRadius(radius)
            self._stage.redraw()
            self.placed.emit()

    def seeds(self, count: int) -> Seeds:
        """Return seeds where the widget is."""
        seeds = Seeds(kind=self.kind, count=count)
        if self.kind == "sphere":
            return replace(seeds, center=self._widget.GetCenter(), radius=self._widget.GetRadius())
        if self.kind == "line":
            return replace(seeds, start=self._widget.GetPoint1(), end=self._widget.GetPoint2())
        corner = np.asarray(self._widget.GetOrigin())
        u, v = (np.asarray(p) - corner for p in (self._widget.GetPoint1(), self._widget.GetPoint2()))
        return replace(seeds, center=vec3(corner + (u + v) / 2), edge_u=vec3(u), edge_v=vec3(v))

    def region(self) -> Roi:
        """Return the region that the box is."""
        from vtkmodules.vtkCommonDataModel import vtkPolyData

        corners = vtkPolyData()
        self._widget.GetPolyData(corners)
        low, high = np.asarray(corners.GetBounds()).reshape(3, 2).T
        return Roi(kind="box", center=vec3((low + high) / 2), size=vec3(np.maximum((high - low) / 2, 1e-6)))


def _prepare(kind: str, widget: Any) -> None:
    if kind == "sphere":
        widget.SetRepresentationToWireframe()
    elif kind == "plane":
        widget.SetRepresentationToOutline()
    elif kind == "line":
        widget.SetAlignToXAxis()
    else:
        widget.RotationEnabledOff()
