"""The user's own rigs below the others: kept from the lamps as they are, renamed, deleted, shared as files."""

from __future__ import annotations

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from sfumato import Scene, SfumatoError
from sfumato.scene.rig_files import SUFFIX, load_rig, normalised, write_rig
from sfumato.scene.rigs import Rig

from .auto_exposure import AutoExposure
from .dialogs import ask_for_export, ask_for_import
from .editing import Editor
from .icons import icon
from .own_rigs import OwnRigs
from .preset_bar import AskLine
from .rigs_row import RigsRow
from .theme import current_theme
from .thumbnails import Thumbnails

GROUP = "own rigs"
FILTER = f"Rigs (*{SUFFIX})"


class OwnRigsRow(QWidget):
    """A heading with buttons, the line that asks for names, and the rigs as live pictures."""

    #: The buttons of the rigs were made anew.
    rebuilt = Signal()

    def __init__(self, editor: Editor, thumbnails: Thumbnails, auto: AutoExposure) -> None:
        super().__init__()
        self._editor = editor
        self.own = OwnRigs()
        self.row = RigsRow(editor, thumbnails, auto, GROUP, ())
        self.ask = AskLine("rig")
        self._answer, self._target = "", ""
        self.save = _button("Keep the lamps as an own rig")
        self.rename = _button("Rename the own rig")
        self.delete = _button("Delete the own rig")
        self.get = _button("Import a rig's file")
        self.share = _button("Export the own rig as a file")
        self._lay_out()
        self.save.clicked.connect(self._ask_save)
        self.rename.clicked.connect(self._ask_rename)
        self.delete.clicked.connect(self._ask_delete)
        self.get.clicked.connect(self._ask_import)
        self.share.clicked.connect(self._ask_export)
        self.ask.answered.connect(self._answered)
        editor.changed.connect(self._on_changed)
        self._fill()
        self.refresh_theme()

    def _lay_out(self) -> None:
        heading = QHBoxLayout()
        heading.setSpacing(2)
        heading.addWidget(QLabel("Own rigs"), 1)
        for button in (self.save, self.rename, self.delete, self.get, self.share):
            heading.addWidget(button)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addLayout(heading)
        column.addWidget(self.ask)
        column.addWidget(self.row)

    # -- showing ----------------------------------------------------------------------------------
    def _fill(self) -> None:
        """Show the rigs that are kept, and say what could not be read."""
        self.row.set_rigs(tuple(self.own.kept.values()))
        self.row.setVisible(bool(self.own.kept))
        for problem in self.own.problems:
            self._editor.rejected.emit(problem)
        self.refresh()
        self.rebuilt.emit()

    def set_reason(self, reason: str) -> None:
        """Disable the rigs for a reason, or enable them if there is none."""
        self.row.set_reason(reason)
        self.refresh()

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.lights != new.lights or old.volume is not new.volume:
            self.refresh()

    def refresh(self) -> None:
        """Offer what can be done with the present lamps, or with the rig that they are."""
        volume = self._editor.scene.volume is not None
        self.save.setEnabled(volume)
        self.get.setEnabled(volume)
        chosen = self._chosen() is not None
        for button, words in (
            (self.rename, "Rename the own rig"),
            (self.delete, "Delete the own rig"),
            (self.share, "Export the own rig as a file"),
        ):
            button.setEnabled(chosen)
            button.setToolTip(words if chosen else f"{words}: choose one first")

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        for button, name in (
            (self.save, "add"), (self.rename, "rename"), (self.delete, "remove"),
            (self.get, "open"), (self.share, "save"),
        ):  # fmt: skip
            button.setIcon(icon(name, current_theme()))

    def _chosen(self) -> Rig | None:
        """Return the own rig by which the scene is lit."""
        name = self.row.current
        return self.own.kept.get(name) if name else None

    # -- keeping ----------------------------------------------------------------------------------
    def _ask_save(self) -> None:
        self._answer = "save"
        self.ask.ask_name("Save", "", self.own.complaint)

    def _ask_rename(self) -> None:
        rig = self._chosen()
        if rig is not None:
            old = self._named(rig)
            self._answer, self._target = "rename", old
            self.ask.ask_name(
                "Rename",
                old,
                lambda new: "" if new.strip().lower() == old.lower() else self.own.complaint(new),
            )

    def _ask_delete(self) -> None:
        rig = self._chosen()
        if rig is not None:
            self._answer, self._target = "delete", self._named(rig)
            self.ask.ask_yes("Delete", f"Delete the rig {self._target}? Its file goes, too.")

    def _named(self, rig: Rig) -> str:
        return next(name for name, kept in self.own.kept.items() if kept is rig)

    def _answered(self, name: str) -> None:
        scene = self._editor.scene
        try:
            if self._answer == "rename":
                self.own.rename(self._target, name)
            elif self._answer == "delete":
                self.own.delete(self._target)
            elif scene.volume is not None:
                self.own.save(name, Rig(name, name, "", normalised(scene.lights, scene.volume)))
        except SfumatoError as error:
            self._editor.rejected.emit(str(error))
            return
        self._fill()
        self.save.setFocus()

    # -- sharing ----------------------------------------------------------------------------------
    def _ask_import(self) -> None:
        ask_for_import(self.window(), "Import a rig", FILTER, self.take)

    def take(self, path: str) -> None:
        """Keep the rig of a file among the own ones; a name that is taken gets a number."""
        try:
            rig = load_rig(path)
            self.own.save(self.own.free_name(rig.title), rig)
        except SfumatoError as error:
            self._editor.rejected.emit(str(error))
            return
        self._fill()

    def _ask_export(self) -> None:
        rig = self._chosen()
        if rig is None:
            return
        ask_for_export(
            self.window(),
            "Export the rig",
            self._named(rig),
            SUFFIX,
            FILTER,
            lambda path: self._give(path, rig),
        )

    def _give(self, path: str, rig: Rig) -> None:
        try:
            write_rig(path, rig)
        except SfumatoError as error:
            self._editor.rejected.emit(str(error))


def _button(name: str) -> QToolButton:
    button = QToolButton()
    button.setAccessibleName(name)
    button.setToolTip(name)
    return button


__all__ = ["OwnRigsRow"]
