"""The row of lamps: select one, mute it, remove it, add another."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QHBoxLayout, QToolButton, QWidget

from sfumato import Light
from sfumato.scene import MAX_LIGHTS

from .editing import Editor
from .icons import icon
from .theme import current_theme

#: What the second to fourth lamp are: a weaker fill from the other side, a rim from behind, a soft top light.
NEW_LAMPS = (
    Light(name="key"),
    Light(name="fill", tilt=45, rotation=350, aperture=35, intensity=0.4),
    Light(name="rim", tilt=140, rotation=60, aperture=15, intensity=0.8),
    Light(name="top", tilt=50, rotation=90, aperture=30, intensity=0.4),
)


class LampRow(QWidget):
    """One button a lamp, then mute, remove and add."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        self._row.setSpacing(4)
        self.chips: list[QToolButton] = []
        self.mute = self._button("Mute the lamp", checkable=True)
        self.remove = self._button("Remove the lamp")
        self.add = self._button("Add a lamp")
        self._row.addStretch(1)
        for button in (self.mute, self.remove, self.add):
            self._row.addWidget(button)
        self.mute.clicked.connect(lambda muted: editor.change_light("Mute the lamp", enabled=not muted))
        self.remove.clicked.connect(self._remove)
        self.add.clicked.connect(self._add)
        editor.changed.connect(lambda old, new: self.refresh() if old.lights != new.lights else None)
        editor.light_selected.connect(self.refresh)
        self.refresh()

    def _button(self, name: str, checkable: bool = False) -> QToolButton:
        button = QToolButton()
        button.setCheckable(checkable)
        button.setAccessibleName(name)
        button.setToolTip(name)
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        return button

    def refresh(self) -> None:
        """Show the scene's lamps."""
        lights = self._editor.scene.lights
        while len(self.chips) < len(lights):
            self._append_chip()
        while len(self.chips) > len(lights):
            chip = self.chips.pop()
            chip.hide()
            chip.deleteLater()
        for i, (chip, light) in enumerate(zip(self.chips, lights, strict=True)):
            chip.setText(light.name or str(i + 1))
            chip.setAccessibleName(f"Lamp {light.name or i + 1}")
            chip.setToolTip(f"{light.name or i + 1}{'' if light.enabled else ' (muted)'}")
            font = chip.font()
            font.setStrikeOut(not light.enabled)
            chip.setFont(font)
            chip.setChecked(i == self._editor.selected)
        chosen = self._editor.light
        self.mute.setChecked(chosen is not None and not chosen.enabled)
        self.mute.setEnabled(chosen is not None)
        self.remove.setEnabled(len(lights) > 1)
        self.remove.setToolTip(
            "Remove the lamp" if len(lights) > 1 else "The last lamp stays; mute it instead"
        )
        self.add.setEnabled(len(lights) < MAX_LIGHTS)
        self.add.setToolTip("Add a lamp" if len(lights) < MAX_LIGHTS else f"At most {MAX_LIGHTS} lamps")
        self.refresh_theme()

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        theme = current_theme()
        self.mute.setIcon(icon("mute" if self.mute.isChecked() else "shown", theme))
        self.remove.setIcon(icon("remove", theme))
        self.add.setIcon(icon("add", theme))

    def _append_chip(self) -> None:
        index = len(self.chips)
        chip = self._button("", checkable=True)
        chip.setProperty("chip", True)
        chip.clicked.connect(lambda: self._editor.select_light(index))
        self._row.insertWidget(index, chip)
        previous = self.chips[-1] if self.chips else None
        if previous is not None:
            QWidget.setTabOrder(previous, chip)
        QWidget.setTabOrder(chip, self.mute)
        self.chips.append(chip)

    def _add(self) -> None:
        lights = self._editor.scene.lights
        used = {light.name for light in lights}
        lamp = next(
            (lamp for lamp in NEW_LAMPS if lamp.name not in used), NEW_LAMPS[len(lights) % len(NEW_LAMPS)]
        )
        if self._editor.change("Add a lamp", lights=(*lights, lamp)):
            self._editor.select_light(len(lights))

    def _remove(self) -> None:
        gone = self._editor.selected
        lights = tuple(light for i, light in enumerate(self._editor.scene.lights) if i != gone)
        if self._editor.change("Remove the lamp", lights=lights):
            self._editor.select_light(min(gone, len(lights) - 1))
