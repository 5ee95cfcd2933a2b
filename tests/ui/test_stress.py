"""A user who does anything: thousands of random actions by real mouse and key events, the same ones for a seed.

No exception (pytest-qt turns those in Qt's callbacks into failures), no message of a failure, no widget and no memory
piled up; and the history is whole: undo all is the start, redo all the end.
"""

from __future__ import annotations

import gc
import resource
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QCoreApplication, QEvent, QPoint, Qt, QTimer
from qtpy.QtTest import QTest
from qtpy.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QDialog,
    QMenu,
    QSlider,
    QWidget,
)

from sfumato import Scene
from sfumato.scene.document import MAX_STEPS
from sfumato_ui.bindings import commands, keys_of
from sfumato_ui.window import MainWindow

from .conftest import Hand, ball, solid
from .test_files import drop, write_series

LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
SHIFT, CTRL, ALT = (
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.AltModifier,
)
ARROWS = (Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Down)
OTHERS = (
    Qt.Key.Key_PageDown, Qt.Key.Key_PageUp, Qt.Key.Key_Plus, Qt.Key.Key_Minus, Qt.Key.Key_Tab, Qt.Key.Key_Backtab,
    Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Delete, Qt.Key.Key_Escape, Qt.Key.Key_B,
)  # fmt: skip
#: Seconds after which a dialog that nobody answers is given up by Esc.
PATIENCE = 0.15
#: What a technique refuses, and says so: no failure.
REFUSED = "the reference knows 1D functions alone"
#: Dialogs that the window has.
DIALOGS = {
    "ExportDialog", "KeyboardDialog", "CommandPalette", "RawDialog", "SeriesDialog", "QFileDialog", "QColorDialog"
}  # fmt: skip


class Anybody:
    """Does random things to a window."""

    def __init__(self, window: MainWindow, qtbot: QtBot, seed: int, files: list[Path]) -> None:
        self.files = files
        self.window, self.qtbot, self.rng = window, qtbot, np.random.default_rng(seed)
        self.hand = Hand(window, qtbot)
        self.done: set[str] = set()
        self.dialogs: set[str] = set()
        self.failures: list[str] = []
        self._seen: dict[QWidget, float] = {}
        window.worker.failed.connect(self._on_failed)
        for name, action in window.commands.actions.items():
            action.triggered.connect(lambda _=False, name=name: self.done.add(name))
        # Loops of events of their own (menus, the system's dialogs) do not keep us: somebody presses Esc.
        self._waiter = QTimer(window)
        self._waiter.timeout.connect(self._give_up_dialogs)
        self._waiter.start(40)
        self.acts: tuple[tuple[float, Callable[[], None]], ...] = (
            (0.26, self.command), (0.2, self.button), (0.14, self.drag_picture), (0.1, self.key),
            (0.1, self.slider), (0.06, self.number), (0.05, self.menu), (0.04, self.wheel), (0.05, self.undo),
            (0.01, self.drop),
        )  # fmt: skip

    def _on_failed(self, words: str, remedy: str) -> None:
        if REFUSED not in words:
            self.failures.append(words)

    def one_of(self, things: Any) -> Any:
        return things[int(self.rng.integers(len(things)))]

    def act(self) -> None:
        """Do something."""
        self._back_to_window()
        weights = np.array([weight for weight, _ in self.acts])
        self.acts[int(self.rng.choice(len(self.acts), p=weights / weights.sum()))][1]()
        QApplication.processEvents()

    def _back_to_window(self) -> None:
        until = time.monotonic() + 10
        while (_dialogs() or QApplication.activePopupWidget()) and time.monotonic() < until:
            self._give_up_dialogs()
            self.qtbot.wait(20)
        assert not _dialogs(), "a dialog does not close by Esc"
        if not self.window.isActiveWindow():
            self.window.activateWindow()
            self.qtbot.waitUntil(self.window.isActiveWindow)

    def _give_up_dialogs(self) -> None:
        now = time.monotonic()
        popup = QApplication.activePopupWidget()
        if isinstance(popup, QMenu):
            popup.close()
        open_now = _dialogs()
        self._seen = {dialog: self._seen.get(dialog, now) for dialog in open_now}
        for dialog, since in self._seen.items():
            self.dialogs |= {c.__name__ for c in type(dialog).__mro__}
            if now - since > PATIENCE:
                QTest.keyClick(dialog, Qt.Key.Key_Escape)

    # -- what may be done -------------------------------------------------------------------------
    def command(self) -> None:
        """Do a command by its key; one without, or whose key is another's here, by the palette."""
        name = self.one_of(self.window.commands.possible())
        keys = keys_of(name)
        if keys and self.rng.random() < 0.8:
            self.window.viewport.setFocus()
            self.qtbot.keySequence(self.window.viewport, keys[0])
            return
        self.window.viewport.setFocus()
        self.qtbot.keySequence(self.window.viewport, keys_of("palette")[0])
        palette = next((d for d in _dialogs() if type(d).__name__ == "CommandPalette"), None)
        if palette is not None:
            self.dialogs.add("CommandPalette")
            QTest.keyClicks(palette.search, commands()[name].title)
            QTest.keyClick(palette.search, Qt.Key.Key_Return)
            self.qtbot.wait(10)

    def button(self) -> None:
        """Click a button that can be seen."""
        found = self._shown(QAbstractButton)
        if found:
            button = self.one_of(found)
            self.qtbot.mouseClick(
                button, LEFT, NONE, QPoint(min(12, button.width() // 2), button.height() // 2)
            )

    def drag_picture(self) -> None:
        """Drag in the picture, with any keys."""
        picture = self.window.viewport
        start, end = (
            QPoint(*(int(v) for v in self.rng.integers((4, 4), (picture.width() - 4, picture.height() - 4))))
            for _ in range(2)
        )
        keys = self.one_of((NONE, NONE, SHIFT, CTRL, ALT))
        button = self.one_of((LEFT, LEFT, LEFT, Qt.MouseButton.RightButton, Qt.MouseButton.MiddleButton))
        if self.rng.random() < 0.1:
            self.qtbot.mouseDClick(picture, LEFT, NONE, start)
            return
        self.hand.drag(picture, start, end, steps=int(self.rng.integers(1, 4)), button=button, keys=keys)

    def key(self) -> None:
        """Press a key on what has the focus."""
        key = self.one_of(ARROWS if self.rng.random() < 0.6 else OTHERS)
        keys = self.one_of((NONE, NONE, SHIFT, CTRL)) if key in ARROWS else NONE
        QTest.keyClick(QApplication.focusWidget() or self.window, key, keys)

    def slider(self) -> None:
        """Drag a slider."""
        found = self._shown(QSlider)
        if found:
            slider = self.one_of(found)
            a, b = (
                QPoint(int(self.rng.integers(2, max(3, slider.width() - 2))), slider.height() // 2)
                for _ in range(2)
            )
            self.hand.drag(slider, a, b, steps=3)

    def number(self) -> None:
        """Type a number."""
        found = self._shown(QAbstractSpinBox)
        if found:
            box = self.one_of(found)
            box.setFocus()
            box.selectAll()
            QTest.keyClicks(box, str(self.one_of((0, 1, -1, 0.5, 20, 99999, "x", "7 K"))))
            QTest.keyClick(box, self.one_of((Qt.Key.Key_Return, Qt.Key.Key_Tab, Qt.Key.Key_Up)))

    def menu(self) -> None:
        """Choose in a menu by a key; the technique that takes minutes is passed over."""
        found = [box for box in self._shown(QComboBox) if box.count()]
        if found:
            box = self.one_of(found)
            box.setFocus()
            QTest.keyClick(box, self.one_of((Qt.Key.Key_Up, Qt.Key.Key_Down)))
            if self.window.editor.scene.technique_id == "reference":
                QTest.keyClick(box, Qt.Key.Key_Up)

    def wheel(self) -> None:
        """Turn the wheel over anything."""
        self.hand.wheel(self.one_of(self._shown(QWidget)), int(self.one_of((-1, 1))))

    def drop(self) -> None:
        """Drop a file about which the window asks, with nothing unsaved."""
        self.window.editor.document.mark_saved()
        drop(self.window, self.one_of(self.files))
        self.qtbot.wait(400)

    def undo(self) -> None:
        """Undo, redo, and again."""
        self.window.viewport.setFocus()
        for _ in range(int(self.rng.integers(1, 4))):
            keys = self.one_of((CTRL, CTRL | SHIFT))
            QTest.keyClick(self.window.viewport, Qt.Key.Key_Z, keys)

    def _shown(self, kind: type[QWidget]) -> list[Any]:
        """Return what can be seen and used, in an order that is the same each time."""
        return [
            w for w in self.window.findChildren(kind)
            if w.isVisible() and w.isEnabled() and not w.visibleRegion().isEmpty()
        ]  # fmt: skip


def _dialogs() -> list[QDialog]:
    return [w for w in QApplication.topLevelWidgets() if isinstance(w, QDialog) and w.isVisible()]


def _widgets() -> int:
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    gc.collect()
    return len(QApplication.allWidgets())


def _close_views(window: MainWindow, technique: Any) -> None:
    """Close the views beside the picture, and show a technique's controls: what is open in the end is chance."""
    window.editor.change("Choose the technique", technique=technique)
    for button in (window.strip.vtk, window.strip.slices):
        button.setChecked(False)
    window.drawer.open("")


def _check_history(window: MainWindow) -> None:
    """Undo all, redo all: the same states again, the start and the end among them."""
    document = window.editor.document
    steps, end = document.steps, document.scene
    for _ in range(MAX_STEPS + 5):
        document.redo()
    last = document.scene
    assert last == steps[-1].scene
    for _ in range(MAX_STEPS + 5):
        document.undo()
    assert document.scene == steps[0].scene
    assert not document.undo_label
    for _ in range(MAX_STEPS + 5):
        document.redo()
    assert document.scene == last
    document.go_to(next(i for i, step in enumerate(steps) if step.scene is end or step.scene == end))
    assert document.scene == end


@pytest.mark.normal_quality
@pytest.mark.parametrize(
    ("count", "seed"),
    [
        (150, 8),
        pytest.param(300, 8, marks=pytest.mark.slow),
        pytest.param(5000, 88, marks=[pytest.mark.slow, pytest.mark.timeout(3000)]),
    ],
)
def test_anything_may_be_done(make_window: Any, qtbot: QtBot, count: int, seed: int, tmp_path: Path) -> None:
    start = Scene(volume=ball(20), transfer=solid(), technique="raycast-phong")
    window: MainWindow = make_window(start, size=(620, 480))
    raw, study = tmp_path / "scan.raw", tmp_path / "study"
    raw.write_bytes(bytes(24 * 24 * 24))
    for name in ("scout", "thorax"):
        write_series(study, 6, name)
    user = Anybody(window, qtbot, seed, [raw, study])
    user.hand.wait_for_picture()
    widgets, memory, technique = 0, 0, start.technique
    for i in range(count):
        user.act()
        if i == count // 4:
            widgets, memory = _widgets(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            technique = window.editor.scene.technique
    user._back_to_window()
    assert not user.failures
    if window.editor.document.position < MAX_STEPS and count < MAX_STEPS:
        assert window.editor.document.steps[0].scene == start
    _check_history(window)
    _close_views(window, technique)
    assert _widgets() < widgets + 150, "widgets pile up"
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < 1.5 * memory + 200_000, "memory piles up"
    if count >= 5000:
        known = set(window.commands.actions)
        assert len(user.done & known) >= 0.95 * len(known), known - user.done
        assert user.dialogs >= DIALOGS
