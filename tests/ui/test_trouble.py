"""When something fails: the window and the last good picture live on, and a message says what to do."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtWidgets import QPushButton

from sfumato import Scene, TransferFunction, Volume, VolumeInfo
from sfumato.gpu.device import Device
from sfumato.gpu.program import ShaderSource
from sfumato.gpu.target import Target
from sfumato_ui.window import MainWindow

LEFT = Qt.MouseButton.LeftButton


def error_of(window: MainWindow, qtbot: QtBot) -> str:
    """Wait for an error and return its text."""
    qtbot.waitUntil(lambda: window.messages.kind == "error", timeout=30_000)
    assert "\n" not in window.messages.text
    return window.messages.text


def click(window: MainWindow, qtbot: QtBot, text: str) -> None:
    """Click a button of the message bar."""
    button = next(b for b in window.messages.findChildren(QPushButton) if b.text() == text and b.isVisible())
    assert button.width() >= button.fontMetrics().horizontalAdvance(text)
    qtbot.mouseClick(button, LEFT)


def move_light(window: MainWindow, tilt: float) -> None:
    """Change the scene."""
    window.editor.change_light("Move the light", tilt=tilt)


def test_a_picture_too_large_for_the_device_is_offered_smaller(
    window: MainWindow, hand: Any, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = hand.pixels()
    make = Target.__init__

    def short_of_memory(self: Target, device: Device, size: tuple[int, int], *more: Any) -> None:
        if size[0] > 300:
            with device.checked(f"a picture of {size[0]} x {size[1]} pixels"):
                raise moderngl.Error("cannot create texture")
        make(self, device, size, *more)

    monkeypatch.setattr(Target, "__init__", short_of_memory)
    move_light(window, 50.0)
    text = error_of(window, qtbot)
    assert "picture" in text
    assert "The last good picture stays" in text
    assert hand.pixels()[..., 3].max() == 255, "the coarse one, for which there was room"
    click(window, qtbot, "Use a smaller size")
    hand.wait_for_picture()
    assert window.messages.kind == ""
    assert hand.pixels().shape[1] == round(window.viewport.pixel_size[0] / 2)
    monkeypatch.undo()
    window.files.opened.emit()
    window.driver.ask()
    qtbot.waitUntil(lambda: hand.pixels().shape == before.shape, timeout=30_000)


def test_a_volume_too_large_for_the_device_is_offered_smaller(
    window: MainWindow, hand: Any, qtbot: QtBot
) -> None:
    device = window.worker._renderer.device
    device.max_texture_3d = 48
    before = hand.pixels()
    data = np.zeros((30, 40, 60), np.uint8)
    data[8:22, 10:30, 10:50] = 200
    volume = Volume(data, spacing=(1.0, 1.5, 2.0), info=VolumeInfo("box.npy", name="box"))
    old = window.editor.scene
    window.editor.change("Show another", volume=volume, camera=None)
    assert "60 x 40 x 30 voxels" in error_of(window, qtbot)
    assert np.array_equal(hand.pixels(), before)
    click(window, qtbot, "Use a smaller size")
    qtbot.waitUntil(lambda: window.editor.scene.volume.dims == (30, 20, 15), timeout=20_000)
    smaller = window.editor.scene.volume
    assert smaller.spacing == pytest.approx((2.0, 3.0, 4.0))
    assert np.allclose(smaller.corners(), volume.corners()), "it fills the same space"
    assert smaller.info.path == "box.npy"
    hand.wait_for_picture()
    assert window.messages.kind != "error"
    window.editor.undo()
    window.editor.undo()
    assert window.editor.scene == old


def test_a_shader_that_does_not_compile(
    window: MainWindow, hand: Any, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = hand.pixels()
    text = ShaderSource.text

    def broken(self: ShaderSource) -> tuple[str, list[str]]:
        body, files = text(self)
        return body.replace("void main() {", "void main() { nonsense;"), files

    monkeypatch.setattr(ShaderSource, "text", broken)
    window.editor.change("Choose the technique", technique="slices")
    said = error_of(window, qtbot)
    assert "does not compile" in said
    assert ".glsl" in said
    assert np.array_equal(hand.pixels(), before)
    monkeypatch.undo()
    click(window, qtbot, "Use another technique")
    assert window.editor.scene.technique_id == "raycast-phong"
    hand.wait_for_picture()
    assert window.messages.kind == ""


def lose(device: Device) -> None:
    """Let a device answer as one whose context is lost: no fence can be made."""
    device._fence_sync = lambda *arguments: 0


def test_a_lost_context_is_replaced_without_a_word(window: MainWindow, hand: Any, qtbot: QtBot) -> None:
    lost = window.worker._renderer
    lose(lost.device)
    move_light(window, 50.0)
    hand.wait_for_picture()
    assert window.worker._renderer is not lost
    assert window.messages.kind == ""


def test_a_context_that_is_lost_again_and_again_is_a_message(
    window: MainWindow, hand: Any, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = hand.pixels()
    lose(window.worker._renderer.device)
    make = Device.__init__

    def stillborn(self: Device) -> None:
        make(self)
        lose(self)

    monkeypatch.setattr(Device, "__init__", stillborn)
    move_light(window, 50.0)
    assert "The graphics context was lost" in error_of(window, qtbot)
    assert np.array_equal(hand.pixels(), before)
    monkeypatch.undo()
    click(window, qtbot, "Try again")
    hand.wait_for_picture()
    assert window.messages.kind == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_disk_leaves_the_work_unsaved_and_nothing_half_written(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    target = tmp_path / "kept.sfumato"
    assert window.files.save_scene_as(str(target))
    good = target.read_bytes()
    # What is written first goes to a device that is full.
    (tmp_path / "kept.sfumato.part").symlink_to("/dev/full")
    move_light(window, 50.0)
    before = hand.pixels()
    hand.press(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    text = error_of(window, qtbot)
    assert "No space left" in text
    assert "Choose another place" in text
    assert target.read_bytes() == good
    assert sorted(p.name for p in tmp_path.glob("kept*")) == ["kept.sfumato"]
    assert window.isWindowModified()
    assert hand.pixels().shape == before.shape
    hand.press(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: not window.isWindowModified())


def bad_files(folder: Path) -> dict[str, Path]:
    """Write files that cannot be opened, by what the message must say."""
    made = {
        "nothing": folder / "empty.nii",
        "not a scene file": folder / "torn.sfumato",
        "carries no scene": folder / "plain.png",
        "no such file": folder / "gone.nrrd",
        "damaged": folder / "named.mha",
    }
    made["nothing"].write_bytes(b"")
    made["not a scene file"].write_text('{"sfumato": 1, "volume"')
    from PIL import Image

    Image.new("RGBA", (4, 4)).save(made["carries no scene"])
    made["damaged"].write_bytes(os.urandom(600))
    return made


def test_files_that_cannot_be_read_are_messages(
    window: MainWindow, hand: Any, qtbot: QtBot, tmp_path: Path
) -> None:
    before, scene = hand.pixels(), window.editor.scene
    for problem, path in bad_files(tmp_path).items():
        window.messages.clear()
        window.open(str(path))
        text = error_of(window, qtbot)
        assert path.name in text
        assert problem in text or problem == "nothing"
        assert "What was open stays open" in text
        assert window.editor.scene is scene
        assert np.array_equal(hand.pixels(), before)
    move_light(window, 40.0)
    hand.wait_for_picture()


def test_a_scene_whose_volume_is_gone_says_which(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, ball_scene: Scene
) -> None:
    volume = Volume(np.zeros((4, 4, 4), np.uint8), info=VolumeInfo(str(tmp_path / "lost.nii")))
    Scene(volume=volume, transfer=TransferFunction.from_points([(0, (1, 1, 1), 0), (9, (1, 1, 1), 1)])).save(
        tmp_path / "orphan.sfumato"
    )
    window.open(str(tmp_path / "orphan.sfumato"))
    assert "lost.nii" in error_of(window, qtbot)


def test_an_error_that_comes_again_leaves_its_button_under_the_mouse(
    window: MainWindow, qtbot: QtBot
) -> None:
    pressed: list[str] = []
    window.messages.show_error("Too large.", {"Use less": lambda: pressed.append("first")})
    button = next(b for b in window.messages.findChildren(QPushButton) if b.text() == "Use less")
    qtbot.mousePress(button, LEFT)
    window.messages.show_error("Too large still.", {"Use less": lambda: pressed.append("second")})
    qtbot.mouseRelease(button, LEFT)
    assert pressed == ["second"]
    assert window.messages.kind == ""
    window.messages.show_error("Too large.", {"Use less": pressed.clear})
    window.messages.show_error("Wrong.", {"Use another": pressed.clear})
    click(window, qtbot, "Use another")  # at once
    assert not pressed
