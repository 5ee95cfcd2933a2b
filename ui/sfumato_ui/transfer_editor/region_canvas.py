"""What the plot of a two-dimensional function shows: joint histogram, shapes, the selected one, the part in view."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QPointF, QSize, Signal
from qtpy.QtGui import QFontMetricsF, QImage, QMouseEvent, QPainter, QPaintEvent
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato import Region, Scene, TransferFunction, Volume
from sfumato.scene.joint_histogram import JointHistogram, first_look, steepest_possible
from sfumato.scene.region_edit import topmost

from ..editing import Editor
from ..theme import Theme, current_theme
from . import histogram, painting, region_painting
from .canvas import TransferCanvas
from .joint_count import JointCount
from .plane import Plane
from .region_hits import handle_at, handle_places, region_at
from .scale import Scale, decimals_for

#: Names of the shapes.
NAMES = {
    "rectangle": "Rectangle",
    "ellipse": "Ellipse",
    "trapezoid": "Trapezoid",
    "polygon": "Freehand",
    "curve": "1D curve",
}


class RegionCanvas(QWidget):
    """Shows the regions of the scene's function; which one is selected is its own affair.

    Parameters
    ----------
    line : TransferCanvas
        The plot of one dimension, which knows the values' unit and in which words they are told.
    """

    #: Another region was selected.
    region_selected = Signal(int)

    def __init__(self, editor: Editor, line: TransferCanvas) -> None:
        super().__init__()
        self._editor, self._line = editor, line
        self._volume: Volume | None = None
        #: Counted values and gradients: at first of few voxels, whose range stays when all are counted.
        self.joint: JointHistogram | None = None
        self._top = 1.0
        self._count = JointCount(self)
        self._count.counted.connect(self._show_joint)
        self._seen: tuple[tuple[float, float], tuple[float, float]] | None = None
        self._selected = -1
        self._hover: QPointF | None = None
        #: Value and gradient magnitude of the material that was picked in the picture.
        self.picked: tuple[float, float] | None = None
        #: What the drag that is going on does with each move.
        self._drag: Callable[[QMouseEvent], None] | None = None
        #: Whether the next drag draws an outline, and its places so far.
        self.drawing, self._drawn = False, list[QPointF]()
        self._images: dict[str, tuple[object, QImage]] = {}
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Values and gradients")

    def sizeHint(self) -> QSize:
        """Be a box a little taller than that of one dimension."""
        return QSize(240, 176 + 3 * self.fontMetrics().height())

    # -- state ------------------------------------------------------------------------------------
    @property
    def transfer(self) -> TransferFunction | None:
        """The function, if it has regions."""
        transfer = self._editor.scene.transfer
        return transfer if transfer is not None and transfer.regions else None

    @property
    def regions(self) -> tuple[Region, ...]:
        """The function's regions, the topmost last."""
        return self.transfer.regions if self.transfer is not None else ()

    @property
    def selected(self) -> int:
        """Index of the selected region: the topmost one if none was chosen; -1 if there are none."""
        last = len(self.regions) - 1
        return last if self._selected < 0 else min(self._selected, last)

    @property
    def region(self) -> Region | None:
        """The selected region."""
        return self.regions[self.selected] if self.regions else None

    @property
    def unit(self) -> str:
        """Unit of gradients."""
        return f"{self._line.unit}/mm" if self._line.unit else "per mm"

    @property
    def decimals(self) -> int:
        """How many decimals gradients have."""
        return max(0, decimals_for(self.whole.gradients[1]) - 1)

    @property
    def whole(self) -> Plane:
        """Everything that can be in view: the volume's values and gradients, and those of the regions near them."""
        scene = self._editor.scene
        values, top = (0.0, 1.0), 1.0
        if scene.volume is not None:
            values = histogram.whole_range(scene.volume, scene.transfer)
            steepest = self.joint.steepest if self.joint is not None else steepest_possible(scene.volume)
            top = max(1.02 * steepest, self._top)
        return Plane(self._areas().plot, values, (0.0, top or 1.0))

    @property
    def plane(self) -> Plane:
        """Where values and gradients lie now."""
        values, gradients = self._seen or self._first()
        return Plane(self._areas().plot, values, gradients)

    def _first(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the values and gradients worth seeing: nearly all voxels."""
        scene, whole = self._editor.scene, self.whole
        if scene.volume is None:
            return whole.values, whole.gradients
        low, high = histogram.first_range(scene.volume, None, self._line.zero)
        return (max(low, whole.values[0]), min(high, whole.values[1])), (
            0.0,
            min(self._top, whole.gradients[1]),
        )

    def show_scene(self, scene: Scene) -> None:
        """Show a scene's function, and its volume's values and gradients behind it; count them if that is not done."""
        if scene.volume is not self._volume:
            self._volume, self.joint, self._seen = scene.volume, None, None
            self._selected, self._drag, self.picked = -1, None, None
            self.end_drawing()
            self._count.want(None)
        if self.regions and scene.volume is not None and self.isVisible():
            if self.joint is None:
                self.joint = first_look(scene.volume)
                self._top = 1.05 * self.joint.usual
            self._count.want(scene.volume)
        if not self.regions and self.drawing:
            self.end_drawing()
        self._describe()
        self.update()

    def _show_joint(self, volume: Volume, joint: JointHistogram) -> None:
        if volume is self._volume:
            self.joint = joint
            self.update()

    def show_all(self) -> None:
        """Zoom out to the first view."""
        self._seen = None
        self.update()

    def _see(self, plane: Plane) -> None:
        self._seen = plane.values, plane.gradients
        self.update()

    @property
    def _zoomed(self) -> bool:
        plane, whole = self.plane, self.whole
        return any(
            b - a < 0.98 * (d - c)
            for (a, b), (c, d) in ((plane.values, whole.values), (plane.gradients, whole.gradients))
        )

    def select(self, index: int) -> None:
        """Select a region by its index."""
        self._selected = index
        self._describe()
        self.region_selected.emit(self.selected)
        self.update()

    def pick(self, value: float, gradient: float) -> None:
        """Mark a material that was picked in the picture, and select the shape in which it lies."""
        self.picked = value, gradient
        plane = self.plane
        if not plane.rect.contains(plane.at(value, gradient)):
            self.show_all()
        under = topmost(self.regions, value, gradient)
        if under >= 0:
            self.select(under)
        self.update()

    def end_drawing(self) -> None:
        """Draw no outline any more."""
        self.drawing, self._drawn = False, []
        self.update()

    def _describe(self) -> None:
        region, index = self.region, self.selected
        if region is None:
            self.setAccessibleDescription("There are no shapes")
            return
        (v0, v1), (g0, g1) = region.extent
        zero, decimals = self._line.zero or 0.0, self._line.decimals
        values = " to ".join(painting.text_of(v - zero, decimals) for v in (v0, v1))
        gradients = " to ".join(painting.text_of(g, self.decimals) for g in (g0, g1))
        self.setAccessibleDescription(
            f"{NAMES[region.shape]}, {index + 1} of {len(self.regions)}: values {values} {self._line.unit}, "
            f"gradients {gradients} {self.unit}, {100 * region.opacity:.3g} %"
        )

    # -- what is under the pointer ------------------------------------------------------------------
    def handle_places(self) -> dict[str, QPointF]:
        """Return the places of the selected region's handles by their names."""
        return handle_places(self.region, self.plane) if self.region is not None else {}

    def _handle_under(self, at: QPointF) -> str:
        return handle_at(self.region, self.plane, at) if self.region is not None else ""

    def _region_under(self, at: QPointF) -> int:
        return region_at(self.regions, self.plane, at, self.selected)

    # -- looks ------------------------------------------------------------------------------------
    def _areas(self) -> painting.Areas:
        metrics = QFontMetricsF(painting.small(self.font()))
        return region_painting.areas_of(
            self.width(),
            self.height(),
            metrics.height(),
            metrics.horizontalAdvance("00000") + 2,
            metrics.horizontalAdvance(self.unit),
        )

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw everything; pictures are made anew only if something of them changed."""
        theme, areas, plane = current_theme(), self._areas(), self.plane
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(painting.small(self.font()))
        painting.draw_box(painter, areas, theme, self.hasFocus())
        transfer = self.transfer
        if self._volume is None or transfer is None:
            return
        image = self._kept(
            "function", (transfer, plane), lambda: region_painting.function_image(transfer, plane)
        )
        region_painting.draw_function(painter, plane, image)
        if self.joint is not None:
            joint = self.joint
            image = self._kept(
                "joint", (id(joint), theme.name), lambda: region_painting.histogram_image(joint, theme)
            )
            region_painting.draw_histogram(painter, plane, joint, image)
        self._draw_axes(painter, areas, plane, theme)
        self._draw_shapes(painter, plane, theme)
        self._draw_readout(painter, areas, plane, theme)

    def _kept(self, name: str, state: object, make: Callable[[], QImage]) -> QImage:
        if name not in self._images or self._images[name][0] != state:
            self._images[name] = state, make()
        return self._images[name][1]

    def _draw_axes(self, painter: QPainter, areas: painting.Areas, plane: Plane, theme: Theme) -> None:
        line = self._line
        scale = Scale(plane.rect, *plane.values)
        painting.draw_axis(painter, areas, scale, theme, line.zero or 0.0, line.unit, line.decimals)
        region_painting.draw_gradient_axis(painter, areas, plane, theme, self.unit)
        if line.zero is not None and self._hover is None:
            painting.draw_tissues(painter, areas, scale, theme, line.zero)

    def _draw_shapes(self, painter: QPainter, plane: Plane, theme: Theme) -> None:
        hover = self._hover if self._drag is None and not self.drawing else None
        under = self._region_under(hover) if hover is not None else -1
        for i in sorted(range(len(self.regions)), key=lambda i: i == self.selected):
            region_painting.draw_shape(
                painter, plane, self.regions[i], theme, selected=i == self.selected, hot=i == under
            )
        if self.picked is not None:
            region_painting.draw_picked(painter, plane, *self.picked, theme)
        hot = self._handle_under(hover) if hover is not None else ""
        for name, at in self.handle_places().items():
            region_painting.draw_handle(painter, at, name, theme, hot=name == hot)
        if self._drawn:
            region_painting.draw_outline(painter, self._drawn, theme)

    def _draw_readout(self, painter: QPainter, areas: painting.Areas, plane: Plane, theme: Theme) -> None:
        if self.drawing:
            text = "Draw a shape's outline; Esc ends"
        elif self._hover is not None and plane.rect.adjusted(-1, -1, 1, 1).contains(self._hover):
            text = self._told(*plane.pair(self._hover))
        else:
            return
        painting.draw_readout(painter, areas, text, theme)

    def _told(self, value: float, gradient: float) -> str:
        """Return value, gradient and opacity at a place in words."""
        opacity = 0.0
        if self.transfer is not None:
            opacity = float(self.transfer.evaluate_2d(np.array([value]), np.array([gradient]))[0, 3])
        zero = self._line.zero or 0.0
        shown = f"{painting.text_of(value - zero, self._line.decimals)} {self._line.unit}".strip()
        return f"{shown}   {painting.text_of(gradient, self.decimals)} {self.unit}   {round(100 * opacity, 2):g} %"
