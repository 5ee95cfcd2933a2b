"""What outlives the window: recent files, its state, unsaved work after a crash."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QIcon
from qtpy.QtWidgets import QApplication, QFileDialog, QPushButton, QWidget

from sfumato import Scene
from sfumato_ui import autosave
from sfumato_ui.recent import MAX_RECENT, recent_files, remember
from sfumato_ui.recent_pictures import file_of
from sfumato_ui.recovery import abandoned
from sfumato_ui.settings import data_dir
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton

#: A program that opens a volume, moves the light and then hangs until it is killed.
VICTIM = """
import sys
from qtpy.QtCore import QTimer
from sfumato_ui import autosave
from sfumato_ui.app import make_application
from sfumato_ui.window import MainWindow
autosave.AUTOSAVE_MS = 50
app = make_application()
window = MainWindow()
window.show()
window.open(sys.argv[1])
window.files.opened.connect(lambda: window.editor.change_light("Move the light", tilt=float(sys.argv[2])))
def look():
    slot = window.autosave._slot
    if slot is not None and slot.scene_file.exists():
        print("written", flush=True)
timer = QTimer()
timer.timeout.connect(look)
timer.start(50)
app.exec()
"""


@pytest.fixture
def volume_file(tmp_path: Path, ball_scene: Scene) -> Path:
    """A ball on the disk, in a folder of its own."""
    path = tmp_path / "data" / "ball.npy"
    path.parent.mkdir()
    assert ball_scene.volume is not None
    np.save(path, ball_scene.volume.data)
    return path


@pytest.fixture
def quick_autosave(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(autosave, "AUTOSAVE_MS", 50)


Start = Callable[..., list[subprocess.Popen[str]]]


@pytest.fixture
def start_victims(volume_file: Path) -> Iterator[Start]:
    """Return a starter of programs with unsaved work, one for each tilt."""
    started: list[subprocess.Popen[str]] = []

    def start(*tilts: float) -> list[subprocess.Popen[str]]:
        for tilt in tilts:
            command = [sys.executable, "-c", VICTIM, str(volume_file), str(tilt)]
            started.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        for program in started:
            assert program.stdout is not None
            assert program.stdout.readline() == "written\n"
        return started

    yield start
    for program in started:
        program.kill()
        program.wait()
        assert program.stdout is not None
        program.stdout.close()


def kill(*programs: subprocess.Popen[str]) -> None:
    """End programs as a crash does."""
    for program in programs:
        os.kill(program.pid, signal.SIGKILL)
        program.wait()


def click(window: MainWindow, qtbot: QtBot, text: str) -> None:
    """Click a button of the message bar."""
    button = next(b for b in window.messages.findChildren(QPushButton) if b.text() == text and b.isVisible())
    qtbot.mouseClick(button, LEFT)


def open_in(window: MainWindow, qtbot: QtBot, path: Path) -> None:
    """Open a path and wait for it."""
    with qtbot.waitSignal(window.files.opened, timeout=20_000):
        window.open(str(path))


def autosaved() -> list[Path]:
    """Return the autosaved scenes on the disk."""
    return sorted((data_dir() / "autosave").glob("*.sfumato"))


# -- after a crash ---------------------------------------------------------------------------------
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs a signal that cannot be caught")
def test_work_is_recovered_after_a_crash(make_window: Any, start_victims: Start, qtbot: QtBot) -> None:
    kill(*start_victims(51.0))
    window = make_window()
    qtbot.waitUntil(lambda: window.messages.kind == "question")
    assert window.messages.text.startswith("Unsaved work on “ball.npy” from ")
    click(window, qtbot, "Recover")
    assert window.focusWidget() is window.viewport, "not what comes next to the button"
    qtbot.waitUntil(lambda: window.editor.scene.volume is not None, timeout=20_000)
    assert window.editor.scene.lights[0].tilt == 51
    assert window.isWindowModified(), "recovered work is still not saved"
    assert window.messages.kind in ("", "notice")
    assert len(autosaved()) == 1, "what was recovered is kept until it is saved"
    window.editor.document.mark_saved()
    window.close()
    assert autosaved() == []


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs a signal that cannot be caught")
@pytest.mark.slow
def test_several_crashes_are_offered_one_by_one_and_discarding_removes(
    make_window: Any, start_victims: Start, qtbot: QtBot
) -> None:
    kill(*start_victims(41.0, 42.0))
    window = make_window()
    qtbot.waitUntil(lambda: window.messages.kind == "question")
    click(window, qtbot, "Discard")
    assert window.messages.kind == "question"
    assert len(autosaved()) == 1
    click(window, qtbot, "Discard")
    assert not window.messages.isVisible()
    assert autosaved() == []
    assert window.editor.scene.volume is None


@pytest.mark.slow
def test_a_window_leaves_the_work_of_a_living_one_alone(
    make_window: Any, start_victims: Start, qtbot: QtBot
) -> None:
    start_victims(43.0)
    window = make_window()
    qtbot.wait(100)
    assert not window.messages.isVisible()
    window.close()
    assert len(autosaved()) == 1


def test_a_question_gives_way_and_comes_back(make_window: Any, qtbot: QtBot) -> None:
    window = make_window()
    answers: list[str] = []
    window.messages.ask("Recover?", {"Recover": lambda: answers.append("yes")})
    window.messages.show_progress("Opening…", 0.5)
    assert window.messages.text == "Opening…"
    window.messages.clear("progress")
    assert window.messages.text == "Recover?"
    qtbot.waitUntil(window.isActiveWindow)
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    for _ in range(80):
        focus = QApplication.focusWidget()
        if isinstance(focus, QPushButton) and focus.text() == "Recover":
            break
        qtbot.keyClick(focus, Qt.Key.Key_Tab)
    qtbot.keyClick(QApplication.focusWidget(), Qt.Key.Key_Space)
    assert answers == ["yes"]
    assert not window.messages.isVisible()


# -- autosave --------------------------------------------------------------------------------------
def test_autosave_follows_the_work(
    make_window: Any, hand_of: Any, qtbot: QtBot, volume_file: Path, quick_autosave: None
) -> None:
    window = make_window()
    open_in(window, qtbot, volume_file)
    window.editor.change_light("Move the light", tilt=50.0)
    qtbot.waitUntil(lambda: len(autosaved()) == 1)
    assert Scene.open(autosaved()[0]) == window.editor.scene
    window.editor.change_light("Move the light", tilt=60.0)
    qtbot.waitUntil(lambda: Scene.open(autosaved()[0]).lights[0].tilt == 60)
    window.editor.undo()
    window.editor.undo()
    assert autosaved() == [], "nothing is unsaved any more"
    window.editor.change_light("Move the light", tilt=55.0)
    qtbot.waitUntil(lambda: len(autosaved()) == 1)
    assert window.files.save_scene_as(str(volume_file.with_name("kept.sfumato")))
    assert autosaved() == []


def test_two_windows_keep_their_work_apart(
    make_window: Any, qtbot: QtBot, volume_file: Path, quick_autosave: None
) -> None:
    windows = [make_window(), make_window()]
    for i, window in enumerate(windows):
        open_in(window, qtbot, volume_file)
        window.editor.change_light("Move the light", tilt=30.0 + i)
    qtbot.waitUntil(lambda: len(autosaved()) == 2)
    assert {Scene.open(path).lights[0].tilt for path in autosaved()} == {30, 31}
    assert abandoned() == []
    windows[0].editor.document.mark_saved()
    windows[0].close()
    assert [Scene.open(path).lights[0].tilt for path in autosaved()] == [31]


def test_an_autosave_that_fails_is_told_once_and_work_goes_on(
    make_window: Any, qtbot: QtBot, volume_file: Path, quick_autosave: None
) -> None:
    window = make_window()
    open_in(window, qtbot, volume_file)
    (data_dir() / "autosave").rmdir()
    (data_dir() / "autosave").write_text("in the way")
    window.editor.change_light("Move the light", tilt=50.0)
    qtbot.waitUntil(lambda: "could not be autosaved" in window.messages.text)
    window.messages.clear()
    window.editor.change_light("Move the light", tilt=51.0)
    qtbot.wait(300)
    assert not window.messages.isVisible()


def test_damage_in_the_autosave_folder_is_harmless(make_window: Any, qtbot: QtBot) -> None:
    (data_dir() / "autosave").mkdir()
    bad = data_dir() / "autosave" / "bad.sfumato"
    bad.write_text("{")
    bad.with_suffix(".json").write_text(json.dumps([1]))
    window = make_window()
    qtbot.waitUntil(lambda: window.messages.kind == "question")
    click(window, qtbot, "Recover")
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=10_000)
    assert "not a scene file" in window.messages.text


# -- recent files and the window's state -----------------------------------------------------------
def test_recent_files_are_listed_marked_and_cleared(
    make_window: Any, qtbot: QtBot, tmp_path: Path, volume_file: Path
) -> None:
    for i in range(MAX_RECENT + 3):
        remember(str(tmp_path / f"gone-{i}.nii"))
    window = make_window()
    open_in(window, qtbot, volume_file)
    assert recent_files()[0] == str(volume_file)
    assert len(recent_files()) == MAX_RECENT
    menu = window.top.recent
    menu.aboutToShow.emit()
    qtbot.waitUntil(lambda: any("(missing)" in a.text() for a in menu.actions()))
    there, gone = menu.actions()[:2]
    assert there.text().startswith("ball.npy")
    assert there.isEnabled()
    assert gone.text().startswith("gone-12.nii")
    assert not gone.isEnabled()
    with qtbot.waitSignal(window.files.opened, timeout=20_000):
        there.trigger()
    # What is open is in the list as it looks, once it has come to rest.
    assert _is_plain(menu.actions()[0].icon())
    qtbot.waitUntil(file_of(str(volume_file)).exists, timeout=30_000)
    menu.aboutToShow.emit()
    assert not _is_plain(menu.actions()[0].icon())
    assert _is_plain(menu.actions()[1].icon())
    next(a for a in menu.actions() if a.text() == "Clear the list").trigger()
    assert recent_files() == []


def _is_plain(icon: QIcon) -> bool:
    """Tell whether an icon has but one colour."""
    image = icon.pixmap(40).toImage()
    return len({image.pixel(x, y) for x in range(0, 40, 4) for y in range(0, 40, 4)}) == 1


def test_dialogs_start_in_the_last_folder(
    make_window: Any, hand_of: Any, qtbot: QtBot, volume_file: Path
) -> None:
    app = QApplication.instance()
    assert app is not None
    app.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs, True)
    window = make_window()
    open_in(window, qtbot, volume_file)
    hand = hand_of(window)
    window.viewport.setFocus()
    for key, *more in (("O",), ("S", Qt.KeyboardModifier.ShiftModifier)):
        hand.press(getattr(Qt.Key, f"Key_{key}"), Qt.KeyboardModifier.ControlModifier, *more)
        qtbot.waitUntil(lambda: any(d.isVisible() for d in window.findChildren(QFileDialog)))
        dialog = next(d for d in window.findChildren(QFileDialog) if d.isVisible())
        assert Path(dialog.directory().path()) == volume_file.parent
        dialog.reject()
        qtbot.waitUntil(lambda: not any(d.isVisible() for d in window.findChildren(QFileDialog)))
    app.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs, False)


def test_tab_sections_and_size_persist(make_window: Any, qtbot: QtBot, ball_scene: Scene) -> None:
    first = make_window(ball_scene, size=(900, 640))
    bar = first.panel.tabBar()
    qtbot.mouseClick(bar, LEFT, pos=bar.tabRect(2).center())
    qtbot.mouseClick(first.view_page.more.header, LEFT)
    assert first.view_page.more.header.isChecked()
    first.close()
    second = MainWindow()
    assert second.panel.currentIndex() == 2
    assert second.view_page.more.header.isChecked()
    assert (second.width(), second.height()) == (900, 640)
    second.worker.ask_to_stop()
    second.close()
    second.deleteLater()


def test_tab_goes_round_the_whole_window(make_window: Any, qtbot: QtBot) -> None:
    window = make_window()
    qtbot.waitUntil(window.isActiveWindow)
    window.viewport.setFocus()
    qtbot.waitUntil(window.viewport.hasFocus)
    seen: list[QWidget] = []
    while (focus := QApplication.focusWidget()) not in seen:
        seen.append(focus)
        qtbot.keyClick(focus, Qt.Key.Key_Tab)
    assert focus is window.viewport, "back where it began"
    assert {window.top.open, window.strip.fit, window.panel.tabBar()} <= set(seen)
