"""The row of lamps: select one, rename it, put it in another place, add one."""

from __future__ import annotations

from qtpy.QtCore import QPoint, QRect
from qtpy.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from sfumato import Light, Scene
from sfumato.scene import MAX_LIGHTS
from sfumato.scene.light import shining

from .editing import Editor
from .icons import icon
from .lamp_chip import LampChip, NameLine
from .lamp_places import most_lamps
from .theme import current_theme

#: What the second to fourth lamp are: a weaker fill from the other side, a rim from behind, a soft top light.
NEW_LAMPS = (
    Light(name="key"),
    Light(name="fill", tilt=45, rotation=350, aperture=35, intensity=0.4),
    Light(name="rim", tilt=140, rotation=60, aperture=15, intensity=0.8),
    Light(name="top", tilt=50, rotation=90, aperture=30, intensity=0.4),
)
ORDER = "Move the lamp in the list"
#: Chips beside each other; further ones stand below.
IN_A_ROW = 4


class LampRow(QWidget):
    """One chip a lamp, four in a row, then a button that adds another."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        self._rows = [QHBoxLayout() for _ in range(-(-MAX_LIGHTS // IN_A_ROW))]
        for row in self._rows:
            row.setSpacing(4)
            row.addStretch(1)
            self._column.addLayout(row)
        self._placed = -1
        self.chips: list[LampChip] = []
        self.name_line: NameLine | None = None
        self.add = QToolButton(self)
        self.add.setAccessibleName("Add a lamp")
        self.add.clicked.connect(self._add)
        editor.changed.connect(self._on_changed)
        editor.light_selected.connect(self.refresh)
        self.refresh()

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.lights != new.lights or type(old.technique) is not type(new.technique):
            self.refresh()

    def refresh(self) -> None:
        """Show the scene's lamps."""
        lights = self._editor.scene.lights
        while len(self.chips) < len(lights):
            self._append_chip()
        while len(self.chips) > len(lights):
            chip = self.chips.pop()
            for row in self._rows:
                row.removeWidget(chip)
            chip.hide()
            chip.deleteLater()
        self._arrange()
        shown = shining(lights)
        for i, (chip, light) in enumerate(zip(self.chips, lights, strict=True)):
            shines = any(light is one for one in shown)
            chip.show_light(light, light.name or str(i + 1), shines, i == self._editor.selected)
        most = most_lamps(self._editor.scene)
        self.add.setEnabled(len(lights) < most)
        self.add.setToolTip("Add a lamp" if len(lights) < most else f"At most {most} lamps")
        self.refresh_theme()

    def _arrange(self) -> None:
        """Put the chips into rows, and the button behind the last."""
        if self._placed == len(self.chips):
            return
        self._placed = len(self.chips)
        for row in self._rows:
            for widget in (*self.chips, self.add):
                row.removeWidget(widget)
        for number, chip in enumerate(self.chips):
            self._rows[number // IN_A_ROW].insertWidget(number % IN_A_ROW, chip)
        self._rows[max(0, len(self.chips) - 1) // IN_A_ROW].addWidget(self.add)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.add.setIcon(icon("add", current_theme()))

    def _append_chip(self) -> None:
        index = len(self.chips)
        chip = LampChip(self)
        # Pressed, not clicked: what is dragged is the selected lamp.
        chip.pressed.connect(lambda: self._editor.select_light(index))
        chip.rename_wanted.connect(lambda: self._ask_name(index))
        chip.nudged.connect(lambda step: self._nudge(index, step))
        chip.drag_started.connect(lambda: self._editor.begin(ORDER))
        chip.dragged.connect(self._drag_to)
        chip.drag_finished.connect(self._editor.end)
        if self.chips:
            QWidget.setTabOrder(self.chips[-1], chip)
        QWidget.setTabOrder(chip, self.add)
        self.chips.append(chip)

    # -- lamps ------------------------------------------------------------------------------------
    def _add(self) -> None:
        lights = self._editor.scene.lights
        used = {light.name for light in lights}
        lamp = next(
            (lamp for lamp in NEW_LAMPS if lamp.name not in used), NEW_LAMPS[len(lights) % len(NEW_LAMPS)]
        )
        if self._editor.change("Add a lamp", lights=(*lights, lamp)):
            self._editor.select_light(len(lights))

    # -- order ------------------------------------------------------------------------------------
    def _drag_to(self, at: QPoint) -> None:
        """Bring the selected lamp to the place under the pointer."""
        tall = self.chips[0].height() + self._column.spacing()
        line = max(0, min(at.y() // tall, len(self._rows) - 1))

        def along(place: QPoint, row: int) -> int:
            """Return a place on the line that the rows are, one after the other."""
            return place.x() + row * 10 * self.width()

        x = along(at, line)
        centres = [along(chip.geometry().center(), i // IN_A_ROW) for i, chip in enumerate(self.chips)]
        chosen = self._editor.selected
        target = chosen
        while target > 0 and x < centres[target - 1]:
            target -= 1
        while target < len(centres) - 1 and x > centres[target + 1]:
            target += 1
        self._move(chosen, target)

    def _nudge(self, index: int, step: int) -> None:
        target = index + step
        if 0 <= target < len(self.chips):
            self._move(index, target)
            self.chips[target].setFocus()

    def _move(self, start: int, end: int) -> None:
        if start == end:
            return
        lights = list(self._editor.scene.lights)
        lights.insert(end, lights.pop(start))
        if self._editor.change(ORDER, lights=tuple(lights)):
            self._editor.select_light(end)
            self._column.activate()

    # -- names ------------------------------------------------------------------------------------
    def _ask_name(self, index: int) -> None:
        """Open a line over the chip in which the name is typed."""
        self._editor.select_light(index)
        chip = self.chips[index]
        line = self.name_line = NameLine(self._editor.scene.lights[index].name, self)
        width = min(self.width(), max(chip.width(), 120))
        left = min(chip.x(), self.width() - width)
        line.setGeometry(QRect(left, chip.y(), width, chip.height()))
        line.finished.connect(lambda name: self._rename(index, name))
        line.show()
        line.setFocus()

    def _rename(self, index: int, name: str) -> None:
        line, self.name_line = self.name_line, None
        lights = self._editor.scene.lights
        if name and index < len(lights) and name != lights[index].name:
            self._editor.change("Rename the lamp", **{f"lights.{index}.name": name})
        if line is not None:
            # The window's own answer: the line has the focus there also while another window is active.
            had_focus = self.window().focusWidget() is line
            line.hide()
            line.deleteLater()
            if had_focus and index < len(self.chips):
                self.chips[index].setFocus()
