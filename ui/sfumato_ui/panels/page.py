"""What the tabs share: a column of controls that scrolls when the window is low."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QApplication,
    QFrame,
    QHBoxLayout,
    QLabel,
    QScrollArea,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)


class Page(QScrollArea):
    """A scrolling column."""

    def __init__(self) -> None:
        super().__init__()
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        inside = QWidget()
        inside.setObjectName("PanelPage")
        self.column = QVBoxLayout(inside)
        self.column.setContentsMargins(14, 8, 14, 10)
        self.verticalScrollBar().rangeChanged.connect(self._keep_width)
        self.column.setSpacing(6)
        self.setWidget(inside)
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        app.focusChanged.connect(self._follow_focus)

    def _follow_focus(self, old: QWidget | None, new: QWidget | None) -> None:
        """Scroll to a control that Tab reached from outside; within the column Qt does that itself."""
        inside = new is not None and self.widget() is not None and self.widget().isAncestorOf(new)
        if inside and new is not None and new.isVisible() and new.visibleRegion().isEmpty():
            self.ensureWidgetVisible(new)

    def _keep_width(self, low: int, high: int) -> None:
        """Take the scroll bar's room from the margin, so that nothing moves when it comes and goes."""
        bar = self.verticalScrollBar().sizeHint().width() if high > low else 0
        self.column.setContentsMargins(14, 8, 14 - bar, 10)

    def add(self, widget: QWidget) -> None:
        """Put a widget at the column's end; it keeps its height however high the window is."""
        policy = widget.sizePolicy()
        policy.setVerticalPolicy(QSizePolicy.Policy.Fixed)
        widget.setSizePolicy(policy)
        self.column.addWidget(widget)

    def add_heading(self, text: str, beside: QWidget | None = None) -> None:
        """Put a heading at the column's end, with a control at its right."""
        label = QLabel(text)
        label.setProperty("heading", True)
        row = QHBoxLayout()
        row.setContentsMargins(0, 8 if self.column.count() else 0, 0, 0)
        row.addWidget(label, 1)
        if beside is not None:
            row.addWidget(beside)
        self.column.addLayout(row)

    def finish(self) -> None:
        """Let what is left of the height stay below the controls."""
        self.column.addStretch(1)

    def refresh_theme(self) -> None:
        """Let every control take the theme's icon colours."""
        for child in self.widget().findChildren(QWidget):
            refresh = getattr(child, "refresh_theme", None)
            if refresh is not None:
                refresh()
