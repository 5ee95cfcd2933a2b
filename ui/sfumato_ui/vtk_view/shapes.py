"""The geometry in VTK's view: an actor for each, one with less in it while something moves, and the volume's box."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from qtpy.QtCore import QObject, Signal

from sfumato import Geometry, Lines, Scene
from sfumato.geometry import kept_lines
from sfumato.geometry.preview import Preview

from ..editing import Editor
from .builder import PreviewBuilder
from .screen import VtkScreen


@dataclass
class _Shown:
    """A geometry, what is shown of it, and its actors: in full, and while something moves."""

    geometry: Geometry
    preview: Preview
    full: Any
    moving: Any

    def let_see(self, visible: bool, moving: bool) -> None:
        """Show the one actor or the other, or neither."""
        for actor in (self.full, self.moving):
            if actor is not None:
                actor.SetVisibility(visible and actor is (self.moving if moving else self.full))


class ShownShapes(QObject):
    """Keeps VTK's actors as the scene has its geometry; they are built away from the window's thread."""

    #: Not all lines are shown, or all again (a sentence, or nothing).
    thinned = Signal(str)

    def __init__(self, screen: VtkScreen, editor: Editor) -> None:
        super().__init__(screen)
        self._screen, self._editor = screen, editor
        self._shown: dict[int, _Shown] = {}
        self._box: Any = None
        self._builder = PreviewBuilder(self)
        self._builder.built.connect(self._on_built)
        self._builder.failed.connect(self.thinned)
        screen.moving_changed.connect(lambda moving: self._see())

    def close(self) -> None:
        """Build nothing more."""
        self._builder.close()

    @property
    def busy(self) -> bool:
        """Whether some of the scene's geometry is still being built."""
        scene = self._editor.scene.geometry
        return any(
            i not in self._shown or self._shown[i].geometry.mesh_key != g.mesh_key
            for i, g in enumerate(scene)
        )

    def show_scene(self, scene: Scene) -> None:
        """Show a scene's geometry, and the box of its volume."""
        for index in [i for i in self._shown if i >= len(scene.geometry)]:
            self._remove(self._shown.pop(index))
        for index, geometry in enumerate(scene.geometry):
            known = self._shown.get(index)
            if known is None or known.geometry.mesh_key != geometry.mesh_key:
                self._builder.want(index, geometry)
        self._see()
        self._show_box(scene)

    def _see(self) -> None:
        scene = self._editor.scene.geometry
        for index, item in self._shown.items():
            item.let_see(index < len(scene) and scene[index].visible, self._screen.moving)

    def _on_built(self, index: int, geometry: Geometry, preview: Preview) -> None:
        """Put what was built in the place of what was there, if the scene still wants it."""
        wanted = self._editor.scene.geometry
        if index >= len(wanted) or wanted[index].mesh_key != geometry.mesh_key:
            return
        if index in self._shown:
            self._remove(self._shown[index])
        full = self._actor(geometry, preview.poly)
        same = preview.moving is preview.poly
        self._shown[index] = _Shown(
            geometry, preview, full, full if same else self._actor(geometry, preview.moving, 1.0)
        )
        self._see()
        self._screen.redraw()
        self.thinned.emit(self._thinned_text())

    def _thinned_text(self) -> str:
        """Tell how many of the lines are shown here, if not all."""
        lines = [item for item in self._shown.values() if isinstance(item.geometry.shape, Lines)]
        shown = sum(len(item.preview.numbers) for item in lines)
        kept = sum(int(kept_lines(item.geometry).sum()) for item in lines)
        return f"{shown:,} of {kept:,} lines are shown here".replace(",", " ") if shown < kept else ""

    def _actor(self, geometry: Geometry, poly: Any, width: float = 1.5) -> Any:
        """Return what shows poly data; nothing where the filters leave nothing."""
        if not poly.GetNumberOfPoints():
            return None
        import pyvista

        return self._screen.view.add_mesh(
            pyvista.wrap(poly), rgb=True, line_width=width, lighting=not isinstance(geometry.shape, Lines),
            reset_camera=False, render=False, show_scalar_bar=False, pickable=True,
        )  # fmt: skip

    def _remove(self, item: _Shown) -> None:
        for actor in (item.full, item.moving):
            if actor is not None:
                self._screen.view.remove_actor(actor, render=False)

    def _show_box(self, scene: Scene) -> None:
        view = self._screen.view
        if self._box is not None:
            view.remove_actor(self._box, render=False)
            self._box = None
        corners = scene.volume.corners() if scene.volume is not None else None
        if corners is None:
            return
        # Corner i has the bits (x, y, z) of its place: edges join those that differ in one.
        edges = [(i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit]
        import pyvista

        box = pyvista.PolyData(corners, lines=np.ravel([(2, a, b) for a, b in edges]))
        self._box = view.add_mesh(
            box, color="white", opacity=0.5, line_width=1, lighting=False,
            reset_camera=False, render=False, pickable=False,
        )  # fmt: skip

    # -- for picking --------------------------------------------------------------------------------
    def lines(self) -> list[tuple[int, np.ndarray, np.ndarray, np.ndarray]]:
        """Return what lines are seen: place in the scene, points (n, 3), where each line begins, its number there."""
        from vtkmodules.util import numpy_support

        to_numpy: Any = numpy_support.vtk_to_numpy
        found = []
        for index, item in self._shown.items():
            if self._seen(index, item) and isinstance(item.geometry.shape, Lines):
                poly = item.preview.poly
                offsets = to_numpy(poly.GetLines().GetOffsetsArray())
                found.append((index, to_numpy(poly.GetPoints().GetData()), offsets, item.preview.numbers))
        return found

    def surfaces(self) -> list[Any]:
        """Return the actors of the surfaces that are seen."""
        return [
            item.full for index, item in self._shown.items()
            if self._seen(index, item) and not isinstance(item.geometry.shape, Lines)
        ]  # fmt: skip

    def _seen(self, index: int, item: _Shown) -> bool:
        """Tell whether a geometry is shown as the scene has it now."""
        scene = self._editor.scene.geometry
        current = index < len(scene) and scene[index].shape is item.geometry.shape
        return current and scene[index].visible and item.full is not None
