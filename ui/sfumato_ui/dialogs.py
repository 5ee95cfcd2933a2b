"""The questions that the window asks: how large a picture, what about unsaved work."""

from __future__ import annotations

from qtpy.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QMessageBox,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)


class PictureDialog(QDialog):
    """Asks for the size of the picture and whether its surround is transparent."""

    def __init__(self, size: tuple[int, int], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Save picture")
        self.wide, self.tall = _pixels("Width", size[0]), _pixels("Height", size[1])
        self.transparent = QCheckBox("Transparent background")
        form = QFormLayout()
        form.setSpacing(8)
        form.addRow("Width", self.wide)
        form.addRow("Height", self.tall)
        form.addRow("", self.transparent)
        buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Save | QDialogButtonBox.StandardButton.Cancel
        )
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 14)
        column.setSpacing(12)
        column.addLayout(form)
        column.addWidget(buttons)

    @property
    def size_in_pixels(self) -> tuple[int, int]:
        """Width and height."""
        return self.wide.value(), self.tall.value()


def _pixels(name: str, value: int) -> QSpinBox:
    box = QSpinBox()
    box.setRange(16, 8192)
    box.setButtonSymbols(QSpinBox.ButtonSymbols.NoButtons)
    box.setValue(value)
    box.setSuffix(" px")
    box.setAccessibleName(f"{name} in pixels")
    return box


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
