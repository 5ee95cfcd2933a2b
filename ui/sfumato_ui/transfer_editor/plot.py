"""The plot in which the transfer function's points are dragged.

Left button: drag a point; press on the curve to add one there, double-click to add one anywhere; drag the
ground to move the view when zoomed in; with shift, drag the whole function sideways (level) and up or down
(width). The wheel zooms when the plot has the focus. The same by keys: see `_keys`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from qtpy.QtCore import QEvent, QPointF, Qt
from qtpy.QtGui import QKeyEvent, QMouseEvent, QWheelEvent

from sfumato import TransferFunction, TransferPoint
from sfumato.scene import transfer_edit

from ..editing import Editor
from . import painting
from .canvas import TransferCanvas
from .scale import nudge

#: Hit distance of the curve in pixels.
HIT_CURVE = 7.0
#: Pixels up or down before a shift-drag changes the width too.
DEAD = 8.0
LEVEL = "Move the transfer function"
TIP = (
    "<p>Drag a point. Click on the curve to add one, or double-click anywhere; Del removes it. "
    "Points snap to the histogram's peaks, with Ctrl they do not. "
    "Shift-drag moves the whole function, up and down widens it. The wheel zooms.</p>"
    "<p>Keys: arrows move the point (shift: ten times as far), Ctrl+arrows select, Alt+arrows move the whole "
    "function, Insert adds a point, + and \N{MINUS SIGN} zoom, 0 shows all.</p>"
)


class TransferPlot(TransferCanvas):
    """Edits the points of the scene's function."""

    def __init__(self, editor: Editor) -> None:
        super().__init__(editor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setToolTip(TIP)

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
        held, (low, high) = scale.at(point.value, point.opacity) - start, self._whole

        def move(event: QMouseEvent) -> None:
            transfer, at = self.transfer, event.position() + held
            if transfer is not None and self.selected >= 0:
                free = event.modifiers() & Qt.KeyboardModifier.ControlModifier
                value = min(max(scale.value(at.x()), low), high)
                value = value if free else self.snapped(value)
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
