"""The plot in which the shapes of a two-dimensional function are drawn and dragged.

Left button: drag a shape, or one of its handles; double-click to add a rectangle; after *Freehand*, draw an
outline; drag the ground to move the view when zoomed in. The wheel zooms when the plot has the focus. The
same by keys: see `_keys`.
"""

from __future__ import annotations

from collections.abc import Callable

from qtpy.QtCore import QEvent, QPointF, Qt
from qtpy.QtGui import QKeyEvent, QMouseEvent, QShowEvent, QWheelEvent

from sfumato.scene import region_edit

from ..editing import Editor
from .canvas import TransferCanvas
from .new_shapes import drawn_region
from .region_edits import RegionEdits

TIP = (
    "<p>How many voxels have a value (across) and a gradient magnitude (up), logarithmically: boundaries "
    "between two tissues are arcs. What lies in the shapes is seen.</p>"
    "<p>Drag a shape or its handles; double-click adds a rectangle, Del removes the selected shape. "
    "The wheel zooms.</p>"
    "<p>Keys: arrows move the shape (shift: ten times as far), Alt+arrows stretch it, Ctrl+arrows select, "
    "Page up and down lay it over others or under, Insert adds a rectangle, Ctrl+D duplicates, "
    "+ and \N{MINUS SIGN} zoom, 0 shows all.</p>"
)


class RegionPlot(RegionEdits):
    """Edits the regions of the scene's function by mouse and keys."""

    def __init__(self, editor: Editor, line: TransferCanvas) -> None:
        super().__init__(editor, line)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setToolTip(TIP)

    def showEvent(self, event: QShowEvent) -> None:
        """Count values and gradients, if that is not done: only now they are seen."""
        super().showEvent(event)
        self.show_scene(self._editor.scene)

    # -- mouse ------------------------------------------------------------------------------------
    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Draw an outline, take a handle, a shape, or the view."""
        if event.button() != Qt.MouseButton.LeftButton or self.transfer is None:
            event.ignore()
            return
        at = event.position()
        if self.drawing:
            self._drawn = [self.plane.clamped(at)]
            self._drag = self._draw_on
        elif handle := self._handle_under(at):
            self._editor.begin("Move the shape" if handle == region_edit.MIDDLE else "Stretch the shape")
            self._drag = self._handle_mover(handle, at)
        elif (index := self._region_under(at)) >= 0 and self.regions[index].shape != "curve":
            self.select(index)
            self._editor.begin("Move the shape")
            self._drag = self._region_mover(at)
        else:
            if index >= 0:
                self.select(index)
            if self._zoomed:
                self._drag = self._view_mover(at)
        self._show_cursor(at)

    def _draw_on(self, event: QMouseEvent) -> None:
        self._drawn.append(self.plane.clamped(event.position()))

    def _handle_mover(self, handle: str, start: QPointF) -> Callable[[QMouseEvent], None]:
        first, plane, least = self.region, self.plane, self._least()
        assert first is not None
        held = self.handle_places()[handle] - start
        label = "Move the shape" if handle == region_edit.MIDDLE else "Stretch the shape"

        def move(event: QMouseEvent) -> None:
            place = plane.pair(self._within_reach(event.position() + held))
            self.put_region(label, region_edit.with_handle_at(first, handle, place, least))

        return move

    def _within_reach(self, at: QPointF) -> QPointF:
        """Return a place at most a little outside of the plot: what is lost from sight could not be taken back."""
        rect = self.plane.rect.adjusted(-8, -8, 8, 8)
        return QPointF(
            min(max(at.x(), rect.left()), rect.right()), min(max(at.y(), rect.top()), rect.bottom())
        )

    def _region_mover(self, start: QPointF) -> Callable[[QMouseEvent], None]:
        first, plane = self.region, self.plane
        assert first is not None
        across, up = plane.per_pixel

        def move(event: QMouseEvent) -> None:
            way = self._within_reach(event.position()) - start
            self.put_region("Move the shape", region_edit.moved(first, way.x() * across, -way.y() * up))

        return move

    def _view_mover(self, start: QPointF) -> Callable[[QMouseEvent], None]:
        first = self.plane
        across, up = first.per_pixel

        def move(event: QMouseEvent) -> None:
            way = event.position() - start
            self._see(first.moved(-way.x() * across, way.y() * up, self.whole))

        return move

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on with the drag, or tell what is under the pointer."""
        self._hover = event.position()
        if self._drag is not None:
            self._drag(event)
        self._show_cursor(event.position())
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag: it is one step of the history."""
        if event.button() != Qt.MouseButton.LeftButton or self._drag is None:
            return
        self._drag = None
        if self.drawing:
            self._close_outline()
        else:
            self._editor.end()
        self._show_cursor(event.position())
        self.update()

    def _close_outline(self) -> None:
        """Make a shape of the outline that was drawn, if it is one."""
        region = drawn_region(self._drawn, self.plane, self.regions)
        self.end_drawing()
        if region is not None and self.transfer is not None:
            self._apply("Draw a shape", *region_edit.with_region_added(self.transfer, region))

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Add a rectangle where there is no shape but a curve."""
        at = event.position()
        if event.button() != Qt.MouseButton.LeftButton or self.drawing or self._handle_under(at):
            return
        under = self._region_under(at)
        if self.plane.rect.contains(at) and (under < 0 or self.regions[under].shape == "curve"):
            self.add_shape("rectangle", at)

    def leaveEvent(self, event: QEvent) -> None:
        """Tell nothing any more."""
        self._hover = None
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom if focused, else let the panel scroll."""
        if not self.hasFocus() or self._volume is None:
            event.ignore()
            return
        self._zoom(1.25 ** (event.angleDelta().y() / 120), event.position())

    def _zoom(self, factor: float, about: QPointF | None = None) -> None:
        plane = self.plane
        self._see(plane.zoomed(factor, plane.rect.center() if about is None else about, self.whole))

    def _show_cursor(self, at: QPointF) -> None:
        shape = Qt.CursorShape
        if self.drawing:
            self.setCursor(shape.CrossCursor)
        elif handle := self._handle_under(at):
            self.setCursor(shape.SizeAllCursor if handle == region_edit.MIDDLE else shape.PointingHandCursor)
        elif (under := self._region_under(at)) >= 0 and self.regions[under].shape != "curve":
            self.setCursor(shape.ClosedHandCursor if self._drag else shape.OpenHandCursor)
        else:
            self.setCursor(shape.ArrowCursor)

    # -- keys -------------------------------------------------------------------------------------
    def _keys(self, event: QKeyEvent) -> Callable[[], None] | None:
        """Return what a key does here, if anything."""
        key, modifiers = Qt.Key(event.key()), event.modifiers()
        keys, held = Qt.Key, Qt.KeyboardModifier
        far = 10.0 if modifiers & held.ShiftModifier else 1.0
        way = {
            keys.Key_Left: (-1, 0), keys.Key_Right: (1, 0), keys.Key_Up: (0, 1), keys.Key_Down: (0, -1)
        }.get(key)  # fmt: skip
        if way is not None:
            if modifiers & held.ControlModifier:
                return lambda: self.select((self.selected + way[0] + way[1]) % max(1, len(self.regions)))
            if modifiers & held.AltModifier:
                return lambda: self._stretch(way[0] * far, way[1] * far)
            return lambda: self._nudge(way[0] * far, way[1] * far)
        if modifiers & held.ControlModifier:
            return self.duplicate_region if key == keys.Key_D else None
        if key == keys.Key_Escape:
            return self.end_drawing if self.drawing else None
        return {
            keys.Key_Delete: self.remove_region,
            keys.Key_Backspace: self.remove_region,
            keys.Key_Insert: lambda: self.add_shape("rectangle"),
            keys.Key_PageUp: lambda: self.reorder_region(1),
            keys.Key_PageDown: lambda: self.reorder_region(-1),
            keys.Key_Plus: lambda: self._zoom(1.25),
            keys.Key_Equal: lambda: self._zoom(1.25),
            keys.Key_Minus: lambda: self._zoom(0.8),
            keys.Key_0: self.show_all,
        }.get(key)

    def _nudge(self, right: float, up: float) -> None:
        if self.region is not None:
            across, high = self.plane.per_pixel
            moved = region_edit.moved(self.region, right * across, up * high)
            self.put_region("Move the shape", moved, True)

    def _stretch(self, wider: float, taller: float) -> None:
        """Make the shape wider about its middle, and taller from its lower edge on, by pixels."""
        if self.region is None:
            return
        (v0, v1), (g0, g1) = self.region.extent
        across, up = self.plane.per_pixel
        least = self._least()
        half = max(v1 - v0 + wider * across, least[0]) / 2
        middle, top = (v0 + v1) / 2, max(g1 + taller * up, g0 + least[1])
        self.stretch("Stretch the shape", (middle - half, middle + half), (g0, top))

    def event(self, event: QEvent) -> bool:
        """Take the keys that act here before the window's shortcuts do."""
        asked = event.type() == QEvent.Type.ShortcutOverride
        if asked and isinstance(event, QKeyEvent) and self.transfer is not None and self._keys(event):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Act on a key, if the function has regions."""
        act = self._keys(event) if self.transfer is not None else None
        if act is None:
            event.ignore()
        else:
            act()
