"""VTK's view of the scene: its shapes, a camera linked both ways, and what a click meets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from qtpy.QtCore import QEvent, QObject, QPointF, Qt, QTimer, Signal
from qtpy.QtGui import QMouseEvent
from qtpy.QtWidgets import QWidget

from sfumato import Scene
from sfumato.geometry.preview import line_poly

from ..editing import Editor
from ..subject import bounds_of, size_of
from ..theme import PICTURE_GREY
from ..tools.view import PictureView
from .link import camera_of, same_view, show_camera
from .picking import Found, line_under, under_pointer
from .screen import VtkScreen
from .shapes import ShownShapes

#: A click is a press and a release within so many pixels.
CLICK_PIXELS = 4
#: What a move of VTK's camera is called in the history.
MOVE = "Move the camera"
#: Colour of the line that is picked, sRGB.
PICKED = (1.0, 0.85, 0.2)


@dataclass(frozen=True)
class Pick:
    """A line that was picked.

    Parameters
    ----------
    geometry : int
        Index in the scene.
    line : int
        Number of the line.
    point : (x, y, z)
        Where on it, world mm.
    """

    geometry: int
    line: int
    point: tuple[float, float, float]


class VtkStage(QObject):
    """VTK's renderer in a widget; lives on the window's thread.

    Parameters
    ----------
    parent : QWidget
        Where the widget is put.

    Raises
    ------
    Exception
        Whatever pyvistaqt or VTK raise where there is no OpenGL for them; the panel reports it.
    """

    #: A line was picked (`Pick`), or a click met nothing (None).
    picked = Signal(object)
    #: A click, wherever: the point under it on what it met, or at the depth of the camera's focus (x, y, z in mm).
    clicked = Signal(object)
    #: Not all lines are shown, or all again (a sentence, or nothing).
    thinned = Signal(str)

    def __init__(self, editor: Editor, parent: QWidget) -> None:
        super().__init__(parent)
        self._editor = editor
        self._following = False
        self._pressed: QPointF | None = None
        self._mark: Any = None
        self._dots: Any = None
        self.screen = VtkScreen(parent, self._before_paint)
        self.view: Any = self.screen.view
        self.view.set_background([c / 255 for c in _rgb(PICTURE_GREY)])
        self.shapes = ShownShapes(self.screen, editor)
        self.shapes.thinned.connect(self.thinned)
        self.view.installEventFilter(self)
        self._listen()
        self._after = QTimer(self)
        self._after.setSingleShot(True)
        self._after.setInterval(0)
        self._after.timeout.connect(self._follow_vtk)
        editor.changed.connect(self._on_changed)
        self.show_scene(editor.scene)

    def _listen(self) -> None:
        style = self.screen.interactor.GetInteractorStyle()
        style.AddObserver("StartInteractionEvent", lambda *_: self._editor.begin(MOVE))
        style.AddObserver("InteractionEvent", lambda *_: self._after.start())
        style.AddObserver("EndInteractionEvent", lambda *_: self._end_move())

    def close(self) -> None:
        """Give VTK's context back, on this thread, while the widget is still there."""
        self._editor.changed.disconnect(self._on_changed)
        self.shapes.close()
        self._after.stop()
        self.view.removeEventFilter(self)
        self.screen.close()

    # -- the scene --------------------------------------------------------------------------------
    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.geometry != new.geometry or old.volume is not new.volume:
            self.show_scene(new)
        elif old.camera != new.camera:
            self._follow_ours()
            self.screen.move()

    def show_scene(self, scene: Scene) -> None:
        """Show the scene's geometry, the box of its volume and what its camera sees."""
        self.shapes.show_scene(scene)
        self.mark(None)
        self._follow_ours()

    @property
    def busy(self) -> bool:
        """Whether some of the scene's geometry is still being built."""
        return self.shapes.busy

    def mark(self, pick: Pick | None) -> None:
        """Show which line is picked."""
        if self._mark is not None:
            self.view.remove_actor(self._mark, render=False)
            self._mark = None
        if pick is not None:
            import pyvista

            line = pyvista.wrap(line_poly(self._editor.scene.geometry[pick.geometry], pick.line))
            self._mark = self.view.add_mesh(
                line, color=PICKED, line_width=5, lighting=False,
                reset_camera=False, render=False, pickable=False,
            )  # fmt: skip
        self.redraw()

    def show_points(self, places: tuple[tuple[float, float, float], ...]) -> None:
        """Show single seeds."""
        if self._dots is not None:
            self.view.remove_actor(self._dots, render=False)
            self._dots = None
        if places:
            import pyvista

            self._dots = self.view.add_mesh(
                pyvista.PolyData(np.asarray(places, np.float32)), color=PICKED, point_size=9,
                render_points_as_spheres=True, reset_camera=False, render=False, pickable=False,
            )  # fmt: skip
        self.redraw()

    # -- the camera -------------------------------------------------------------------------------
    def _follow_ours(self) -> None:
        if self._following:  # VTK has moved its camera itself, and drawn it
            return
        camera = self._editor.scene.camera
        if camera is not None:
            show_camera(camera, self.view.renderer.GetActiveCamera())
        self.redraw()

    def _end_move(self) -> None:
        self._follow_vtk()
        self._editor.end()

    def _follow_vtk(self) -> None:
        ours, moved = self._editor.scene.camera, camera_of(self.view.renderer.GetActiveCamera())
        if ours is None or same_view(ours, moved):
            return
        self._following = True
        self._editor.change(MOVE, True, camera=moved)
        self._following = False

    def redraw(self) -> None:
        """Draw soon, once for all that changed."""
        self.screen.redraw()

    def _before_paint(self) -> None:
        """Let VTK's near and far planes enclose all that is shown."""
        corners = bounds_of(self._editor.scene)
        if corners is not None:
            low, high = corners.min(axis=0), corners.max(axis=0)
            margin = 0.05 * size_of(self._editor.scene)
            box = np.stack([low - margin, high + margin], axis=1).ravel()
            self.view.renderer.ResetCameraClippingRange(*map(float, box))

    # -- picking ----------------------------------------------------------------------------------
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Tell clicks from drags."""
        if isinstance(event, QMouseEvent) and event.button() == Qt.MouseButton.LeftButton:
            at = event.position()
            if event.type() == QEvent.Type.MouseButtonPress:
                self._pressed = at
            elif event.type() == QEvent.Type.MouseButtonRelease and self._pressed is not None:
                moved = at - self._pressed
                self._pressed = None
                if math.hypot(moved.x(), moved.y()) <= CLICK_PIXELS:
                    self.pick(at)
        return super().eventFilter(watched, event)

    def pick(self, at: QPointF) -> None:
        """Pick the line under a place of the widget, and tell of it."""
        camera = self._editor.scene.camera
        if camera is None:
            return
        view, place = PictureView(camera, self.view.width(), self.view.height()), (at.x(), at.y())
        hit = self._surface_depth(view, at)
        made, found = self._line_under(view, place, np.inf if hit is None else hit)
        depth = found.depth if found is not None else camera.distance if hit is None else hit
        self.mark(made)
        self.picked.emit(made)
        self.clicked.emit(under_pointer(view, place, depth))

    def _line_under(
        self, view: PictureView, place: tuple[float, float], before: float
    ) -> tuple[Pick | None, Found | None]:
        """Return the line under a place, before a depth."""
        best: tuple[Pick | None, Found | None] = (None, None)
        for index, points, offsets, numbers in self.shapes.lines():
            found = line_under(view, place, points, offsets, before)
            if found is not None and (best[1] is None or found.away < best[1].away):
                x, y, z = map(float, found.point)
                best = Pick(index, int(numbers[found.cell]), (x, y, z)), found
        return best

    def _surface_depth(self, view: PictureView, at: QPointF) -> float | None:
        """Return how far before the eye, in mm, the surface under a place of the widget lies, if there is one."""
        surfaces = self.shapes.surfaces()
        if not surfaces:
            return None
        from vtkmodules.vtkRenderingCore import vtkCellPicker

        picker = vtkCellPicker()
        picker.SetTolerance(0)
        picker.PickFromListOn()
        for actor in surfaces:
            picker.AddPickList(actor)
        ratio = self.view.devicePixelRatioF()
        x, y = at.x() * ratio, (self.view.height() - at.y()) * ratio
        return (
            view.depth(np.array(picker.GetPickPosition()))
            if picker.Pick(x, y, 0, self.view.renderer)
            else None
        )


def _rgb(color: str) -> tuple[int, int, int]:
    from qtpy.QtGui import QColor

    shown = QColor(color)
    return shown.red(), shown.green(), shown.blue()
