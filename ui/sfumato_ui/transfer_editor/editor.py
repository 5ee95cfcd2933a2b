"""The plots of one dimension and two with their heading and switch, and the selected point in typed numbers."""

from __future__ import annotations

from qtpy.QtCore import Qt, Signal
from qtpy.QtGui import QShowEvent
from qtpy.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from sfumato import Scene
from sfumato.scene import transfer_edit
from sfumato.scene.picking import Found

from ..color_button import ColorButton
from ..editing import Editor
from ..icons import icon
from ..sliders import LabelledSlider, NumberBox
from ..theme import TARGET, current_theme
from .dimensions import Dimensions
from .plot import TransferPlot
from .region_editor import RegionEditor

TITLES = ("Values and opacity", "Values and gradients")


class TransferEditor(QWidget):
    """Edits the scene's transfer function, point by point, shape by shape, or as a whole."""

    #: The user wants the preset's function back.
    reset_wanted = Signal()

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self.plot = TransferPlot(editor)
        self.shapes = RegionEditor(editor, self.plot)
        self.dimensions = Dimensions(editor)
        self.reset = _tool("Reset the function")
        self.value = _number("Value of the point", "Type the point's value")
        self.opacity = _number("Opacity of the point in %", "Type the point's opacity, per unit distance")
        self.color = ColorButton("Colour of the point")
        self.remove = _tool("Remove the point")
        #: Its place is under More, which the panel decides.
        self.glow = LabelledSlider(
            "Glow of the point", ((0.0, 4.0),), 0.0, decimals=2, step=0.05, limits=(0, 100),
            tip="Light that the tissue gives off by itself in its colour, per unit distance",
        )  # fmt: skip
        self.opacity.setRange(0, 100)
        self.opacity.setDecimals(1)
        self.opacity.setSuffix(" %")
        self._lay_out()
        self._connect()
        self.refresh_theme()

    # -- building ---------------------------------------------------------------------------------
    def _lay_out(self) -> None:
        self.heading = QLabel(TITLES[0])
        self.heading.setProperty("heading", True)
        top = QHBoxLayout()
        top.setSpacing(4)
        top.addWidget(self.heading, 1)
        top.addWidget(self.dimensions)
        top.addWidget(self.reset)
        keep = self.reset.sizePolicy()
        keep.setRetainSizeWhenHidden(True)
        self.reset.setSizePolicy(keep)
        self.point = QWidget()
        point = QGridLayout(self.point)
        point.setContentsMargins(0, 0, 0, 0)
        point.setHorizontalSpacing(6)
        point.setVerticalSpacing(2)
        for column, (text, widget) in enumerate(
            (("Value", self.value), ("Opacity", self.opacity), ("Colour", self.color), ("", self.remove))
        ):
            label = QLabel(text)
            label.setProperty("muted", True)
            label.setBuddy(widget)
            point.addWidget(label, 0, column)
            point.addWidget(widget, 1, column)
        self.color.setMinimumWidth(2 * TARGET)
        for column, stretch in enumerate((4, 3, 3, 0)):
            point.setColumnStretch(column, stretch)
        column_of_all = QVBoxLayout(self)
        column_of_all.setContentsMargins(0, 0, 0, 0)
        column_of_all.setSpacing(4)
        column_of_all.addLayout(top)
        column_of_all.addWidget(self.plot)
        column_of_all.addWidget(self.point)
        column_of_all.addWidget(self.shapes)

    def _connect(self) -> None:
        plot = self.plot
        plot.point_selected.connect(self._show_point)
        self.reset.clicked.connect(self.reset_wanted)
        self.remove.clicked.connect(plot.remove_point)
        self.value.valueChanged.connect(
            lambda v: plot.change_point("Change the value", value=v + (plot.zero or 0.0))
        )
        self.opacity.valueChanged.connect(lambda v: plot.change_point("Change the opacity", opacity=v / 100))
        self.color.opened.connect(lambda: self._editor.begin("Colour the point"))
        self.color.picked.connect(lambda rgb: plot.change_point("Colour the point", color=rgb))
        self.color.closed.connect(self._editor.end)
        self.glow.edited.connect(self._set_glow)
        self.glow.drag_started.connect(lambda: self._editor.begin("Let the point glow"))
        self.glow.drag_finished.connect(self._editor.end)

    def _set_glow(self, glow: float) -> None:
        """Let the point give off light in the colour that it gives off now, else in its own."""
        transfer = self.plot.transfer
        if transfer is None or self.plot.selected < 0:
            return
        point = transfer.points[self.plot.selected]
        red, green, blue = point.emission if any(point.emission) else point.color
        part = glow / (max(red, green, blue) or 1.0)
        emission = (red * part, green * part, blue * part)
        self.plot.change_point("Let the point glow", not self.glow.slider.isSliderDown(), emission=emission)

    # -- showing ----------------------------------------------------------------------------------
    def show_scene(self, scene: Scene, origin: str, edited: bool) -> None:
        """Show a scene's function.

        Parameters
        ----------
        origin : str
            Name of the preset that it was made from.
        edited : bool
            Whether it differs from that.
        """
        self.plot.show_scene(scene)
        self.shapes.show_scene(scene)
        self.dimensions.show_scene(scene)
        two = self.dimensions.two
        self.heading.setText(TITLES[two])
        for widget, shown in ((self.plot, not two), (self.point, not two), (self.shapes, two)):
            widget.setVisible(shown)
        for widget, shown in ((self.glow, not two), (self.shapes.glow, two), (self.shapes.extents, two)):
            widget.setVisible(shown)
        self.reset.setVisible(edited)
        self.reset.setToolTip(f"Back to the preset {origin}" if origin else "Back to the first preset")
        self._show_point()

    def pick(self, found: Found) -> None:
        """Show where a material that was picked in the picture lies."""
        self.plot.pick(found.value)
        self.shapes.plot.pick(found.value, found.gradient)

    def _show_point(self, index: int | None = None) -> None:
        plot, transfer = self.plot, self.plot.transfer
        index = plot.selected
        shown = transfer is not None and index >= 0
        for widget in (self.value, self.opacity, self.color):
            widget.setEnabled(shown)
            widget.blockSignals(True)
        self.glow.setEnabled(shown)
        if shown:
            assert transfer is not None
            self._fill(transfer.points[index].value, transfer.points[index].opacity)
            self.color.set_color(transfer.points[index].color)
            self.glow.set_number(max(transfer.points[index].emission))
        else:
            for box in (self.value, self.opacity):
                box.lineEdit().clear()
        for widget in (self.value, self.opacity, self.color):
            widget.blockSignals(False)
        enough = transfer is not None and len(transfer.points) > transfer_edit.MIN_POINTS
        self.remove.setEnabled(shown and enough)
        self.remove.setToolTip(
            "Remove the point (Del)" if not shown or enough else "The last two points stay"
        )

    def showEvent(self, event: QShowEvent) -> None:
        """Empty the fields again if no point is selected: Qt fills them when they are shown."""
        super().showEvent(event)
        self._show_point()

    def _fill(self, value: float, opacity: float) -> None:
        plot = self.plot
        zero, span = plot.zero or 0.0, plot.scale.high - plot.scale.low
        self.value.setDecimals(plot.decimals)
        self.value.setSingleStep(10.0**-plot.decimals)
        self.value.setSuffix(f" {plot.unit}" if plot.unit else "")
        limit = 100 * (abs(value) + span + 1)
        self.value.setRange(-limit, limit)
        self.value.setValue(value - zero)
        self.opacity.setValue(100 * opacity)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.reset.setIcon(icon("reset", current_theme()))
        self.remove.setIcon(icon("remove", current_theme()))
        self.shapes.refresh_theme()
        self.plot.update()


def _tool(name: str) -> QToolButton:
    button = QToolButton()
    button.setAccessibleName(name)
    button.setToolTip(name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button


def _number(name: str, tip: str) -> NumberBox:
    box = NumberBox()
    box.setAccessibleName(name)
    box.setToolTip(tip)
    box.setMinimumWidth(3 * TARGET)
    return box
