"""The View tab: standard and kept views, projection, lens, clip planes, crop box, geometry, exposure, background.

Under More: quality of the still picture, sampling, theme.
"""

from __future__ import annotations

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import (
    QCheckBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from sfumato import Camera, Scene
from sfumato.scene import STANDARD_VIEWS, fields_of

from .. import camera_moves
from ..bindings import explain
from ..bookmarks import BookmarkButton
from ..clip_controls import ClipControls, CropControls
from ..clip_planes import ClipPlanes
from ..editing import Editor
from ..generated import ChoiceBox, ParamControl, bind_slider, labelled, slider_for, tooltip_of
from ..geometry_controls import GeometryControls
from ..help_pictures import illustrated
from ..jobs import STILL_SECONDS
from ..orientation import cube_wanted
from ..quality import QUALITIES, chosen_quality, remember_quality
from ..section import Section
from ..settings import settings
from ..theme import THEMES, current_theme
from .page import Page

#: Linear RGBA by name; without a background the window shows its grey.
BACKGROUNDS = {
    "None": (0.0, 0.0, 0.0, 0.0),
    "Black": (0.0, 0.0, 0.0, 1.0),
    "Grey": (0.216, 0.216, 0.216, 1.0),
    "White": (1.0, 1.0, 1.0, 1.0),
}


#: Fields of the scene that the page shows, but for the camera.
SHOWN = (
    "volume", "geometry", "clip", "crop", "solid_cuts", "exposure", "white_balance", "tone_curve", "step", "background"
)  # fmt: skip


class ViewPage(Page):
    """From where, through which lens, how bright, on what."""

    theme_chosen = Signal(str)
    #: The user asked to see the whole subject from a side ("" keeps the side).
    view_chosen = Signal(str)
    #: A still picture is to have so many frames.
    frames_chosen = Signal(int)
    #: A scale bar is wanted in the picture, or no more.
    scale_bar_chosen = Signal(bool)
    #: The orientation cube is wanted in the picture, or no more.
    cube_chosen = Signal(bool)

    def __init__(self, editor: Editor, clips: ClipPlanes) -> None:
        super().__init__()
        self._editor = editor
        self.views = self._view_buttons()
        self.parallel = QCheckBox("Orthographic")
        self.parallel.setToolTip("Parallel projection: no foreshortening, lengths can be compared")
        self.turntable = QPushButton("Turn")
        self.turntable.setAccessibleName("Turntable")
        self.turntable.setCheckable(True)
        self.turntable.setProperty("compact", True)
        self.turntable.setMinimumWidth(44)  # wider than its one short word
        explain(
            self.turntable,
            "Let the subject turn, once around in 12 s; the next press or key ends it",
            "turntable",
        )
        self.bookmarks = BookmarkButton(editor)
        self.lens = slider_for(fields_of(Camera)["view_angle"], "Camera.view_angle")
        self.clip = ClipControls(editor, clips)
        self.crop = CropControls(editor, clips)
        self.solid = QCheckBox("Solid cut faces")
        declared = fields_of(Scene)["solid_cuts"].param
        assert declared is not None
        self.solid.setToolTip(illustrated(tooltip_of(declared), "Scene.solid_cuts"))
        self.shapes = GeometryControls(editor)
        self.exposure = slider_for(fields_of(Scene)["exposure"], "Scene.exposure")
        self.step = slider_for(fields_of(Scene)["step"])
        self.background: list[QPushButton] = []
        self.more = Section("More", "view_more")
        self.quality = ChoiceBox()
        self.theme = ChoiceBox()
        self.auto = QPushButton("Auto")
        explain(
            self.auto, "Automatic exposure: bright parts get the brightness of their own colour", "exposure"
        )
        self.automatic = QCheckBox("Automatic exposure")
        self.automatic.setToolTip(
            "Expose when a volume is opened or a rig is chosen; never while a lamp is moved"
        )
        known = fields_of(Scene)
        self.white = ParamControl(known["white_balance"], editor, "white_balance")
        self.tone = ParamControl(known["tone_curve"], editor, "tone_curve")
        self.scale_bar = QCheckBox("Scale bar")
        self.scale_bar.setChecked(bool(settings().value("view/scale_bar", False, type=bool)))
        self.cube = QCheckBox("Orientation cube")
        explain(
            self.cube,
            "A cube, upper left, whose faces name the patient's sides; a press on one looks at it",
            "cube",
        )
        self.cube.setChecked(cube_wanted())
        # Without clip planes all of it fits into a window of 1280 x 720.
        self.column.setSpacing(4)
        self.add_heading("Camera")
        self.add(self.views)
        self.add(self._projection_row())
        self.add(self.lens)
        self.add_heading("Clip planes", self.solid)
        self.add(self.clip)
        self.add_heading("Crop box")
        self.add(self.crop)
        self.add(self.shapes)
        self.add_heading("Picture")
        self.exposure.add_button(self.auto)
        self.add(self.exposure)
        self.add(self._background_row())
        self.add(self.more)
        self.more.add(self.automatic)
        self.more.add(self.white)
        self.more.add(self.tone)
        self.more.add(_side_by_side(self.scale_bar, self.cube))
        self.more.add(self._quality_row())
        self.more.add(self.step)
        self.more.add(self._theme_row())
        self.finish()
        self._connect()
        self.refresh()

    # -- building ---------------------------------------------------------------------------------
    def _view_buttons(self) -> QWidget:
        box = QWidget()
        grid = QGridLayout(box)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(6)
        for i, name in enumerate(STANDARD_VIEWS):
            button = QPushButton(name.capitalize())
            button.setProperty("compact", True)
            button.setAccessibleName(f"View from the {name}")
            explain(button, f"See the whole from the {name}", f"view-{name}")
            button.clicked.connect(lambda _=False, name=name: self.view_chosen.emit(name))
            grid.addWidget(button, i // 3, i % 3)
        return box

    def _projection_row(self) -> QWidget:
        rows = QWidget()
        column = QVBoxLayout(rows)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        layout = QHBoxLayout()
        layout.addWidget(self.parallel, 1)
        layout.addWidget(self.turntable)
        layout.addWidget(self.bookmarks)
        column.addLayout(layout)
        column.addWidget(self.bookmarks.ask)
        return rows

    def _background_row(self) -> QWidget:
        row = QWidget()
        column = QVBoxLayout(row)
        column.setContentsMargins(0, 2, 0, 4)
        column.setSpacing(4)
        column.addWidget(QLabel("Background"))
        layout = QHBoxLayout()
        layout.setSpacing(6)
        column.addLayout(layout)
        for name in BACKGROUNDS:
            button = QPushButton(name)
            button.setCheckable(True)
            button.setAccessibleName(f"Background: {name}")
            button.setProperty("compact", True)
            button.clicked.connect(lambda _=False, name=name: self._set_background(name))
            self.background.append(button)
            layout.addWidget(button, 1)
        return row

    def _quality_row(self) -> QWidget:
        self.quality.setAccessibleName("Quality")
        self.quality.setToolTip(
            "How far a still picture is refined: jittered frames that it accumulates. Draft and Normal make "
            f"do with fewer if they take longer than {STILL_SECONDS:.0f} s"
        )
        for quality in QUALITIES:
            self.quality.addItem(f"{quality.title} ({quality.frames} frames)", quality)
        self.quality.setCurrentIndex(QUALITIES.index(chosen_quality()))
        return labelled("Quality", self.quality)

    def _theme_row(self) -> QWidget:
        self.theme.setAccessibleName("Theme")
        for name in THEMES:
            self.theme.addItem(name.capitalize(), name)
        return labelled("Theme", self.theme)

    def _connect(self) -> None:
        editor = self._editor
        self.parallel.toggled.connect(self._set_parallel)
        self.lens.edited.connect(self._set_lens)
        self.lens.drag_started.connect(lambda: editor.begin("Change the lens"))
        self.lens.drag_finished.connect(editor.end)
        self.solid.toggled.connect(lambda on: editor.change("Change the cut faces", solid_cuts=on))
        bind_slider(self.exposure, editor, "exposure", "exposure")
        bind_slider(self.step, editor, "step", "sampling")
        self.scale_bar.toggled.connect(self.scale_bar_chosen)
        self.cube.toggled.connect(self.cube_chosen)
        self.quality.activated.connect(self._choose_quality)
        self.theme.activated.connect(lambda i: self.theme_chosen.emit(self.theme.itemData(i)))
        editor.changed.connect(self._on_changed)

    # -- edits and showing ------------------------------------------------------------------------
    def _choose_quality(self, index: int) -> None:
        remember_quality(QUALITIES[index])
        self.frames_chosen.emit(QUALITIES[index].frames)

    def _set_background(self, name: str) -> None:
        self._editor.change("Change the background", background=BACKGROUNDS[name])
        self.refresh()

    def _set_parallel(self, on: bool) -> None:
        camera = self._editor.scene.camera
        if camera is not None:
            self._editor.change("Change the projection", camera=camera_moves.with_projection(camera, on))

    def _set_lens(self, angle: float) -> None:
        camera = self._editor.scene.camera
        if camera is not None:
            angle = max(1.0, min(160.0, angle))
            changed = camera_moves.with_lens(camera, angle)
            self._editor.change("Change the lens", not self.lens.slider.isSliderDown(), camera=changed)
        self.refresh()

    def _on_changed(self, old: Scene, new: Scene) -> None:
        """Show what is other than before: a drag of camera or lamp must not wait for the rest of the page."""
        # As tuples: what is the same object is not compared further.
        if tuple(getattr(old, name) for name in SHOWN) != tuple(getattr(new, name) for name in SHOWN):
            self.refresh()
        elif _lens_of(old.camera) != _lens_of(new.camera):
            self._show_camera(new.camera)

    def refresh(self) -> None:
        """Show the scene's values."""
        scene = self._editor.scene
        self.clip.refresh()
        self.crop.refresh()
        self.shapes.refresh()
        self.solid.blockSignals(True)
        self.solid.setChecked(scene.solid_cuts)
        self.solid.blockSignals(False)
        self.solid.setEnabled(scene.volume is not None)
        self.exposure.set_number(scene.exposure)
        self.auto.setEnabled(scene.volume is not None)
        self.white.show_value()
        self.tone.show_value()
        self.step.set_number(scene.step)
        for button, color in zip(self.background, BACKGROUNDS.values(), strict=True):
            button.setChecked(color == scene.background)
        self.theme.setCurrentIndex(self.theme.findData(current_theme().name, Qt.ItemDataRole.UserRole))
        self._show_camera(scene.camera)

    def _show_camera(self, camera: Camera | None) -> None:
        for widget in (self.views, self.parallel, self.turntable, self.bookmarks, self.lens):
            widget.setEnabled(camera is not None)
        if camera is not None:
            self.parallel.blockSignals(True)
            self.parallel.setChecked(camera.parallel_projection)
            self.parallel.blockSignals(False)
            self.lens.set_number(camera.view_angle)
            self.lens.setEnabled(not camera.parallel_projection)
        orthographic = camera is not None and camera.parallel_projection
        self.scale_bar.setEnabled(orthographic)
        self.scale_bar.setToolTip(
            "A bar of true length in the picture's lower right corner"
            if orthographic
            else "Needs an orthographic view: in perspective, what is nearer is larger"
        )


def _lens_of(camera: Camera | None) -> tuple[bool, float] | None:
    """Return what the page shows of a camera."""
    return None if camera is None else (camera.parallel_projection, camera.view_angle)


def _side_by_side(*boxes: QWidget) -> QWidget:
    """Return a row of widgets of one width."""
    row = QWidget()
    layout = QHBoxLayout(row)
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(8)
    for box in boxes:
        layout.addWidget(box, 1)
    return row
