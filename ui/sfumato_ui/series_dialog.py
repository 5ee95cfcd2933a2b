"""Which of a folder's DICOM series to open: pictures, names, sizes; the largest volume is proposed."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

import numpy as np
from qtpy.QtCore import QSize, Qt, Signal
from qtpy.QtGui import QColor, QIcon, QImage, QPainter, QPixmap
from qtpy.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QLabel,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from sfumato import SfumatoError

from .slices import slice_image
from .theme import current_theme

#: Side of a thumbnail in pixels.
THUMBNAIL = 72
#: With fewer slices a series is a survey (localizer), not what a folder was opened for.
FEWEST_SLICES = 5
_COLUMNS = ("Series", "Images", "Pixels", "Spacing (mm)")


class SeriesDialog(QDialog):
    """Lists the series of a DICOM folder; Enter or a double click opens the selected one.

    Parameters
    ----------
    path : str
        The folder.
    series : sequence of SeriesInfo
        What is in it.
    """

    #: A series' middle slice, from the thread that reads them (key, slice).
    _read = Signal(str, object)

    def __init__(self, path: str, series: Sequence[Any], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Several series")
        self._series = series
        self._stop = threading.Event()
        self.list = _list_of(series)
        self.list.itemActivated.connect(lambda item, column: self.accept())
        self.list.currentItemChanged.connect(lambda now, before: self._enable())
        self.buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Open | QDialogButtonBox.StandardButton.Cancel
        )
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(10)
        layout.addWidget(QLabel("This folder holds several series. Which one shall be opened?"))
        layout.addWidget(self.list)
        layout.addWidget(self.buttons)
        self.resize(700, 140 + min(5, len(series)) * (THUMBNAIL + 8))
        self._enable()
        self.list.setFocus()
        self._read.connect(self._show_slice)
        self.finished.connect(lambda result: self._stop.set())
        threading.Thread(target=self._look, args=(path,), name="sfumato-previews", daemon=True).start()

    @property
    def chosen(self) -> Any:
        """The selected series."""
        return self._series[self.list.indexOfTopLevelItem(self.list.currentItem())]

    def accept(self) -> None:
        """Open the selected series, if it is a volume."""
        if is_volume(self.chosen):
            super().accept()

    def _enable(self) -> None:
        self.buttons.button(QDialogButtonBox.StandardButton.Open).setEnabled(is_volume(self.chosen))

    def _look(self, path: str) -> None:
        from sfumato.io import preview_series

        try:
            preview_series(path, self._read.emit, cancel=self._stop.is_set)
        except (SfumatoError, RuntimeError):  # the folder went away, or the dialog did
            return

    def _show_slice(self, key: str, plane: np.ndarray) -> None:
        for i, one in enumerate(self._series):
            if one.key == key:
                ratio = self.devicePixelRatioF()
                image = slice_image(plane, one.spacing[:2], round(THUMBNAIL * ratio))
                row = self.list.topLevelItem(i)
                assert row is not None
                row.setIcon(0, _icon(_on_square(image, ratio)))


def is_volume(series: Any) -> bool:
    """Tell whether a series has more than one slice."""
    return bool(series.count > 1)


def largest_volume(series: Sequence[Any]) -> int:
    """Return which series has most voxels; a few slices, however large, come after it, single images last."""
    ranks = [(is_volume(s), s.count >= FEWEST_SLICES, _voxels(s)) for s in series]
    return max(range(len(series)), key=ranks.__getitem__)


def _voxels(series: Any) -> int:
    x, y, z = series.dims
    return int(x * y * z)


def _list_of(series: Sequence[Any]) -> QTreeWidget:
    made = QTreeWidget()
    made.setHeaderLabels(_COLUMNS)
    made.setRootIsDecorated(False)
    made.setUniformRowHeights(True)
    made.setIconSize(QSize(THUMBNAIL, THUMBNAIL))
    made.setAccessibleName("Series")
    made.header().setStretchLastSection(False)
    made.header().setSectionsMovable(False)
    for column in range(len(_COLUMNS)):
        mode = QHeaderView.ResizeMode.ResizeToContents if column else QHeaderView.ResizeMode.Stretch
        made.header().setSectionResizeMode(column, mode)
    rows = [_row(one) for one in series]
    made.addTopLevelItems(rows)
    made.setCurrentItem(rows[largest_volume(series)])
    return made


def _row(series: Any) -> QTreeWidgetItem:
    x, y, _ = series.dims
    spacing = " × ".join(f"{s:.3g}" for s in series.spacing)
    volume = is_volume(series)
    name = series.label if volume else f"{series.label}\nsingle image, not a volume"
    row = QTreeWidgetItem([name, str(series.count), f"{x} × {y}", spacing if volume else "–"])
    empty = QPixmap(THUMBNAIL, THUMBNAIL)
    empty.fill(QColor(current_theme().separator))
    row.setIcon(0, _icon(empty))
    row.setToolTip(0, series.label)
    for column in (1, 2, 3):
        row.setTextAlignment(column, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    if not volume:
        for column in range(len(_COLUMNS)):
            row.setForeground(column, QColor(current_theme().muted))
    return row


def _icon(pixmap: QPixmap) -> QIcon:
    """Return an icon that keeps its greys where it is selected."""
    made = QIcon(pixmap)
    made.addPixmap(pixmap, QIcon.Mode.Selected)
    return made


def _on_square(image: QImage, ratio: float) -> QPixmap:
    """Return a picture in the middle of a black square, so that all rows are alike."""
    side = round(THUMBNAIL * ratio)
    square = QPixmap(side, side)
    square.fill(QColor("black"))
    painter = QPainter(square)
    painter.drawImage((side - image.width()) // 2, (side - image.height()) // 2, image)
    painter.end()
    square.setDevicePixelRatio(ratio)
    return square
