"""Where the VTK view is: beside the picture, in a window of its own, or nowhere."""

from __future__ import annotations

from qtpy.QtCore import QObject, Qt, Signal
from qtpy.QtGui import QCloseEvent
from qtpy.QtWidgets import QSplitter, QVBoxLayout, QWidget

from ..docking import dock
from ..editing import Editor
from ..messages import MessageBar
from .panel import VtkPanel


class _Floating(QWidget):
    """The window of an undocked view."""

    closed = Signal()

    def __init__(self, parent: QWidget, panel: VtkPanel) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.setWindowTitle("VTK view – Sfumato")
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(panel)
        self.resize(640, 560)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Tell that the user closed it."""
        self.closed.emit()
        super().closeEvent(event)


class VtkLayout(QObject):
    """Opens, undocks and closes the view; each time with a new VTK context, so that none changes its window."""

    #: Opened or closed.
    changed = Signal(bool)
    #: Streamlines are to be traced (`Tracing`).
    trace_wanted = Signal(object)
    #: The panel came or went: Tab's order is another.
    rebuilt = Signal()

    def __init__(self, splitter: QSplitter, editor: Editor, messages: MessageBar) -> None:
        super().__init__(splitter)
        self._splitter, self._editor, self._messages = splitter, editor, messages
        self.panel: VtkPanel | None = None
        self.floating: _Floating | None = None

    @property
    def is_open(self) -> bool:
        """Whether the view is shown anywhere."""
        return self.panel is not None

    def set_open(self, opened: bool) -> None:
        """Show it beside the picture, or close it wherever it is."""
        if opened != self.is_open:
            if opened:
                self._show(docked=True)
            else:
                self.close()
            self.changed.emit(self.is_open)

    def _show(self, docked: bool) -> None:
        panel = VtkPanel(self._editor, docked)
        panel.failed.connect(self._on_failed)
        panel.trace_wanted.connect(self.trace_wanted)
        panel.undock_wanted.connect(lambda: self._move(docked=not docked))
        panel.close_wanted.connect(lambda: self.set_open(False))
        self.panel = panel
        if docked:
            self._splitter.addWidget(panel)
            dock(self._splitter, panel, 0.5)
        else:
            self.floating = _Floating(self._splitter.window(), panel)
            self.floating.closed.connect(lambda: self.set_open(False))
            self.floating.show()
        self.rebuilt.emit()
        panel.start()

    def _move(self, docked: bool) -> None:
        self.close()
        self._show(docked)

    def close(self) -> None:
        """Take the view away."""
        panel, self.panel = self.panel, None
        floating, self.floating = self.floating, None
        if panel is None:
            return
        panel.close_stage()
        panel.hide()
        panel.setParent(None)
        panel.deleteLater()
        if floating is not None:
            floating.blockSignals(True)
            floating.close()
            floating.deleteLater()
        self.rebuilt.emit()

    def _on_failed(self, why: str) -> None:
        self.set_open(False)
        self._messages.show_error(f"The VTK view cannot be shown: {why}. All else goes on without it.")

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        if self.panel is not None:
            self.panel.refresh_theme()
