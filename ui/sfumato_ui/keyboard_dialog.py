"""The dialog *Keyboard*: every command's keys, to see and to change."""

from __future__ import annotations

from qtpy.QtCore import Qt, Signal
from qtpy.QtGui import QKeySequence
from qtpy.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QKeySequenceEdit,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from .bindings import (
    RESERVED,
    commands,
    keys_of,
    owner_of,
    reset_all_keys,
    reset_keys,
    set_keys,
)
from .palette import command_list, fill, matching

_NAME = Qt.ItemDataRole.UserRole


class KeyboardDialog(QDialog):
    """A list of commands; below it, the new key of the chosen one and whom it would be taken from."""

    #: Keys were changed; they count at once.
    rebound = Signal()

    def __init__(self, names: list[str], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keyboard")
        self._names = names
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search commands and keys")
        self.search.setAccessibleName("Search the commands")
        self.list = command_list("Commands and their keys")
        self.edit = QKeySequenceEdit()
        self.edit.setMaximumSequenceLength(1)
        self.edit.setAccessibleName("New key")
        self.told = QLabel()
        self.told.setWordWrap(True)
        self.told.setMinimumHeight(2 * self.fontMetrics().lineSpacing())
        self.assign = _button("Assign", "Let the chosen command have this key")
        self.without = _button("No key", "Take the chosen command's keys away")
        self.reset = _button("Reset", "Give the chosen command the keys that it comes with")
        self.reset_all = _button("Reset all", "Give every command the keys that it comes with")
        self.shut = _button("Close", "Close; the keys count already")
        self._lay_out()
        self._connect()
        self._show()

    def _lay_out(self) -> None:
        key, ends = QHBoxLayout(), QHBoxLayout()
        key.addWidget(QLabel("New key"))
        key.addWidget(self.edit, 1)
        for button in (self.assign, self.without, self.reset):
            key.addWidget(button)
        ends.addWidget(self.reset_all)
        ends.addStretch(1)
        ends.addWidget(self.shut)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 14)
        column.setSpacing(10)
        column.addWidget(self.search)
        column.addWidget(self.list, 1)
        column.addLayout(key)
        column.addWidget(self.told)
        column.addLayout(ends)
        self.resize(560, 520)

    def _connect(self) -> None:
        self.search.textChanged.connect(self._show)
        self.list.currentItemChanged.connect(lambda *_: self._choose())
        self.edit.keySequenceChanged.connect(lambda _: self._judge())
        self.assign.clicked.connect(lambda: self._set((self._typed,)))
        self.without.clicked.connect(lambda: self._set(()))
        self.reset.clicked.connect(self._reset)
        self.reset_all.clicked.connect(self._reset_all)
        self.shut.clicked.connect(self.accept)

    # -- showing ----------------------------------------------------------------------------------
    @property
    def command(self) -> str:
        """Id of the chosen command, or nothing."""
        item = self.list.currentItem()
        return str(item.data(0, _NAME)) if item is not None else ""

    @property
    def _typed(self) -> str:
        return self.edit.keySequence().toString(QKeySequence.SequenceFormat.PortableText)

    def _show(self) -> None:
        chosen = self.command
        self.list.blockSignals(True)
        self.list.clear()
        fill(self.list, matching(self._names, self.search.text()))
        found = (self.list.topLevelItem(i) for i in range(self.list.topLevelItemCount()))
        items = [item for item in found if item is not None]
        again = [item for item in items if item.data(0, _NAME) == chosen] or items
        if again:
            self.list.setCurrentItem(again[0])
        self.list.blockSignals(False)
        self._choose()

    def _choose(self) -> None:
        self.edit.blockSignals(True)
        self.edit.clear()
        self.edit.blockSignals(False)
        self._judge()

    def _judge(self) -> None:
        """Say what the new key would do, and whether it can be had."""
        name, typed = self.command, self._typed
        owner = owner_of(typed) if typed else ""
        reserved = RESERVED.get(typed, "")
        if not name:
            said = "No command holds these words."
        elif not typed:
            said = f"{commands()[name].title}: click into the field and press the new key."
        elif reserved:
            said = f"{typed} stays as it is: it {reserved}."
        elif owner == name:
            said = f"{typed} does this already."
        elif owner:
            said = f"{typed} belongs to “{commands()[owner].title}”, which would lose it."
        else:
            said = f"{typed} is free."
        self.told.setText(said)
        self.assign.setEnabled(bool(name and typed and not reserved and owner != name))
        self.without.setEnabled(bool(name and keys_of(name)))
        self.reset.setEnabled(bool(name) and keys_of(name) != commands()[name].keys)
        self.reset_all.setEnabled(any(keys_of(n) != commands()[n].keys for n in self._names))

    # -- changing ---------------------------------------------------------------------------------
    def _set(self, keys: tuple[str, ...]) -> None:
        set_keys(self.command, keys)
        self._told()

    def _reset(self) -> None:
        reset_keys(self.command)
        self._told()

    def _reset_all(self) -> None:
        reset_all_keys()
        self._told()

    def _told(self) -> None:
        self.rebound.emit()
        self._show()


def _button(text: str, tip: str) -> QPushButton:
    button = QPushButton(text)
    button.setToolTip(tip)
    button.setAutoDefault(False)
    return button
