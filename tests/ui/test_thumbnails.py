"""Thumbnails: drawn when the picture is finished, given up for a drag, taken up again, never twice."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint
from qtpy.QtGui import QImage

from sfumato import Scene
from sfumato_ui import worker
from sfumato_ui.jobs import STILL_FRAMES
from sfumato_ui.window import MainWindow

SIZE = (48, 36)


class Album:
    """Keeps what `Thumbnails` tells."""

    def __init__(self, window: MainWindow) -> None:
        self.pictures: dict[Any, QImage] = {}
        self.told: list[tuple[str, Any]] = []
        window.thumbnails.ready.connect(self._keep)

    def _keep(self, group: str, key: Any, image: QImage) -> None:
        # The panels want theirs, too.
        if group not in ("test", "other"):
            return
        self.pictures[group, key] = image
        self.told.append((group, key))


@pytest.fixture
def album(window: MainWindow) -> Album:
    return Album(window)


def tilted(scene: Scene, *tilts: float) -> dict[Any, Scene]:
    return {tilt: scene.with_(**{"lights.0.tilt": tilt}) for tilt in tilts}


def brightness(image: QImage) -> np.ndarray:
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat.astype(float)


def test_they_show_their_scenes(window: MainWindow, album: Album, qtbot: QtBot) -> None:
    window.thumbnails.want("test", tilted(window.editor.scene, 0.0, 50.0), SIZE)
    qtbot.waitUntil(lambda: len(album.pictures) == 2, timeout=60_000)
    first, second = album.pictures["test", 0.0], album.pictures["test", 50.0]
    assert (first.width(), first.height()) == SIZE
    assert np.abs(brightness(first) - brightness(second)).mean() > 1


def test_a_hand_that_moves_waits_for_none(window: MainWindow, album: Album, hand: Any, qtbot: QtBot) -> None:
    moving: list[bool] = []
    window.thumbnails.ready.connect(lambda *_: moving.append(window.viewport.picture.interactive))
    window.thumbnails.want("test", tilted(window.editor.scene, 10.0), SIZE)
    middle = window.viewport.rect().center()
    hand.drag(window.viewport, middle, middle + QPoint(60, 20), steps=20)
    qtbot.waitUntil(lambda: bool(album.told), timeout=90_000)
    assert not any(moving)


def test_between_the_frames_of_a_picture_at_rest(
    window: MainWindow, album: Album, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "IDLE_SECONDS", 0.0)
    frames: list[int] = []
    window.worker.thumbnail.connect(lambda *_: frames.append(window.viewport.picture.frames))
    window.driver.set_frames(STILL_FRAMES + 4)
    window.editor.change_light("Move the light", tilt=20.0)
    window.thumbnails.want("test", tilted(window.editor.scene, 10.0), SIZE)
    qtbot.waitUntil(lambda: bool(album.told), timeout=90_000)
    assert frames[0] < STILL_FRAMES + 4
    qtbot.waitUntil(lambda: window.viewport.picture.frames == STILL_FRAMES + 4, timeout=90_000)


def test_an_urgent_one_waits_for_a_frame_alone(
    window: MainWindow, album: Album, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An exposure, for one: the picture is not to be finished and then drawn anew."""
    monkeypatch.setattr(worker, "IDLE_SECONDS", 3600.0)
    told: list[int] = []
    window.worker.thumbnail.connect(
        lambda request, _: told.append(window.viewport.picture.frames) if request.group == "test" else None
    )
    window.driver.set_frames(STILL_FRAMES + 4)
    window.editor.change_light("Move the light", tilt=20.0)
    window.thumbnails.want("test", tilted(window.editor.scene, 10.0), SIZE, first=True)
    qtbot.waitUntil(lambda: bool(told), timeout=90_000)
    assert told[0] <= 2


def test_a_new_wish_replaces_the_old_one(window: MainWindow, album: Album, qtbot: QtBot) -> None:
    window.thumbnails.want("test", tilted(window.editor.scene, 10.0, 20.0), SIZE)
    window.thumbnails.want("other", tilted(window.editor.scene, 5.0), SIZE)
    window.thumbnails.want("test", tilted(window.editor.scene, 30.0), SIZE)
    qtbot.waitUntil(lambda: len(album.pictures) == 2, timeout=60_000)
    qtbot.wait(100)
    assert set(album.pictures) == {("test", 30.0), ("other", 5.0)}


def test_what_is_there_is_told_at_once(window: MainWindow, album: Album, qtbot: QtBot) -> None:
    scenes = tilted(window.editor.scene, 10.0)
    window.thumbnails.want("test", scenes, SIZE)
    qtbot.waitUntil(lambda: bool(album.told), timeout=60_000)
    window.thumbnails.want("test", scenes, SIZE)
    assert len(album.told) == 2


def test_forgotten_wishes_are_not_drawn(window: MainWindow, album: Album, qtbot: QtBot) -> None:
    window.thumbnails.want("test", tilted(window.editor.scene, *range(8)), (400, 300))
    window.thumbnails.forget("test")
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=90_000)
    qtbot.wait(200)
    assert not album.told


@pytest.mark.measured
def test_a_drag_does_not_wait_for_them(window: MainWindow, album: Album, hand: Any, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=90_000)
    window.thumbnails.want("test", tilted(window.editor.scene, *range(6)), (900, 900))
    qtbot.wait(60)
    interactive: list[float] = []
    window.worker.picture.connect(lambda picture: interactive.append(time.perf_counter()))
    started = time.perf_counter()
    window.editor.change_light("Move the light", tilt=20.0)
    qtbot.waitUntil(lambda: bool(interactive), timeout=30_000)
    assert interactive[0] - started < 2, "a piece of a thumbnail, then the drag's picture"
    window.thumbnails.forget("test")
