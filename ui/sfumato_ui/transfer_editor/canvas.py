"""What the transfer function's plot shows: the function, the selected point, the values in view."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QPointF, QSize, Qt, Signal
from qtpy.QtGui import QFontMetricsF, QMouseEvent, QPainter, QPaintEvent, QPixmap
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato import Scene, TransferFunction, Volume
from sfumato.scene import transfer_edit
from sfumato.scene.peaks import peaks_of
from sfumato.scene.presets.values import hounsfield_zero

from ..color_button import to_srgb
from ..editing import Editor
from ..theme import Theme, current_theme
from . import histogram, painting, tissue
from .scale import Scale, decimals_for

#: Hit radius of a point in pixels.
HIT = 12.0
#: Distance in pixels within which a point snaps to a peak of the histogram.
SNAP = 5.0
#: Least part of the whole range that the view can show.
CLOSEST = 1 / 400


class TransferCanvas(QWidget):
    """Shows the points of the scene's function; which one is selected is its own affair."""

    #: Another point was selected, or none (-1).
    point_selected = Signal(int)

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._volume: Volume | None = None
        self._histogram = histogram.Histogram(np.zeros(0), np.zeros(0))
        #: Value that means 0 HU, if the values are Hounsfield units.
        self.zero: float | None = None
        #: Values at the peaks of the histogram, to which points snap.
        self.peaks: tuple[float, ...] = ()
        self._range, self._whole = (0.0, 1.0), (0.0, 1.0)
        self._selected = -1
        self._hover: QPointF | None = None
        #: Value of the material that was picked in the picture.
        self.picked: float | None = None
        #: What the drag that is going on does with each move.
        self._drag: Callable[[QMouseEvent], None] | None = None
        self._ground: tuple[tuple[object, ...], QPixmap] | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Transfer function")

    def sizeHint(self) -> QSize:
        """Be a low box, taller with larger text."""
        return QSize(240, 152 + 3 * self.fontMetrics().height())

    # -- state ------------------------------------------------------------------------------------
    @property
    def transfer(self) -> TransferFunction | None:
        """The function, if it has points to drag."""
        transfer = self._editor.scene.transfer
        return transfer if transfer is not None and not transfer.regions else None

    @property
    def selected(self) -> int:
        """Index of the selected point, or -1."""
        count = len(self.transfer.points) if self.transfer is not None else 0
        return min(self._selected, count - 1)

    @property
    def scale(self) -> Scale:
        """Where values and opacities lie now."""
        return Scale(self._areas().plot, *self._range)

    @property
    def unit(self) -> str:
        """Unit of the values that are shown."""
        return "HU" if self.zero is not None else ""

    @property
    def decimals(self) -> int:
        """How many decimals the values have."""
        whole = self._volume is not None and self._volume.data.dtype.kind in "ui"
        return 0 if whole else decimals_for(self._whole[1] - self._whole[0])

    def show_scene(self, scene: Scene) -> None:
        """Show a scene's function, and its volume's values behind it."""
        if scene.volume is not self._volume:
            self._volume = scene.volume
            self._show_volume(scene)
        if scene.volume is not None:
            self._whole = histogram.whole_range(scene.volume, scene.transfer)
        self._describe()
        self.update()

    def _show_volume(self, scene: Scene) -> None:
        self._selected, self._drag, self.picked = -1, None, None
        if scene.volume is None:
            return
        self.peaks = peaks_of(scene.volume)
        self.zero = hounsfield_zero(scene.volume)
        self._histogram = histogram.log_histogram(scene.volume)
        self._range = histogram.first_range(scene.volume, scene.transfer, self.zero)

    def show_all(self) -> None:
        """Zoom out to the first view."""
        scene = self._editor.scene
        if scene.volume is not None:
            self._range = histogram.first_range(scene.volume, scene.transfer, self.zero)
            self.update()

    def select(self, index: int) -> None:
        """Select a point by its index, or none (-1)."""
        self._selected = index
        self._describe()
        self.point_selected.emit(self.selected)
        self.update()

    def pick(self, value: float) -> None:
        """Mark the value of a material that was picked in the picture, and select the point nearest to it."""
        self.picked = value
        low, high = self._range
        if not low <= value <= high:
            self._show_range(value - (high - low) / 2, value + (high - low) / 2)
        if self.transfer is not None:
            away = [abs(point.value - value) for point in self.transfer.points]
            self.select(min(range(len(away)), key=away.__getitem__))
        self.update()

    def _picked_points(self) -> tuple[int, ...]:
        """Return the points between which the picked value lies."""
        if self.picked is None or self.transfer is None:
            return ()
        after = sum(point.value <= self.picked for point in self.transfer.points)
        return tuple(i for i in (after - 1, after) if 0 <= i < len(self.transfer.points))

    def _describe(self) -> None:
        transfer, index = self.transfer, self.selected
        if transfer is None or index < 0:
            self.setAccessibleDescription("No point is selected")
            return
        text = self.told(transfer.points[index].value, transfer.points[index].opacity)
        self.setAccessibleDescription(f"Point {index + 1} of {len(transfer.points)}: {text}")

    def told(self, value: float, opacity: float) -> str:
        """Return value, opacity and the usual tissue in words."""
        shown = value - (self.zero or 0.0)
        words = [f"{painting.text_of(shown, self.decimals)} {self.unit}".strip(), f"{100 * opacity:.3g} %"]
        name = tissue.tissue_at(shown) if self.zero is not None else ""
        return "   ".join([*words, name] if name else words)

    # -- view -------------------------------------------------------------------------------------
    def zoom(self, factor: float, about: float) -> None:
        """Show a factor less of the values, with one of them staying where it is."""
        low, high = self._range
        whole = self._whole[1] - self._whole[0]
        factor = min(max(factor, (high - low) / whole), (high - low) / (whole * CLOSEST))
        self._show_range(about - (about - low) / factor, about + (high - about) / factor)

    def _show_range(self, low: float, high: float) -> None:
        """Show these values, moved so that nothing beyond the whole range is in view."""
        low_end, high_end = min(self._whole[0], self._range[0]), max(self._whole[1], self._range[1])
        move = max(0.0, low_end - low) - max(0.0, high - high_end)
        self._range = low + move, high + move
        self.update()

    @property
    def _zoomed(self) -> bool:
        return self._range[1] - self._range[0] < 0.98 * (self._whole[1] - self._whole[0])

    def snapped(self, value: float) -> float:
        """Return the peak of the histogram that is so near to a value that a point snaps to it; else the value."""
        near = min(self.peaks, key=lambda peak: abs(peak - value), default=value)
        return near if abs(near - value) <= SNAP * self.scale.per_pixel else value

    def _point_under(self, at: QPointF) -> int:
        if self.transfer is None:
            return -1
        scale = self.scale
        away = [QPointF(scale.at(p.value, p.opacity) - at) for p in self.transfer.points]
        distances = [math.hypot(d.x(), d.y()) for d in away]
        nearest = min(range(len(distances)), key=distances.__getitem__)
        # Of points on top of each other, the selected one keeps the hand.
        if 0 <= self.selected < len(distances) and distances[self.selected] <= distances[nearest] + 1e-6:
            nearest = self.selected
        return nearest if distances[nearest] <= HIT else -1

    # -- looks ------------------------------------------------------------------------------------
    def _areas(self) -> painting.Areas:
        metrics = QFontMetricsF(painting.small(self.font()))
        gutter = metrics.horizontalAdvance("100 %") + 2
        return painting.areas_of(self.width(), self.height(), metrics.height(), gutter, self.zero is not None)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw everything; what the function does not change is drawn once and kept."""
        theme, areas, scale = current_theme(), self._areas(), self.scale
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._kept_ground(areas, scale, theme))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(painting.small(self.font()))
        transfer = self._editor.scene.transfer
        if self._volume is None or transfer is None:
            return
        if self.transfer is None:
            text = "This function depends on the gradient too, and has no points. A preset brings them back."
            painting.draw_message(painter, areas, text, theme)
            return
        curve = painting.curve_of(transfer, scale)
        painting.draw_function(painter, areas, curve, painting.colours_of(transfer, scale), theme)
        if self.picked is not None:
            painting.draw_picked(painter, scale, self.picked, theme)
        self._draw_points(painter, scale, transfer)
        self._draw_readout(painter, areas, scale, transfer)

    def _kept_ground(self, areas: painting.Areas, scale: Scale, theme: Theme) -> QPixmap:
        """Return what lies behind the function, drawn anew only if something of it changed."""
        ratio = self.devicePixelRatioF()
        state = (
            self.size(),
            ratio,
            scale,
            theme.name,
            self.hasFocus(),
            self.font().key(),
            id(self._histogram),
        )
        if self._ground is None or self._ground[0] != state:
            pixmap = QPixmap(self.size() * ratio)
            pixmap.setDevicePixelRatio(ratio)
            pixmap.fill(Qt.GlobalColor.transparent)
            with QPainter(pixmap) as painter:
                self._draw_ground(painter, areas, scale, theme)
            self._ground = state, pixmap
        return self._ground[1]

    def _draw_ground(self, painter: QPainter, areas: painting.Areas, scale: Scale, theme: Theme) -> None:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(painting.small(self.font()))
        painting.draw_box(painter, areas, theme, self.hasFocus())
        if self._volume is None:
            return
        painter.setClipRect(areas.plot.adjusted(-5, -9, 5, 0))
        painting.draw_histogram(painter, scale, self._histogram, theme)
        painter.setClipping(False)
        painting.draw_lines(painter, scale, theme)
        painting.draw_peaks(painter, scale, self.peaks, theme)
        painting.draw_axis(painter, areas, scale, theme, self.zero or 0.0, self.unit, self.decimals)
        if self.zero is not None:
            painting.draw_tissues(painter, areas, scale, theme, self.zero)

    def _draw_points(self, painter: QPainter, scale: Scale, transfer: TransferFunction) -> None:
        hot = self._point_under(self._hover) if self._hover is not None and self._drag is None else -1
        picked = self._picked_points()
        order = sorted(range(len(transfer.points)), key=lambda i: i == self.selected)
        for i in order:
            point = transfer.points[i]
            at = scale.at(point.value, point.opacity)
            if scale.rect.left() - 1 <= at.x() <= scale.rect.right() + 1:
                painting.draw_point(
                    painter,
                    at,
                    to_srgb(point.color),
                    current_theme(),
                    selected=i == self.selected,
                    hot=i == hot or i in picked,
                )

    def _draw_readout(
        self, painter: QPainter, areas: painting.Areas, scale: Scale, transfer: TransferFunction
    ) -> None:
        if self._hover is None:
            return
        if self._drag is not None and self.selected >= 0:
            point = transfer.points[self.selected]
        elif scale.rect.left() <= self._hover.x() <= scale.rect.right():
            point = transfer_edit.point_at(transfer, scale.value(self._hover.x()))
        else:
            return
        painting.draw_readout(painter, areas, self.told(point.value, point.opacity), current_theme())
