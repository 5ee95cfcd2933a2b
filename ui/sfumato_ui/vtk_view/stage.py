"""What VTK shows: the geometry as lines and surfaces, the volume's box, and a camera linked both ways."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from qtpy.QtCore import QEvent, QObject, QPointF, Qt, QTimer, Signal
from qtpy.QtGui import QMouseEvent
from qtpy.QtWidgets import QWidget

from sfumato import Geometry, Lines, Scene
from sfumato.geometry import kept_lines
from sfumato.geometry.preview import line_poly

from ..editing import Editor
from ..subject import bounds_of, size_of
from ..theme import PICTURE_GREY
from .builder import PolyBuilder
from .link import camera_of, same_view, show_camera

#: A click is a press and a release within so many pixels.
CLICK_PIXELS = 4
#: How near a click must come to a line, as a part of the view's diagonal.
PICK_TOLERANCE = 0.008
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
        Where, world mm.
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
    #: A click, wherever: the point on what it met, or at the depth of the camera's focus (x, y, z in mm).
    clicked = Signal(object)
    #: Not all lines are shown, or all again (a sentence, or nothing).
    thinned = Signal(str)

    def __init__(self, editor: Editor, parent: QWidget) -> None:
        super().__init__(parent)
        from pyvistaqt import QtInteractor

        self._editor = editor
        self._following = False
        self._pressed: QPointF | None = None
        #: By place in the scene: geometry, its actor (None if nothing of it is left), what its cells are.
        self._actors: dict[int, tuple[Geometry, Any, np.ndarray]] = {}
        self._builder = PolyBuilder(self)
        self._builder.built.connect(self._on_built)
        self._builder.failed.connect(self.thinned)
        self._box: Any = None
        self._mark: Any = None
        self._dots: Any = None
        make: Any = QtInteractor
        self.view: Any = make(parent, auto_update=False)
        # pyvista's own keys (q, e, w, …) would close or change the view behind the document's back.
        self.view.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.view.set_background([c / 255 for c in _rgb(PICTURE_GREY)])
        self.view.enable_trackball_style()
        self.view.installEventFilter(self)
        self._listen()
        self._redraw = QTimer(self)
        self._redraw.setSingleShot(True)
        self._redraw.setInterval(0)
        self._redraw.timeout.connect(self._render)
        self._after = QTimer(self)
        self._after.setSingleShot(True)
        self._after.setInterval(0)
        self._after.timeout.connect(self._follow_vtk)
        editor.changed.connect(self._on_changed)
        self.show_scene(editor.scene)

    def _listen(self) -> None:
        style = self.view.iren.interactor.GetInteractorStyle()
        style.AddObserver("StartInteractionEvent", lambda *_: self._editor.begin(MOVE))
        style.AddObserver("InteractionEvent", lambda *_: self._after.start())
        style.AddObserver("EndInteractionEvent", lambda *_: self._end_move())

    def close(self) -> None:
        """Give VTK's context back, on this thread, while the widget is still there."""
        self._editor.changed.disconnect(self._on_changed)
        self._builder.close()
        self._redraw.stop()
        self._after.stop()
        self.view.removeEventFilter(self)
        self.view.close()

    # -- the scene --------------------------------------------------------------------------------
    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.geometry != new.geometry or old.volume is not new.volume:
            self.show_scene(new)
        elif old.camera != new.camera:
            self._follow_ours()

    def show_scene(self, scene: Scene) -> None:
        """Show the scene's geometry, the box of its volume and what its camera sees."""
        for index in [i for i in self._actors if i >= len(scene.geometry)]:
            self._remove(self._actors.pop(index)[1])
        for index, geometry in enumerate(scene.geometry):
            self._show_geometry(index, geometry)
        self._show_box(scene)
        self.mark(None)
        self._follow_ours()

    @property
    def busy(self) -> bool:
        """Whether some of the scene's geometry is still being built."""
        shown = self._editor.scene.geometry
        known = [self._actors.get(i) for i in range(len(shown))]
        keys = zip(known, shown, strict=True)
        return any(k is None or k[0].mesh_key != g.mesh_key for k, g in keys)

    def _show_geometry(self, index: int, geometry: Geometry) -> None:
        known = self._actors.get(index)
        if known is not None and known[0].mesh_key == geometry.mesh_key:
            if known[1] is not None:
                known[1].SetVisibility(geometry.visible)
            return
        self._builder.want(index, geometry)

    def _on_built(self, index: int, geometry: Geometry, made: tuple[Any, np.ndarray]) -> None:
        """Put what was built in the place of what was there, if the scene still wants it."""
        wanted = self._editor.scene.geometry
        if index >= len(wanted) or wanted[index].mesh_key != geometry.mesh_key:
            return
        known = self._actors.get(index)
        if known is not None:
            self._remove(known[1])
        poly, numbers = made
        self._actors[index] = (geometry, self._actor(wanted[index], poly), numbers)
        self.redraw()
        self.thinned.emit(self._thinned_text())

    def _thinned_text(self) -> str:
        """Tell how many of the lines are shown here, if not all."""
        lines = [(g, n) for g, _, n in self._actors.values() if isinstance(g.shape, Lines)]
        shown, kept = sum(len(n) for _, n in lines), sum(int(kept_lines(g).sum()) for g, _ in lines)
        return f"{shown:,} of {kept:,} lines are shown here".replace(",", " ") if shown < kept else ""

    def _actor(self, geometry: Geometry, poly: Any) -> Any:
        """Return what shows poly data; nothing where the filters leave nothing."""
        if not poly.GetNumberOfPoints():
            return None
        import pyvista

        actor = self.view.add_mesh(
            pyvista.wrap(poly), rgb=True, line_width=1.5, lighting=not isinstance(geometry.shape, Lines),
            reset_camera=False, render=False, show_scalar_bar=False, pickable=True,
        )  # fmt: skip
        actor.SetVisibility(geometry.visible)
        return actor

    def _remove(self, actor: Any) -> None:
        if actor is not None:
            self.view.remove_actor(actor, render=False)

    def _show_box(self, scene: Scene) -> None:
        if self._box is not None:
            self.view.remove_actor(self._box, render=False)
            self._box = None
        corners = scene.volume.corners() if scene.volume is not None else None
        if corners is None:
            return
        # Corner i has the bits (x, y, z) of its place: edges join those that differ in one.
        edges = [(i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit]
        import pyvista

        box = pyvista.PolyData(corners, lines=np.ravel([(2, a, b) for a, b in edges]))
        self._box = self.view.add_mesh(
            box, color="white", opacity=0.5, line_width=1, lighting=False,
            reset_camera=False, render=False, pickable=False,
        )  # fmt: skip

    def mark(self, pick: Pick | None) -> None:
        """Show which line is picked."""
        if self._mark is not None:
            self.view.remove_actor(self._mark, render=False)
            self._mark = None
        if pick is not None:
            import pyvista

            line = pyvista.wrap(line_poly(self._editor.scene.geometry[pick.geometry], pick.line))
            self._mark = self.view.add_mesh(
                line,
                color=PICKED,
                line_width=5,
                lighting=False,
                reset_camera=False,
                render=False,
                pickable=False,
            )
        self.redraw()

    def show_points(self, places: tuple[tuple[float, float, float], ...]) -> None:
        """Show single seeds."""
        self._remove(self._dots)
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
        self._redraw.start()

    def _render(self) -> None:
        corners = bounds_of(self._editor.scene)
        if corners is not None:
            low, high = corners.min(axis=0), corners.max(axis=0)
            margin = 0.05 * size_of(self._editor.scene)
            box = np.stack([low - margin, high + margin], axis=1).ravel()
            self.view.renderer.ResetCameraClippingRange(*map(float, box))
        self.view.render()

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
        from vtkmodules.vtkRenderingCore import vtkCellPicker

        picker = vtkCellPicker()
        picker.SetTolerance(PICK_TOLERANCE)
        ratio = self.view.devicePixelRatioF()
        x, y = at.x() * ratio, (self.view.height() - 1 - at.y()) * ratio
        picker.Pick(x, y, 0, self.view.renderer)
        found = self._of_actor(picker.GetActor(), picker.GetCellId())
        made = None if found is None else Pick(*found, tuple(float(v) for v in picker.GetPickPosition()))  # type: ignore[arg-type]
        self.mark(made)
        self.picked.emit(made)
        self.clicked.emit(tuple(float(v) for v in picker.GetPickPosition()))

    def _of_actor(self, actor: Any, cell: int) -> tuple[int, int] | None:
        for index, (geometry, own, numbers) in self._actors.items():
            scene = self._editor.scene.geometry
            current = index < len(scene) and scene[index].shape is geometry.shape
            if own is actor and current and 0 <= cell < len(numbers) and isinstance(geometry.shape, Lines):
                return index, int(numbers[cell])
        return None


def _rgb(color: str) -> tuple[int, int, int]:
    from qtpy.QtGui import QColor

    shown = QColor(color)
    return shown.red(), shown.green(), shown.blue()
