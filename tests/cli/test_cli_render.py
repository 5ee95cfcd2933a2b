"""`sfumato render`: the file is the picture that the scene is."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image

import sfumato
from sfumato import Scene, TransferFunction
from sfumato.export.png import open_png
from sfumato.scene import STANDARD_VIEWS
from sfumato.scene.params import to_json
from sfumato.techniques import techniques

pytestmark = pytest.mark.gpu

SIZE = "40x30"
FAST = ("--technique", "raycast")


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image)


def test_picture_and_scene(run, ball, tmp_path):
    outcome = run(
        "render", ball, "-o", "out.png", "--size", SIZE, "--tilt", 30, "--rotation", 90, "--frames", 2
    )
    assert (outcome.status, outcome.err) == (0, "")
    assert "out.png: 40 x 30, cone" in outcome.out
    picture = pixels("out.png")
    assert picture.shape == (30, 40, 4)
    assert np.ptp(picture[..., :3]) > 40
    scene = open_png("out.png")
    assert (scene.lights[0].tilt, scene.lights[0].rotation, scene.frames) == (30, 90, 2)
    np.testing.assert_array_equal(picture, sfumato.render(scene, size=(40, 30)))
    assert str(tmp_path).encode() not in (tmp_path / "out.png").read_bytes()


def test_a_picture_renders_as_itself_and_changed(run, ball):
    run("render", ball, "-o", "a.png", "--size", SIZE, "--technique", "raycast-phong", "--ambient", 0.4)
    assert run("render", "a.png", "-o", "b.png", "--size", SIZE).status == 0
    np.testing.assert_array_equal(pixels("a.png"), pixels("b.png"))
    assert open_png("b.png").technique.ambient == 0.4
    assert run("render", "a.png", "-o", "c.png", "--size", SIZE, "--ambient", 0.0).status == 0
    assert pixels("c.png")[..., :3].mean() < pixels("a.png")[..., :3].mean()


def test_scene_file_and_another_volume(run, ball, tmp_path):
    scene = Scene(volume=sfumato.load(ball), technique="raycast")
    scene.save("study.sfumato")
    assert run("render", "study.sfumato", "--size", SIZE).status == 0
    np.testing.assert_array_equal(pixels("study.png"), sfumato.render(scene, size=(40, 30)))
    (tmp_path / "far" / "away").mkdir(parents=True)
    moved = ball.rename(tmp_path / "far" / "away" / "moved.npy")
    assert "ball.npy" in run("render", "study.sfumato", "--size", SIZE).failed_with(1)
    assert run("render", "study.sfumato", "--volume", moved, "--size", SIZE, "-o", "two.png").status == 0
    np.testing.assert_array_equal(pixels("study.png"), pixels("two.png"))
    moved.rename(tmp_path / "renamed.npy")  # beside the scene it is known by its content
    assert run("render", "study.sfumato", "--size", SIZE, "-o", "three.png").status == 0
    np.testing.assert_array_equal(pixels("study.png"), pixels("three.png"))


def test_default_name_is_in_this_folder(run, ball, tmp_path):
    (tmp_path / "there").mkdir()
    ball.rename(tmp_path / "there" / "ball.npy")
    assert run("render", "there/ball.npy", "--size", "8x8").status == 0
    assert (tmp_path / "ball.png").exists()
    assert run("render", "ball.png", "--volume", "there/ball.npy", "--size", "8x8").status == 0
    assert (tmp_path / "ball-again.png").exists()
    assert "input" in run("render", "ball.png", "-o", "ball.png").failed_with(2)


def test_settings_are_checked_together(run, ball):
    line = [
        "render",
        ball,
        "-o",
        "out.png",
        "--size",
        "8x8",
        "--set",
        "lights.0.tilt=84",
        "--set",
        "lights.0.aperture=5",
    ]
    assert run(*line).status == 0
    assert (open_png("out.png").lights[0].tilt, open_png("out.png").lights[0].aperture) == (84, 5)
    assert "tilt" in run(*line[:-2]).failed_with(1)


@pytest.mark.parametrize("view", list(STANDARD_VIEWS))
def test_views(run, ball, view):
    assert run("render", ball, "-o", "out.png", "--size", "30x40", *FAST, "--camera", view).status == 0
    scene = open_png("out.png")
    side, up = STANDARD_VIEWS[view]
    np.testing.assert_allclose(scene.camera.basis().back, side, atol=1e-6)
    np.testing.assert_allclose(scene.camera.view_up, up)
    assert_nothing_is_cut_off(pixels("out.png"))


def test_a_portrait_cuts_nothing_off(run, ball):
    assert run("render", ball, "-o", "out.png", "--size", "20x40", *FAST).status == 0
    assert_nothing_is_cut_off(pixels("out.png"))


def assert_nothing_is_cut_off(picture):
    """The border is background, and the middle is not."""
    border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
    assert np.ptp(border, axis=0).max() == 0
    middle = picture[picture.shape[0] // 2, picture.shape[1] // 2].astype(int)
    assert np.abs(middle - border[0]).max() > 5


def test_background(run, ball):
    run("render", ball, "-o", "grey.png", "--size", SIZE)
    assert pixels("grey.png")[0, 0].tolist() == [78, 78, 78, 255]
    run("render", ball, "-o", "clear.png", "--size", SIZE, "--transparent")
    assert pixels("clear.png")[0, 0, 3] == 0
    assert pixels("clear.png")[15, 20, 3] > 200


def test_linear_pictures(run, ball):
    line = ["render", ball, "--size", SIZE, "--transparent"]
    assert run(*line, "-o", "out.npy").status == 0
    assert run(*line, "--linear", "-o", "out.exr").status == 0
    assert run(*line, "-o", "out.png").status == 0
    wanted = sfumato.render(open_png("out.png"), size=(40, 30), linear=True)
    np.testing.assert_allclose(np.load("out.npy"), wanted, atol=1e-6)
    openexr = pytest.importorskip("OpenEXR")
    with openexr.File("out.exr") as file:
        np.testing.assert_allclose(file.channels()["RGBA"].pixels, wanted, atol=1e-6)


def test_transfer_by_preset_and_by_file(run, ball, tmp_path):
    assert run("render", ball, "-o", "a.png", "--size", "8x8", "--transfer", "solid red").status == 0
    assert open_png("a.png").transfer.name == "Solid red"
    wanted = TransferFunction.from_points([(0, (0, 0, 0), 0.0), (100, (0, 1, 0), 0.5)], name="mine")
    (tmp_path / "mine.json").write_text(json.dumps(to_json(wanted)))
    Scene(transfer=wanted).save("mine.sfumato")
    for name in ("mine.json", "mine.sfumato"):
        assert run("render", ball, "-o", "a.png", "--size", "8x8", "--transfer", name).status == 0
        assert open_png("a.png").transfer == wanted


@pytest.mark.parametrize("technique_id", list(techniques()))
def test_every_technique_draws(run, ball, technique_id):
    line = ["render", ball, "-o", "out.png", "--size", "16x16", "--technique", technique_id]
    assert run(*line, "--transparent").status == 0
    assert open_png("out.png").technique_id == technique_id
    assert pixels("out.png")[8, 8, 3] > 200


@pytest.fixture
def without_a_screen(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("sys.platform", "linux")


@pytest.mark.usefixtures("without_a_screen")
def test_without_a_screen_the_picture_is_drawn(run, ball):
    outcome = run(ball)
    assert outcome.status == 0
    assert "no screen" in outcome.err
    assert len(outcome.err.splitlines()) == 1
    assert open_png("sfumato-sample.png").volume == sfumato.load(ball)


@pytest.mark.usefixtures("without_a_screen")
@pytest.mark.slow
def test_without_a_screen_and_without_a_path_the_sample_is_drawn(run):
    assert run().status == 0
    assert pixels("sfumato-sample.png").shape == (1024, 1024, 4)
    assert open_png("sfumato-sample.png").volume.info.path == "sample:hand"
