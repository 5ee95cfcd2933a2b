"""All commands of the window: their names, their keys, and what the tooltips say of them.

Plain data and the settings. app-model would do it too, but it wants every command's callback, menus and
contexts in a global application object of its own; three fields and a `QAction` are all that is needed here.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

from qtpy.QtGui import QAction, QKeySequence
from qtpy.QtWidgets import QAbstractButton, QWidget

from sfumato.scene import STANDARD_VIEWS
from sfumato.scene.rigs import rigs
from sfumato.techniques import techniques

from .settings import settings


@dataclass(frozen=True)
class Command:
    """Something the window does.

    Attributes
    ----------
    id : str
        Its name in the settings.
    title, group : str
        What is read in the palette and in the dialog *Keyboard*.
    keys : tuple of str
        Key combinations that do it unless the user chose others, as `QKeySequence` writes them.
    """

    id: str
    title: str
    group: str
    keys: tuple[str, ...] = ()


_FIXED = (
    Command("open", "Open a volume or a scene", "File", ("Ctrl+O",)),
    Command("open-folder", "Open a folder", "File", ("Ctrl+Shift+O",)),
    Command("save", "Save the scene", "File", ("Ctrl+S",)),
    Command("save-as", "Save the scene under another name", "File", ("Ctrl+Shift+S",)),
    Command("export", "Export the picture", "File", ("Ctrl+E",)),
    Command("copy", "Copy the picture", "File", ("Ctrl+Shift+C",)),
    Command("undo", "Undo", "Edit", ("Ctrl+Z",)),
    Command("redo", "Redo", "Edit", ("Ctrl+Shift+Z", "Ctrl+Y")),
    Command("history", "History", "Window", ("H",)),
    Command("compare", "Compare", "Window", ("K",)),
    Command("vtk", "VTK view", "Window", ("V",)),
    Command("slices", "Slice views", "Window", ("M",)),
    Command("theme", "Other theme (dark or light)", "Window"),
    Command("tab-light", "Panel: Light", "Window", ("Alt+1",)),
    Command("tab-material", "Panel: Material", "Window", ("Alt+2",)),
    Command("tab-view", "Panel: View", "Window", ("Alt+3",)),
    Command("palette", "Search all commands", "Window", ("Ctrl+K",)),
    Command("keyboard", "Keyboard: show and change the keys", "Window", ("Ctrl+Shift+K",)),
    Command("tool-orbit", "Tool: Orbit", "Tool", ("Esc",)),
    Command("tool-light", "Tool: Light", "Tool", ("L",)),
    Command("tool-shadow", "Tool: Shadow", "Tool", ("S",)),
    Command("tool-clip", "Tool: Clip", "Tool", ("C",)),
    Command("tool-pick", "Tool: Pick", "Tool", ("P",)),
    Command("exposure", "Automatic exposure", "View", ("X",)),
    Command("audit", "Shadow audit: mark what shadows hide", "Light", ("A",)),
    Command("fit", "See the whole subject", "View", ("Home",)),
    Command("turntable", "Turntable: let the subject turn", "View", ("T",)),
    Command("cube", "Orientation cube", "View", ("O",)),
    Command("bookmark", "Keep this view", "View", ("Ctrl+B",)),
    Command("bookmark-next", "Next kept view", "View", ("N",)),
)
#: Keys that the picture, the controls and the dialogs need for themselves, with what they do.
RESERVED = {
    **dict.fromkeys(("Left", "Right", "Up", "Down"), "turns the subject or moves a handle"),
    **{f"Shift+{k}": "moves the lamp" for k in ("Left", "Right", "Up", "Down")},
    **{f"Ctrl+{k}": "moves the subject" for k in ("Left", "Right", "Up", "Down")},
    **dict.fromkeys(("+", "-", "="), "zooms"),
    **dict.fromkeys(("PgUp", "PgDown"), "goes from handle to handle"),
    **dict.fromkeys(("Tab", "Shift+Tab"), "goes from control to control"),
    **dict.fromkeys(("Return", "Enter", "Space"), "presses the control that has the focus"),
    **dict.fromkeys(("Del", "Backspace"), "deletes in lists and text"),
    "B": "shows the picture without light while it is held",
}


@functools.cache
def commands() -> dict[str, Command]:
    """Return all commands by id, in the order of lists."""
    views = [
        Command(f"view-{name}", f"View from the {name}", "View", (str(i + 1),))
        for i, name in enumerate(STANDARD_VIEWS)
    ]
    lit = [Command(f"technique-{t.id}", f"Technique: {t.title}", "Light") for t in techniques().values()]
    rigged = [Command(f"rig-{rig.id}", f"Rig: {rig.title}", "Light") for rig in rigs().values()]
    return {c.id: c for c in (*_FIXED, *views, *rigged, *lit)}


# -- keys --------------------------------------------------------------------------------------------
def keys_of(name: str) -> tuple[str, ...]:
    """Return the keys of a command: the user's, else those it comes with."""
    kept = settings().value(f"keys/{name}", None)
    if kept is None:
        return commands()[name].keys
    return tuple(k for k in str(kept).split(" or ") if k and not QKeySequence(k).isEmpty())


def set_keys(name: str, keys: tuple[str, ...]) -> None:
    """Let a command have these keys; every other one loses them."""
    for other in commands():
        left = tuple(k for k in keys_of(other) if k not in keys)
        if other != name and left != keys_of(other):
            settings().setValue(f"keys/{other}", " or ".join(left))
    settings().setValue(f"keys/{name}", " or ".join(keys))


def reset_keys(name: str) -> None:
    """Give a command the keys that it comes with; who has them now loses them."""
    set_keys(name, commands()[name].keys)
    settings().remove(f"keys/{name}")


def reset_all_keys() -> None:
    """Give every command the keys that it comes with."""
    settings().remove("keys")


def owner_of(keys: str) -> str:
    """Return the id of the command that has a key combination, or nothing."""
    return next((name for name in commands() if keys in keys_of(name)), "")


def words_for(name: str) -> str:
    """Return a command's keys as they are read."""
    native = QKeySequence.SequenceFormat.NativeText
    return " or ".join(QKeySequence(k).toString(native) for k in keys_of(name))


# -- tooltips ----------------------------------------------------------------------------------------
def explain(target: QAbstractButton | QAction, text: str, name: str) -> None:
    """Let a button's tooltip, or a menu's line, say what it does and by which key."""
    target.setProperty("command", name)
    target.setProperty("explained", text)
    _show_keys(target)


def refresh_tips(root: QWidget) -> None:
    """Say the keys anew everywhere below a widget."""
    targets: list[QAbstractButton | QAction] = [*root.findChildren(QAbstractButton)]
    for target in (*targets, *root.findChildren(QAction)):
        if target.property("command") and target.property("explained"):
            _show_keys(target)


def _show_keys(target: QAbstractButton | QAction) -> None:
    text, name = str(target.property("explained")), str(target.property("command"))
    keys = words_for(name)
    if isinstance(target, QAction):
        target.setText(f"{text}\t{keys}" if keys else text)
    else:
        first = keys.split(" or ")[0]
        target.setToolTip(f"{text} ({first})" if first else text)
