"""Clip planes and crop box as rows of the View tab."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QHBoxLayout, QLabel, QPushButton, QToolButton, QVBoxLayout, QWidget

from sfumato.scene import MAX_CLIP_PLANES

from .clip_planes import CROP, MOVE, ClipPlanes, axes_of, cut_names
from .editing import Editor
from .icons import icon
from .range_slider import LabelledRange
from .sliders import LabelledSlider
from .theme import current_theme


class ClipControls(QWidget):
    """One chip a plane with add, flip, switch and remove; below them offset and direction of the selected one."""

    def __init__(self, editor: Editor, clips: ClipPlanes) -> None:
        super().__init__()
        self._editor, self._clips = editor, clips
        self.chips = [self._chip(i) for i in range(MAX_CLIP_PLANES)]
        self.empty = QLabel("None yet")
        self.empty.setProperty("muted", True)
        self.flip = _button("Flip the clip plane", "Keep the other side")
        self.switch = _button("Switch the clip plane off", "", checkable=True)
        self.remove = _button("Remove the clip plane", "Remove the selected clip plane")
        self.add = _button("Add a clip plane", "")
        self.offset = LabelledSlider(
            "Offset", ((-1.0, 1.0),), 0.0, unit="mm", decimals=1, limits=(-99999.0, 99999.0),
            tip="Distance of the plane from the middle of the volume",
        )  # fmt: skip
        self.offset.number.setFixedWidth(self.offset.fontMetrics().horizontalAdvance("-0000.0 mm") + 22)
        self.cuts = [QPushButton() for _ in range(4)]
        self._own = QWidget()
        self._lay_out()
        self._connect()
        self.refresh()

    def _chip(self, index: int) -> QToolButton:
        chip = _button(f"Clip plane {index + 1}", f"Select clip plane {index + 1}", checkable=True)
        chip.setText(str(index + 1))
        chip.clicked.connect(lambda: self._select(index))
        return chip

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.setSpacing(2)
        for chip in self.chips:
            row.addWidget(chip)
        row.addWidget(self.empty)
        row.addStretch(1)
        for button in (self.flip, self.switch, self.remove, self.add):
            row.addWidget(button)
        cuts = QHBoxLayout()
        cuts.setSpacing(6)
        for cut in self.cuts:
            cut.setProperty("compact", True)
            cuts.addWidget(cut, 1)
        own = QVBoxLayout(self._own)
        own.setContentsMargins(0, 0, 0, 0)
        own.setSpacing(4)
        own.addWidget(self.offset)
        own.addLayout(cuts)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addLayout(row)
        column.addWidget(self._own)

    def _connect(self) -> None:
        editor, clips = self._editor, self._clips
        self.add.clicked.connect(clips.add)
        self.remove.clicked.connect(clips.remove)
        self.flip.clicked.connect(clips.flip)
        self.switch.clicked.connect(lambda off: clips.enable(not off))
        self.offset.edited.connect(self._set_offset)
        self.offset.drag_started.connect(lambda: editor.begin(MOVE))
        self.offset.drag_finished.connect(editor.end)
        for i, button in enumerate(self.cuts):
            button.clicked.connect(lambda _=False, i=i: clips.turn_to(i))
        clips.selected_changed.connect(self.refresh)

    def _select(self, index: int) -> None:
        self._clips.select(index)
        self.refresh()

    def _set_offset(self, value: float) -> None:
        low, high = self._clips.offset_range()
        self._clips.set_offset(min(max(value, low), high), not self.offset.slider.isSliderDown())
        self.refresh()

    def refresh(self) -> None:
        """Show the scene's planes."""
        scene, plane, opened = self._editor.scene, self._clips.plane, self._editor.scene.volume is not None
        count = len(scene.clip)
        for i, chip in enumerate(self.chips):
            chip.setVisible(i < count)
            chip.setChecked(i == self._clips.selected and i < count)
            font = chip.font()
            font.setStrikeOut(i < count and not scene.clip[i].enabled)
            chip.setFont(font)
        self.empty.setVisible(count == 0)
        self._own.setVisible(plane is not None)
        self.add.setEnabled(opened and count < MAX_CLIP_PLANES)
        self.add.setToolTip(
            "Add a clip plane" if count < MAX_CLIP_PLANES else f"At most {MAX_CLIP_PLANES} planes"
        )
        for button in (self.flip, self.switch, self.remove):
            button.setVisible(plane is not None)
        if plane is not None:
            self._show_plane(plane.enabled)
        self.refresh_theme()

    def _show_plane(self, enabled: bool) -> None:
        self.switch.setChecked(not enabled)
        self.switch.setAccessibleName("Switch the clip plane off" if enabled else "Switch the clip plane on")
        self.switch.setToolTip("Off: cut nothing" if enabled else "On: cut again")
        self.offset.slider.set_pieces((self._clips.offset_range(),))
        self.offset.set_number(self._clips.offset())
        for button, name in zip(self.cuts, cut_names(self._editor.scene), strict=True):
            button.setText(name)
            button.setAccessibleName(f"Clip plane: {name}")
            across = "towards the eye" if name == "View" else f"to the {name} plane"
            button.setToolTip(f"Turn the plane {across}; what is nearer goes")

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        theme = current_theme()
        for button, name in ((self.flip, "flip"), (self.remove, "remove"), (self.add, "add")):
            button.setIcon(icon(name, theme))
        self.switch.setIcon(icon("mute" if self.switch.isChecked() else "shown", theme))


class CropControls(QWidget):
    """One range a patient's axis, in mm."""

    def __init__(self, editor: Editor, clips: ClipPlanes) -> None:
        super().__init__()
        self._editor, self._clips = editor, clips
        tip = "The part of the volume that is shown; what is cut away casts no shadow"
        self.ranges = [LabelledRange(name, tip) for name in "xyz"]
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        for index, row in enumerate(self.ranges):
            column.addWidget(row)
            row.edited.connect(lambda low, high, i=index: self._crop(i, low, high))
            row.drag_started.connect(lambda: editor.begin(CROP))
            row.drag_finished.connect(editor.end)
        self.refresh()

    def _crop(self, index: int, low: float, high: float) -> None:
        volume = self._editor.scene.volume
        if volume is not None:
            merge = not self.ranges[index].slider.dragging
            self._clips.set_crop(axes_of(volume)[index], low, high, merge)
        self.refresh()

    def refresh(self) -> None:
        """Show the scene's crop box."""
        scene = self._editor.scene
        self.setEnabled(scene.volume is not None)
        if scene.volume is None:
            return
        for row, axis in zip(self.ranges, axes_of(scene.volume), strict=True):
            row.set_axis(axis.name, axis.length, scene.volume.spacing[axis.index])
            row.set_values(*axis.to_mm(scene.crop.low[axis.index], scene.crop.high[axis.index]))


def _button(name: str, tip: str, checkable: bool = False) -> QToolButton:
    button = QToolButton()
    button.setCheckable(checkable)
    button.setAccessibleName(name)
    button.setToolTip(tip)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button
