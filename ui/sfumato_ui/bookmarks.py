"""Cameras kept under names, saved with the scene: a button with a menu, and the line in which a name is asked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from qtpy.QtGui import QAction
from qtpy.QtWidgets import QMenu, QPushButton

from sfumato import Scene
from sfumato.scene import Bookmark
from sfumato.scene.camera import MAX_NAME
from sfumato.scene.scene import MAX_BOOKMARKS

from .bindings import explain
from .editing import Editor
from .preset_bar import AskLine

KEEP = "Keep this view"


class Bookmarks:
    """What is done with the cameras that a scene keeps."""

    def __init__(self, editor: Editor) -> None:
        self._editor = editor

    @property
    def kept(self) -> tuple[Bookmark, ...]:
        """The bookmarks of the scene."""
        return self._editor.scene.bookmarks

    def current(self) -> int | None:
        """Return the number of the bookmark at which the camera stands; None if there is none."""
        camera = self._editor.scene.camera
        return next((i for i, mark in enumerate(self.kept) if mark.camera == camera), None)

    def can_keep(self) -> bool:
        """Tell whether the present camera can be kept: there is one, it is not kept, and there is room."""
        there = self._editor.scene.camera is not None
        return there and self.current() is None and len(self.kept) < MAX_BOOKMARKS

    def keep(self) -> None:
        """Keep the present camera under the first free name."""
        camera = self._editor.scene.camera
        if camera is None or not self.can_keep():
            return
        names = {mark.name for mark in self.kept}
        name = next(f"View {k}" for k in range(1, MAX_BOOKMARKS + 2) if f"View {k}" not in names)
        self._editor.change(KEEP, bookmarks=(*self.kept, Bookmark(name, camera)))

    def go(self, index: int) -> None:
        """Look from where a bookmark was kept."""
        mark = self.kept[index]
        self._editor.change(f"View: {mark.name}", camera=mark.camera)

    def go_on(self) -> None:
        """Go to the bookmark after that at which the camera stands, or to the first."""
        if self.kept:
            here = self.current()
            self.go(0 if here is None else (here + 1) % len(self.kept))

    def rename(self, index: int, name: str) -> None:
        """Give a bookmark another name."""
        kept = list(self.kept)
        kept[index] = replace(kept[index], name=name)
        self._editor.change("Rename the view", bookmarks=tuple(kept))

    def remove(self, index: int) -> None:
        """Forget a bookmark."""
        kept = self.kept
        self._editor.change("Remove the kept view", bookmarks=kept[:index] + kept[index + 1 :])

    def complaint(self, name: str, index: int) -> str:
        """Return what is wrong with a name for a bookmark; empty if nothing is."""
        name = name.strip()
        if not name:
            return "A name is needed"
        if len(name) > MAX_NAME:
            return f"At most {MAX_NAME} characters"
        taken = any(mark.name == name and i != index for i, mark in enumerate(self.kept))
        return "This name is taken" if taken else ""


class BookmarkButton(QPushButton):
    """Opens the menu of kept views."""

    def __init__(self, editor: Editor) -> None:
        super().__init__("Kept views")
        self.marks = Bookmarks(editor)
        self.ask = AskLine("view")
        self._target = 0
        self.setProperty("menu", True)
        self.setAccessibleName("Kept views")
        self.setToolTip("Keep this view under a name, and come back to it; saved with the scene")
        menu = QMenu(self)
        menu.aboutToShow.connect(self.fill)
        self.setMenu(menu)
        self.ask.answered.connect(lambda name: self.marks.rename(self._target, name))
        editor.changed.connect(self._on_changed)
        self.fill()

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.bookmarks != new.bookmarks:
            self.ask.hide()

    def fill(self) -> None:
        """Offer what can be done now."""
        menu, here = self.menu(), self.marks.current()
        menu.clear()
        explain(self._add("", self.marks.keep, self.marks.can_keep()), KEEP, "bookmark")
        for index, mark in enumerate(self.marks.kept):
            if index == 0:
                menu.addSeparator()
            action = self._add(mark.name.replace("&", "&&"), lambda i=index: self.marks.go(i))  # type: ignore[misc]
            action.setCheckable(True)
            action.setChecked(index == here)
        if here is not None:
            menu.addSeparator()
            name = self.marks.kept[here].name.replace("&", "&&")
            self._add(f"Rename {name}…", lambda: self._ask_name(here))
            self._add(f"Remove {name}", lambda: self.marks.remove(here))

    def _add(self, text: str, act: Callable[[], None], enabled: bool = True) -> QAction:
        action = self.menu().addAction(text)
        action.triggered.connect(lambda _=False: act())
        action.setEnabled(enabled)
        return action

    def _ask_name(self, index: int) -> None:
        self._target = index
        self.ask.ask_name(
            "Rename", self.marks.kept[index].name, lambda text: self.marks.complaint(text, index)
        )


__all__ = ["BookmarkButton", "Bookmarks"]
