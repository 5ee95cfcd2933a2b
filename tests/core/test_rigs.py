"""Rigs and solo: which lamps shine, and that each rig lights a subject neither too darkly nor too brightly."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

import sfumato
from sfumato import Light, Scene, SceneError, TransferFunction, Volume
from sfumato.scene import MAX_LIGHTS
from sfumato.scene.rigs import rig_named, rig_of, rigs
from sfumato_app.first_picture import CLIPPED, MEDIAN, look_at

SKIN = (0.62, 0.36, 0.26)


@pytest.fixture(scope="module")
def subject() -> Scene:
    """A skin-coloured ball before nothing: every part of a rig shows on it."""
    n = 40
    z, y, x = np.mgrid[0:n, 0:n, 0:n] * (2 / (n - 1)) - 1
    data = np.clip((0.75 - np.sqrt(x * x + y * y + z * z)) * n * 4, 0, 200).astype(np.int16)
    look = TransferFunction.from_points([(20, SKIN, 0.0), (120, SKIN, 0.9)])
    return Scene(volume=Volume(data), transfer=look, step=1.0)


def test_the_rigs() -> None:
    first = ["top-left", "headlamp", "three-point", "rim", "raking", "flat"]
    assert list(rigs()) == [*first, "under-light", "soft-box"]
    assert rigs()["top-left"].lights == (Light(),), "a new scene is lit by the first rig"
    for name, rig in rigs().items():
        assert rig.id == name
        assert rig.title
        assert rig.description
        assert 1 <= len(rig.lights) <= MAX_LIGHTS
        names = [light.name for light in rig.lights]
        assert len(set(names)) == len(names)
        assert all(light.attached == "viewer" and light.enabled and not light.solo for light in rig.lights)


def test_a_rig_is_found_by_name_and_by_its_lamps() -> None:
    for name, rig in rigs().items():
        assert rig_named(name) is rig
        assert rig_of(rig.lights) == name
    assert rig_of((Light(tilt=38.0),)) == ""
    with pytest.raises(SceneError, match="top-left"):
        rig_named("disco")


@pytest.mark.parametrize("name", list(rigs()))
def test_a_rig_is_neither_dull_nor_clipped(subject: Scene, name: str) -> None:
    picture = sfumato.render(subject.with_(lights=rigs()[name].lights), (96, 96))
    seen = picture[picture[..., 3] > 250][:, :3]
    assert 70 <= np.median(seen.mean(axis=1)) <= 190
    assert (seen.max(axis=1) == 255).mean() < 0.15


@pytest.mark.real_data
@pytest.mark.slow
@pytest.mark.parametrize("name", ["three-point", "rim", "raking"])
def test_several_lamps_do_not_clip_a_head(data_dir: Path, name: str) -> None:
    head = Scene(volume=sfumato.load(data_dir / "mr_head_electrodes" / "MR.nii.gz"), step=1.0)
    _, figures = look_at(head.with_(lights=rigs()[name].lights), (112, 112))
    assert figures.clipped < CLIPPED
    assert MEDIAN[0] <= figures.median <= MEDIAN[1]


def test_no_two_rigs_look_alike(subject: Scene) -> None:
    pictures = {
        name: sfumato.render(subject.with_(lights=rig.lights), (64, 64)).astype(float)
        for name, rig in rigs().items()
    }
    for a, b in itertools.combinations(pictures, 2):
        # A ball has no hollows, where flat light and a headlamp differ most.
        least = 0.3 if {a, b} == {"headlamp", "flat"} else 2.0
        assert np.abs(pictures[a] - pictures[b]).mean() > least, (a, b)


def test_solo_leaves_the_other_lamps_dark() -> None:
    key, fill, rim = Light(name="key"), Light(name="fill", tilt=20), Light(name="rim", tilt=140)
    assert Scene(lights=(key, fill, rim)).active_lights == (key, fill, rim)
    scene = Scene(lights=(key, fill, rim)).with_(**{"lights.1.solo": True})
    assert [light.name for light in scene.active_lights] == ["fill"]
    scene = scene.with_(**{"lights.2.solo": True})
    assert [light.name for light in scene.active_lights] == ["fill", "rim"]
    scene = scene.with_(**{"lights.1.enabled": False})
    assert [light.name for light in scene.active_lights] == ["rim"]
    scene = scene.with_(**{"lights.2.enabled": False})
    assert [light.name for light in scene.active_lights] == ["key"], "a muted lamp's solo counts for nothing"


def test_solo_draws_what_the_lamp_alone_draws(subject: Scene) -> None:
    key, rim = Light(name="key"), Light(name="rim", tilt=140, rotation=30)
    both = subject.with_(lights=(key, Light(name="rim", tilt=140, rotation=30, solo=True)))
    alone = subject.with_(lights=(rim,))
    assert np.array_equal(sfumato.render(both, (48, 48)), sfumato.render(alone, (48, 48)))


def test_solo_is_kept_in_scene_files() -> None:
    scene = Scene(lights=(Light(), Light(name="rim", tilt=140, solo=True)))
    assert Scene.from_json(scene.to_json()).lights == scene.lights
