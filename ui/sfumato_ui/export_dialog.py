"""The question how a picture shall be exported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QAbstractSpinBox,
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QVBoxLayout,
    QWidget,
)

from sfumato.export.picture import MAX_PIXELS, MAX_SIDE, PictureSpec

from .export_size import LEAST_SIDE, OWN, PRESETS, ExportSize, duration_words, memory_words
from .generated import ChoiceBox
from .orientation import cube_wanted
from .settings import settings

#: Jittered frames by quality.
QUALITIES = {"Draft": 2, "Normal": 8, "Fine": 32}
FORMATS = {"PNG": ".png", "TIFF": ".tif"}
DEPTHS = {"8 bits": 8, "16 bits": 16}


@dataclass(frozen=True)
class ExportWish:
    """What the user wants: the file's properties and how the picture is drawn."""

    spec: PictureSpec
    suffix: str
    transparent: bool


class ExportDialog(QDialog):
    """Asks for size, format and quality of the picture.

    Parameters
    ----------
    seen : (int, int)
        Size of the picture in the window in pixels.
    orthographic : bool
        Whether a scale bar is possible.
    estimate : callable
        Returns the seconds that a picture of a size and a number of frames will take, or None if not known.
    """

    def __init__(
        self,
        seen: tuple[int, int],
        orthographic: bool,
        estimate: Callable[[tuple[int, int], int], float | None],
        parent: QWidget,
        colored: bool = False,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Export the picture")
        self._seen, self._estimate = seen, estimate
        self._filling = False
        kept = settings()
        dpi = min(2400.0, max(30.0, float(str(kept.value("export/dpi", 300.0)))))
        self.size_wanted = ExportSize(seen, dpi, aspect=seen[0] / seen[1])
        self._make_fields(orthographic)
        self.color_bars.setChecked(colored)
        self.color_bars.setVisible(colored)
        self.format.setCurrentIndex(max(0, self.format.findText(str(kept.value("export/format", "PNG")))))
        self.bits.setCurrentIndex(1 if kept.value("export/bits", 8, type=int) == 16 else 0)
        self.quality.setCurrentIndex(
            max(0, self.quality.findText(str(kept.value("export/quality", "Normal"))))
        )
        self._lay_out(orthographic)
        self._connect()
        self._show()

    # -- building ---------------------------------------------------------------------------------
    def _make_fields(self, orthographic: bool) -> None:
        self.preset = _choice("Size", [p.title for p in PRESETS] + [OWN])
        self.pixels = [_whole(f"{name} in pixels") for name in ("Width", "Height")]
        self.lengths = [_length(f"{name} in millimetres") for name in ("Width", "Height")]
        self.lock = QCheckBox("Keep proportions")
        self.lock.setToolTip("Change width and height together")
        self.lock.setChecked(True)
        self.dpi = _length("Resolution in dpi", " dpi", (30, 2400))
        self.dpi.setDecimals(0)
        self.dpi.setToolTip("Pixels per inch on paper; written into the file")
        self.format = _choice("Format", list(FORMATS))
        self.bits = _choice("Depth", list(DEPTHS))
        self.bits.setToolTip("Bits a channel: 16 keep smooth shades smooth when the picture is edited")
        self.quality = _choice("Quality", list(QUALITIES))
        self.quality.setToolTip("Draft, normal, fine: 2, 8 or 32 pictures are averaged")
        self.transparent = QCheckBox("Transparent background")
        self.transparent.setToolTip("Leave the background out")
        self.cube = QCheckBox("Orientation cube")
        self.cube.setToolTip("The patient's sides on a cube, upper left")
        self.cube.setChecked(cube_wanted())
        self.color_bars = QCheckBox("Colour bar")
        self.color_bars.setToolTip("The values behind the colours of tracts and meshes, lower left")
        self.scale_bar = QCheckBox("Scale bar")
        self.scale_bar.setEnabled(orthographic)
        self.scale_bar.setToolTip(
            "A bar of true length, lower right"
            if orthographic
            else "Needs an orthographic view: in perspective, what is nearer is larger"
        )

    def _lay_out(self, orthographic: bool) -> None:
        form = QFormLayout()
        form.setSpacing(8)
        form.setLabelAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        form.addRow("Size", self.preset)
        form.addRow("Pixels", _pair(self.pixels[0], self.pixels[1]))
        form.addRow("On paper", _pair(self.lengths[0], self.lengths[1]))
        form.addRow("", self.lock)
        form.addRow("Resolution", self.dpi)
        form.addRow("Format", _pair(self.format, self.bits, ""))
        form.addRow("Quality", self.quality)
        form.addRow("", self.transparent)
        form.addRow("", self.scale_bar)
        form.addRow("", self.cube)
        if self.color_bars.isChecked():
            form.addRow("", self.color_bars)
        else:
            self.color_bars.setParent(self)
        if not orthographic:
            reason = QLabel("A scale bar needs an orthographic view.")
            reason.setEnabled(False)
            form.addRow("", reason)
        self.summary = QLabel()
        self.summary.setWordWrap(True)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
        self.go = self.buttons.addButton("Export…", QDialogButtonBox.ButtonRole.AcceptRole)
        self.go.setDefault(True)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 14)
        column.setSpacing(12)
        column.addLayout(form)
        column.addWidget(self.summary)
        column.addWidget(self.buttons)
        self.setMinimumWidth(380)

    def _connect(self) -> None:
        self.preset.activated.connect(self._take_preset)
        for axis, (side, length) in enumerate(zip(self.pixels, self.lengths, strict=True)):
            side.valueChanged.connect(lambda value, axis=axis: self._edit("with_side", axis, round(value)))
            length.valueChanged.connect(lambda value, axis=axis: self._edit("with_length", axis, value))
        self.dpi.valueChanged.connect(lambda value: self._edit("with_dpi", value))
        self.lock.toggled.connect(lambda on: self._edit("with_lock", on))
        for box in (self.format, self.bits, self.quality):
            box.currentIndexChanged.connect(self.show_summary)
        self.scale_bar.toggled.connect(self.show_summary)
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)

    # -- the size ---------------------------------------------------------------------------------
    def _take_preset(self, index: int) -> None:
        if index < len(PRESETS):
            self.size_wanted = self.size_wanted.with_preset(PRESETS[index], self._seen)
            self._show()

    def _edit(self, change: str, *values: float) -> None:
        if self._filling:
            return
        self.size_wanted = getattr(self.size_wanted, change)(*values)
        if change in ("with_side", "with_length"):
            self.preset.setCurrentIndex(self.preset.count() - 1)
        self._show()

    def _show(self) -> None:
        """Show the size in all fields but the one that is being typed in, whose text is the user's."""
        self._filling = True
        size = self.size_wanted
        fields = [*self.pixels, *self.lengths]
        for field, value in zip(fields, [*size.pixels, *size.millimetres], strict=True):
            if abs(field.value() - value) >= 0.5 * 10 ** -field.decimals():
                field.setValue(value)
        self.dpi.setValue(size.dpi)
        self._filling = False
        self.show_summary()

    def show_summary(self) -> None:
        """Say how large the picture becomes, and how long it takes as far as that is known."""
        size = self.size_wanted
        self.go.setEnabled(size.possible)
        if not size.possible:
            self.summary.setText(
                f"Too large: {MAX_SIDE} pixels on a side and {MAX_PIXELS // 10**6} megapixels are possible."
            )
            return
        spec = self._spec()
        seconds = self._estimate(size.pixels, spec.frames or 1)
        parts = [f"{size.pixels[0]} × {size.pixels[1]} pixels"]
        if seconds is not None:
            parts.append(duration_words(seconds))
        parts.append(f"{memory_words(spec.memory)} of memory")
        self.summary.setText(", ".join(parts))

    # -- the answer -------------------------------------------------------------------------------
    def _spec(self) -> PictureSpec:
        return PictureSpec(
            self.size_wanted.pixels,
            bits=DEPTHS[self.bits.currentText()],
            dpi=self.size_wanted.dpi,
            frames=QUALITIES[self.quality.currentText()],
            scale_bar=self.scale_bar.isChecked(),
            color_bars=self.color_bars.isChecked(),
            orientation_cube=self.cube.isChecked(),
        )

    @property
    def wish(self) -> ExportWish:
        """What the user wants."""
        return ExportWish(self._spec(), FORMATS[self.format.currentText()], self.transparent.isChecked())

    def accept(self) -> None:
        """Remember what is likely to be wanted again."""
        kept = settings()
        kept.setValue("export/dpi", self.size_wanted.dpi)
        kept.setValue("export/format", self.format.currentText())
        kept.setValue("export/bits", DEPTHS[self.bits.currentText()])
        kept.setValue("export/quality", self.quality.currentText())
        super().accept()


class _Number(QDoubleSpinBox):
    """A number without buttons, which takes effect while it is typed."""

    def __init__(self, name: str, unit: str, span: tuple[float, float], decimals: int) -> None:
        super().__init__()
        self.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
        self.setDecimals(decimals)
        self.setRange(*span)
        self.setSuffix(unit)
        self.setAccessibleName(name)
        self.setToolTip(name)
        self.setGroupSeparatorShown(False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)


def _length(name: str, unit: str = " mm", span: tuple[float, float] = (1, 20_000)) -> _Number:
    return _Number(name, unit, span, 1)


def _whole(name: str) -> _Number:
    return _Number(name, " px", (LEAST_SIDE, 99_999), 0)


def _choice(name: str, words: list[str]) -> ChoiceBox:
    box = ChoiceBox()
    box.addItems(words)
    box.setAccessibleName(name)
    box.setToolTip(name)
    return box


def _pair(first: QWidget, second: QWidget, between: str = "×") -> QWidget:
    row = QWidget()
    layout = QHBoxLayout(row)
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(6)
    layout.addWidget(first, 1)
    if between:
        layout.addWidget(QLabel(between))
    layout.addWidget(second, 1)
    return row
