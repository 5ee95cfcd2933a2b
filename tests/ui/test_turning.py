"""The orientation cube in the picture, and the turntable."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, QPointF, Qt

from sfumato import Scene
from sfumato_ui.orientation import MARGIN, SIDE
from sfumato_ui.window import MainWindow

from .conftest import Hand, MakeWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def window(make_window: MakeWindow, ball_scene: Scene) -> MainWindow:
    return make_window(ball_scene.with_(technique="raycast"), size=(680, 560))


def corner(window: MainWindow) -> np.ndarray:
    """Return what is painted where the cube is."""
    image = window.viewport.grab().toImage()
    return np.array([
        [image.pixelColor(x, y).lightness() for x in range(MARGIN, MARGIN + SIDE, 3)]
        for y in range(MARGIN, MARGIN + SIDE, 3)
    ])  # fmt: skip


def test_the_cube_is_switched_on_and_a_press_on_a_face_looks_at_it(
    window: MainWindow, make_window: MakeWindow, qtbot: QtBot
) -> None:
    hand = Hand(window, qtbot)
    hand.wait_for_picture()
    window.look("front")
    bare = corner(window)
    window.viewport.setFocus()
    qtbot.keyClick(window.viewport, Qt.Key.Key_O)
    assert window.view_page.cube.isChecked()
    assert np.abs(corner(window) - bare).max() > 100
    for _ in range(4):
        qtbot.keyClick(window.viewport, Qt.Key.Key_Down)
    steps = len(window.editor.document.steps)
    camera = window.editor.scene.camera
    assert camera is not None
    # From a little above, the upper face is a strip at the cube's upper edge.
    place = next(
        y for y in range(MARGIN, MARGIN + SIDE) if window.viewport.cube.face(camera, _at(y)) == "top"
    )
    qtbot.mouseClick(window.viewport, LEFT, pos=QPoint(MARGIN + SIDE // 2, place + 1))
    assert len(window.editor.document.steps) == steps + 1
    turned = window.editor.scene.camera
    assert turned is not None
    assert turned.basis().back == pytest.approx((0, 0, 1))
    assert turned.distance == pytest.approx(camera.distance), "as near as it was"
    assert make_window().viewport.cube.on, "kept for the next window"


def _at(y: int) -> QPointF:
    return QPointF(MARGIN + SIDE / 2, y)


def test_the_turntable_turns_until_the_next_act_and_leaves_no_trace(window: MainWindow, qtbot: QtBot) -> None:
    hand = Hand(window, qtbot)
    hand.wait_for_picture()
    document, start = window.editor.document, window.editor.scene.camera
    assert start is not None
    steps = len(document.steps)
    window.viewport.setFocus()

    def turned() -> bool:
        camera = window.editor.scene.camera
        assert camera is not None
        assert camera.distance == pytest.approx(start.distance)
        return camera != start and camera.position[2] == pytest.approx(start.position[2])

    for end in (Qt.Key.Key_T, Qt.Key.Key_Shift):
        qtbot.keyClick(window.viewport, Qt.Key.Key_T)
        assert window.turntable.playing
        assert window.view_page.turntable.isChecked()
        qtbot.waitUntil(turned, timeout=10_000)
        qtbot.keyClick(window.viewport, end)
        assert not window.turntable.playing, end
        assert not window.view_page.turntable.isChecked()
        assert window.editor.scene.camera == start
        assert len(document.steps) == steps
        qtbot.wait(1)
    window.panel.setCurrentWidget(window.view_page)
    button = window.view_page.turntable
    qtbot.mouseClick(button, LEFT)
    qtbot.waitUntil(turned, timeout=10_000)
    qtbot.mouseClick(button, LEFT)
    assert not window.turntable.playing
    assert window.editor.scene.camera == start


def test_an_act_while_it_turns_counts_from_where_it_began(window: MainWindow, qtbot: QtBot) -> None:
    hand = Hand(window, qtbot)
    hand.wait_for_picture()
    start = window.editor.scene.camera
    window.viewport.setFocus()
    qtbot.keyClick(window.viewport, Qt.Key.Key_T)
    qtbot.waitUntil(lambda: window.editor.scene.camera != start, timeout=10_000)
    qtbot.keyClick(window.viewport, Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert not window.turntable.playing
    assert window.editor.scene.camera == start
    assert window.editor.document.undo_label, "the lamp moved, as one step"
    window.editor.undo()
    assert not window.editor.document.undo_label
    qtbot.keyClick(window.viewport, Qt.Key.Key_T)
    window.editor.change("Elsewhere", exposure=0.5)
    assert not window.turntable.playing, "another hand ended it"
