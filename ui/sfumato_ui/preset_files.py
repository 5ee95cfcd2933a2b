"""Finding presets by a word, and sharing own ones as files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QHBoxLayout, QLineEdit, QToolButton, QWidget

from sfumato import SfumatoError, TransferFunction

from .dialogs import ask_for_export, ask_for_import
from .icons import icon
from .own_presets import SUFFIX, OwnPresets
from .theme import current_theme

FILTER = f"Transfer functions (*{SUFFIX});;All files (*)"


class PresetFiles(QWidget):
    """A line in which a word is typed, and buttons that import and export.

    Parameters
    ----------
    own : OwnPresets
        Where an imported one is kept.
    shown : callable
        Returns the function that is exported, with its name.
    taken : callable
        Returns the names that others than the own presets have.
    """

    #: The user looks for presets that hold these words.
    sought = Signal(str)
    #: A preset was imported (its name), or something failed (why).
    imported = Signal(str)
    failed = Signal(str)

    def __init__(
        self,
        own: OwnPresets,
        shown: Callable[[], TransferFunction | None],
        taken: Callable[[], Iterable[str]],
    ) -> None:
        super().__init__()
        self._own, self._shown, self._taken = own, shown, taken
        self.words = QLineEdit()
        self.words.setPlaceholderText("Find a preset")
        self.words.setAccessibleName("Find a preset")
        self.words.setToolTip("Shows the presets above that hold what is typed, in their name or description")
        self.get = _button("Import a preset: a file of a transfer function, of one dimension or two")
        self.share = _button("Export the function as a file")
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        row.addWidget(self.words, 1)
        row.addWidget(self.get)
        row.addWidget(self.share)
        self.words.textChanged.connect(self.sought)
        self.get.clicked.connect(self._ask_import)
        self.share.clicked.connect(self._ask_export)
        self.refresh_theme()

    def _ask_import(self) -> None:
        ask_for_import(self.window(), "Import a preset", FILTER, self.take)

    def take(self, path: str) -> None:
        """Keep the function of a file among the own presets; a name that is taken gets a number."""
        try:
            told, transfer = self._own.read(Path(path))
            name = self._free_name(told or Path(path).stem)
            self._own.save(name, transfer)
        except (OSError, ValueError, RecursionError, SfumatoError) as error:
            self.failed.emit(f"{Path(path).name} cannot be imported: {str(error).splitlines()[0]}")
        else:
            self.imported.emit(name)

    def _free_name(self, wanted: str) -> str:
        """Return a name like the wanted one that no preset has."""
        stem, taken = self._own.free_name(wanted), {name.lower() for name in self._taken()}
        names = (stem, *(f"{stem} {i}" for i in range(2, 1000)))
        return next(n for n in names if n.lower() not in taken and not self._own.complaint(n))

    def _ask_export(self) -> None:
        transfer = self._shown()
        if transfer is None:
            return
        name = transfer.name or "Transfer function"
        ask_for_export(
            self.window(),
            "Export the function",
            name,
            SUFFIX,
            FILTER,
            lambda path: self._give(path, transfer),
        )

    def _give(self, path: str, transfer: TransferFunction) -> None:
        try:
            self._own.write(Path(path), transfer.name or Path(path).stem, transfer)
        except (OSError, SfumatoError) as error:
            self.failed.emit(f"{Path(path).name} cannot be written: {str(error).splitlines()[0]}")

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        for button, name in ((self.get, "open"), (self.share, "save")):
            button.setIcon(icon(name, current_theme()))


def _button(tip: str) -> QToolButton:
    button = QToolButton()
    button.setAccessibleName(tip.split(":")[0])
    button.setToolTip(tip)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button
