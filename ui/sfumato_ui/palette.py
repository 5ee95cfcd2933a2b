"""The command palette: type a word of what you want, Enter does it."""

from __future__ import annotations

from qtpy.QtCore import QEvent, QObject, QSize, Qt, Signal
from qtpy.QtGui import QKeyEvent
from qtpy.QtWidgets import (
    QApplication,
    QDialog,
    QHeaderView,
    QLineEdit,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from .bindings import commands, words_for
from .theme import TARGET

_NAME = Qt.ItemDataRole.UserRole
_MOVES = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown)


def matching(names: list[str], typed: str) -> list[str]:
    """Return the commands that hold every typed word, those first that begin with what was typed."""
    words = typed.lower().split()

    def text(name: str) -> str:
        command = commands()[name]
        return f"{command.title} {command.group} {words_for(name)}".lower()

    found = [name for name in names if all(word in text(name) for word in words)]
    return sorted(found, key=lambda name: not text(name).startswith(typed.lower().strip()))


class CommandPalette(QDialog):
    """A line to type in over a list of commands with their keys."""

    #: A command was chosen (its id); told after the palette has closed.
    chosen = Signal(str)

    def __init__(self, names: list[str], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Commands")
        self._names = names
        self.search = QLineEdit()
        self.search.setPlaceholderText("Type what you want to do")
        self.search.setAccessibleName("Search the commands")
        self.search.setClearButtonEnabled(False)
        self.list = command_list("Commands")
        self.keys = QPushButton("Change keys…")
        self.keys.setAutoDefault(False)
        self.keys.setToolTip("Show and change the keys of all commands")
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 12, 12, 12)
        column.setSpacing(8)
        column.addWidget(self.search)
        column.addWidget(self.list, 1)
        column.addWidget(self.keys, 0, Qt.AlignmentFlag.AlignRight)
        self.resize(460, 420)
        self.search.textChanged.connect(self._show)
        self.search.returnPressed.connect(self._take)
        self.search.installEventFilter(self)
        self.list.itemActivated.connect(self._take)
        self.list.itemClicked.connect(self._take)
        self.keys.clicked.connect(lambda: self._end("keyboard"))
        self._show("")

    def _show(self, typed: str) -> None:
        self.list.clear()
        fill(self.list, matching(self._names, typed))
        first = self.list.topLevelItem(0)
        if first is not None:
            self.list.setCurrentItem(first)

    def _take(self) -> None:
        item = self.list.currentItem()
        if item is not None:
            self._end(str(item.data(0, _NAME)))

    def _end(self, name: str) -> None:
        if self.isVisible():  # a click may be told as an activation, too
            self.accept()
            self.chosen.emit(name)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Move through the list by arrow keys while typing."""
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent) and event.key() in _MOVES:
            QApplication.sendEvent(self.list, event)
            return True
        return super().eventFilter(watched, event)


def command_list(name: str) -> QTreeWidget:
    """Return an empty list of commands with a column of keys."""
    made = QTreeWidget()
    made.setAccessibleName(name)
    made.setColumnCount(2)
    made.setHeaderLabels(["Command", "Keys"])
    made.setRootIsDecorated(False)
    made.setUniformRowHeights(True)
    made.setTabKeyNavigation(False)
    made.header().setStretchLastSection(False)
    made.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
    made.header().setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
    made.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    return made


def fill(tree: QTreeWidget, names: list[str]) -> None:
    """Add commands to a list."""
    for name in names:
        command = commands()[name]
        item = QTreeWidgetItem([command.title, words_for(name)])
        item.setData(0, _NAME, name)
        item.setSizeHint(0, QSize(0, max(TARGET, tree.fontMetrics().height() + 8)))
        item.setToolTip(0, f"{command.group}: {command.title}")
        tree.addTopLevelItem(item)
