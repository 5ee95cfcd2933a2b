"""Where the slice views are: beside the picture, or nowhere; and the cross-hair's mark in the picture."""

from __future__ import annotations

from qtpy.QtCore import QObject, Qt, Signal
from qtpy.QtWidgets import QSplitter

from ..docking import dock
from ..editing import Editor
from ..settings import settings
from ..viewport import Viewport
from .panel import SlicePanel

OPEN, WIDE = "slices/open", "slices/part"
#: Part of the picture's width that the views take at first, and the least and most that is remembered.
PART, LIMITS = 1 / 3, (0.1, 0.8)


class SliceLayout(QObject):
    """Opens and closes the views; closed, they cost nothing, and keep cross-hair and window."""

    #: Opened or closed.
    changed = Signal(bool)
    #: The panel was made: Tab's order is another.
    rebuilt = Signal()

    def __init__(self, splitter: QSplitter, editor: Editor, viewport: Viewport) -> None:
        super().__init__(splitter)
        self._splitter, self._editor, self._viewport = splitter, editor, viewport
        self.panel: SlicePanel | None = None
        splitter.splitterMoved.connect(lambda place, index: self._keep_part())

    @property
    def is_open(self) -> bool:
        """Whether they are shown."""
        return self.panel is not None and not self.panel.isHidden()

    def restore(self) -> None:
        """Show them if they were when the window was closed."""
        self.set_open(bool(settings().value(OPEN, False, type=bool)))

    def set_open(self, opened: bool) -> None:
        """Show them beside the picture, or not."""
        if opened == self.is_open:
            return
        settings().setValue(OPEN, opened)
        if opened:
            panel = self.panel or self._make()
            panel.show()
            self._dock()
        elif self.panel is not None:
            focused = self._splitter.window().focusWidget()
            if focused is not None and self.panel.isAncestorOf(focused):
                self._viewport.setFocus()
            self.panel.hide()
        self._mark()
        self.changed.emit(opened)

    def _make(self) -> SlicePanel:
        panel = self.panel = SlicePanel(self._editor)
        panel.close_wanted.connect(lambda: self.set_open(False))
        panel.state.moved.connect(self._mark)
        # When the window opens with them, its size is known only then.
        panel.seen.connect(self._dock, Qt.ConnectionType.QueuedConnection)
        panel.hide()
        self._splitter.addWidget(panel)
        self.rebuilt.emit()
        return panel

    def _dock(self) -> None:
        if self.panel is not None and self.is_open:
            dock(self._splitter, self.panel, kept_part())

    def go_to(self, point: object) -> None:
        """Move the cross-hair to a world point, if the views are shown."""
        if self.panel is not None and self.is_open:
            self.panel.state.go_to(point)

    def _mark(self) -> None:
        """Show the cross-hair's place in the picture."""
        state = self.panel.state if self.panel is not None and self.is_open else None
        self._viewport.set_mark(state.cross if state is not None and state.volume is not None else None)

    def close(self) -> None:
        """Make no slices any more: the window closes."""
        if self.panel is not None:
            self.panel.close_threads()

    def _keep_part(self) -> None:
        """Remember how wide the views are, as the hand made them; a narrow window may leave them no choice."""
        if self.panel is not None and self.is_open:
            both = self._splitter.sizes()[0] + self.panel.width()
            settings().setValue(WIDE, self.panel.width() / max(1, both))

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        if self.panel is not None:
            self.panel.refresh_theme()


def kept_part() -> float:
    """Return the part of the picture's width that the views are to take: as it was, or the first one."""
    try:
        part = float(str(settings().value(WIDE, PART)))
    except ValueError:
        return PART
    return part if LIMITS[0] <= part <= LIMITS[1] else PART


__all__ = ["SliceLayout"]
