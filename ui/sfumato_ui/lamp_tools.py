"""What is done with the selected lamp beside the dial: intensity, colour, mute, solo, remove."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QGridLayout, QLabel, QToolButton, QWidget

from sfumato import Light, Scene
from sfumato.scene import fields_of

from .color_button import RGB, ColorButton
from .editing import Editor
from .generated import tooltip_of
from .icons import icon
from .sliders import NumberBox
from .theme import current_theme

INTENSITY = "Change the intensity"


class LampTools(QWidget):
    """A column of small controls for the selected lamp."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self.intensity = _intensity_box()
        self.color = ColorButton("Colour of the lamp")
        self.mute = _button("Mute the lamp", checkable=True)
        self.solo = _button("Solo: the other lamps are dark", checkable=True)
        self.remove = _button("Remove the lamp")
        self._lay_out()
        self.intensity.valueChanged.connect(lambda v: editor.change_light(INTENSITY, True, intensity=v))
        self.color.picked.connect(self._set_color)
        self.mute.clicked.connect(self._set_muted)
        self.solo.clicked.connect(self._set_solo)
        self.remove.clicked.connect(self._remove)
        editor.changed.connect(self._on_changed)
        editor.light_selected.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(2)
        grid.setVerticalSpacing(4)
        grid.setRowStretch(0, 1)
        words = QLabel("Intensity")
        words.setBuddy(self.intensity)
        grid.addWidget(words, 1, 0, 1, 3)
        grid.addWidget(self.intensity, 2, 0, 1, 3)
        grid.addWidget(QLabel("Colour"), 3, 0, 1, 3)
        grid.addWidget(self.color, 4, 0, 1, 3)
        for column, button in enumerate((self.mute, self.solo, self.remove)):
            grid.addWidget(button, 5, column)
        grid.setRowStretch(6, 1)

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.lights != new.lights:
            self.refresh()

    def refresh(self) -> None:
        """Show the selected lamp."""
        light = self._editor.light
        self.setEnabled(light is not None)
        if light is None:
            return
        self.intensity.blockSignals(True)
        self.intensity.setValue(light.intensity)
        self.intensity.blockSignals(False)
        self.color.set_color(light.color)
        self.mute.setChecked(not light.enabled)
        self.mute.setToolTip("Mute the lamp" if light.enabled else "Let the lamp shine again")
        self.solo.setChecked(light.solo)
        self.solo.setToolTip("Let all lamps shine" if light.solo else "Solo: the other lamps are dark")
        alone = len(self._editor.scene.lights) == 1
        self.remove.setEnabled(not alone)
        self.remove.setToolTip("The last lamp stays; mute it instead" if alone else "Remove the lamp")
        self.refresh_theme()

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        theme = current_theme()
        self.mute.setIcon(icon("mute" if self.mute.isChecked() else "shown", theme))
        self.solo.setIcon(icon("solo", theme))
        self.remove.setIcon(icon("remove", theme))

    # -- edits ------------------------------------------------------------------------------------
    def _set_color(self, rgb: RGB) -> None:
        self._editor.change_light("Colour the lamp", True, color=rgb)

    def _set_muted(self, muted: bool) -> None:
        self._editor.change_light("Mute the lamp" if muted else "Unmute the lamp", enabled=not muted)

    def _set_solo(self, solo: bool) -> None:
        """Let this lamp alone shine, or all; there is one solo lamp at a time."""
        chosen = self._editor.selected
        paths = {f"lights.{i}.solo": solo and i == chosen for i in range(len(self._editor.scene.lights))}
        self._editor.change("Solo the lamp" if solo else "Let all lamps shine", **paths)

    def _remove(self) -> None:
        gone = self._editor.selected
        lights = tuple(light for i, light in enumerate(self._editor.scene.lights) if i != gone)
        if self._editor.change("Remove the lamp", lights=lights):
            self._editor.select_light(min(gone, len(lights) - 1))


def _button(name: str, checkable: bool = False) -> QToolButton:
    button = QToolButton()
    button.setCheckable(checkable)
    button.setAccessibleName(name)
    button.setToolTip(name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button


def _intensity_box() -> NumberBox:
    """Return the number that its declaration describes."""
    param = fields_of(Light)["intensity"].param
    assert param is not None
    box = NumberBox()
    box.setDecimals(2)
    box.setSingleStep(0.05)
    box.setRange(param.ge or 0.0, param.le or 100.0)
    box.setAccessibleName("Intensity of the lamp in numbers")
    box.setToolTip(f"<p>{tooltip_of(param)}</p><p>Up and Down keys change it by 0.05.</p>")
    return box
