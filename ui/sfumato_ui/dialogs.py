"""The questions that the window asks: what about unsaved work."""

from __future__ import annotations

from qtpy.QtWidgets import (
    QMessageBox,
    QWidget,
)


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
