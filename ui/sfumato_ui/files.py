"""Opening and saving: from the wish, over question and progress, to the result or its message."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from qtpy.QtCore import QObject, Signal
from qtpy.QtWidgets import QDialog, QFileDialog, QWidget

from sfumato import Geometry, Scene, SfumatoError, Tracing
from sfumato.geometry import is_geometry

from .autosave import Slot
from .dialogs import ask_about_unsaved
from .editing import Editor
from .loading import SAMPLE, SCENE_SUFFIX, Loader, Wish, geometry_notices
from .messages import MessageBar
from .raw_dialog import RawDialog
from .recent import last_folder, recent_folders, remember
from .series_dialog import SeriesDialog
from .subject import is_open, name_of, technique_drawing_geometry


class Files(QObject):
    """What touches the disk, on behalf of one window."""

    #: Another scene is open.
    opened = Signal()
    #: What a crash left behind is open (its slot).
    recovered = Signal(object)
    #: The scene was saved.
    scene_saved = Signal()

    def __init__(
        self, window: QWidget, editor: Editor, bar: MessageBar, aspect: Callable[[], float] = lambda: 1.0
    ) -> None:
        super().__init__(window)
        self._window, self._editor, self._bar, self._aspect = window, editor, bar, aspect
        self.loader = Loader()
        self.scene_path = ""
        self._wish = Wish("")
        #: Geometry that is to be added to what is being opened.
        self._more: list[str] = []
        self._connect()

    def _connect(self) -> None:
        loader = self.loader
        loader.progress.connect(
            lambda done, text: self._bar.show_progress(f"Opening {self._wish.name}… {text}", done)
        )
        loader.loaded.connect(self._on_loaded)
        loader.geometry_loaded.connect(self._on_geometry)
        loader.traced.connect(self._on_traced)
        loader.several.connect(self._ask_for_series)
        loader.raw_found.connect(self._ask_for_form)
        loader.reduced.connect(self._on_reduced)
        loader.volume_missing.connect(self._on_missing)
        loader.failed.connect(self._on_failed)
        loader.cancelled.connect(lambda: self._bar.clear("progress"))
        self._bar.cancelled.connect(self._cancel)

    def _cancel(self) -> None:
        self._more.clear()
        self.loader.cancel()
        self._bar.clear("progress")

    # -- opening ----------------------------------------------------------------------------------
    def ask_to_open(self) -> None:
        """Let the user choose a file; folders are dropped on the window or chosen by any file in them."""
        dialog = QFileDialog(self._window, "Open a volume, tracts, a mesh or a scene", last_folder())
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.fileSelected.connect(self.open)
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def ask_to_open_folder(self) -> None:
        """Let the user choose a folder."""
        dialog = QFileDialog(self._window, "Open a folder", last_folder())
        dialog.setFileMode(QFileDialog.FileMode.Directory)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
        dialog.fileSelected.connect(self.open)
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def open(self, path: str) -> None:
        """Open a path, after asking about unsaved work; tracts and meshes join what is open."""
        self.open_all([path])

    def open_all(self, paths: list[str]) -> None:
        """Open the first path that is no geometry, and add all geometry to it, or to what is open."""
        geometry = [p for p in paths if is_geometry(p)]
        others = [p for p in paths if p not in geometry]
        if not others and is_open(self._editor.scene):
            self._add_geometry(geometry)
        elif (others or geometry) and self.may_leave():
            self._more = geometry if others else geometry[1:]
            self._begin(Wish((others or geometry)[0]))

    def _add_geometry(self, paths: list[str]) -> None:
        self._wish = Wish(paths[0])
        self._bar.show_progress(f"Opening {self._wish.name}… ", 0.0)
        self._bar.repaint()
        self.loader.open_geometry(paths, self._editor.scene)

    def trace(self, tracing: Tracing) -> None:
        """Trace streamlines, instead of those that were traced before."""
        self._wish = Wish(tracing.path)
        self.loader.trace(tracing)

    def _on_traced(self, made: Geometry) -> None:
        """Show new streamlines as the ones that they replace were shown."""
        self._bar.clear("progress")
        self._bar.clear("error")
        scene = self._editor.scene
        old = next((g for g in scene.geometry if g.tracing and g.path == made.path), None)
        if old is not None:
            made = replace(old, shape=made.shape, tracing=made.tracing, name=made.name, notices=made.notices)
        geometry = tuple(made if g is old else g for g in scene.geometry) + (() if old else (made,))
        self._editor.change(
            "Trace streamlines", True, technique=technique_drawing_geometry(scene), geometry=geometry
        )
        if made.notices:
            self._bar.show_notice("\n".join(made.notices))

    def _on_geometry(self, geometry: tuple[Geometry, ...], notices: tuple[str, ...]) -> None:
        self._bar.clear("progress")
        self._bar.clear("error")
        scene = self._editor.scene
        for one in geometry:
            if one.path:
                remember(one.path)
        names = ", ".join(one.name for one in geometry)
        self._editor.change(
            f"Add {names}",
            technique=technique_drawing_geometry(scene),
            geometry=(*scene.geometry, *geometry),
        )
        if notices:
            self._bar.show_notice("\n".join(notices))

    def _begin(self, wish: Wish) -> None:
        wish = replace(wish, places=tuple(recent_folders()))
        self._wish = wish
        self._bar.show_progress(f"Opening {wish.name}… ", 0.0)
        # At once: a reader's first import may hold the interpreter for half a second.
        self._bar.repaint()
        self.loader.open(wish, self._aspect())

    def _on_loaded(self, scene: Scene, wish: Wish) -> None:
        self.scene_path = wish.slot.about().scene_path if wish.slot else wish.scene_path
        if not (wish.is_sample or wish.slot):
            remember(wish.path)
        self._bar.clear("progress")
        self._bar.clear("error")
        self._editor.reset(scene)
        if wish.slot:
            self._editor.document.mark_unsaved()
            self.recovered.emit(wish.slot)
        self.opened.emit()
        notices = [*(scene.volume.info.notices if scene.volume is not None else ())]
        for geometry in scene.geometry:
            notices += geometry_notices(geometry, scene.volume)
        if notices:
            self._bar.show_notice("\n".join(dict.fromkeys(notices)))
        if self._more:
            more, self._more = self._more, []
            self._add_geometry(more)

    def recover(self, slot: Slot) -> bool:
        """Open what a crash left behind, after asking about unsaved work; tells whether that was allowed."""
        if not self.may_leave():
            return False
        self._begin(Wish(str(slot.scene_file), slot=slot))
        return True

    def path(self) -> str:
        """Return the path of what is open, as the recent files list it; nothing if it has none."""
        scene = self._editor.scene
        named = scene.volume.info.path if scene.volume is not None else ""
        named = named or next((g.path for g in scene.geometry if g.path), "")
        named = self.scene_path or named
        return os.path.abspath(named) if named and not named.startswith(SAMPLE) else ""

    def identify(self) -> tuple[str, str]:
        """Return the scene's file, or nothing, and its name."""
        return self.scene_path, self.name

    def _on_missing(self, wish: Wish, message: str) -> None:
        """Let the user say where a scene's volume is now."""
        self._on_failed(message, {"Find it…": lambda: self._ask_for_volume(wish)})

    def _ask_for_volume(self, wish: Wish) -> None:
        dialog = QFileDialog(self._window, f"Where is the volume of {wish.name}?", last_folder())
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.fileSelected.connect(lambda path: self._begin(replace(wish, volume=path)))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _on_failed(self, message: str, answers: dict[str, Callable[[], object]] | None = None) -> None:
        if self._wish.slot:  # it is offered again at the next start
            self._wish.slot.release()
        self._more.clear()
        kept = " What was open stays open." if is_open(self._editor.scene) else ""
        self._bar.show_error(f"{message}.{kept}", answers)

    def _ask_for_series(self, path: str, series: Any) -> None:
        dialog = SeriesDialog(path, series, self._window)
        dialog.accepted.connect(lambda: self._begin(Wish(path, series=dialog.chosen.key)))
        self._ask(dialog)

    def _ask_for_form(self, path: str, guesses: Any) -> None:
        dialog = RawDialog(path, guesses, self._window)
        dialog.accepted.connect(lambda: self._begin(Wish(path, raw=dialog.form)))
        dialog.accepted.connect(lambda: self._keep_form(dialog))
        self._ask(dialog)

    def _ask(self, dialog: QDialog) -> None:
        """Ask what is needed to open something; it is given up with the dialog."""
        self._bar.clear("progress")
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _keep_form(self, dialog: RawDialog) -> None:
        try:
            dialog.keep_form()
        except SfumatoError as error:
            self._bar.show_error(f"The description could not be kept: {error}")

    # -- a device that is too small ---------------------------------------------------------------
    def reduce(self) -> None:
        """Take the volume at half its resolution."""
        self._wish = Wish("a smaller volume")
        self.loader.reduce(self._editor.scene)

    def _on_reduced(self, scene: Scene) -> None:
        self._bar.clear("progress")
        self._editor.change("Use a smaller volume", volume=scene.volume)
        self.opened.emit()

    # -- the scene --------------------------------------------------------------------------------
    @property
    def name(self) -> str:
        """Name of what is open."""
        if self.scene_path:
            return Path(self.scene_path).stem
        return name_of(self._editor.scene)

    def may_leave(self) -> bool:
        """Ask about unsaved work; tells whether it may be left behind."""
        if not self._editor.document.modified:
            return True
        answer = ask_about_unsaved(self.name, self._window)
        return answer == "discard" or (answer == "save" and self.save_scene(wait=True))

    def save_scene(self, wait: bool = False) -> bool:
        """Save to the scene's file, or ask for one; tells whether it was saved, if it is to wait for that."""
        if not is_open(self._editor.scene):
            return False
        return self.save_scene_as(self.scene_path) if self.scene_path else self.ask_to_save_scene(wait)

    def ask_to_save_scene(self, wait: bool = False) -> bool:
        """Let the user choose the scene's file; tells whether it was saved, if it is to wait for that."""
        if not is_open(self._editor.scene):
            return False
        start = self.scene_path or str(Path(last_folder()) / f"{self.name or 'scene'}{SCENE_SUFFIX}")
        dialog = QFileDialog(self._window, "Save the scene", start, f"Scenes (*{SCENE_SUFFIX})")
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(SCENE_SUFFIX[1:])
        saved: list[bool] = []
        dialog.fileSelected.connect(lambda path: saved.append(self.save_scene_as(path)))
        if wait:
            dialog.exec()
            dialog.deleteLater()
        else:
            dialog.finished.connect(dialog.deleteLater)
            dialog.open()
        return bool(saved and saved[0])

    def save_scene_as(self, path: str) -> bool:
        """Write the scene to a file; a message tells if it could not be written."""
        try:
            self._editor.scene.save(path)
        except SfumatoError as error:
            self._bar.show_error(f"{error}. Choose another place.")
            return False
        self.scene_path = path
        self._editor.document.mark_saved()
        remember(path)
        self._bar.show_notice(f"Saved {path}")
        self.scene_saved.emit()
        return True
