"""The plot of two dimensions with the list of shapes, and the selected shape in typed numbers."""

from __future__ import annotations

from qtpy.QtCore import Qt, Signal
from qtpy.QtGui import QShowEvent
from qtpy.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QMenu, QToolButton, QVBoxLayout, QWidget

from sfumato import Region, Scene

from ..color_button import ColorButton
from ..editing import Editor
from ..generated import ChoiceBox
from ..icons import icon
from ..sliders import LabelledSlider, NumberBox
from ..theme import TARGET, current_theme
from .canvas import TransferCanvas
from .extents import Extents
from .region_canvas import NAMES
from .region_plot import RegionPlot

#: The shapes in the order of the menu, and what is said of them.
SHAPES = {
    "rectangle": "Values and gradients from – to",
    "ellipse": "Soft all around",
    "trapezoid": "Narrow where gradients are small, as a boundary's arc is inside",
    "polygon": "Draw its outline with the pointer",
    "curve": "Shows the 1D function between these values and gradients",
}


class RegionEditor(QWidget):
    """Edits the scene's two-dimensional function, shape by shape."""

    #: Shapes came or went: fields may be enabled that were not.
    listed = Signal()

    def __init__(self, editor: Editor, line: TransferCanvas) -> None:
        super().__init__()
        self._editor = editor
        self.plot = RegionPlot(editor, line)
        self.shape = ChoiceBox()
        self.shape.setAccessibleName("Shape")
        self.shape.setToolTip("The selected shape; those below lie over those above")
        self.add = _tool("Add a shape")
        self.duplicate = _tool("Duplicate the shape (Ctrl+D in the plot)")
        self.over, self.under = (
            _tool("Lay the shape over the next (Page up)"),
            _tool("Lay the shape under the next (Page down)"),
        )
        self.remove = _tool("Remove the shape (Del)")
        self.opacity = _per_cent("Opacity of the shape in %", "The shape's opacity, per unit distance")
        self.soft = _per_cent(
            "Soft edge of the shape in %", "Part of the shape over which it fades to nothing at its edge"
        )
        self.color = ColorButton("Colour of the shape")
        #: Their place is under More, which the panel decides.
        self.extents = Extents(self.plot, line)
        self.glow = LabelledSlider(
            "Glow of the shape", ((0.0, 4.0),), 0.0, decimals=2, step=0.05, limits=(0, 100),
            tip="Light that the tissue gives off by itself in its colour, per unit distance",
        )  # fmt: skip
        self._glow_tip = self.glow.toolTip()
        self._make_menu()
        self._lay_out()
        self._connect()
        self.refresh_theme()

    # -- building ---------------------------------------------------------------------------------
    def _make_menu(self) -> None:
        menu = QMenu(self.add)
        menu.setToolTipsVisible(True)
        for shape, tip in SHAPES.items():
            action = menu.addAction(NAMES[shape])
            action.setToolTip(tip)
            action.triggered.connect(lambda checked=False, shape=shape: self.plot.add_shape(shape))
        self.add.setMenu(menu)
        self.add.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)

    def _lay_out(self) -> None:
        shapes = QHBoxLayout()
        shapes.setSpacing(0)  # the list needs the room
        shapes.addWidget(self.shape, 1)
        for button in (self.add, self.duplicate, self.over, self.under, self.remove):
            shapes.addWidget(button)
        fields = QGridLayout()
        fields.setHorizontalSpacing(6)
        fields.setVerticalSpacing(2)
        for column, (text, widget) in enumerate(
            (("Opacity", self.opacity), ("Soft edge", self.soft), ("Colour", self.color))
        ):
            label = QLabel(text)
            label.setProperty("muted", True)
            label.setBuddy(widget)
            fields.addWidget(label, 0, column)
            fields.addWidget(widget, 1, column)
            fields.setColumnStretch(column, 1)
        self.color.setMinimumWidth(2 * TARGET)
        column_of_all = QVBoxLayout(self)
        column_of_all.setContentsMargins(0, 0, 0, 0)
        column_of_all.setSpacing(4)
        column_of_all.addWidget(self.plot)
        column_of_all.addLayout(shapes)
        column_of_all.addLayout(fields)

    def _connect(self) -> None:
        plot, begin = self.plot, self._editor.begin
        plot.region_selected.connect(lambda index: self._show_region())
        self.shape.activated.connect(plot.select)
        self.duplicate.clicked.connect(plot.duplicate_region)
        self.over.clicked.connect(lambda: plot.reorder_region(1))
        self.under.clicked.connect(lambda: plot.reorder_region(-1))
        self.remove.clicked.connect(plot.remove_region)
        self.opacity.valueChanged.connect(lambda v: plot.change_region("Change the opacity", opacity=v / 100))
        self.soft.valueChanged.connect(lambda v: plot.change_region("Soften the edge", feather=v / 100))
        self.color.opened.connect(lambda: begin("Colour the shape"))
        self.color.picked.connect(lambda rgb: plot.change_region("Colour the shape", color=rgb))
        self.color.closed.connect(self._editor.end)
        self.glow.edited.connect(self._set_glow)
        self.glow.drag_started.connect(lambda: begin("Let the shape glow"))
        self.glow.drag_finished.connect(self._editor.end)

    def _set_glow(self, glow: float) -> None:
        """Let the shape give off light in the colour that it gives off now, else in its own."""
        region = self.plot.region
        if region is None:
            return
        red, green, blue = region.emission if any(region.emission) else region.color
        part = glow / (max(red, green, blue) or 1.0)
        emission = (red * part, green * part, blue * part)
        self.plot.change_region("Let the shape glow", not self.glow.slider.isSliderDown(), emission=emission)

    # -- showing ----------------------------------------------------------------------------------
    def show_scene(self, scene: Scene) -> None:
        """Show a scene's function."""
        self.plot.show_scene(scene)
        self._show_region()

    def _show_region(self) -> None:
        regions, region = self.plot.regions, self.plot.region
        if region is None:
            return
        self._list(regions)
        curve = region.shape == "curve"
        for box, number in ((self.opacity, region.opacity), (self.soft, region.feather)):
            box.blockSignals(True)
            box.setValue(100 * number)
            box.blockSignals(False)
        self.color.set_color(region.color)
        self.glow.set_number(max(region.emission))
        why = "The curve's points have their own: choose 1D to change them"
        for part in (self.glow, self.glow.label, self.glow.slider, self.glow.number):
            part.setToolTip(why if curve else self._glow_tip)
        self.color.setEnabled(not curve)
        self.color.setToolTip(why if curve else "Colour of the shape")
        self.glow.setEnabled(not curve)
        self.extents.show_region(region)
        index, last = self.plot.selected, len(regions) - 1
        for button, able, words, reason in (
            (self.over, index < last, "Lay the shape over the next (Page up)", "No shape lies over it"),
            (self.under, index > 0, "Lay the shape under the next (Page down)", "No shape lies under it"),
            (
                self.remove,
                last > 0,
                "Remove the shape (Del)",
                "The last shape stays: choose 1D to do without",
            ),
        ):
            button.setEnabled(able)
            button.setToolTip(words if able else reason)

    def _list(self, regions: tuple[Region, ...]) -> None:
        """Fill the list of shapes, and mark the selected one."""
        names = [f"{i + 1}  {NAMES[region.shape]}" for i, region in enumerate(regions)]
        if names != [self.shape.itemText(i) for i in range(self.shape.count())]:
            self.shape.clear()
            self.shape.addItems(names)
        self.shape.setCurrentIndex(self.plot.selected)

    def showEvent(self, event: QShowEvent) -> None:
        """Show what is there now: while it was hidden it may have changed."""
        super().showEvent(event)
        self._show_region()

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        for button, name in (
            (self.add, "add"), (self.duplicate, "duplicate"), (self.over, "over"),
            (self.under, "under"), (self.remove, "remove"),
        ):  # fmt: skip
            button.setIcon(icon(name, current_theme()))
        self.plot.update()


def _tool(name: str) -> QToolButton:
    button = QToolButton()
    button.setAccessibleName(name.split(" (")[0])
    button.setToolTip(name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button


def _per_cent(name: str, tip: str) -> NumberBox:
    box = NumberBox()
    box.setAccessibleName(name)
    box.setToolTip(tip)
    box.setMinimumWidth(3 * TARGET)
    box.setRange(0, 100)
    box.setDecimals(1)
    box.setSuffix(" %")
    return box
