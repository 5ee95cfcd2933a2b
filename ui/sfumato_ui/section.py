"""A section of a panel that opens and closes under its name; its state persists."""

from __future__ import annotations

from qtpy.QtCore import QSize, Qt
from qtpy.QtWidgets import QSizePolicy, QToolButton, QVBoxLayout, QWidget

from .icons import icon
from .settings import settings
from .theme import current_theme


class Section(QWidget):
    """Closed at first; `key` names it in the settings, where its state is kept."""

    def __init__(self, title: str, key: str) -> None:
        super().__init__()
        self._key = f"section/{key}"
        self.header = QToolButton()
        self.header.setCheckable(True)
        self.header.setIconSize(QSize(12, 12))
        self.header.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.header.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.header.setProperty("section", True)
        self.header.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.body = QWidget()
        self._inside = inside = QVBoxLayout(self.body)
        inside.setContentsMargins(0, 4, 0, 4)
        inside.setSpacing(6)
        outside = QVBoxLayout(self)
        outside.setContentsMargins(0, 0, 0, 0)
        outside.setSpacing(0)
        outside.addWidget(self.header)
        outside.addWidget(self.body)
        self.set_title(title)
        self.header.toggled.connect(self._on_toggled)
        self.set_open(bool(settings().value(self._key, False, type=bool)))
        self._on_toggled(self.header.isChecked(), remember=False)

    def set_title(self, title: str) -> None:
        """Name the section."""
        self.header.setText(title)
        self.header.setAccessibleName(title)

    def set_open(self, opened: bool) -> None:
        """Open or close it."""
        self.header.setChecked(opened)

    def clear(self) -> None:
        """Remove what is in it."""
        while self._inside.count():
            widget = self._inside.takeAt(0).widget()
            if widget is not None:
                widget.hide()
                widget.deleteLater()

    def add(self, widget: QWidget) -> None:
        """Put a widget at its end."""
        self._inside.addWidget(widget)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.header.setIcon(
            icon("opened" if self.header.isChecked() else "closed", current_theme(), current_theme().text)
        )

    def _on_toggled(self, opened: bool, remember: bool = True) -> None:
        self.body.setVisible(opened)
        self.refresh_theme()
        if remember:
            settings().setValue(self._key, opened)
