"""The presets' heading with its buttons, and the line below in which names are asked and deletion confirmed."""

from __future__ import annotations

from collections.abc import Callable

from qtpy.QtCore import QEvent, Qt, Signal
from qtpy.QtGui import QKeyEvent
from qtpy.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QPushButton, QToolButton, QVBoxLayout, QWidget

from .icons import icon
from .theme import current_theme


class AskLine(QWidget):
    """Asks for a name, or a yes, in place; Enter agrees, Esc gives up."""

    #: The user answered (the text, empty for a yes), or gave up.
    answered = Signal(str)
    given_up = Signal()

    def __init__(self, noun: str = "preset") -> None:
        super().__init__()
        self._noun = noun
        self._complaint: Callable[[str], str] = lambda text: ""
        self._text = QLineEdit()
        self._question = QLabel()
        self._question.setWordWrap(True)
        self.accept, self.cancel = QPushButton("Save"), QPushButton("Cancel")
        row = QHBoxLayout()
        row.setSpacing(6)
        row.addWidget(self._text, 1)
        row.addWidget(self.accept)
        row.addWidget(self.cancel)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addWidget(self._question)
        column.addLayout(row)
        self._row = row
        self._text.textChanged.connect(self._judge)
        self._text.returnPressed.connect(self._agree)
        self.accept.clicked.connect(self._agree)
        self.cancel.clicked.connect(self._give_up)
        self.hide()

    @property
    def text(self) -> QLineEdit:
        """The field in which the name is typed."""
        return self._text

    @property
    def complaint(self) -> str:
        """What it says about the name that is typed."""
        return self._question.text()

    def ask_name(self, verb: str, name: str, complaint: Callable[[str], str]) -> None:
        """Ask for a name; `complaint` says what is wrong with one."""
        self._complaint = complaint
        self._text.setAccessibleName(f"Name of the {self._noun}")
        self._text.setPlaceholderText("Name")
        self._text.setText(name)
        self._text.selectAll()
        self._open(verb, "", True)
        self._judge(name)
        self._text.setFocus()

    def ask_yes(self, verb: str, question: str) -> None:
        """Ask whether to go on."""
        self._complaint = lambda text: ""
        self._text.clear()
        self._open(verb, question, False)
        self.accept.setEnabled(True)
        self.accept.setFocus()

    def _open(self, verb: str, question: str, named: bool) -> None:
        self.accept.setText(verb)
        self._question.setText(question)
        self._question.setVisible(bool(question))
        self._text.setVisible(named)
        self.show()

    def _judge(self, text: str) -> None:
        """Say at once what is wrong with the name; an empty one is only not accepted yet."""
        complaint = self._complaint(text)
        self.accept.setEnabled(not complaint)
        told = complaint if text.strip() else ""
        self._question.setText(told)
        self._question.setVisible(bool(told))

    def _agree(self) -> None:
        if self.accept.isEnabled():
            self.hide()
            self.answered.emit(self._text.text().strip())

    def _give_up(self) -> None:
        self.hide()
        self.given_up.emit()

    def event(self, event: QEvent) -> bool:
        """Take Esc before the window's shortcut does."""
        asked = event.type() == QEvent.Type.ShortcutOverride
        if asked and isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc gives up, Enter agrees."""
        if event.key() == Qt.Key.Key_Escape:
            self._give_up()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.accept.hasFocus():
            self._agree()
        else:
            super().keyPressEvent(event)


class PresetBar(QWidget):
    """Heading, what the scene's function is called, and the buttons for own presets.

    Attributes
    ----------
    unfolded : bool
        Whether all presets are to be shown.
    """

    #: All presets are to be shown, or the first ones again.
    fold_changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._count = self._most = 0
        self.unfolded = False
        self.origin = QLabel()
        self.origin.setProperty("muted", True)
        self.save = _button("Save as an own preset")
        self.rename = _button("Rename the own preset (F2)")
        self.delete = _button("Delete the own preset (Del)")
        self.unfold = _button("Show all presets")
        self.unfold.clicked.connect(lambda: self.set_unfolded(not self.unfolded))
        heading = QLabel("Presets")
        heading.setProperty("heading", True)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        row.addWidget(heading)
        row.addWidget(self.origin, 1)
        for button in (self.save, self.rename, self.delete, self.unfold):
            row.addWidget(button)
        self.refresh_theme()

    def show_state(self, edited: str, own: bool, savable: bool) -> None:
        """Show whose edited form the function is, if one's, and what can be done."""
        self.origin.setText(edited)
        self.save.setEnabled(savable)
        why = "" if own else ": only own presets can be, select one"
        for button, word in ((self.rename, "Rename"), (self.delete, "Delete")):
            button.setEnabled(own)
            button.setToolTip(f"{word} the own preset{why}")

    def offer_fold(self, count: int, most: int) -> None:
        """Offer to show all presets, if there are more than are shown at first."""
        self._count, self._most = count, most
        self.unfold.setVisible(count > most)
        self._show_fold()

    def set_unfolded(self, unfolded: bool) -> None:
        """Show all presets, or the first ones."""
        if unfolded != self.unfolded:
            self.unfolded = unfolded
            self._show_fold()
            self.fold_changed.emit()

    def _show_fold(self) -> None:
        first, whole = f"Show the first {self._most} presets", f"Show all {self._count} presets"
        name = first if self.unfolded else whole
        self.unfold.setAccessibleName(name)
        self.unfold.setToolTip(name)
        self.unfold.setIcon(icon("fold" if self.unfolded else "unfold", current_theme()))

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        for button, name in ((self.save, "add"), (self.rename, "rename"), (self.delete, "remove")):
            button.setIcon(icon(name, current_theme()))
        self._show_fold()


def _button(name: str) -> QToolButton:
    button = QToolButton()
    button.setAccessibleName(name)
    button.setToolTip(name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button
