"""What is done with the selected lamp beside the dial: kind, intensity, colour, mute, solo, duplicate, remove."""

from __future__ import annotations

from dataclasses import replace

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QGridLayout, QLabel, QToolButton, QWidget

from sfumato import Light, Scene
from sfumato.scene import fields_of
from sfumato.techniques import techniques

from .color_button import RGB, ColorButton
from .editing import Editor
from .generated import ChoiceBox, tooltip_of
from .icons import icon
from .lamp_chip import LONGEST_NAME
from .lamp_places import KINDS, as_kind, kind_of, most_lamps, offered_kinds
from .sliders import NumberBox
from .theme import current_theme

INTENSITY = "Change the intensity"


class LampTools(QWidget):
    """A column of small controls for the selected lamp."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self.kind = _kind_box()
        self.kind_words = QLabel("Kind")
        self.intensity = _intensity_box()
        self.color = ColorButton("Colour of the lamp")
        self.mute = _button("Mute the lamp", checkable=True)
        self.solo = _button("Solo: the other lamps are dark", checkable=True)
        self.duplicate = _button("Duplicate the lamp")
        self.remove = _button("Remove the lamp")
        self._lay_out()
        self.kind.activated.connect(lambda index: self._set_kind(self.kind.itemData(index)))
        self.intensity.valueChanged.connect(lambda v: editor.change_light(INTENSITY, True, intensity=v))
        self.color.picked.connect(self._set_color)
        self.mute.clicked.connect(self._set_muted)
        self.solo.clicked.connect(self._set_solo)
        self.duplicate.clicked.connect(self._duplicate)
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
        self.kind_words.setBuddy(self.kind)
        rows = (self.kind_words, self.kind, words, self.intensity, QLabel("Colour"), self.color)
        for row, widget in enumerate(rows, 1):
            grid.addWidget(widget, row, 0, 1, 4)
        for column, button in enumerate((self.mute, self.solo, self.duplicate, self.remove)):
            grid.addWidget(button, len(rows) + 1, column)
        grid.setRowStretch(len(rows) + 2, 1)

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.lights != new.lights or type(old.technique) is not type(new.technique):
            self.refresh()

    def refresh(self) -> None:
        """Show the selected lamp."""
        light = self._editor.light
        self.setEnabled(light is not None)
        if light is None:
            return
        self._show_kind(light)
        self.intensity.blockSignals(True)
        self.intensity.setValue(light.intensity)
        self.intensity.blockSignals(False)
        self.color.set_color(light.color)
        self.mute.setChecked(not light.enabled)
        self.mute.setToolTip("Mute the lamp" if light.enabled else "Let the lamp shine again")
        self.solo.setChecked(light.solo)
        self.solo.setToolTip("Let all lamps shine" if light.solo else "Solo: the other lamps are dark")
        most = most_lamps(self._editor.scene)
        room = len(self._editor.scene.lights) < most
        self.duplicate.setEnabled(room)
        self.duplicate.setToolTip("Duplicate the lamp" if room else f"At most {most} lamps")
        alone = len(self._editor.scene.lights) == 1
        self.remove.setEnabled(not alone)
        self.remove.setToolTip("The last lamp stays; mute it instead" if alone else "Remove the lamp")
        self.refresh_theme()

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        theme = current_theme()
        self.mute.setIcon(icon("mute" if self.mute.isChecked() else "shown", theme))
        self.solo.setIcon(icon("solo", theme))
        self.duplicate.setIcon(icon("duplicate", theme))
        self.remove.setIcon(icon("remove", theme))

    def _show_kind(self, light: Light) -> None:
        """Offer the kinds that the technique knows; nothing, if that is the lamp's own alone."""
        offered = offered_kinds(techniques()[self._editor.scene.technique_id], light)
        self.kind.setVisible(len(offered) > 1)
        self.kind_words.setVisible(len(offered) > 1)
        if [self.kind.itemData(i) for i in range(self.kind.count())] != [kind.id for kind in offered]:
            self.kind.clear()
            for kind in offered:
                self.kind.addItem(kind.title, kind.id)
        self.kind.setCurrentIndex(self.kind.findData(kind_of(light).id))

    # -- edits ------------------------------------------------------------------------------------
    def _set_kind(self, wanted: str) -> None:
        light = self._editor.light
        if light is not None and wanted != kind_of(light).id:
            kind = next(kind for kind in KINDS if kind.id == wanted)
            self._editor.change_light("Change the kind of lamp", **as_kind(self._editor.scene, light, kind))

    def _set_color(self, rgb: RGB) -> None:
        self._editor.change_light("Colour the lamp", True, color=rgb)

    def _set_muted(self, muted: bool) -> None:
        self._editor.change_light("Mute the lamp" if muted else "Unmute the lamp", enabled=not muted)

    def _set_solo(self, solo: bool) -> None:
        """Let this lamp alone shine, or all; there is one solo lamp at a time."""
        chosen = self._editor.selected
        paths = {f"lights.{i}.solo": solo and i == chosen for i in range(len(self._editor.scene.lights))}
        self._editor.change("Solo the lamp" if solo else "Let all lamps shine", **paths)

    def _duplicate(self) -> None:
        """Put another lamp like the selected one behind it."""
        lights, chosen = self._editor.scene.lights, self._editor.selected
        used = {light.name for light in lights}
        stem = (lights[chosen].name or f"{chosen + 1}")[: LONGEST_NAME - 3]
        name = next(f"{stem} {i}" for i in range(2, len(lights) + 3) if f"{stem} {i}" not in used)
        copy = replace(lights[chosen], name=name, solo=False)
        if self._editor.change(
            "Duplicate the lamp", lights=(*lights[: chosen + 1], copy, *lights[chosen + 1 :])
        ):
            self._editor.select_light(chosen + 1)

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


def _kind_box() -> ChoiceBox:
    box = ChoiceBox()
    box.setMinimumContentsLength(max(len(kind.title) for kind in KINDS))
    box.setAccessibleName("Kind of lamp")
    box.setToolTip(
        "<p>Parallel light comes from far away. Point, spot, rectangle, sphere and tube stand somewhere, also "
        "inside the subject: drag them in the picture with the Light tool.</p>"
    )
    return box


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
