"""The render thread and the window: nobody waits, nothing freezes, errors are messages."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, QTimer

from sfumato import GpuError, Scene, Volume
from sfumato.renderer import Renderer
from sfumato_ui.jobs import STILL_FRAMES, Picture
from sfumato_ui.window import MainWindow

#: Longest gap in seconds between two turns of the event loop; measured under load, hence the margin on 0.1.
LONGEST_GAP = 0.1
MARGIN = 1.5


def noisy(n: int) -> Volume:
    """Return a volume that is expensive to draw: translucent everywhere."""
    return Volume(np.random.default_rng(1).integers(0, 255, (n, n, n)).astype(np.uint8))


@pytest.mark.normal_quality
def test_a_still_picture_is_refined_to_the_end(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=120_000)
    assert window.viewport.picture.frames == STILL_FRAMES
    assert f"frame {STILL_FRAMES} of {STILL_FRAMES}" in window.status.state.text()
    assert window.status.renderer.text()
    assert not window.status.bar.isVisible()


def longest_gap(qtbot: QtBot, milliseconds: int) -> float:
    """Return the longest time in seconds between two turns of the event loop."""
    gaps: list[float] = []
    last = time.perf_counter()

    def tick() -> None:
        nonlocal last
        now = time.perf_counter()
        gaps.append(now - last)
        last = now

    timer = QTimer()
    timer.timeout.connect(tick)
    timer.start(5)
    qtbot.wait(milliseconds)
    timer.stop()
    return max(gaps)


@pytest.mark.measured
@pytest.mark.normal_quality
def test_the_event_loop_never_stalls_during_a_heavy_render(make_window: Any, qtbot: QtBot) -> None:
    window = make_window(size=(1200, 860))
    # What the machine itself does to an idle loop, with other programs beside us, is not ours.
    idle = longest_gap(qtbot, 3000)
    window.editor.reset(Scene(volume=noisy(160), step=0.25))
    qtbot.waitUntil(lambda: window.viewport.picture is not None, timeout=200_000)
    gap = longest_gap(qtbot, 6000)
    assert not window.viewport.picture.settled, "the render was not heavy enough to measure anything"
    print(f"longest gap {1000 * gap:.0f} ms, idle {1000 * idle:.0f} ms")
    assert gap < LONGEST_GAP * MARGIN + 2 * idle


def test_pictures_keep_coming_while_the_hand_moves(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    seen: list[Picture] = []
    window.worker.picture.connect(seen.append)
    start = window.editor.scene.camera
    middle = window.viewport.rect().center()
    hand.drag(window.viewport, middle, middle + QPoint(120, 30), steps=60)

    def turned() -> list[Picture]:  # a frame of the still picture may yet come in between
        return [picture for picture in seen if picture.scene.camera != start]

    qtbot.waitUntil(lambda: bool(turned()), timeout=30_000)
    assert turned()[0].interactive, "the first picture of a drag is a coarse one"
    hand.wait_for_picture()


@pytest.mark.measured
@pytest.mark.normal_quality
def test_closing_while_rendering_is_quick(make_window: Any, qtbot: QtBot) -> None:
    window = make_window(Scene(volume=noisy(96), step=0.25))
    qtbot.waitUntil(lambda: window.viewport.picture is not None, timeout=120_000)
    qtbot.wait(300)
    started = time.perf_counter()
    window.close()
    assert time.perf_counter() - started < 5
    assert not window.worker.alive


def test_a_device_that_fails_is_a_message_and_the_picture_stays(
    window: MainWindow, hand: Any, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = hand.pixels()
    begin = Renderer.begin

    def fail(*args: Any, **options: Any) -> Any:
        raise GpuError("64 GiB of texture memory", "the device offers 2 GiB")

    monkeypatch.setattr(Renderer, "begin", fail)
    window.editor.change_light("Move the light", tilt=50.0)
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=30_000)
    assert "64 GiB of texture memory" in window.messages.text
    assert np.array_equal(hand.pixels(), before)
    assert window.worker.alive
    monkeypatch.setattr(Renderer, "begin", begin)
    window.editor.change_light("Move the light", tilt=20.0)
    hand.wait_for_picture()
    assert window.messages.kind == "", "the message goes when pictures come again"
