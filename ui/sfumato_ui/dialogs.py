"""The questions that the window asks: what about unsaved work, which file to take, where to write one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from qtpy.QtWidgets import (
    QFileDialog,
    QMessageBox,
    QWidget,
)

from .recent import last_folder


def ask_about_unsaved(name: str, parent: QWidget) -> str:
    """Ask what to do about unsaved changes; returns ``save``, ``discard`` or ``cancel``."""
    kind = QMessageBox.StandardButton
    box = QMessageBox(
        QMessageBox.Icon.Question, "Unsaved changes", f"Save the changes to “{name}”?",
        kind.Save | kind.Discard | kind.Cancel, parent,
    )  # fmt: skip
    box.setInformativeText("Light, view and material are lost otherwise.")
    box.setDefaultButton(kind.Save)
    answer = box.exec()
    box.deleteLater()
    return {kind.Save: "save", kind.Discard: "discard"}.get(kind(answer), "cancel")


def ask_for_import(parent: QWidget, title: str, kinds: str, take: Callable[[str], object]) -> None:
    """Let the user choose a file, and hand over its path."""
    dialog = QFileDialog(parent, title, last_folder(), kinds)
    dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
    _open(dialog, take)


def ask_for_export(
    parent: QWidget, title: str, name: str, suffix: str, kinds: str, give: Callable[[str], object]
) -> None:
    """Let the user choose where to write something of a name, and hand over the path."""
    dialog = QFileDialog(parent, title, str(Path(last_folder()) / f"{name}{suffix}"), kinds)
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setDefaultSuffix(suffix[1:])
    _open(dialog, give)


def _open(dialog: QFileDialog, chosen: Callable[[str], object]) -> None:
    dialog.fileSelected.connect(chosen)
    dialog.finished.connect(dialog.deleteLater)
    dialog.open()
