"""The VTK view with its bar: what the hand does there, what was picked, undock and close."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from qtpy.QtCore import Qt, Signal
from qtpy.QtGui import QGuiApplication
from qtpy.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from sfumato import Lines, Roi, Scene, Surface, Tracing
from sfumato.geometry import has_vectors
from sfumato.scene import Seeds

from ..editing import Editor
from ..generated import ChoiceBox
from ..icons import icon
from ..sliders import NumberBox
from ..subject import bounds_of, size_of
from ..theme import current_theme
from .importing import VtkImporter
from .stage import Pick, VtkStage
from .tools import PlacingTool

TOOLS = {
    "look": "Pick lines",
    "box": "Region: box",
    "sphere": "Seeds: sphere",
    "line": "Seeds: line",
    "plane": "Seeds: plane",
    "points": "Seeds: points",
    "surface": "Seeds: on the surface",
}
#: Tools that place seeds, and which of them are one of VTK's widgets.
SEEDING = ("sphere", "line", "plane", "points", "surface")
WIDGETS = ("box", "sphere", "line", "plane")
HELP = {
    "look": "Click a line to pick it",
    "box": "Lines through the box stay",
    "sphere": "Drag the sphere: streamlines begin in it",
    "line": "Drag the line: streamlines begin on it",
    "plane": "Drag the plane: streamlines begin on it",
    "points": "Click where a streamline is to begin",
    "surface": "Streamlines begin on the surface",
}
#: Radius of the region that a pick keeps, as a part of the subject's diagonal.
KEPT_RADIUS = 0.02
SEEDS = 200


class VtkPanel(QFrame):
    """Bar and stage; the stage comes once VTK is imported."""

    #: VTK cannot show anything here; why.
    failed = Signal(str)
    #: Streamlines are to be traced (`Tracing`).
    trace_wanted = Signal(object)
    undock_wanted = Signal()
    close_wanted = Signal()

    def __init__(self, editor: Editor, docked: bool) -> None:
        super().__init__()
        self.setObjectName("VtkPanel")
        self._editor = editor
        self.stage: VtkStage | None = None
        self.placing: PlacingTool | None = None
        self._pick: Pick | None = None
        self._places: tuple[tuple[float, float, float], ...] = ()
        self._thinned = ""
        self._field = ("", False)
        self.tool = ChoiceBox()
        self.told = QLabel("Starting VTK…")
        self.keep = QPushButton("Keep lines here")
        self.all_lines = QPushButton("All lines")
        self.count, self.radius = NumberBox(), NumberBox()
        self.undock = _button("Undock the VTK view" if docked else "Dock the VTK view")
        self.shut = _button("Close the VTK view")
        self._lay_out()
        self._connect()
        self._importer = VtkImporter(self)
        self._importer.done.connect(self._on_imported)

    # -- building ---------------------------------------------------------------------------------
    def _lay_out(self) -> None:
        self.tool.setAccessibleName("What the hand does in the VTK view")
        self.told.setProperty("muted", True)
        self.told.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.keep.setToolTip("Show only the lines that pass near the picked point")
        self.all_lines.setToolTip("Take the regions away: show all lines")
        for button in (self.keep, self.all_lines):
            button.setProperty("compact", True)
        for box, name, suffix, top in (
            (self.count, "Seeds", " seeds", 20000),
            (self.radius, "Radius in mm", " mm", 9999),
        ):
            box.setAccessibleName(name)
            box.setSuffix(suffix)
            box.setRange(1 if box is self.count else 0.001, top)
            box.setKeyboardTracking(False)
        self.count.setDecimals(0)
        self.count.setValue(SEEDS)
        head, below = QHBoxLayout(), QHBoxLayout()
        for row, widgets in (
            (head, (self.tool, self.undock, self.shut)),
            (below, (self.told, self.count, self.radius, self.keep, self.all_lines)),
        ):
            row.setContentsMargins(8, 4, 8, 0)
            row.setSpacing(4)
            for widget in widgets:
                row.addWidget(widget, int(widget in (self.tool, self.told)))
        # The row keeps its height whatever it shows: else the view would jump under the hand at the first pick.
        tallest = max(w.sizeHint().height() for w in (self.count, self.radius, self.keep, self.all_lines))
        below.addStrut(tallest)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        self._column.addLayout(head)
        self._column.addLayout(below)
        self._room = QWidget()
        self._column.addWidget(self._room, 1)
        self.setMinimumWidth(260)
        self._show_tool()
        self.refresh_theme()

    def _connect(self) -> None:
        self.tool.activated.connect(lambda index: self._take_tool())
        self.keep.clicked.connect(self._keep_lines_here)
        self.all_lines.clicked.connect(self._show_all_lines)
        self.undock.clicked.connect(self.undock_wanted)
        self.shut.clicked.connect(self.close_wanted)
        self.count.valueChanged.connect(lambda value: self._on_placed())
        self.radius.valueChanged.connect(self._set_radius)
        self._editor.changed.connect(self._on_changed)

    def start(self) -> None:
        """Import VTK, then show its view."""
        self._importer.start()

    def _on_imported(self, problem: str) -> None:
        if QGuiApplication.platformName() in ("offscreen", "minimal"):
            problem = problem or "this screen has no OpenGL"
        if not problem:
            try:
                self.stage = VtkStage(self._editor, self)
            except Exception as error:  # whatever VTK, its wrapper or the driver raise
                problem = str(error) or type(error).__name__
        if problem or self.stage is None:
            self.failed.emit(problem)
            return
        self._column.removeWidget(self._room)
        self._room.deleteLater()
        self._column.addWidget(self.stage.view, 1)
        self.stage.picked.connect(self._on_picked)
        self.stage.clicked.connect(self._on_clicked)
        self.stage.thinned.connect(self._on_thinned)
        self.placing = PlacingTool(self.stage)
        self.placing.placed.connect(self._on_placed)
        self._take_tool()

    def close_stage(self) -> None:
        """Give VTK's context back; called before the panel is deleted."""
        self._importer.blockSignals(True)
        self._editor.changed.disconnect(self._on_changed)
        if self.placing is not None:
            self.placing.hide()
        if self.stage is not None:
            self.stage.close()
            self.stage = None

    # -- the tool ---------------------------------------------------------------------------------
    @property
    def tool_name(self) -> str:
        """Which of `TOOLS` is active."""
        return str(self.tool.currentData() or "look")

    def _offered(self) -> list[str]:
        scene = self._editor.scene
        lines = any(isinstance(g.shape, Lines) for g in scene.geometry)
        field = scene.volume is not None and self._has_vectors(scene.volume.info.path)
        seeding = [name for name in SEEDING if name != "surface" or self._surface()]
        return ["look", *(["box"] if lines else []), *(seeding if field else [])]

    def _has_vectors(self, path: str) -> bool:
        """Tell whether a file has vectors; it is looked at once."""
        if self._field[0] != path:
            self._field = (path, has_vectors(path))
        return self._field[1]

    def _surface(self) -> str:
        """Return the file of the first surface of the scene, or nothing."""
        geometry = self._editor.scene.geometry
        return next((g.path for g in geometry if isinstance(g.shape, Surface) and g.path), "")

    def _show_tool(self) -> None:
        """Offer what the scene allows, and show what the active tool needs."""
        offered, before = self._offered(), self.tool_name
        if offered != [self.tool.itemData(i) for i in range(self.tool.count())]:
            self.tool.clear()
            for name in offered:
                self.tool.addItem(TOOLS[name], name)
            self.tool.setCurrentIndex(max(0, self.tool.findData(before)))
        name = self.tool_name
        self.count.setVisible(name in SEEDING and name != "points")
        self.radius.setVisible(name == "sphere")
        self.keep.setVisible(name == "look" and self._pick is not None)
        self.all_lines.setVisible(any(g.rois for g in self._editor.scene.geometry))

    def _take_tool(self) -> None:
        name, corners = self.tool_name, bounds_of(self._editor.scene)
        self._places = ()
        self._tell_help()
        if self.stage is not None:
            self.stage.show_points(())
        if self.placing is not None:
            self.placing.hide()
            if name in WIDGETS and corners is not None:
                self.placing.show(name, np.stack([corners.min(axis=0), corners.max(axis=0)]))
            if name != "look":
                self._on_placed()
        if name == "sphere" and self.placing is not None:
            self.radius.blockSignals(True)
            self.radius.setValue(self.placing.radius)
            self.radius.blockSignals(False)
        self._show_tool()

    def _tell_help(self) -> None:
        thinned = f" ({self._thinned})" if self._thinned and self.tool_name == "look" else ""
        self.told.setText(HELP[self.tool_name] + thinned)
        self.told.setToolTip(self.told.text())

    def _on_thinned(self, text: str) -> None:
        self._thinned = text
        if self._pick is None:
            self._tell_help()

    def _set_radius(self, radius: float) -> None:
        if self.placing is not None:
            self.placing.set_radius(radius)

    def _on_placed(self) -> None:
        """Trace from where the seeds are, or keep the lines through the box."""
        if self.placing is not None and self.placing.kind == "box":
            self._set_regions("Choose lines by a box", (self.placing.region(),))
            return
        volume, seeds = self._editor.scene.volume, self._seeds()
        if volume is None or seeds is None:
            return
        # Length, steps and all else as in the streamlines that are replaced.
        known = [g.tracing for g in self._editor.scene.geometry if g.tracing is not None]
        same = next((t for t in known if t.path == volume.info.path), Tracing(path=volume.info.path))
        self.trace_wanted.emit(replace(same, seeds=seeds))

    def _seeds(self) -> Seeds | None:
        """Return the seeds of the active tool; nothing if it has none yet."""
        count, name = round(self.count.value()), self.tool_name
        if name == "surface" and self._surface():
            return Seeds(kind="surface", path=self._surface(), count=count)
        if name == "points":
            return Seeds(kind="points", places=self._places) if self._places else None
        return self.placing.seeds(count) if self.placing is not None and self.placing.kind else None

    def _on_clicked(self, point: tuple[float, float, float]) -> None:
        """Let a streamline begin where the click was."""
        if self.tool_name == "points" and self.stage is not None:
            self._places = (*self._places, point)
            self.stage.show_points(self._places)
            self._on_placed()

    # -- picking ----------------------------------------------------------------------------------
    def _on_picked(self, pick: Pick | None) -> None:
        if self.tool_name != "look":
            return
        self._pick = pick
        if pick is not None:
            self.told.setText(self._pick_text(pick))
        else:
            self._tell_help()
        self._show_tool()

    def _pick_text(self, pick: Pick) -> str:
        geometry = self._editor.scene.geometry[pick.geometry]
        assert isinstance(geometry.shape, Lines)
        text = f"Line {pick.line + 1}: {geometry.shape.lengths[pick.line]:.4g} mm"
        if geometry.color_by == "scalar":
            part = slice(*geometry.shape.offsets[pick.line : pick.line + 2])
            text += f", {geometry.scalar} {np.nanmean(geometry.scalar_values(geometry.scalar)[part]):.4g}"
        return text

    def _keep_lines_here(self) -> None:
        if self._pick is not None:
            radius = KEPT_RADIUS * size_of(self._editor.scene)
            self._set_regions("Choose lines by a pick", (Roi(center=self._pick.point, size=(radius,) * 3),))

    def _show_all_lines(self) -> None:
        self._set_regions("Show all lines", ())

    def _set_regions(self, label: str, rois: tuple[Roi, ...]) -> None:
        geometry = self._editor.scene.geometry
        changed = tuple(replace(g, rois=rois) if isinstance(g.shape, Lines) else g for g in geometry)
        self._editor.change(label, True, geometry=changed)
        self._show_tool()

    # -- showing ----------------------------------------------------------------------------------
    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.geometry != new.geometry or old.volume is not new.volume:
            self._pick = None
            self._show_tool()

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.undock.setIcon(icon("undock", current_theme()))
        self.shut.setIcon(icon("close", current_theme()))


def _button(name: str) -> QToolButton:
    button = QToolButton()
    button.setAccessibleName(name)
    button.setToolTip(name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button
