"""The transfer function's colours from a library's map, and its mirror along the values."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QSize
from qtpy.QtGui import QIcon, QImage, QPixmap
from qtpy.QtWidgets import QHBoxLayout, QPushButton, QWidget

from sfumato import TransferFunction
from sfumato.export.encode import srgb
from sfumato.scene.transfer_whole import COLOR_MAPS, colored, inverted, map_colors

from .editing import Editor
from .generated import ChoiceBox, labelled

#: Width and height of a map's picture in the menu.
STRIP = QSize(48, 14)
PROMPT = "As they are"


class MapRow(QWidget):
    """A menu of colour maps, and a button that mirrors the function."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._chosen = ""
        self.maps = ChoiceBox()
        self.maps.setAccessibleName("Colours of the function")
        self.maps.setToolTip(
            "Colours of a map over the values that the function shows, from left to right; opacities stay. "
            "Points are added where colours between two would not be those of the map"
        )
        self.maps.setIconSize(STRIP)
        self.maps.addItem(PROMPT)
        for title, name in COLOR_MAPS.items():
            self.maps.addItem(_strip(name), title, name)
        self.mirror = QPushButton("Mirror")
        self.mirror.setProperty("compact", True)
        self.mirror.setToolTip("Mirrors the function along the values, about the middle of its points")
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        row.addWidget(labelled("Colours", self.maps), 1)
        row.addWidget(self.mirror)
        self.maps.activated.connect(self._color)
        self.mirror.clicked.connect(lambda: self._change("Mirror the function", inverted))

    def _color(self, index: int) -> None:
        title, name = self.maps.itemText(index), self.maps.itemData(index)
        if name is not None:
            self._chosen = name
            self._change(f"Colour by {title}", lambda transfer: colored(transfer, name))
        self.refresh()

    def _change(self, label: str, change: Callable[[TransferFunction], TransferFunction]) -> None:
        transfer = self._editor.scene.transfer
        if transfer is not None:
            # Arrow keys go through the maps: that is one step.
            self._editor.change(label, True, transfer=change(transfer))

    def refresh(self) -> None:
        """Name the map that was chosen last as long as the function has its colours."""
        transfer = self._editor.scene.transfer
        same = transfer is not None and self._chosen and colored(transfer, self._chosen) == transfer
        self.maps.setCurrentIndex(self.maps.findData(self._chosen) if same else 0)


def _strip(name: str) -> QIcon:
    """Return a map's colours from left to right."""
    colors = srgb(map_colors(name, np.linspace(0, 1, STRIP.width())))
    pixels = np.ascontiguousarray(
        np.rint(255 * np.repeat(colors[None], STRIP.height(), axis=0)).astype(np.uint8)
    )
    image = QImage(pixels.data, STRIP.width(), STRIP.height(), 3 * STRIP.width(), QImage.Format.Format_RGB888)
    return QIcon(QPixmap.fromImage(image.copy()))
