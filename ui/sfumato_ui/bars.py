"""The top bar and the tool strip: buttons only; what they do is wired in `window`."""

from __future__ import annotations

from qtpy.QtCore import QSize, Qt, Signal
from qtpy.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QMenu,
    QToolButton,
    QVBoxLayout,
    QWidget,
    QWidgetAction,
)

import sfumato_samples

from .bindings import explain
from .editing import Editor
from .icons import icon
from .recent_menu import RecentMenu
from .subject import is_open
from .theme import current_theme


def tool_button(name: str, tip: str, *, text: str = "", checkable: bool = False) -> QToolButton:
    """Return a button with an accessible name, a tooltip and, if given, text beside its icon."""
    button = QToolButton()
    button.setText(text or name)
    button.setAccessibleName(name)
    button.setToolTip(tip)
    button.setCheckable(checkable)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    button.setIconSize(QSize(20, 20))
    beside, alone = Qt.ToolButtonStyle.ToolButtonTextBesideIcon, Qt.ToolButtonStyle.ToolButtonIconOnly
    button.setToolButtonStyle(beside if text else alone)
    return button


class TopBar(QFrame):
    """Open, Save, Undo, Redo, and to the right Before/After and Export."""

    #: Unlit is held (True) or let go.
    unlit = Signal(bool)
    #: What the user wants to open.
    file_wanted = Signal()
    folder_wanted = Signal()
    sample_wanted = Signal(str)

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self.setObjectName("TopBar")
        self._editor = editor
        self._said: tuple[object, ...] = ()
        self.open = tool_button("Open", "", text="Open")
        explain(self.open, "Open a volume, a folder or a scene", "open")
        self.open.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.open.setMenu(self._open_menu())
        self.save = tool_button("Save scene", "", text="Save")
        explain(self.save, "Save the scene", "save")
        self.undo = tool_button("Undo", "")
        self.redo = tool_button("Redo", "")
        self.before = tool_button(
            "Before/After", "Hold to see the picture without light (hold B)", text="Before/After"
        )
        self.picture = tool_button("Export", "", text="Export")
        explain(self.picture, "Export the picture for screen or print", "export")
        row = QHBoxLayout(self)
        row.setContentsMargins(8, 4, 8, 4)
        row.setSpacing(2)
        for button in (self.open, self.save):
            row.addWidget(button)
        row.addSpacing(10)
        for button in (self.undo, self.redo):
            row.addWidget(button)
        row.addStretch(1)
        for button in (self.before, self.picture):
            row.addWidget(button)
        self.undo.clicked.connect(editor.undo)
        self.redo.clicked.connect(editor.redo)
        self.before.pressed.connect(lambda: self.unlit.emit(True))
        self.before.released.connect(lambda: self.unlit.emit(False))
        editor.changed.connect(lambda old, new: self.refresh())
        editor.history_changed.connect(self.refresh)
        self.refresh_theme()
        self.refresh()

    def _open_menu(self) -> QMenu:
        menu = QMenu(self)
        menu.setToolTipsVisible(True)
        explain(menu.addAction("File…", self.file_wanted.emit), "File…", "open")
        explain(menu.addAction("Folder…", self.folder_wanted.emit), "Folder…", "open-folder")
        self.recent = RecentMenu(menu)
        menu.addMenu(self.recent)
        menu.addSeparator()
        menu.addAction(_menu_heading("Samples", menu))
        for entry in sfumato_samples.catalogue():
            action = menu.addAction(entry.title)
            action.setToolTip(entry.description)
            action.triggered.connect(
                lambda _=False, name=entry.name: self.sample_wanted.emit(f"sample:{name}")
            )
        return menu

    def refresh(self) -> None:
        """Say what can be undone, if that is other than what is said already: drags come here at each move."""
        document, opened = self._editor.document, is_open(self._editor.scene)
        said = (document.undo_label, document.redo_label, opened)
        if said == self._said:
            return
        self._said = said
        for button, word, label in (
            (self.undo, "Undo", document.undo_label),
            (self.redo, "Redo", document.redo_label),
        ):
            button.setEnabled(bool(label))
            explain(button, f"{word}: {label}" if label else f"Nothing to {word.lower()}", word.lower())
        for button in (self.save, self.before, self.picture):
            button.setEnabled(opened)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        theme = current_theme()
        for button, name in (
            (self.open, "open"), (self.save, "save"), (self.undo, "undo"), (self.redo, "redo"),
            (self.before, "unlit"), (self.picture, "picture"),
        ):  # fmt: skip
            button.setIcon(icon(name, theme))


def _menu_heading(text: str, menu: QMenu) -> QWidgetAction:
    """Return a title for what follows in a menu; a section's own would be hidden by the style sheet."""
    label = QLabel(text)
    label.setProperty("muted", True)
    label.setContentsMargins(12, 2, 12, 2)
    action = QWidgetAction(menu)
    action.setDefaultWidget(label)
    return action


def _explained(name: str, text: str, command: str, checkable: bool = True) -> QToolButton:
    button = tool_button(name, "", checkable=checkable)
    explain(button, text, command)
    return button


class ToolStrip(QFrame):
    """Exactly one tool is active."""

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("Strip")
        self.tools = {
            "orbit": _explained("Orbit", "Orbit: drag turns the subject", "tool-orbit"),
            "light": _explained("Light", "Light: drag moves the lamps", "tool-light"),
            "shadow": _explained(
                "Shadow", "Shadow: drag the lamp's shadow to where it is to fall", "tool-shadow"
            ),
            "clip": _explained("Clip", "Clip: drag the faces of the crop box and the planes", "tool-clip"),
            "pick": _explained("Pick", "Pick: press on a material to find it in the function", "tool-pick"),
        }
        self.vtk = _explained(
            "VTK view", "VTK view beside the picture: pick lines, place seeds and regions", "vtk"
        )
        self.slices = _explained(
            "Slice views",
            "Slice views beside the picture: axial, coronal, sagittal, with the lamps",
            "slices",
        )
        self.fit = _explained("Fit", "See the whole subject", "fit", checkable=False)
        column = QVBoxLayout(self)
        column.setContentsMargins(5, 8, 5, 8)
        column.setSpacing(4)
        for name, button in self.tools.items():
            button.setIconSize(QSize(22, 22))
            button.clicked.connect(lambda _=False, name=name: self.choose(name))
            column.addWidget(button)
        column.addStretch(1)
        for button in (self.slices, self.vtk, self.fit):
            button.setIconSize(QSize(22, 22))
            column.addWidget(button)
        self.choose("orbit")
        self.refresh_theme()

    def choose(self, name: str) -> None:
        """Make a tool the active one."""
        # No exclusive button group: its unchecked buttons could not be reached by Tab.
        for other, button in self.tools.items():
            button.setChecked(other == name)
        self.chosen.emit(name)

    def buttons(self) -> list[QWidget]:
        """Return the buttons from top to bottom."""
        return [*self.tools.values(), self.slices, self.vtk, self.fit]

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        layouts = (("slices", self.slices), ("vtk", self.vtk), ("fit", self.fit))
        for name, button in (*self.tools.items(), *layouts):
            button.setIcon(icon(name, current_theme()))
