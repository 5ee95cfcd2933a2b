"""The document: the current scene and its history.

Undo is a list of references to older trees. One drag is one step (`Document.drag`), and edits of one
kind within a second (camera moves) are one step too.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from .scene import Scene

Listener = Callable[[Scene, Scene], None]

#: Seconds within which edits with the same label are one undo step.
MERGE_SECONDS = 1.0
MAX_STEPS = 500


@dataclass(frozen=True)
class Step:
    """A state of the history.

    Attributes
    ----------
    label : str
        What led to it, in words; empty for the state with which the history begins.
    scene : Scene
        The state itself.
    """

    label: str
    scene: Scene


class Document:
    """Holds the current scene, tells listeners of changes, and remembers every step.

    Not thread-safe: it lives on the thread of its window; scenes, being frozen, can be handed to any.
    """

    def __init__(self, scene: Scene, clock: Callable[[], float] = time.monotonic) -> None:
        self._scene = scene
        self._undo: list[tuple[Scene, str]] = []
        self._redo: list[tuple[Scene, str]] = []
        self._listeners: list[Listener] = []
        self._clock = clock
        self._last_edit = float("-inf")
        self._open_drag: tuple[Scene, str] | None = None
        self._saved: Scene | None = scene

    @property
    def scene(self) -> Scene:
        """The current scene."""
        return self._scene

    @property
    def modified(self) -> bool:
        """Whether the scene differs from the one last marked as saved."""
        return self._scene is not self._saved and self._scene != self._saved

    def mark_saved(self) -> None:
        """Remember the current scene as the saved one."""
        self._saved = self._scene

    def mark_unsaved(self) -> None:
        """Count the current scene as saved nowhere: it was recovered."""
        self._saved = None

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Call ``listener(old, new)`` on each change; returns a function that ends it."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener) if listener in self._listeners else None

    def edit(self, new: Scene, label: str, *, merge: bool = False) -> None:
        """Make a scene the current one, as a step of the history.

        Parameters
        ----------
        label : str
            What was done, in words ("Move the light").
        merge : bool
            Join the previous step if that has the same label and is less than a second old.
        """
        if new == self._scene:
            return
        old, now = self._scene, self._clock()
        if self._open_drag is None:
            fresh = now - self._last_edit < MERGE_SECONDS
            if not (merge and fresh and self._undo and self._undo[-1][1] == label):
                self._remember(old, label)
            self._redo.clear()
        self._last_edit = now
        self._become(new)

    def change(self, label: str, *, merge: bool = False, **paths: object) -> None:
        """Edit by paths, as in `Scene.with_`."""
        self.edit(self._scene.with_(paths), label, merge=merge)

    def reset(self, scene: Scene) -> None:
        """Start anew with a scene: another file was opened. The history is emptied."""
        self._undo.clear()
        self._redo.clear()
        self._open_drag = None
        self._saved = scene
        self._become(scene)

    @contextmanager
    def drag(self, label: str) -> Iterator[None]:
        """Make all edits within the block one step."""
        self.begin_drag(label)
        try:
            yield
        finally:
            self.end_drag()

    def begin_drag(self, label: str) -> None:
        """Start a drag: edits until `end_drag` are one step."""
        self.end_drag()
        self._open_drag = (self._scene, label)

    def end_drag(self) -> None:
        """End a drag, if one is open."""
        if self._open_drag is None:
            return
        start, label = self._open_drag
        self._open_drag = None
        self._last_edit = float("-inf")
        if start != self._scene:
            self._remember(start, label)
            self._redo.clear()

    @property
    def dragging(self) -> bool:
        """Whether a drag is open."""
        return self._open_drag is not None

    @property
    def undo_label(self) -> str:
        """What `undo` would take back, or nothing."""
        return self._undo[-1][1] if self._undo else ""

    @property
    def redo_label(self) -> str:
        """What `redo` would do again, or nothing."""
        return self._redo[-1][1] if self._redo else ""

    @property
    def steps(self) -> tuple[Step, ...]:
        """Every state that can be returned to, the oldest first; what a drag does is none before its end."""
        labels = ["", *(label for _, label in self._undo), *(label for _, label in reversed(self._redo))]
        now = self._open_drag[0] if self._open_drag is not None else self._scene
        scenes = [*(scene for scene, _ in self._undo), now, *(scene for scene, _ in reversed(self._redo))]
        return tuple(map(Step, labels, scenes))

    @property
    def position(self) -> int:
        """Index of the present state in `steps`."""
        return len(self._undo)

    def go_to(self, index: int) -> None:
        """Return to a state of `steps`, as by so many undos or redos, but told to listeners once.

        Raises
        ------
        IndexError
            If there is no such state.
        """
        self.end_drag()
        if not 0 <= index <= len(self._undo) + len(self._redo):
            raise IndexError(f"no step {index} in a history of {len(self._undo) + len(self._redo) + 1}")
        scene = self._scene
        while index != self.position:
            source, target = (self._undo, self._redo) if index < self.position else (self._redo, self._undo)
            before, label = source.pop()
            target.append((scene, label))
            scene = before
        if scene is not self._scene:
            self._last_edit = float("-inf")
            self._become(scene)

    def undo(self) -> None:
        """Go back one step, if there is one."""
        self.end_drag()
        self._travel(self._undo, self._redo)

    def redo(self) -> None:
        """Go forward one step, if there is one."""
        self.end_drag()
        self._travel(self._redo, self._undo)

    def _travel(self, source: list[tuple[Scene, str]], target: list[tuple[Scene, str]]) -> None:
        if source:
            scene, label = source.pop()
            target.append((self._scene, label))
            self._last_edit = float("-inf")
            self._become(scene)

    def _remember(self, scene: Scene, label: str) -> None:
        self._undo.append((scene, label))
        del self._undo[:-MAX_STEPS]

    def _become(self, new: Scene) -> None:
        old, self._scene = self._scene, new
        for listener in tuple(self._listeners):
            listener(old, new)
