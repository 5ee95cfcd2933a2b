"""The View tab and what belongs to the view: quality, letters, sharpness on dense screens."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytestqt.qtbot import QtBot
from qtpy.QtCore import QPoint, Qt

from sfumato import Camera, Scene
from sfumato_ui import camera_moves
from sfumato_ui.quality import QUALITIES, chosen_quality
from sfumato_ui.tab_order import widgets_of
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton
START = Camera(position=(10.0, -500.0, 5.0), focal_point=(10.0, 20.0, 5.0))
#: The patient's axes by letter (LPS).
AXES = {"L": (1, 0, 0), "R": (-1, 0, 0), "P": (0, 1, 0), "A": (0, -1, 0), "S": (0, 0, 1), "I": (0, 0, -1)}


@given(st.floats(-180, 180), st.floats(-80, 80), st.sampled_from(["front", "top", "left"]))
def test_letters_name_the_side_that_lies_there(azimuth: float, elevation: float, side: str) -> None:
    camera = camera_moves.orbit(camera_moves.from_side(START, side), azimuth, elevation)
    letters, basis = camera_moves.edge_letters(camera), camera.basis()
    for edge, axis in (("right", basis.right), ("top", basis.up)):
        shown = np.asarray(AXES[letters[edge]]) @ np.asarray(axis)
        assert shown == pytest.approx(np.abs(axis).max()), "no other side lies further that way"
        assert AXES[letters[edge]] == tuple(
            -c for c in AXES[letters[{"right": "left", "top": "bottom"}[edge]]]
        )


@pytest.mark.normal_quality
def test_quality_is_kept_and_refines_as_far(
    window: MainWindow, hand: Any, qtbot: QtBot, make_window: Any
) -> None:
    window.panel.setCurrentIndex(2)
    window.view_page.more.set_open(True)
    box = window.view_page.quality
    assert box.currentText() == "Normal (8 frames)"
    box.setFocus()
    hand.press(Qt.Key.Key_Up)
    assert box.currentText() == "Draft (2 frames)"
    assert chosen_quality() == QUALITIES[0]
    qtbot.waitUntil(lambda: window.viewport.picture.settled, timeout=60_000)
    assert window.viewport.picture.frames == window.viewport.picture.wanted == 2
    assert "frame 2 of 2" in window.status.state.text()
    assert not window.editor.document.modified, "quality is the user's, not the scene's"
    assert make_window().view_page.quality.currentText() == "Draft (2 frames)", "kept for the next window"


def test_standard_views_follow_the_buttons(window: MainWindow, qtbot: QtBot) -> None:
    window.panel.setCurrentIndex(2)
    qtbot.mouseClick(widgets_of(window.view_page.views.layout())[5], LEFT)
    assert window.editor.scene.camera.basis().back == pytest.approx((0, 0, -1), abs=1e-6)
    qtbot.mouseClick(window.view_page.parallel, LEFT, pos=QPoint(12, 12))
    assert window.editor.scene.camera.parallel_projection
    assert not window.view_page.lens.isEnabled()


def test_background_and_exposure(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    window.panel.setCurrentIndex(2)
    page = window.view_page
    qtbot.mouseClick(page.background[3], LEFT)
    hand.wait_for_picture()
    assert hand.pixels()[2, 2].tolist() == [255, 255, 255, 255]
    page.exposure.number.setFocus()
    page.exposure.number.selectAll()
    qtbot.keyClicks(page.exposure.number, "-2")
    hand.press(Qt.Key.Key_Return)
    assert window.editor.scene.exposure == -2.0


PROBE = """
import json, time
import numpy as np
from qtpy.QtWidgets import QApplication
from sfumato import Document, Scene, TransferFunction, Volume, VolumeInfo
from sfumato_ui.theme import apply_theme
from sfumato_ui.window import MainWindow

app = QApplication([])
apply_theme(app, "dark")
z, y, x = np.mgrid[0:24, 0:24, 0:24]
data = (200 * ((x // 6 + z // 6) % 2)).astype(np.uint8)
scene = Scene(
    volume=Volume(data, info=VolumeInfo(orientation_known=True)),
    transfer=TransferFunction.from_points([(20, (1, 1, 1), 0), (120, (1, 1, 1), 0.9)]),
    technique="raycast",
)
window = MainWindow(Document(scene))
window.resize(620, 420)
window.show()
view = window.viewport


def settled():
    picture = view.picture
    return picture is not None and not picture.interactive and picture.size == view.pixel_size


while not settled():
    app.processEvents()
    time.sleep(0.01)
out = {"ratio": view.devicePixelRatioF(), "size": [view.width(), view.height()]}
out["picture"] = [view.picture.image.width(), view.picture.image.height()]


def grab():
    image = view.grab().toImage().convertToFormat(view.picture.image.format())
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).astype(int)


shown = grab()
out["grab"] = [shown.shape[1], shown.shape[0]]
inner = view.picture.image
flat = np.frombuffer(inner.constBits(), np.uint8).reshape(inner.height(), inner.bytesPerLine())
picture = flat[:, : 4 * inner.width()].reshape(inner.height(), inner.width(), 4).astype(int)
h, w = picture.shape[0] // 3, picture.shape[1] // 3
part = np.s_[h : 2 * h, w : 2 * w, :3]
alpha = picture[part[0], part[1], 3:] / 255
out["difference"] = float(np.abs(shown[part] - picture[part] - 78 * (1 - alpha)).max())
row = shown[shown.shape[0] // 2]
dark = np.nonzero(np.all(row[:, :3] < 75, axis=1))[0] / out["ratio"]
out["right_letter"] = [float(dark[dark > view.width() / 2].min()), float(dark.max())]
window.strip.choose("clip")
out["handle_colour"] = []
for handle in view.tools["clip"].handles(view.view):
    px, py = (round(c * out["ratio"]) for c in handle.at)
    out["handle_colour"].append(grab()[py, px, :3].tolist())
window.editor.document.mark_saved()
window.close()
print(json.dumps(out))
"""


@pytest.mark.parametrize("factor", [1.5, 2.0])
def test_a_dense_screen_is_sharp_and_in_place(factor: float, tmp_path: Path) -> None:
    env = {**os.environ, "QT_SCALE_FACTOR": str(factor), "SFUMATO_SETTINGS": str(tmp_path)}
    run = subprocess.run(
        [sys.executable, "-c", PROBE], env=env, capture_output=True, text=True, timeout=120, check=False
    )
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout.splitlines()[-1])
    width, height = found["size"]
    assert found["ratio"] == factor
    assert found["picture"] == found["grab"] == [round(factor * width), round(factor * height)]
    assert found["difference"] <= 2, "a pixel of the picture is a pixel of the screen"
    assert width - 40 < found["right_letter"][0] < found["right_letter"][1] < width
    assert found["handle_colour"], "six faces"
    assert all(min(colour) > 200 for colour in found["handle_colour"]), "each handle is where it is hit"


def test_an_unknown_orientation_is_said(make_window: Any, ball_scene: Scene, qtbot: QtBot) -> None:
    from sfumato import Volume

    volume = ball_scene.volume
    assert volume is not None
    plain = make_window(Scene(volume=Volume(volume.data), transfer=ball_scene.transfer), size=(900, 600))
    known = make_window(ball_scene, size=(900, 600))
    for window, expected in ((plain, False), (known, True)):
        qtbot.waitExposed(window)
        image = window.viewport.grab().toImage()
        corner = image.copy(0, image.height() - 44, 100, 44)
        dark = [corner.pixelColor(x, y).lightness() < 40 for x in range(10, 90, 4) for y in range(10, 36, 4)]
        assert any(dark) != expected, "the patch in the corner says that it is unknown"


def test_views_are_kept_chosen_renamed_and_removed(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    window.panel.setCurrentIndex(2)
    button, editor = window.view_page.bookmarks, window.editor
    first = editor.scene.camera
    window.viewport.setFocus()
    hand.press(Qt.Key.Key_B, Qt.KeyboardModifier.ControlModifier)
    hand.press(Qt.Key.Key_Right)
    assert editor.scene.camera != first
    hand.press(Qt.Key.Key_B, Qt.KeyboardModifier.ControlModifier)
    assert [mark.name for mark in editor.scene.bookmarks] == ["View 1", "View 2"]
    hand.press(Qt.Key.Key_N)
    assert editor.scene.camera == first

    def choose(text: str) -> None:
        menu = button.menu()
        button.setFocus()
        qtbot.keyClick(button, Qt.Key.Key_Space)
        qtbot.waitUntil(menu.isVisible)
        enabled = [a for a in menu.actions() if a.isEnabled() and not a.isSeparator()]
        for _ in range(1 + next(i for i, a in enumerate(enabled) if a.text().startswith(text))):
            qtbot.keyClick(menu, Qt.Key.Key_Down)
        qtbot.keyClick(menu, Qt.Key.Key_Return)
        qtbot.waitUntil(lambda: not menu.isVisible())

    choose("View 2")
    assert editor.scene.camera == editor.scene.bookmarks[1].camera
    choose("Rename View 2")
    qtbot.keyClicks(button.ask.text, "View 1")
    assert button.ask.complaint == "This name is taken"
    button.ask.text.selectAll()
    qtbot.keyClicks(button.ask.text, "From the right")
    qtbot.keyClick(button.ask.text, Qt.Key.Key_Return)
    assert editor.scene.bookmarks[1].name == "From the right"
    choose("Remove From the right")
    assert [mark.name for mark in editor.scene.bookmarks] == ["View 1"]
    editor.undo()
    assert len(editor.scene.bookmarks) == 2
