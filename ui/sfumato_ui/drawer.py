"""The drawer below the picture: closed at start, one page at a time, opened by buttons in the status line."""

from __future__ import annotations

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QFrame, QToolButton, QVBoxLayout, QWidget

from .bars import tool_button
from .bindings import explain
from .icons import icon
from .theme import current_theme


class Drawer(QFrame):
    """Pages of which at most one is seen."""

    #: The page that is open now, "" for none.
    changed = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("Drawer")
        self.pages: dict[str, QWidget] = {}
        self.toggles: dict[str, QToolButton] = {}
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(8, 6, 8, 6)
        self.hide()

    def add(self, name: str, title: str, tip: str, page: QWidget) -> QToolButton:
        """Add a page; returns the button that opens it, whose icon and command have the page's name."""
        toggle = tool_button(title, "", text=title, checkable=True)
        explain(toggle, tip, name)
        toggle.clicked.connect(lambda on: self.open(name if on else ""))
        self.pages[name], self.toggles[name] = page, toggle
        page.hide()
        self._column.addWidget(page)
        self.refresh_theme()
        return toggle

    @property
    def page(self) -> str:
        """The page that is open, "" if none is."""
        return next((name for name, page in self.pages.items() if not page.isHidden()), "")

    def open(self, name: str) -> None:
        """Open a page instead of another, or close the drawer."""
        if name == self.page:
            return
        inside = self.isAncestorOf(self.focusWidget()) if self.focusWidget() is not None else False
        for other, page in self.pages.items():
            page.setVisible(other == name)
            self.toggles[other].setChecked(other == name)
        self.setVisible(bool(name))
        if inside and not name:
            self.toggles[next(iter(self.toggles))].setFocus()
        self.changed.emit(name)

    def toggle(self, name: str) -> None:
        """Open a page, or close it if it is open."""
        self.open("" if self.page == name else name)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        for name, button in self.toggles.items():
            button.setIcon(icon(name, current_theme()))
