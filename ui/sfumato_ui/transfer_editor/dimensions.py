"""The switch between functions of the value alone and of value and gradient; nothing is lost on the way."""

from __future__ import annotations

import weakref

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QHBoxLayout, QToolButton, QWidget

from sfumato import Region, Scene, Volume
from sfumato.scene.presets import suggest_transfer
from sfumato.scene.region_edit import one_dimensional, two_dimensional

from ..editing import Editor

TIPS = (
    "A function of the value: points of colour and opacity. Coming from 2D, its points are as they were; "
    "the shapes come back with 2D.",
    "A function of the value and of how steeply it changes, by shapes. At first one shape, the 1D curve, shows "
    "everywhere what the points show: cut it to steep gradients, or lay other shapes over it.",
)


class Dimensions(QWidget):
    """Two buttons, of which one is down."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        #: Shapes that the switch left, of which volume and of a function of which name: others' do not come back.
        self._left: tuple[weakref.ref[Volume] | None, str, tuple[Region, ...]] = (None, "", ())
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        # No exclusive group: Tab would reach one of the two alone.
        self.buttons = _button("1D", TIPS[0]), _button("2D", TIPS[1])
        for button in self.buttons:
            row.addWidget(button)
        self.buttons[0].clicked.connect(self._to_one)
        self.buttons[1].clicked.connect(self._to_two)

    @property
    def two(self) -> bool:
        """Whether the scene's function has two dimensions."""
        transfer = self._editor.scene.transfer
        return transfer is not None and bool(transfer.regions)

    def show_scene(self, scene: Scene) -> None:
        """Show which of the two a scene's function is."""
        for button, down in zip(self.buttons, (not self.two, self.two), strict=True):
            button.setChecked(down)

    def _to_one(self) -> None:
        scene = self._editor.scene
        if self.two and scene.transfer is not None and scene.volume is not None:
            self._left = weakref.ref(scene.volume), scene.transfer.name, scene.transfer.regions
            flat = one_dimensional(scene.transfer, suggest_transfer(scene.volume))
            self._editor.change("Use the 1D function", transfer=flat)
        self.show_scene(self._editor.scene)

    def _to_two(self) -> None:
        scene = self._editor.scene
        if not self.two and scene.transfer is not None and scene.volume is not None:
            of, name, regions = self._left
            same = of is not None and of() is scene.volume and name == scene.transfer.name
            kept = regions if same else ()
            self._editor.change(
                "Use a 2D function", transfer=two_dimensional(scene.transfer, scene.volume, kept)
            )
        self.show_scene(self._editor.scene)


def _button(name: str, tip: str) -> QToolButton:
    button = QToolButton()
    button.setText(name)
    button.setCheckable(True)
    button.setAccessibleName(f"{name} transfer function")
    button.setToolTip(f"<p>{tip}</p>")
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button
