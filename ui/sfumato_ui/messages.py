"""The bar on top of the picture that tells what happened, what to do, or how far something is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise

from qtpy.QtCore import Qt, QTimer, Signal
from qtpy.QtGui import QColor, QPalette
from qtpy.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from .icons import icon
from .status import set_quietly
from .theme import current_theme

#: A notice goes away by itself after this, in milliseconds; an error stays until it is closed.
NOTICE_MS = 12_000
#: Of the bar from the picture's upper edge in pixels: a letter there is covered as a whole.
TOP = 6


class MessageBar(QFrame):
    """One message at a time, laid over the picture."""

    #: The user pressed the bar's button ("Cancel").
    cancelled = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._over = parent
        self.setObjectName("MessageBar")
        self.kind = ""
        self._question: tuple[str, Mapping[str, Callable[[], object]]] | None = None
        self._icon = QLabel()
        self._text = QLabel()
        self._text.setWordWrap(True)
        self._text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._text.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self._bar = QProgressBar()
        self._bar.setTextVisible(False)
        self._bar.setRange(0, 1000)
        self._bar.setAccessibleName("Progress")
        self._cancel = QPushButton("Cancel")
        self._answers: list[QPushButton] = []
        self._acts: dict[str, Callable[[], object]] = {}
        self._close = QToolButton()
        self._close.setAccessibleName("Close the message")
        self._cancel.clicked.connect(self.cancelled)
        self._close.clicked.connect(self.clear)
        self._fade = QTimer(self)
        self._fade.setSingleShot(True)
        self._fade.timeout.connect(self.clear)
        self._lay_out()
        self.hide()

    def _lay_out(self) -> None:
        words = QVBoxLayout()
        words.setSpacing(6)
        words.addWidget(self._text)
        words.addWidget(self._bar)
        self._row = row = QHBoxLayout(self)
        row.setContentsMargins(12, 8, 8, 8)
        row.setSpacing(10)
        row.addWidget(self._icon, 0, Qt.AlignmentFlag.AlignTop)
        row.addLayout(words, 1)
        row.addWidget(self._cancel, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self._close, 0, Qt.AlignmentFlag.AlignTop)

    @property
    def text(self) -> str:
        """What it says."""
        return self._text.text() if self.isVisible() else ""

    def show_error(self, text: str, answers: Mapping[str, Callable[[], object]] | None = None) -> None:
        """Say what went wrong; it stays until closed or replaced.

        Parameters
        ----------
        answers : mapping of str to callable, optional
            Buttons that mend it, by their text.
        """
        self._show("error", text, answers)

    def ask(self, text: str, answers: Mapping[str, Callable[[], object]]) -> None:
        """Ask something that can wait: it gives way to other messages and comes back until answered.

        Parameters
        ----------
        answers : mapping of str to callable
            Buttons by their text.
        """
        self._question = text, answers
        if not self.kind:
            self._show("question", text, answers)

    def show_notice(self, text: str) -> None:
        """Say something worth knowing; it goes away by itself."""
        self._show("notice", text)
        self._fade.start(NOTICE_MS)

    def show_progress(self, text: str, fraction: float) -> None:
        """Say how far something is (0 to 1), with a button to give it up."""
        set_quietly(self._bar, round(1000 * max(0.0, min(1.0, fraction))))
        if self.kind != "progress" or self._text.text() != text:
            self._show("progress", text)

    def clear(self, kind: str = "") -> None:
        """Hide the bar, if it shows this kind of message (any, if none is named)."""
        if not kind or kind == self.kind:
            self._fade.stop()
            if self.kind == "question":
                self._question = None
            self.kind = ""
            focus = self.window().focusWidget()
            if focus is not None and self.isAncestorOf(focus):
                self._over.setFocus()  # else Qt gives it to whatever comes next
            self.hide()
            if self._question is not None:
                self._show("question", *self._question)

    def place(self) -> None:
        """Take the width that the picture has, up to a readable line."""
        parent = self._over
        width = min(620, parent.width() - 24)
        self.setFixedWidth(max(120, width))
        buttons = [self._cancel] if self.kind == "progress" else self._answers
        taken = sum(button.sizeHint().width() + 10 for button in buttons)
        taken += 0 if self.kind == "progress" else 40
        self._text.setFixedWidth(max(60, width - 60 - taken))
        self.adjustSize()
        self.move((parent.width() - self.width()) // 2, TOP)

    def _show(self, kind: str, text: str, answers: Mapping[str, Callable[[], object]] | None = None) -> None:
        self._fade.stop()
        self._offer(answers or {})
        self.kind = kind
        self._text.setText(text)
        self._text.setAccessibleName(text)
        self._bar.setVisible(kind == "progress")
        self._cancel.setVisible(kind == "progress")
        self._close.setVisible(kind != "progress")
        self.refresh_theme()
        self.place()
        self.show()
        self.raise_()

    def _offer(self, answers: Mapping[str, Callable[[], object]]) -> None:
        """Replace the buttons; each one closes the bar and acts."""
        self._acts = dict(answers)
        if [button.text() for button in self._answers] == list(answers):
            return  # a message that comes again must not take a button from under the mouse
        for button in self._answers:
            button.hide()
            self._row.removeWidget(button)
            button.deleteLater()
        self._answers = []
        for text in answers:
            button = QPushButton(text)
            button.clicked.connect(lambda _=False, text=text: self._answer(text))
            self._row.insertWidget(self._row.count() - 1, button, 0, Qt.AlignmentFlag.AlignVCenter)
            button.show()  # in a bar that is seen, the layout would show it only after the next event
            self._answers.append(button)
        # Tab goes from the picture to the answers.
        for before, after in pairwise([self._over, *self._answers, self._close]):
            QWidget.setTabOrder(before, after)

    def _answer(self, text: str) -> None:
        act = self._acts[text]
        self.clear(self.kind)
        act()

    def refresh_theme(self) -> None:
        """Take the theme's colours."""
        theme = current_theme()
        bad = self.kind == "error"
        ground, ink = (theme.error, theme.on_error) if bad else (theme.panel, theme.text)
        self.setStyleSheet(
            f"#MessageBar {{ background: {ground}; border: 1px solid {theme.border}; border-radius: 6px; }}"
            f"#MessageBar QLabel {{ color: {ink}; }}"
        )
        palette = self.palette()
        palette.setColor(QPalette.ColorRole.WindowText, QColor(ink))
        self.setPalette(palette)
        self._icon.setPixmap(icon("error" if bad else "info", theme, ink).pixmap(20, 20))
        self._close.setIcon(icon("close", theme, ink))
