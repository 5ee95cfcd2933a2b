"""What a user does with the window: real mouse and key events, waiting, looking."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from qtpy.QtCore import QEvent, QPoint, QPointF, Qt
from qtpy.QtGui import QColor, QImage, QMouseEvent, QPainter
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication, QWidget

from sfumato import SfumatoError
from sfumato_ui.theme import THEMES, current_theme
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
SHIFT = Qt.KeyboardModifier.ShiftModifier
CTRL = Qt.KeyboardModifier.ControlModifier
NONE = Qt.KeyboardModifier.NoModifier
#: Longest wait in seconds for anything.
PATIENCE = 240.0


def pause(milliseconds: int) -> None:
    """Go on with events for a while; unlike QTest's own, other threads may go on, too."""
    until = time.monotonic() + milliseconds / 1000
    while time.monotonic() < until:
        QApplication.processEvents()
        time.sleep(0.002)


class Hand:
    """The user of one window.

    Parameters
    ----------
    window : MainWindow
        The window, shown.
    folder : Path
        Where its screenshots go.
    settle : float
        Longest wait in seconds for a finished picture; then the coarse one is enough.
    """

    def __init__(self, window: MainWindow, folder: Path, settle: float = PATIENCE) -> None:
        self.window, self.folder, self.settle = window, folder, settle

    # -- waiting ----------------------------------------------------------------------------------
    def wait_until(self, there: Callable[[], bool], what: str) -> None:
        """Go on with events until something holds.

        Raises
        ------
        SfumatoError
            If it does not come about in `PATIENCE` seconds.
        """
        until = time.monotonic() + PATIENCE
        while not there():
            if time.monotonic() > until:
                raise SfumatoError(f"the window: no {what} in {PATIENCE:.0f} s")
            pause(20)

    def rest(self) -> None:
        """Wait until the picture of the scene is finished, and those of rigs and presets if they are seen."""
        until = time.monotonic() + self.settle
        self.wait_until(
            lambda: self._shown() and (self._settled() or time.monotonic() > until), "picture of the scene"
        )
        pause(600)  # the rigs' pictures are wanted when the scene is still
        if self._settled():
            self.wait_until(lambda: self.window.thumbnails.idle, "pictures of rigs and presets")
        page = self.window.light_page
        if page.rigs.isVisible() and page.rigs.isEnabled():
            buttons = page.rigs.buttons.values()
            self.wait_until(lambda: all(not b.image.isNull() for b in buttons), "pictures of the rigs")
        gallery = self.window.material_page.presets
        if gallery.isVisible():
            self.wait_until(lambda: len(gallery.pictures) == gallery.count(), "pictures of the presets")

    def _shown(self) -> bool:
        picture = self.window.viewport.picture
        return (
            picture is not None
            and picture.scene == self.window.driver.shown_scene
            and picture.size == self.window.viewport.pixel_size
            and (picture.audit is not None) == self.window.light_page.audit.on.isChecked()
        )

    def _settled(self) -> bool:
        picture = self.window.viewport.picture
        return picture is not None and picture.settled

    # -- acting -----------------------------------------------------------------------------------
    def click(self, widget: QWidget, at: QPoint | None = None, keys: Qt.KeyboardModifier = NONE) -> None:
        """Click in the middle of a widget, or at a place in it."""
        QTest.mouseClick(widget, LEFT, keys, at if at is not None else widget.rect().center())

    def press(self, key: Qt.Key, keys: Qt.KeyboardModifier = NONE) -> None:
        """Press and release a key on what has the focus."""
        if not self.window.isActiveWindow():  # without a window manager, it stays so after a dialog
            self.window.activateWindow()
            self.wait_until(self.window.isActiveWindow, "active window")
        QTest.keyClick(QApplication.focusWidget() or self.window, key, keys)

    def drag(
        self,
        widget: QWidget,
        start: QPointF,
        end: QPointF,
        keys: Qt.KeyboardModifier = NONE,
        let_go: bool = True,
    ) -> None:
        """Press at one place, move to another, release there unless the hand is to stay down."""
        QTest.mousePress(widget, LEFT, keys, start.toPoint())
        for i in range(1, 9):
            at = start + (end - start) * (i / 8)
            event = QMouseEvent(
                QEvent.Type.MouseMove,
                at,
                QPointF(widget.mapToGlobal(at)),
                Qt.MouseButton.NoButton,
                LEFT,
                keys,
            )
            QApplication.sendEvent(widget, event)
            pause(15)
        if let_go:
            self.release(widget, end, keys)

    def release(self, widget: QWidget, at: QPointF, keys: Qt.KeyboardModifier = NONE) -> None:
        """Release the mouse."""
        QTest.mouseRelease(widget, LEFT, keys, at.toPoint())

    def choose_tab(self, index: int) -> None:
        """Click a panel's tab."""
        bar = self.window.panel.tabBar()
        self.click(bar, bar.tabRect(index).center())
        pause(100)

    # -- looking ----------------------------------------------------------------------------------
    def look(self, name: str, title: str) -> None:
        """Save what is on the screen, in both themes."""
        first = current_theme().name
        for theme in (first, *(other for other in THEMES if other != first)):
            if theme != current_theme().name:
                self.window.set_theme(theme)
            pause(60)
            path = self.folder / f"{name}-{theme}.png"
            if not self.seen().save(str(path)):
                raise SfumatoError(f"{path}: the screenshot could not be written")
        if current_theme().name != first:
            self.window.set_theme(first)
        picture = self.window.viewport.picture
        coarse = "" if picture is None or picture.settled else " (the picture is coarse)"
        print(f"{name}: {title}{coarse}", flush=True)

    def seen(self) -> QImage:
        """Return the window with its dialogs and menus on it."""
        image = self.window.grab().toImage()
        corner = self.window.mapToGlobal(QPoint())
        painter = QPainter(image)
        for top in QApplication.topLevelWidgets():
            if top is self.window or not top.isVisible():
                continue
            place = top.mapToGlobal(QPoint()) - corner
            painter.drawPixmap(place, top.grab())
            painter.setPen(QColor(current_theme().border))
            painter.drawRect(top.rect().translated(place).adjusted(-1, -1, 0, 0))
        painter.end()
        return image
