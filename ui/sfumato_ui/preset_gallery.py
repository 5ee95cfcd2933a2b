"""Presets as pictures with names: one control for Tab, the arrow keys go from preset to preset."""

from __future__ import annotations

from collections.abc import Sequence

from qtpy.QtCore import QRectF, QSize, Qt, Signal
from qtpy.QtGui import QIcon, QImage, QKeyEvent, QPainter, QPainterPath, QPixmap, QResizeEvent, QWheelEvent
from qtpy.QtWidgets import QListView, QListWidget, QListWidgetItem

from sfumato.scene.presets import Preset

from .theme import PICTURE_GREY
from .transfer_editor.painting import small
from .transfer_preview import ramp

#: Width and height of a preset's picture in pixels.
PICTURE = (84, 66)
COLUMNS = 3
#: Presets that are shown while the gallery is folded: with more rows the function would lie below the window's edge.
FEW = 2 * COLUMNS
_SWATCH = 7


class PresetGallery(QListWidget):
    """A grid of presets that is as tall as its rows; the wheel scrolls the panel around it.

    Attributes
    ----------
    pictures : dict of int to QImage
        The pictures that have come, by row.
    """

    #: The user chose this row.
    chosen = Signal(int)
    #: F2 or Del was pressed, or a preset double-clicked.
    rename_wanted = Signal()
    #: A preset is marked that the folded gallery does not show.
    hidden_marked = Signal()
    delete_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._presets: tuple[Preset, ...] = ()
        self._words, self._folded = "", True
        self.pictures: dict[int, QImage] = {}
        self.setViewMode(QListView.ViewMode.IconMode)
        self.setMovement(QListView.Movement.Static)
        self.setResizeMode(QListView.ResizeMode.Adjust)
        self.setIconSize(QSize(*PICTURE))
        self.setProperty("gallery", True)
        self.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName("Presets")
        # Not the current row: Qt makes the first one current when the focus comes.
        self.itemSelectionChanged.connect(self._tell)
        self.itemDoubleClicked.connect(lambda item: self.rename_wanted.emit())

    # -- contents ---------------------------------------------------------------------------------
    def fill(self, presets: Sequence[Preset]) -> None:
        """Show presets, by their colours until their pictures come."""
        self._presets, self.pictures = tuple(presets), {}
        self.blockSignals(True)
        self.clear()
        for preset in presets:
            item = QListWidgetItem(preset.name)
            item.setToolTip(f"{preset.name}: {preset.description}")
            self.addItem(item)
        self.blockSignals(False)
        for row in range(len(presets)):
            self._draw(row)
        self._hide_rows()

    def show_picture(self, row: int, image: QImage) -> None:
        """Show a preset's picture."""
        if 0 <= row < self.count():
            self.pictures[row] = image
            self._draw(row)

    def mark(self, row: int | None) -> None:
        """Mark a preset as the current one, or none, without telling anybody."""
        self.blockSignals(True)
        self.setCurrentRow(-1 if row is None else row)
        if row is None:
            self.clearSelection()
        self.blockSignals(False)
        if row is not None and self._folded and row >= FEW:
            self.hidden_marked.emit()

    def _tell(self) -> None:
        for index in self.selectedIndexes():
            self.chosen.emit(index.row())

    def _draw(self, row: int) -> None:
        """Compose a preset's icon: its picture on the picture's grey, above a strip of its colours."""
        ratio = self.devicePixelRatioF()
        pixmap = QPixmap(QSize(*PICTURE) * ratio)
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(Qt.GlobalColor.transparent)
        painter = QPainter(pixmap)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        rounded = QPainterPath()
        rounded.addRoundedRect(QRectF(0, 0, *PICTURE), 4, 4)
        painter.setClipPath(rounded)
        painter.fillRect(0, 0, *PICTURE, PICTURE_GREY)
        transfer = self._presets[row].transfer
        if row in self.pictures:
            painter.drawImage(QRectF(0, 0, *PICTURE), self.pictures[row])
        else:
            painter.setOpacity(0.4)
            painter.drawImage(QRectF(0, 0, *PICTURE), ramp(transfer, PICTURE[0]))
            painter.setOpacity(1.0)
        strip = QRectF(0, PICTURE[1] - _SWATCH, PICTURE[0], _SWATCH)
        painter.drawImage(strip, ramp(transfer, PICTURE[0]))
        painter.end()
        icon = QIcon()
        # The same for the selected state: Qt would tint it.
        for mode in (QIcon.Mode.Normal, QIcon.Mode.Selected):
            icon.addPixmap(pixmap, mode)
        self.item(row).setIcon(icon)

    def seek(self, words: str) -> None:
        """Show only presets that hold all of some words."""
        self._words = words.lower()
        self._hide_rows()

    def fold(self, folded: bool) -> None:
        """Show the first presets alone, or all; a search finds all in any case."""
        self._folded = folded
        self._hide_rows()

    def _hide_rows(self) -> None:
        words = self._words.split()
        for row, preset in enumerate(self._presets):
            text = f"{preset.name} {preset.description}".lower()
            beyond = self._folded and not words and row >= FEW
            self.setRowHidden(row, beyond or not all(word in text for word in words))
        self._fit()

    # -- size -------------------------------------------------------------------------------------
    def _fit(self) -> None:
        """Take the height of all rows; the names are a little smaller than other text, so that they fit."""
        parent = self.parentWidget()
        self.setFont(small((parent or self).font()))
        width = max(1, (self.width() - 2 * self.frameWidth() - 2) // COLUMNS)
        height = PICTURE[1] + self.fontMetrics().height() + 14
        self.setGridSize(QSize(width, height))
        for row in range(self.count()):  # else names would be cut off at the width of the picture
            self.item(row).setSizeHint(QSize(width - 1, height - 4))
        shown = sum(not self.isRowHidden(row) for row in range(self.count()))
        rows = -(-shown // COLUMNS)
        self.setFixedHeight(max(1, rows) * height + 2 * self.frameWidth() + 2)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the columns."""
        super().resizeEvent(event)
        self._fit()

    # -- keys and wheel ---------------------------------------------------------------------------
    def keyPressEvent(self, event: QKeyEvent) -> None:
        """F2 renames, Del deletes, arrows choose; letters are the window's."""
        if event.key() == Qt.Key.Key_F2:
            self.rename_wanted.emit()
        elif event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.delete_wanted.emit()
        elif event.text().strip():
            # Qt would look for a name that begins with the letter: holding B would choose Bone.
            event.ignore()
        else:
            super().keyPressEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Let the panel scroll."""
        event.ignore()
