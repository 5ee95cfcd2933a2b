"""What each command does in the main window, and when it can be done."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from sfumato.scene import STANDARD_VIEWS
from sfumato.scene.rigs import rigs
from sfumato.techniques import techniques

from .commands import Commands
from .subject import is_open
from .theme import THEMES, current_theme

if TYPE_CHECKING:
    from .window import MainWindow


def window_commands(window: MainWindow) -> Commands:
    """Return the window's commands, bound to their keys."""
    acts: dict[str, Callable[[], Any]] = {
        "open": window.files.ask_to_open,
        "open-folder": window.files.ask_to_open_folder,
        "save": lambda: window.files.save_scene(),
        "save-as": lambda: window.files.ask_to_save_scene(),
        "export": window.exporter.ask,
        "copy": window.exporter.copy,
        "undo": window.editor.undo,
        "redo": window.editor.redo,
        "history": lambda: window.drawer.toggle("history"),
        "compare": lambda: window.drawer.toggle("compare"),
        "vtk": window.strip.vtk.toggle,
        "slices": window.strip.slices.toggle,
        "exposure": window.exposure.ask,
        "audit": window.light_page.audit.on.toggle,
        "theme": lambda: window.set_theme(_other_theme()),
        "turntable": window.turntable.toggle,
        "cube": window.view_page.cube.toggle,
        "fit": lambda: window.look(""),
        "bookmark": window.view_page.bookmarks.marks.keep,
        "bookmark-next": window.view_page.bookmarks.marks.go_on,
        **{f"tool-{name}": partial(window.strip.choose, name) for name in window.strip.tools},
        "tool-orbit": partial(_escape, window),
        **{
            f"tab-{name}": partial(window.panel.setCurrentIndex, i)
            for i, name in enumerate(("light", "material", "view"))
        },
        **{f"view-{name}": partial(window.look, name) for name in STANDARD_VIEWS},
        **{f"rig-{name}": window.light_page.rig_buttons[name].click for name in rigs()},
        **{f"technique-{name}": partial(_light_by, window, name) for name in techniques()},
    }
    return Commands(window, acts, _possible(window))


def _possible(window: MainWindow) -> dict[str, Callable[[], bool]]:
    """Return when a command makes sense; one that is not named always does."""

    def opened() -> bool:
        return is_open(window.editor.scene)

    def volume() -> bool:
        return window.editor.scene.volume is not None

    needing = ("save", "save-as", "export", "copy", "fit", *(f"view-{name}" for name in STANDARD_VIEWS))
    return {
        **dict.fromkeys(needing, opened),
        **{f"rig-{n}": partial(_can_be_clicked, window, n) for n in rigs()},
        **{f"technique-{n}": volume for n in techniques()},
        "audit": opened,
        "cube": opened,
        "turntable": opened,
        "bookmark": window.view_page.bookmarks.marks.can_keep,
        "bookmark-next": lambda: bool(window.editor.scene.bookmarks),
        "exposure": volume,
        "undo": lambda: bool(window.editor.document.undo_label),
        "redo": lambda: bool(window.editor.document.redo_label),
    }


def _can_be_clicked(window: MainWindow, rig: str) -> bool:
    return window.editor.scene.volume is not None and window.light_page.rig_buttons[rig].isEnabled()


def _light_by(window: MainWindow, technique: str) -> None:
    if window.editor.scene.technique_id != technique:
        window.editor.change("Choose the technique", technique=technique)


def _other_theme() -> str:
    return next(name for name in THEMES if name != current_theme().name)


def _escape(window: MainWindow) -> None:
    """End what lies over the picture, else the tool."""
    if not window.compare.end():
        window.strip.choose("orbit")
