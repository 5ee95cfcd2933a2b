"""The Shadow tool's bar over the picture: what to do, what cannot be done, and the switch to the highlight."""

from __future__ import annotations

from qtpy.QtCore import QSize, Qt
from qtpy.QtGui import QColor, QPalette
from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton

from sfumato.techniques import techniques

from ..editing import Editor
from ..icons import icon
from ..theme import current_theme
from .shadow import ShadowTool

HINTS = {
    False: "Drag from what casts the shadow to where it is to fall",
    True: "Drag the highlight to where it is to sit",
}
#: Widest that the bar's words get, and what switch and margins beside them need, in pixels.
WIDEST, BESIDE = 560, 180


class ShadowBar(QFrame):
    """Shown while the Shadow tool is active."""

    def __init__(self, editor: Editor, tool: ShadowTool) -> None:
        super().__init__()
        self.setObjectName("ToolBar")
        self._editor, self._tool = editor, tool
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.highlight = QToolButton()
        self.highlight.setText("Highlight")
        self.highlight.setToolTip(
            "<p>Place the highlight instead of the shadow; a drag with Alt does the other of the two.</p>"
            "<p>Page up and down go from end to end, arrow keys move it.</p>"
        )
        self.highlight.setAccessibleName("Place the highlight")
        self.highlight.setCheckable(True)
        self.highlight.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.highlight.setIconSize(QSize(18, 18))
        self.highlight.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 6, 6, 6)
        row.setSpacing(12)
        row.addWidget(self.words, 1)
        row.addWidget(self.highlight)
        self.setCursor(Qt.CursorShape.ArrowCursor)
        self.highlight.toggled.connect(self._switch)
        tool.told.changed.connect(self.show_words)
        editor.changed.connect(lambda old, new: self._refresh() if self.isVisible() else None)
        self._told = ""
        self.refresh_theme()
        self.hide()

    def set_shown(self, shown: bool) -> None:
        """Show or hide the bar."""
        if shown:
            self._refresh()
        self.setVisible(shown)

    def show_words(self, words: str) -> None:
        """Say something; nothing: say what to do."""
        self._told = words
        self._refresh()

    def _switch(self, glossy: bool) -> None:
        self._tool.glossy = glossy
        self.show_words("")

    def _refresh(self) -> None:
        words = self._told or self._reason() or HINTS[self.highlight.isChecked()]
        self.words.setText(words)
        self.fit()

    def fit(self) -> None:
        """Give the words the width that they need, as far as the picture has it."""
        parent = self.parentWidget()
        room = WIDEST if parent is None else parent.width() - BESIDE
        needed = self.words.fontMetrics().horizontalAdvance(self.words.text()) + 4
        self.words.setFixedWidth(max(60, min(WIDEST, room, needed)))

    def _reason(self) -> str:
        """Return why nothing would be seen of it, or nothing."""
        scene, light = self._editor.scene, self._editor.light
        if light is None:
            return "There is no lamp: add one in the Light tab"
        if not techniques()[scene.technique_id].lit:
            return "This technique draws without light: choose another in the Light tab"
        if light not in scene.active_lights:
            return f"The lamp {light.name or self._editor.selected + 1} does not shine now".rstrip()
        if self.highlight.isChecked() and not getattr(scene.technique, "specular", 0.0):
            if hasattr(scene.technique, "specular"):
                return "Highlights are off: raise them in the Light tab"
            return "This technique has no highlights"
        return ""

    def refresh_theme(self) -> None:
        """Take the theme's colours."""
        theme = current_theme()
        self.setStyleSheet(
            f"#ToolBar {{ background: {theme.panel}; border: 1px solid {theme.border}; border-radius: 6px; }}"
            f"#ToolBar QLabel {{ color: {theme.text}; }}"
        )
        palette = self.palette()
        palette.setColor(QPalette.ColorRole.WindowText, QColor(theme.text))
        self.setPalette(palette)
        self.highlight.setIcon(icon("highlight", theme))
