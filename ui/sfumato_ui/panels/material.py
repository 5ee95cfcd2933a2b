"""The Material tab: presets of the transfer function, and how dense the material is."""

from __future__ import annotations

from dataclasses import replace

from qtpy.QtCore import QSize, Qt
from qtpy.QtGui import QWheelEvent
from qtpy.QtWidgets import QListWidget, QListWidgetItem

from sfumato import Scene, TransferFunction
from sfumato.scene.presets import Preset, presets_for

from ..editing import Editor
from ..sliders import LabelledSlider
from ..transfer_preview import TransferPreview, swatch
from .page import Page


class PresetList(QListWidget):
    """A list that the wheel scrolls, and that is as tall as its rows."""

    def __init__(self) -> None:
        super().__init__()
        self.setIconSize(QSize(44, 20))
        self.setUniformItemSizes(True)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName("Presets")

    def fit(self) -> None:
        """Take the height of all rows."""
        self.setFixedHeight(
            sum(self.sizeHintForRow(i) for i in range(self.count())) + 2 * self.frameWidth() + 4
        )

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Let the panel scroll."""
        event.ignore()


class MaterialPage(Page):
    """What the values of the volume look like."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._presets: tuple[Preset, ...] = ()
        self._volume: object = None
        self.preview = TransferPreview()
        self.presets = PresetList()
        self.density = LabelledSlider(
            "Density", ((1 / 16, 16.0),), 1.0, unit="×", decimals=2, step=0.05, limits=(0.01, 100), log=True,
            tip="How much light each millimetre stops: thin shows what is inside, dense the surface",
        )  # fmt: skip
        self.add_heading("Presets")
        self.add(self.presets)
        self.add(self.density)
        self.add_heading("Values and opacity")
        self.add(self.preview)
        self.finish()
        self.presets.currentRowChanged.connect(self._choose)
        self.density.edited.connect(self._set_density)
        self.density.drag_started.connect(lambda: editor.begin("Change the density"))
        self.density.drag_finished.connect(editor.end)
        editor.changed.connect(self._on_changed)
        self.refresh()

    def refresh(self) -> None:
        """Show everything anew."""
        scene = self._editor.scene
        if scene.volume is not self._volume:
            self._volume = scene.volume
            self._presets = presets_for(scene.volume) if scene.volume is not None else ()
            self._fill()
        self.setEnabled(scene.volume is not None)
        self.preview.show_scene(scene)
        current = self._current()
        self.presets.blockSignals(True)
        self.presets.setCurrentRow(-1 if current is None else current)
        self.presets.blockSignals(False)
        self.density.set_number(self._density())

    def _fill(self) -> None:
        self.presets.blockSignals(True)
        self.presets.clear()
        for preset in self._presets:
            item = QListWidgetItem(swatch(preset.transfer), preset.name)
            item.setToolTip(preset.description)
            self.presets.addItem(item)
        self.presets.fit()
        self.presets.blockSignals(False)

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.volume is not new.volume or old.transfer != new.transfer:
            self.refresh()

    def _current(self) -> int | None:
        """Return which preset the scene's function is, whatever its density."""
        transfer = self._editor.scene.transfer
        for i, preset in enumerate(self._presets):
            if transfer is not None and (preset.transfer.points, preset.transfer.regions) == (
                transfer.points,
                transfer.regions,
            ):
                return i
        return None

    def _base(self, transfer: TransferFunction) -> float:
        """Return the unit distance in mm that counts as density 1."""
        volume, current = self._editor.scene.volume, self._current()
        assert volume is not None
        preset = self._presets[current].transfer if current is not None else None
        return (preset.unit_distance if preset is not None else None) or volume.unit_distance

    def _density(self) -> float:
        transfer = self._editor.scene.transfer
        if transfer is None:
            return 1.0
        base = self._base(transfer)
        return base / (transfer.unit_distance or base)

    def _choose(self, row: int) -> None:
        if 0 <= row < len(self._presets):
            self._editor.change("Choose the preset", True, transfer=self._presets[row].transfer)

    def _set_density(self, density: float) -> None:
        transfer = self._editor.scene.transfer
        if transfer is not None:
            thinner = replace(transfer, unit_distance=self._base(transfer) / density)
            self._editor.change(
                "Change the density", not self.density.slider.isSliderDown(), transfer=thinner
            )
        self.refresh()
