"""The Material tab: presets as pictures, density, and the transfer function point by point."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import replace

from qtpy.QtCore import QTimer
from qtpy.QtGui import QHideEvent, QImage, QShowEvent

from sfumato import Scene, SfumatoError, TransferFunction
from sfumato.scene.presets import Preset, presets_for

from ..editing import Editor
from ..map_row import MapRow
from ..own_presets import OwnPresets
from ..preset_bar import AskLine, PresetBar
from ..preset_files import PresetFiles
from ..preset_gallery import FEW, PICTURE, PresetGallery
from ..section import Section
from ..settings import settings
from ..sliders import LabelledSlider
from ..thumbnails import Thumbnails
from ..transfer_editor import TransferEditor
from .page import Page
from .whole_function import WholeFunction

#: Name of this tab's thumbnails, and the quiet time in milliseconds after which they are drawn anew.
GROUP = "presets"
#: Key of the settings under which it is kept whether all presets are shown.
UNFOLDED = "section/all_presets"
QUIET_MS = 700


class MaterialPage(Page):
    """What the values of the volume look like."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._presets: tuple[Preset, ...] = ()
        self._volume: object = None
        self._thumbnails: Thumbnails | None = None
        #: What is asked below the heading, and about which own preset.
        self._answer, self._target = "save", ""
        self.own = OwnPresets()
        self._told: tuple[str, ...] = ()
        self.bar, self.ask, self.presets = PresetBar(), AskLine(), PresetGallery()
        self.files = PresetFiles(
            self.own, lambda: editor.scene.transfer, lambda: [p.name for p in self._presets]
        )
        self.transfer = TransferEditor(editor)
        self.more = Section("More", "material_more")
        self._quiet = QTimer(self)
        self._quiet.setSingleShot(True)
        self._quiet.setInterval(QUIET_MS)
        self._make_sliders()
        for widget in (self.bar, self.ask, self.presets, self.density, self.transfer, self.more):
            self.add(widget)
        shapes = self.transfer.shapes
        self.more.add(shapes.extents)
        for slider in (shapes.glow, self.level, self.width_of_all, self.transfer.glow):
            self.more.add(slider)
        self.maps = MapRow(editor)
        self.more.add(self.maps)
        self.more.add(self.files)
        self.finish()
        self._connect()
        self.bar.set_unfolded(bool(settings().value(UNFOLDED, False, type=bool)))
        self.refresh()

    # -- building ---------------------------------------------------------------------------------
    def _make_sliders(self) -> None:
        self.density = LabelledSlider(
            "Density", ((1 / 16, 16.0),), 1.0, unit="×", decimals=2, step=0.05, limits=(0.01, 100), log=True,
            tip="How much light each millimetre stops: thin shows what is inside, dense the surface",
        )  # fmt: skip
        self.level = LabelledSlider(
            "Shift of all", ((-100.0, 100.0),), 0.0, unit="%", decimals=1, limits=(-1000, 1000),
            tip="Moves the whole function along the values, in parts of the volume's range",
        )  # fmt: skip
        self.width_of_all = LabelledSlider(
            "Width of all", ((0.1, 10.0),), 1.0, unit="×", decimals=2, step=0.02, limits=(0.01, 100),
            log=True, tip="Stretches the whole function about its middle",
        )  # fmt: skip

    def _connect(self) -> None:
        editor, ask = self._editor, self.ask
        self.presets.chosen.connect(self._choose)
        self.presets.rename_wanted.connect(self._ask_rename)
        self.presets.delete_wanted.connect(self._ask_delete)
        self.bar.save.clicked.connect(self._ask_save)
        self.bar.rename.clicked.connect(self._ask_rename)
        self.bar.delete.clicked.connect(self._ask_delete)
        ask.answered.connect(self._answered)
        ask.given_up.connect(self.presets.setFocus)
        self.transfer.reset_wanted.connect(self._reset)
        self.files.sought.connect(self.presets.seek)
        self.files.failed.connect(editor.rejected)
        self.files.imported.connect(self._take_imported)
        self.bar.fold_changed.connect(self._show_fold)
        self.presets.hidden_marked.connect(lambda: self.bar.set_unfolded(True))
        self._bind(self.density, "Change the density", WholeFunction.with_density)
        self._bind(self.level, "Shift the function", WholeFunction.with_shift)
        self._bind(self.width_of_all, "Widen the function", WholeFunction.with_width)
        editor.changed.connect(self._on_changed)
        self._quiet.timeout.connect(self._want_pictures)

    def _bind(
        self,
        slider: LabelledSlider,
        label: str,
        function: Callable[[WholeFunction, float], TransferFunction],
    ) -> None:
        """Let a slider edit the transfer function; a drag is one step."""

        def edit(value: float) -> None:
            whole = self._whole()
            if whole is not None:
                changed = function(whole, value)
                self._editor.change(label, not slider.slider.isSliderDown(), transfer=changed)
            self.refresh()

        slider.edited.connect(edit)
        slider.drag_started.connect(lambda: self._editor.begin(label))
        slider.drag_finished.connect(self._editor.end)

    def use_thumbnails(self, thumbnails: Thumbnails) -> None:
        """Take the pictures of presets from here."""
        self._thumbnails = thumbnails
        thumbnails.ready.connect(self._on_thumbnail)

    # -- showing ----------------------------------------------------------------------------------
    def refresh(self) -> None:
        """Show everything anew."""
        scene = self._editor.scene
        if scene.volume is not self._volume:
            self._volume = scene.volume
            self._fill()
        self.setEnabled(scene.volume is not None)
        current, origin = self._current(), self._origin()
        edited = current is None and scene.transfer is not None
        name = origin.name if origin is not None else ""
        self.transfer.show_scene(scene, name, edited)
        self.presets.mark(current)
        self.bar.show_state(
            f"{name}, edited" if edited and name else "", self._is_own(current), scene.transfer is not None
        )
        whole = self._whole()
        self.maps.refresh()
        self.density.set_number(whole.density if whole is not None else 1.0)
        shift, width = whole.shift_and_width if whole is not None else (0.0, 1.0)
        self.level.set_number(shift)
        self.width_of_all.set_number(width)

    def _fill(self) -> None:
        volume = self._editor.scene.volume
        built_in = presets_for(volume) if volume is not None else ()
        self._presets = (*built_in, *self.own.presets)
        self.presets.fill(self._presets)
        self.bar.offer_fold(len(self._presets), FEW)
        self.presets.seek(self.files.words.text())
        self._quiet.start()

    def _show_fold(self) -> None:
        settings().setValue(UNFOLDED, self.bar.unfolded)
        self.presets.fold(not self.bar.unfolded)

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.volume is not new.volume or old.transfer != new.transfer:
            self.refresh()
        self._quiet.start()

    def _want_pictures(self) -> None:
        """Ask for the presets' pictures, in the light and from the side that the scene has now."""
        scene = self._editor.scene
        if self._thumbnails is None or scene.volume is None or not self.isVisible():
            return
        ratio = self.devicePixelRatioF()
        size = round(PICTURE[0] * ratio), round(PICTURE[1] * ratio)
        bare = scene.with_(background=(0.0, 0.0, 0.0, 0.0))
        wanted: dict[Hashable, Scene] = {
            row: bare.with_(transfer=p.transfer) for row, p in enumerate(self._presets)
        }
        self._thumbnails.want(GROUP, wanted, size)

    def _on_thumbnail(self, group: str, key: object, image: QImage) -> None:
        if group == GROUP and isinstance(key, int):
            self.presets.show_picture(key, image)

    def showEvent(self, event: QShowEvent) -> None:
        """Want pictures only while the tab is in front; see what other windows saved or broke meanwhile."""
        super().showEvent(event)
        self._quiet.start()
        before = self.own.presets
        self.own.load()
        if self.own.presets != before:
            self._fill()
            self.refresh()
        for problem in self.own.problems:
            if problem not in self._told:
                self._editor.rejected.emit(problem)
        self._told = self.own.problems

    def hideEvent(self, event: QHideEvent) -> None:
        """Want no more pictures."""
        super().hideEvent(event)
        self._quiet.stop()
        if self._thumbnails is not None:
            self._thumbnails.forget(GROUP)

    # -- which preset -----------------------------------------------------------------------------
    def _current(self) -> int | None:
        """Return which preset the scene's function is, whatever its density."""
        transfer = self._editor.scene.transfer
        if transfer is None:
            return None
        alike = [
            i
            for i, p in enumerate(self._presets)
            if (p.transfer.points, p.transfer.regions) == (transfer.points, transfer.regions)
        ]
        return next((i for i in alike if self._presets[i].name == transfer.name), alike[0] if alike else None)

    def _origin(self) -> Preset | None:
        """Return the preset that the scene's function is, or was made from."""
        current, transfer = self._current(), self._editor.scene.transfer
        if current is not None:
            return self._presets[current]
        name = transfer.name if transfer is not None else ""
        return next((p for p in self._presets if name and p.name == name), None)

    def _whole(self) -> WholeFunction | None:
        """Return the scene's function beside its preset's."""
        scene, origin = self._editor.scene, self._origin()
        if scene.volume is None or scene.transfer is None:
            return None
        return WholeFunction(scene.volume, scene.transfer, origin.transfer if origin is not None else None)

    def _is_own(self, row: int | None) -> bool:
        return row is not None and row >= len(self._presets) - len(self.own.presets)

    def _choose(self, row: int) -> None:
        if 0 <= row < len(self._presets):
            preset = self._presets[row]
            self._editor.change(
                "Choose the preset", True, transfer=replace(preset.transfer, name=preset.name)
            )

    def _reset(self) -> None:
        origin = self._origin() or (self._presets[0] if self._presets else None)
        if origin is not None:
            self._editor.change("Reset the function", transfer=replace(origin.transfer, name=origin.name))

    def _take_imported(self, name: str) -> None:
        """Show a preset that was imported, and choose it."""
        self.files.words.clear()
        self._fill()
        self._choose(next(row for row, p in enumerate(self._presets) if self._is_own(row) and p.name == name))
        self.refresh()

    # -- own presets ------------------------------------------------------------------------------
    def _ask_save(self) -> None:
        self._answer = "save"
        self.ask.ask_name("Save", "", self._complaint)

    def _ask_rename(self) -> None:
        row = self._current()
        if self._is_own(row):
            assert row is not None
            old = self._presets[row].name
            self._answer, self._target = "rename", old
            same = old.lower()
            self.ask.ask_name(
                "Rename", old, lambda new: "" if new.strip().lower() == same else self._complaint(new)
            )

    def _complaint(self, name: str) -> str:
        """Return what is wrong with the name of an own preset, or nothing."""
        taken = (p.name.lower() for p in self._presets)
        return self.own.complaint(name) or ("A preset has this name" if name.strip().lower() in taken else "")

    def _ask_delete(self) -> None:
        row = self._current()
        if self._is_own(row):
            assert row is not None
            self._answer, self._target = "delete", self._presets[row].name
            self.ask.ask_yes("Delete", f"Delete the preset {self._target}? Its file goes, too.")

    def _answered(self, name: str) -> None:
        transfer = self._editor.scene.transfer
        renamed = self._answer == "rename" and transfer is not None and transfer.name == self._target
        try:
            if self._answer == "rename":
                self.own.rename(self._target, name)
            elif self._answer == "delete":
                self.own.delete(self._target)
            elif transfer is not None:
                self.own.save(name, transfer)
        except SfumatoError as error:
            self._editor.rejected.emit(str(error))
            return
        self._fill()
        if transfer is not None and (renamed or self._answer == "save"):
            # The scene's function is called as its preset is, so that what is made of it knows where it is from.
            self._editor.change("Name the preset", True, transfer=replace(transfer, name=name))
        self.refresh()
        self.presets.setFocus()
