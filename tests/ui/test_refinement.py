"""What tells how light becomes a picture draws no frame anew; what light depends on does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint

import sfumato
from sfumato_ui.jobs import STILL_FRAMES, Picture
from sfumato_ui.window import MainWindow


@pytest.mark.normal_quality
def test_the_frames_that_are_there_are_shown_in_another_way_and_added_to(
    window: MainWindow, hand: Any, qtbot: QtBot, count: Any
) -> None:
    pictures: list[Picture] = []
    window.worker.picture.connect(pictures.append)
    tones: tuple[dict[str, Any], ...] = (
        {"exposure": 1.5},
        {"tone_curve": "soft"},
        {"white_balance": 4000.0},
        {"background": (0.2, 0.1, 0.4, 1.0)},
    )
    for changes in tones:
        before = hand.pixels()
        window.editor.change("Tone", **changes)
        hand.wait_for_picture()
        assert np.abs(hand.pixels() - before).mean() > 0.5, changes
    assert count.frames == 0
    assert min(picture.seconds for picture in pictures) > 0.01, "exports are judged by what a frame takes"
    assert {picture.frames for picture in pictures} == {STILL_FRAMES}, "no coarse picture in between"
    width, height = window.viewport.pixel_size
    anew = sfumato.render(window.editor.scene.with_(frames=STILL_FRAMES), (width, height)).astype(int)
    shown = hand.pixels()[..., 2::-1]  # blue comes first
    assert np.abs(shown - anew[..., :3]).max() <= 1
    count.frames = 0
    window.driver.set_frames(STILL_FRAMES + 2)
    qtbot.waitUntil(lambda: window.viewport.picture.frames == STILL_FRAMES + 2, timeout=90_000)
    assert count.frames == 2
    window.editor.change_light("Move the light", tilt=20.0)
    hand.wait_for_picture()
    assert count.frames > 2, "what light depends on is drawn anew"


@pytest.mark.slow
@pytest.mark.normal_quality
def test_an_exposure_amid_the_refinement_keeps_its_frames(
    window: MainWindow, qtbot: QtBot, count: Any
) -> None:
    window.driver.set_frames(STILL_FRAMES + 8)
    qtbot.waitUntil(lambda: window.viewport.picture.frames > STILL_FRAMES + 1, timeout=90_000)
    frames: list[int] = []
    window.worker.picture.connect(lambda picture: frames.append(picture.frames))
    window.editor.change("Brighter", exposure=1.0)
    qtbot.waitUntil(lambda: window.viewport.picture.frames == STILL_FRAMES + 8, timeout=90_000)
    assert min(frames) > STILL_FRAMES
    assert window.viewport.picture.scene.exposure == 1.0


@pytest.mark.slow
@pytest.mark.normal_quality
def test_a_floor_of_shadows_moves_on_the_frames_that_are_there(
    window: MainWindow, hand: Any, qtbot: QtBot, count: Any
) -> None:
    window.editor.change("Floor", shadow_floor=0.2)
    qtbot.waitUntil(lambda: window.viewport.picture.settled and count.frames > 0, timeout=90_000)
    hand.wait_for_picture()
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=90_000)
    dark, drawn = hand.pixels(), count.frames
    window.editor.change("Floor", shadow_floor=0.7)
    hand.wait_for_picture()
    assert count.frames == drawn
    assert (hand.pixels()[..., :3].sum() - dark[..., :3].sum()) > 0
    middle = window.viewport.rect().center()
    hand.drag(window.viewport, middle, middle + QPoint(30, 0))
    hand.wait_for_picture()
    assert count.frames > drawn
