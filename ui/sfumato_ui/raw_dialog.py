"""How to read bare voxels: size, type, spacing and offset, with guesses and the middle slice to judge by."""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from typing import Any

import numpy as np
from qtpy.QtCore import Qt, QTimer, Signal
from qtpy.QtGui import QImage, QPixmap
from qtpy.QtWidgets import (
    QAbstractSpinBox,
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from sfumato.io import RawGuess, describe_raw

from .slices import slice_image
from .theme import PICTURE_GREY, current_theme

TYPES = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")
#: Side of the preview in pixels.
PREVIEW = 280
#: Quiet time in milliseconds before the preview is read again.
PREVIEW_MS = 80
_OWN = "Own values"


class RawDialog(QDialog):
    """Asks how a raw file is to be read.

    Parameters
    ----------
    path : str
        The file.
    guesses : sequence of RawGuess
        Proposals, best first; may be empty.
    """

    #: The middle slice, from the thread that reads it (which request, picture or None).
    _read = Signal(int, object)

    def __init__(self, path: str, guesses: Sequence[RawGuess], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Raw voxels")
        self._path, self._guesses = path, list(guesses)
        self._size = os.stat(path).st_size
        self._serial = 0
        self._filling = False
        self._make_fields()
        self._lay_out()
        self._late = QTimer(self)
        self._late.setSingleShot(True)
        self._late.timeout.connect(self._ask_for_slice)
        self._read.connect(self._show_slice)
        self._connect()
        if self._guesses:
            self._take_guess(0)
        self._on_edited()

    # -- building ---------------------------------------------------------------------------------
    def _make_fields(self) -> None:
        self.proposals = QComboBox()
        self.proposals.setAccessibleName("Proposal")
        self.proposals.addItems([_words(g) for g in self._guesses] + [_OWN])
        self.dims = [_whole(f"Voxels along {axis}", 1, 100_000, 64) for axis in "xyz"]
        self.spacing = [_length(f"Spacing along {axis} in mm") for axis in "xyz"]
        self.type = QComboBox()
        self.type.setAccessibleName("Type of the voxels")
        self.type.addItems(TYPES)
        self.big = QCheckBox("Big endian")
        self.big.setToolTip("The most significant byte comes first")
        self.offset = _whole("Offset in bytes", 0, 2**31 - 1, 0)
        self.offset.setSuffix(" bytes")
        self.offset.setToolTip("Bytes before the first voxel")
        self.keep = QCheckBox("Keep this description beside the file")
        self.keep.setToolTip("A small .json file, with which the file and scenes on it open without asking")
        self.keep.setChecked(True)
        self.verdict = QLabel()
        self.verdict.setWordWrap(True)
        self.verdict.setMinimumHeight(2 * self.fontMetrics().lineSpacing() + 4)
        self.preview = QLabel("Middle slice")
        self.preview.setAccessibleName("Middle slice")
        self.preview.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.preview.setFixedSize(PREVIEW, PREVIEW)
        self.preview.setStyleSheet(f"background: {PICTURE_GREY}; color: white; border-radius: 4px;")
        self.buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Open | QDialogButtonBox.StandardButton.Cancel
        )

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.setSpacing(8)
        form.addRow("Proposal", self.proposals)
        form.addRow("Voxels x, y, z", _side_by_side(self.dims))
        form.addRow("Type", _side_by_side([self.type, self.big]))
        form.addRow("Spacing x, y, z", _side_by_side(self.spacing))
        form.addRow("Offset", self.offset)
        form.addRow("", self.keep)
        left = QVBoxLayout()
        left.setSpacing(10)
        title = QLabel(f"{os.path.basename(self._path)} does not say how its voxels are stored.")
        title.setWordWrap(True)
        left.addWidget(title)
        left.addLayout(form)
        left.addWidget(self.verdict)
        left.addStretch(1)
        columns = QHBoxLayout()
        columns.setSpacing(16)
        columns.addLayout(left, 1)
        columns.addWidget(self.preview, 0, Qt.AlignmentFlag.AlignTop)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(12)
        layout.addLayout(columns)
        layout.addWidget(self.buttons)

    def _connect(self) -> None:
        self.proposals.activated.connect(self._take_guess)
        for whole in (*self.dims, self.offset):
            whole.valueChanged.connect(self._on_typed)
        for length in self.spacing:
            length.valueChanged.connect(self._on_typed)
        self.type.currentIndexChanged.connect(self._on_typed)
        self.big.toggled.connect(self._on_typed)
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)

    # -- what is asked for --------------------------------------------------------------------------
    @property
    def form(self) -> RawGuess:
        """How the file is to be read."""
        plain = np.dtype(self.type.currentText())
        swapped = self.big.isChecked() and plain.itemsize > 1
        name = plain.newbyteorder(">").str if swapped else plain.name
        x, y, z = (box.value() for box in self.dims)
        sx, sy, sz = (box.value() for box in self.spacing)
        return RawGuess((x, y, z), name, (sx, sy, sz), self.offset.value())

    def keep_form(self) -> None:
        """Write the description beside the file, if that is wished.

        Raises
        ------
        LoadError
            If the folder cannot be written.
        """
        if self.keep.isChecked():
            describe_raw(self._path, self.form)

    @property
    def missing(self) -> int:
        """Bytes that the file is too short for what is asked; negative if there are more than enough."""
        how = self.form
        x, y, z = how.dims
        return how.offset + x * y * z * np.dtype(how.dtype).itemsize - self._size

    # -- events -----------------------------------------------------------------------------------
    def _take_guess(self, index: int) -> None:
        if index >= len(self._guesses):
            return
        guess, self._filling = self._guesses[index], True
        for box, count in zip(self.dims, guess.dims, strict=True):
            box.setValue(count)
        for length, step in zip(self.spacing, guess.spacing, strict=True):
            length.setValue(step)
        dtype = np.dtype(guess.dtype)
        self.type.setCurrentText(dtype.name)
        self.big.setChecked(dtype.byteorder == ">")
        self.offset.setValue(guess.offset)
        self._filling = False
        self._on_edited()

    def _on_typed(self) -> None:
        if not self._filling:
            self.proposals.setCurrentIndex(self.proposals.count() - 1)
            self._on_edited()

    def _on_edited(self) -> None:
        self.big.setEnabled(np.dtype(self.type.currentText()).itemsize > 1)
        missing = self.missing
        self.buttons.button(QDialogButtonBox.StandardButton.Open).setEnabled(missing <= 0)
        flat = min(self.form.dims) < 2
        if flat:
            self._say("A volume needs at least 2 voxels along each axis.", bad=True)
        elif missing > 0:
            self._say(f"The file is {missing:,} bytes too short for this.", bad=True)
        elif missing < 0:
            self._say(f"{-missing:,} bytes at the end would not be read.")
        else:
            self._say("The file's size agrees.")
        self.buttons.button(QDialogButtonBox.StandardButton.Open).setEnabled(missing <= 0 and not flat)
        self._late.start(PREVIEW_MS)

    def _say(self, text: str, bad: bool = False) -> None:
        theme = current_theme()
        ground = f"background: {theme.error}; color: {theme.on_error}; border-radius: 4px; padding: 2px 6px;"
        self.verdict.setStyleSheet(ground if bad else f"color: {theme.muted}; padding: 2px 0px;")
        self.verdict.setText(text)

    # -- the preview --------------------------------------------------------------------------------
    def _ask_for_slice(self) -> None:
        self._serial += 1
        if self.missing > 0:
            self.preview.setPixmap(QPixmap())
            self.preview.setText("Does not fit the file")
            return
        side = round(PREVIEW * self.devicePixelRatioF())
        arguments = (self._serial, self._path, self.form, side)
        threading.Thread(target=self._look, args=arguments, name="sfumato-slice", daemon=True).start()

    def _look(self, serial: int, path: str, how: RawGuess, side: int) -> None:
        try:
            image: QImage | None = middle_slice(path, how, side)
        except (OSError, ValueError):
            image = None
        try:
            self._read.emit(serial, image)
        except RuntimeError:  # the dialog was closed meanwhile
            return

    def _show_slice(self, serial: int, image: QImage | None) -> None:
        if serial != self._serial:
            return
        if image is None:
            self.preview.setText("Cannot be read")
            return
        pixmap = QPixmap.fromImage(image)
        pixmap.setDevicePixelRatio(self.devicePixelRatioF())
        self.preview.setPixmap(pixmap)


def middle_slice(path: str, how: RawGuess, longest: int) -> QImage:
    """Return the middle slice of a raw file as a picture; only that slice is read."""
    x, y, z = how.dims
    dtype = np.dtype(how.dtype)
    start = how.offset + (z // 2) * x * y * dtype.itemsize
    plane = np.memmap(path, dtype, "r", start, (y, x))
    return slice_image(plane, how.spacing[:2], longest)


def _words(guess: RawGuess) -> str:
    x, y, z = guess.dims
    why = f" ({guess.reason})" if guess.reason else ""
    return f"{x} × {y} × {z}, {guess.dtype}{why}"


def _whole(name: str, low: int, high: int, value: int) -> QSpinBox:
    box = QSpinBox()
    box.setRange(low, high)
    box.setValue(value)
    box.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
    box.setAccessibleName(name)
    return box


def _length(name: str) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setRange(0.0001, 10_000.0)
    box.setDecimals(4)
    box.setValue(1.0)
    box.setSuffix(" mm")
    box.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
    box.setAccessibleName(name)
    return box


def _side_by_side(widgets: Sequence[Any]) -> QHBoxLayout:
    row = QHBoxLayout()
    row.setSpacing(6)
    for widget in widgets:
        row.addWidget(widget, 1)
    return row
