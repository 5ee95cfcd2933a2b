"""The one door through which the window changes its document.

`Editor` wraps the Qt-free `Document` in signals, turns refused values into a message instead of an
exception, and keeps what belongs to the window alone: which lamp is selected.
"""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QObject, Signal

from sfumato import Document, Light, Scene, SceneError


class Editor(QObject):
    """Edits of a document, on the window's thread."""

    #: The scene became another one (old, new).
    changed = Signal(object, object)
    #: What can be undone or redone changed, though the scene may not have.
    history_changed = Signal()
    #: A value was refused; the reason in one line.
    rejected = Signal(str)
    #: Another lamp was selected (its index).
    light_selected = Signal(int)

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self._selected = 0
        self._unsubscribe = document.subscribe(self._on_changed)

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self.document.scene

    # -- edits ------------------------------------------------------------------------------------
    def change(self, label: str, merge: bool = False, /, **paths: Any) -> bool:
        """Change the scene by paths; returns whether the values were accepted."""
        try:
            self.document.change(label, merge=merge, **paths)
        except SceneError as error:
            self.rejected.emit(str(error))
            return False
        self.history_changed.emit()
        return True

    def change_light(self, label: str, merge: bool = False, /, **fields: Any) -> bool:
        """Change fields of the selected lamp."""
        if not self.scene.lights:
            return False
        prefix = f"lights.{self.selected}."
        return self.change(label, merge, **{prefix + name: value for name, value in fields.items()})

    def begin(self, label: str) -> None:
        """Start a drag: what follows until `end` is one step of the history."""
        self.document.begin_drag(label)

    def end(self) -> None:
        """End the drag, if one is open."""
        self.document.end_drag()
        self.history_changed.emit()

    def undo(self) -> None:
        """Go back one step."""
        self.document.undo()
        self.history_changed.emit()

    def redo(self) -> None:
        """Go forward one step."""
        self.document.redo()
        self.history_changed.emit()

    def go_to(self, index: int) -> None:
        """Return to a step of the history by its index."""
        self.document.go_to(index)
        self.history_changed.emit()

    def reset(self, scene: Scene) -> None:
        """Start anew with another scene."""
        self._selected = 0
        self.document.reset(scene)
        self.history_changed.emit()

    def close(self) -> None:
        """Stop listening to the document, which may outlive the window."""
        self._unsubscribe()

    # -- lamps ------------------------------------------------------------------------------------
    @property
    def selected(self) -> int:
        """Index of the selected lamp."""
        return max(0, min(self._selected, len(self.scene.lights) - 1))

    @property
    def light(self) -> Light | None:
        """The selected lamp."""
        return self.scene.lights[self.selected] if self.scene.lights else None

    def select_light(self, index: int) -> None:
        """Select a lamp by its index."""
        self._selected = index
        self.light_selected.emit(self.selected)

    def _on_changed(self, old: Scene, new: Scene) -> None:
        self.changed.emit(old, new)
