"""The questions that the window asks: which series, how large a picture, what about unsaved work."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHeaderView,
    QLabel,
    QMessageBox,
    QSpinBox,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)


class SeriesDialog(QDialog):
    """Lists the series of a DICOM folder; Enter opens the selected one."""

    def __init__(self, series: Sequence[Any], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Several series")
        self._series = series
        self.list = QTreeWidget()
        self.list.setHeaderLabels(["Series", "Images", "Spacing (mm)"])
        self.list.setRootIsDecorated(False)
        self.list.header().setStretchLastSection(False)
        self.list.header().setSectionsMovable(False)
        self.list.setAccessibleName("Series")
        for column, mode in enumerate(("Stretch", "ResizeToContents", "ResizeToContents")):
            self.list.header().setSectionResizeMode(column, QHeaderView.ResizeMode[mode])
        for one in series:
            spacing = " × ".join(f"{s:.2f}" for s in one.spacing) if one.spacing else "not known"
            row = QTreeWidgetItem([one.label, str(one.count), spacing])
            row.setTextAlignment(1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            self.list.addTopLevelItem(row)
        largest = max(range(len(series)), key=lambda i: series[i].count)
        self.list.setCurrentIndex(self.list.model().index(largest, 0))
        self.list.itemActivated.connect(lambda item, column: self.accept())
        buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Open | QDialogButtonBox.StandardButton.Cancel
        )
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(10)
        layout.addWidget(QLabel("This folder holds several series. Which one shall be opened?"))
        layout.addWidget(self.list)
        layout.addWidget(buttons)
        self.resize(560, 300)

    @property
    def chosen(self) -> Any:
        """The selected series."""
        return self._series[self.list.indexOfTopLevelItem(self.list.currentItem())]


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
