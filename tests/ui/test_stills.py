"""What was drawn to the end a moment ago, and is wanted again, is there at once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QImage

from sfumato import Scene, Volume
from sfumato.techniques.frame import FULL
from sfumato_ui.jobs import Picture, ViewRequest
from sfumato_ui.stills import MOST, Stills
from sfumato_ui.window import MainWindow


def settle(window: MainWindow, qtbot: QtBot) -> np.ndarray:
    """Wait until the present scene's picture is finished, and return it as the screen has it."""

    def finished() -> bool:
        picture = window.viewport.picture
        return bool(picture.settled and picture.scene == window.driver.shown_scene)

    qtbot.waitUntil(finished, timeout=90_000)
    image = window.viewport.picture.image.convertToFormat(QImage.Format.Format_RGB32)
    return np.frombuffer(image.constBits(), np.uint8).copy()


def test_before_and_after_undo_and_redo_draw_nothing_anew(
    window: MainWindow, hand: Any, qtbot: QtBot, count: Any
) -> None:
    lit = settle(window, qtbot)
    frames = window.viewport.picture.frames
    window.viewport.setFocus()
    qtbot.keyPress(window.viewport, Qt.Key.Key_B)
    unlit = settle(window, qtbot)
    count.frames = 0
    qtbot.keyRelease(window.viewport, Qt.Key.Key_B)
    assert np.array_equal(settle(window, qtbot), lit)
    qtbot.keyPress(window.viewport, Qt.Key.Key_B)
    assert np.array_equal(settle(window, qtbot), unlit)
    qtbot.keyRelease(window.viewport, Qt.Key.Key_B)
    settle(window, qtbot)
    assert count.frames == 0
    window.editor.change_light("Move the light", tilt=20.0)
    moved = settle(window, qtbot)
    count.frames = 0
    hand.press(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert np.array_equal(settle(window, qtbot), lit)
    hand.press(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier)
    assert np.array_equal(settle(window, qtbot), moved)
    assert count.frames == 0
    window.editor.undo()
    settle(window, qtbot)
    window.editor.change("Brighter", exposure=1.0)

    def begun() -> bool:
        picture = window.viewport.picture
        return bool(picture.scene.exposure == 1.0 and not picture.interactive)

    qtbot.waitUntil(begun, timeout=90_000)
    window.editor.undo()  # amid the frames of the same light, fewer than there were
    assert np.array_equal(settle(window, qtbot), lit)
    assert window.viewport.picture.frames == frames


# -- how many, and for how long ---------------------------------------------------------------------
def still(scene: Scene, width: int = 4, **changes: Any) -> tuple[ViewRequest, Picture]:
    """Return a request and its finished picture."""
    size = (width, width)
    image = QImage(*size, QImage.Format.Format_ARGB32_Premultiplied)
    given: dict[str, Any] = {"interactive": False, "frames": 1, "wanted": 1} | changes
    return ViewRequest(scene, size, False), Picture(image, scene, size, 0.1, **given)


@pytest.fixture
def scenes() -> list[Scene]:
    volume = Volume(np.zeros((4, 4, 4), np.uint8))
    return [Scene(volume=volume, exposure=0.1 * i) for i in range(MOST + 2)]


def test_those_not_seen_for_longest_go_first(scenes: list[Scene]) -> None:
    stills, asked = Stills(), [still(scene) for scene in scenes]
    for request, picture in asked[:MOST]:
        stills.keep(request, FULL, picture)
    assert stills.find(asked[0][0], FULL) is not None
    stills.keep(asked[MOST][0], FULL, asked[MOST][1])
    assert stills.find(asked[1][0], FULL) is None
    assert stills.find(asked[0][0], FULL) is not None


def test_bookmarks_change_no_picture_and_size_does(scenes: list[Scene]) -> None:
    stills, (request, picture) = Stills(), still(scenes[0])
    stills.keep(request, FULL, picture)
    equal = scenes[0].with_(frames=scenes[0].frames)
    found = stills.find(ViewRequest(equal, (4, 4), True), FULL)
    assert found is not None
    assert found.scene is equal
    assert found.interactive
    assert stills.find(ViewRequest(scenes[0], (5, 4), False), FULL) is None
    assert stills.find(ViewRequest(scenes[0], (4, 4), False, audit=0.25), FULL) is None


def test_unfinished_pictures_and_other_volumes_are_not_kept(scenes: list[Scene]) -> None:
    stills = Stills()
    for changes in ({"interactive": True}, {"wanted": 2}, {"light": 0.5}):
        request, picture = still(scenes[0], **changes)
        stills.keep(request, FULL, picture)
        assert stills.find(request, FULL) is None
    request, picture = still(scenes[0])
    stills.keep(request, FULL, picture)
    other = Scene(volume=Volume(np.zeros((4, 4, 4), np.uint8)))
    assert stills.find(ViewRequest(other, (4, 4), False), FULL) is None
    assert stills.find(request, FULL) is None, "its volume is not held any longer"
