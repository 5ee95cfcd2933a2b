"""The plot in which the transfer function's points are dragged.

Left button: drag a point; press on the curve to add one there, double-click to add one anywhere; drag the
ground to move the view when zoomed in; with shift, drag the whole function sideways (level) and up or down
(width). The wheel zooms when the plot has the focus. The same by keys: see `_keys`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from qtpy.QtCore import QEvent, QPointF, QSize, Qt, Signal
from qtpy.QtGui import QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QWheelEvent
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato import Scene, TransferFunction, TransferPoint, Volume
from sfumato.scene import transfer_edit
from sfumato.scene.presets.values import hounsfield_zero

from ..color_button import to_srgb
from ..editing import Editor
from ..theme import current_theme
from . import histogram, painting, tissue
from .scale import Scale, decimals_for, nudge

#: Hit radius of a point and of the curve in pixels.
HIT, HIT_CURVE = 12.0, 7.0
#: Pixels up or down before a shift-drag changes the width too.
DEAD = 8.0
#: Least part of the whole range that the view can show.
CLOSEST = 1 / 400
LEVEL = "Move the transfer function"
TIP = (
    "<p>Drag a point. Click on the curve to add one, or double-click anywhere; Del removes it. "
    "Shift-drag moves the whole function, up and down widens it. The wheel zooms.</p>"
    "<p>Keys: arrows move the point (shift: ten times as far), Ctrl+arrows select, Alt+arrows move the whole "
    "function, Insert adds a point, + and \N{MINUS SIGN} zoom, 0 shows all.</p>"
)


class TransferPlot(QWidget):
    """Shows and edits the points of the scene's function; which one is selected is its own affair."""

    #: Another point was selected, or none (-1).
    point_selected = Signal(int)

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self._volume: Volume | None = None
        self._histogram = histogram.Histogram(np.zeros(0), np.zeros(0))
        #: Value that means 0 HU, if the values are Hounsfield units.
        self.zero: float | None = None
        self._range, self._whole = (0.0, 1.0), (0.0, 1.0)
        self._selected = -1
        self._hover: QPointF | None = None
        self._drag: Callable[[QMouseEvent], None] | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setAccessibleName("Transfer function")
        self.setToolTip(TIP)

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
        self._selected = -1
        if scene.volume is None:
            return
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

    def _describe(self) -> None:
        transfer, index = self.transfer, self.selected
        if transfer is None or index < 0:
            self.setAccessibleDescription("No point is selected")
            return
        text = self._told(transfer.points[index].value, transfer.points[index].opacity)
        self.setAccessibleDescription(f"Point {index + 1} of {len(transfer.points)}: {text}")

    def _told(self, value: float, opacity: float) -> str:
        """Return value, opacity and the usual tissue in words."""
        shown = value - (self.zero or 0.0)
        words = [f"{painting.text_of(shown, self.decimals)} {self.unit}".strip(), f"{100 * opacity:.3g} %"]
        name = tissue.tissue_at(shown) if self.zero is not None else ""
        return "   ".join([*words, name] if name else words)

    # -- edits ------------------------------------------------------------------------------------
    def change_point(self, label: str, merge: bool = True, /, **fields: object) -> None:
        """Change fields of the selected point."""
        if self.transfer is not None and self.selected >= 0:
            changed, index = transfer_edit.with_point_changed(self.transfer, self.selected, **fields)
            self._apply(label, changed, index, merge)

    def add_point(self, point: TransferPoint) -> None:
        """Add a point and select it."""
        if self.transfer is not None:
            self._apply("Add a point", *transfer_edit.with_point_added(self.transfer, point))

    def remove_point(self) -> None:
        """Remove the selected point."""
        transfer, index = self.transfer, self.selected
        if transfer is not None and index >= 0:
            changed = transfer_edit.without_point(transfer, index)
            self._apply("Remove the point", changed, min(index, len(changed.points) - 1))

    def _apply(self, label: str, transfer: TransferFunction, index: int, merge: bool = False) -> None:
        if self._editor.change(label, merge, transfer=transfer):
            self.select(index)

    def _add_between(self) -> None:
        """Add a point half way from the selected one to the next."""
        transfer = self.transfer
        if transfer is None:
            return
        index = max(0, min(self.selected, len(transfer.points) - 2))
        values = [p.value for p in transfer.points[index : index + 2]]
        self.add_point(transfer_edit.point_at(transfer, sum(values) / len(values)))

    def _step_point(self, values: float, opacity: float) -> None:
        transfer, index = self.transfer, self.selected
        if transfer is None or index < 0:
            self.select(0)
            return
        point = transfer.points[index]
        step = 1.0 if self.decimals == 0 and self.scale.per_pixel > 0.2 else self.scale.per_pixel
        value = transfer_edit.between_neighbours(transfer, index, point.value + values * step)
        self.change_point("Move the point", value=value, opacity=nudge(point.opacity, opacity))

    def _step_function(self, shift: float, widen: float) -> None:
        if self.transfer is not None:
            level = transfer_edit.level_and_width(self.transfer)[0]
            changed = transfer_edit.scaled_about(
                self.transfer, level, 1.02**widen, shift * self.scale.per_pixel
            )
            self._apply(LEVEL, changed, self.selected, True)

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

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom if focused, else let the panel scroll; sideways, or with shift, move the view."""
        if not self.hasFocus() or self._volume is None:
            event.ignore()
            return
        sideways, notches = event.angleDelta().x() / 120, event.angleDelta().y() / 120
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            sideways, notches = sideways or notches, 0.0
        if sideways:
            move = -sideways * 30 * self.scale.per_pixel
            self._show_range(self._range[0] + move, self._range[1] + move)
        if notches:
            self.zoom(1.25**notches, self.scale.value(event.position().x()))

    # -- mouse ------------------------------------------------------------------------------------
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

    def _on_curve(self, at: QPointF) -> bool:
        if self.transfer is None or not self.scale.rect.adjusted(0, -HIT_CURVE, 0, HIT_CURVE).contains(at):
            return False
        curve = painting.curve_of(self.transfer, self.scale)
        return any(math.hypot(p.x() - at.x(), p.y() - at.y()) <= HIT_CURVE for p in curve)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take a point, make one on the curve, take the whole function, or the view."""
        if event.button() != Qt.MouseButton.LeftButton or self.transfer is None:
            event.ignore()
            return
        at = event.position()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self._editor.begin(LEVEL)
            self._drag = self._function_mover(at)
        elif (index := self._point_under(at)) >= 0:
            self.select(index)
            self._editor.begin("Move the point")
            self._drag = self._point_mover(at)
        elif self._on_curve(at):
            self._editor.begin("Add a point")
            self.add_point(transfer_edit.point_at(self.transfer, self.scale.value(at.x())))
            self._drag = self._point_mover(at)
        elif self._zoomed:
            self._drag = self._view_mover(at)
        self._show_cursor(at, event.modifiers())

    def _point_mover(self, start: QPointF) -> Callable[[QMouseEvent], None]:
        assert self.transfer is not None
        scale, point = self.scale, self.transfer.points[self.selected]
        held = scale.at(point.value, point.opacity) - start

        def move(event: QMouseEvent) -> None:
            transfer, at = self.transfer, event.position() + held
            if transfer is not None and self.selected >= 0:
                value = min(max(scale.value(at.x()), self._whole[0]), self._whole[1])
                value = transfer_edit.between_neighbours(transfer, self.selected, value)
                self.change_point("Move the point", value=value, opacity=scale.opacity(at.y()))

        return move

    def _function_mover(self, start: QPointF) -> Callable[[QMouseEvent], None]:
        first, scale = self.transfer, self.scale
        assert first is not None
        level = transfer_edit.level_and_width(first)[0]

        def move(event: QMouseEvent) -> None:
            way = event.position() - start
            up = math.copysign(max(0.0, abs(way.y()) - DEAD), -way.y())
            changed = transfer_edit.scaled_about(first, level, math.exp(up / 80), way.x() * scale.per_pixel)
            self._apply(LEVEL, changed, self.selected)

        return move

    def _view_mover(self, start: QPointF) -> Callable[[QMouseEvent], None]:
        low, high = self._range
        per_pixel = self.scale.per_pixel

        def move(event: QMouseEvent) -> None:
            way = (event.position().x() - start.x()) * per_pixel
            self._show_range(low - way, high - way)

        return move

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on with the drag, or tell what is under the pointer."""
        self._hover = event.position()
        if self._drag is not None:
            self._drag(event)
        self._show_cursor(event.position(), event.modifiers())
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag: it is one step of the history."""
        if event.button() == Qt.MouseButton.LeftButton and self._drag is not None:
            self._drag = None
            self._editor.end()
            self._show_cursor(event.position(), event.modifiers())
            self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Add a point where there is none."""
        at, transfer = event.position(), self.transfer
        if event.button() != Qt.MouseButton.LeftButton or transfer is None or self._point_under(at) >= 0:
            return
        scale = self.scale
        if scale.rect.adjusted(-4, -4, 4, 4).contains(at):
            point = transfer_edit.point_at(transfer, scale.value(at.x()))
            self.add_point(replace(point, opacity=scale.opacity(at.y())))

    def leaveEvent(self, event: QEvent) -> None:
        """Tell nothing any more."""
        self._hover = None
        self.update()

    def _show_cursor(self, at: QPointF, keys: Qt.KeyboardModifier) -> None:
        shape = Qt.CursorShape
        if keys & Qt.KeyboardModifier.ShiftModifier:
            self.setCursor(shape.SizeAllCursor)
        elif self._point_under(at) >= 0:
            self.setCursor(shape.ClosedHandCursor if self._drag else shape.PointingHandCursor)
        elif self._on_curve(at):
            self.setCursor(shape.CrossCursor)
        else:
            self.setCursor(shape.OpenHandCursor if self._zoomed else shape.ArrowCursor)

    # -- keys -------------------------------------------------------------------------------------
    def _keys(self, event: QKeyEvent) -> Callable[[], None] | None:
        """Return what a key does here, if anything."""
        key, modifiers = Qt.Key, event.modifiers()
        far = 10.0 if modifiers & Qt.KeyboardModifier.ShiftModifier else 1.0
        way = {
            key.Key_Left: (-1, 0), key.Key_Right: (1, 0), key.Key_Up: (0, 1), key.Key_Down: (0, -1)
        }.get(key(event.key()))  # fmt: skip
        if way is not None:
            if modifiers & Qt.KeyboardModifier.AltModifier:
                return lambda: self._step_function(way[0] * far, way[1] * far)
            if modifiers & Qt.KeyboardModifier.ControlModifier:
                return lambda: self._select_next(way[0] + way[1])
            return lambda: self._step_point(way[0] * far, way[1] * far)
        return {
            key.Key_Delete: self.remove_point,
            key.Key_Backspace: self.remove_point,
            key.Key_Insert: self._add_between,
            key.Key_Plus: lambda: self.zoom(1.25, self._focus_value()),
            key.Key_Equal: lambda: self.zoom(1.25, self._focus_value()),
            key.Key_Minus: lambda: self.zoom(0.8, self._focus_value()),
            key.Key_0: self.show_all,
        }.get(key(event.key()))

    def _focus_value(self) -> float:
        if self.transfer is not None and self.selected >= 0:
            return min(max(self.transfer.points[self.selected].value, self._range[0]), self._range[1])
        return sum(self._range) / 2

    def _select_next(self, way: int) -> None:
        if self.transfer is not None:
            self.select(min(max(self.selected + way, 0), len(self.transfer.points) - 1))

    def event(self, event: QEvent) -> bool:
        """Take the keys that act here before the window's shortcuts do."""
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and self._keys(event)
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Act on a key, if the function has points."""
        act = self._keys(event) if self.transfer is not None else None
        if act is None:
            event.ignore()
        else:
            act()

    # -- looks ------------------------------------------------------------------------------------
    def _areas(self) -> painting.Areas:
        metrics = QFontMetricsF(painting.small(self.font()))
        gutter = metrics.horizontalAdvance("100 %") + 2
        return painting.areas_of(self.width(), self.height(), metrics.height(), gutter, self.zero is not None)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw everything; the cost is that of some hundred points."""
        theme, areas, scale = current_theme(), self._areas(), self.scale
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(painting.small(self.font()))
        painting.draw_box(painter, areas, theme, self.hasFocus())
        transfer = self._editor.scene.transfer
        if self._volume is None or transfer is None:
            return
        painter.save()
        painter.setClipRect(areas.box.adjusted(2, 2, -2, -2))
        painting.draw_histogram(painter, scale, self._histogram, theme)
        painter.restore()
        painting.draw_axis(painter, areas, scale, theme, self.zero or 0.0, self.unit, self.decimals)
        if self.zero is not None:
            painting.draw_tissues(painter, areas, scale, theme, self.zero)
        if self.transfer is None:
            text = "This function depends on the gradient too, and has no points. A preset brings them back."
            painting.draw_message(painter, areas, text, theme)
            return
        painting.draw_lines(painter, scale, theme)
        curve = painting.curve_of(transfer, scale)
        painting.draw_function(painter, areas, curve, painting.colours_of(transfer, scale), theme)
        self._draw_points(painter, scale, transfer)
        self._draw_readout(painter, areas, scale, transfer)

    def _draw_points(self, painter: QPainter, scale: Scale, transfer: TransferFunction) -> None:
        hot = self._point_under(self._hover) if self._hover is not None and self._drag is None else -1
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
                    hot=i == hot,
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
        painting.draw_readout(painter, areas, self._told(point.value, point.opacity), current_theme())
