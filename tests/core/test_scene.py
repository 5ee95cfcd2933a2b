"""The scene tree: changed copies, JSON, files, settings from text, errors that name the field."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sfumato
from sfumato import (
    Camera,
    ClipPlane,
    CropBox,
    Light,
    LoadError,
    Region,
    Scene,
    SceneError,
    TransferFunction,
    Volume,
)
from sfumato.scene import MAX_CLIP_PLANES, MAX_LIGHTS, parse_setting

RAMP = TransferFunction.from_points([(0, (0, 0, 0), 0.0), (1, (1, 1, 1), 1.0)])


@pytest.fixture(scope="module")
def volume() -> Volume:
    return Volume(np.arange(60, dtype=np.uint8).reshape(3, 4, 5), spacing=(1, 2, 3))


@pytest.fixture(scope="module")
def rich(volume: Volume) -> Scene:
    """A scene in which little is as by default."""
    region = Region(shape="polygon", points=((0, 0), (1, 0), (0, 1)), feather=0.5)
    return Scene(
        volume=volume,
        transfer=TransferFunction(RAMP.points, 2.0, (region,), "mine"),
        camera=Camera((10, -50, 3), (1, 2, 3), view_angle=20, window_center=(0.1, -0.2)),
        lights=[
            Light(tilt=120, name="rim"),
            Light(kind="point", position=(1, 2, 3), radius=4, enabled=False),
        ],
        technique="half-angle",
        step=1.5,
        background=(0.1, 0.2, 0.3, 1),
        exposure=-1,
        frames=3,
        clip=[ClipPlane((1, 2, 3), (0, 0, 1)), ClipPlane(enabled=False)],
        crop=CropBox((0.1, 0, 0), (0.9, 1, 1)),
    )


def test_defaults_are_filled_in_once_there_is_a_volume(volume: Volume) -> None:
    assert Scene().camera is None
    scene = Scene(volume=volume)
    assert scene.camera is not None
    assert scene.transfer is not None
    assert scene == Scene(volume=volume)
    assert hash(scene) == hash(Scene(volume=volume))


def test_with_changes_by_path_and_leaves_the_rest(rich: Scene) -> None:
    changed = rich.with_(
        **{"lights.0.tilt": 150, "camera.view_angle": 40, "technique.softness": False, "frames": 7}
    )
    assert (changed.lights[0].tilt, changed.frames) == (150, 7)
    assert changed.lights[1] is rich.lights[1]
    assert changed.volume is rich.volume
    assert rich.lights[0].tilt == 120
    back = changed.with_(
        {"lights.0.tilt": 120, "camera.view_angle": 20, "technique.softness": True, "frames": 3}
    )
    assert back == rich


def test_parts_changed_together_are_checked_together() -> None:
    scene = Scene(lights=[Light(tilt=60, aperture=20)])
    both = {"lights.0.tilt": 20, "lights.0.aperture": 60}
    assert scene.with_(both).lights[0].aperture == 60
    with pytest.raises(SceneError, match=r"lights\.0\.tilt"):
        scene.with_({"lights.0.aperture": 60})
    assert scene.with_({"crop.low": (0.5, 0, 0), "crop.high": (0.6, 1, 1)}).crop.low[0] == 0.5


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("lights.0.tilt", 200),
        ("lights.0.tilt", float("nan")),
        ("lights.0.aperture", 0),
        ("lights.2.tilt", 3),
        ("lights.-1.tilt", 3),
        ("lights.0.no_such", 3),
        ("camera.view_angle", 170),
        ("camera.view_up", (0, 0)),
        ("step", 0),
        ("background", (0, 0, 0)),
        ("background", (0, 0, 0, 2)),
        ("frames", 1.5),
        ("exposure", "bright"),
        ("technique.no_such", 1),
        ("technique.resolution", 99),
        ("crop.low", (1, 0, 0)),
        ("clip.0.normal", (0, 0, 0)),
        ("transfer.points.0.opacity", 2),
        ("volume.data", 3),
        ("step.deeper", 3),
        ("", 1),
        ("lights", 3),
        ("lights", [3]),
        ("clip", 3),
        ("camera", 3),
    ],
)
def test_bad_changes_are_scene_errors_that_name_the_path(rich: Scene, path: str, value: Any) -> None:
    with pytest.raises(SceneError) as caught:
        rich.with_({path: value})
    shared = caught.value.path.split(".")[0]
    assert shared == path.split(".")[0]
    assert "\n" not in str(caught.value)


def test_limits_on_numbers_of_things() -> None:
    with pytest.raises(SceneError, match="lights"):
        Scene(lights=[Light()] * (MAX_LIGHTS + 1))
    with pytest.raises(SceneError, match="clip"):
        Scene(clip=[ClipPlane()] * (MAX_CLIP_PLANES + 1))


def test_only_lights_that_shine_are_active(rich: Scene) -> None:
    assert [light.name for light in rich.active_lights] == ["rim"]
    assert rich.with_({"lights.0.intensity": 0}).active_lights == ()


def test_json_and_file_round_trip(rich: Scene, volume: Volume, tmp_path: Path) -> None:
    assert Scene.from_json(json.loads(json.dumps(rich.to_json())), volume) == rich
    rich.save(tmp_path / "a.sfumato")
    assert Scene.open(tmp_path / "a.sfumato", volume=volume) == rich
    assert [p.name for p in tmp_path.iterdir()] == ["a.sfumato"], "no temporary file is left"


def test_a_saved_scene_finds_its_volume_beside_it(volume: Volume, tmp_path: Path) -> None:
    np.save(tmp_path / "v.npy", volume.data)
    loaded = sfumato.load(tmp_path / "v.npy")
    Scene(volume=loaded, exposure=2).save(tmp_path / "s.sfumato")
    assert json.loads((tmp_path / "s.sfumato").read_text())["volume"]["path"] == "v.npy"
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    for name in ("v.npy", "s.sfumato"):
        (tmp_path / name).rename(moved / name)
    scene = Scene.open(moved / "s.sfumato")
    assert scene.volume == loaded
    assert scene.exposure == 2
    np.save(moved / "v.npy", volume.data + 1)
    with pytest.raises(LoadError, match="not the volume"):
        Scene.open(moved / "s.sfumato")


@pytest.mark.parametrize(
    "text",
    ["", "{", "[1]", '"x"', "null", '{"sfumato": 99}', '{"sfumato": 1, "colour": 2}', "{" * 3000, "\0"],
)
def test_files_that_are_no_scenes(text: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.sfumato"
    path.write_text(text)
    with pytest.raises((LoadError, SceneError)) as caught:
        Scene.open(path)
    assert "\n" not in str(caught.value)


def test_missing_and_unwritable_files(tmp_path: Path) -> None:
    with pytest.raises(LoadError, match="No such file"):
        Scene.open(tmp_path / "none.sfumato")
    with pytest.raises(LoadError):
        Scene.open(tmp_path)
    with pytest.raises(SceneError, match="could not be written"):
        Scene().save(tmp_path / "no" / "such" / "folder.sfumato")


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers(-9, 9) | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=6,
)
FIELDS = st.sampled_from(
    ["transfer", "camera", "lights", "technique", "step", "background", "frames", "clip", "crop", "geometry"]
)


@given(st.dictionaries(FIELDS, JSON, max_size=3))
@settings(max_examples=60, deadline=None)
def test_any_json_is_a_scene_or_a_scene_error(data: dict[str, Any]) -> None:
    with contextlib.suppress(SceneError):  # and nothing else
        Scene.from_json({"sfumato": 1, **data})


@pytest.mark.parametrize(
    ("path", "text", "value"),
    [
        ("lights.0.tilt", "37", 37.0),
        ("step", "0.5", 0.5),
        ("lights.0.color", "[1, 0.5, 0]", (1.0, 0.5, 0.0)),
        ("lights.0.attached", "patient", "patient"),
        ("lights.0.name", "top", "top"),
        ("lights.0.enabled", "false", False),
        ("frames", "8", 8),
        ("technique", "slices", "slices"),
        ("technique.occlusion", "additive", "additive"),
    ],
)
def test_settings_from_text(path: str, text: str, value: Any) -> None:
    scene = Scene(technique="multidirectional")
    parsed = parse_setting(scene, path, text)
    assert parsed == value
    assert type(parsed) is type(value)
    scene.with_({path: parsed})


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("lights.0.tilt", "steep"),
        ("lights.7.tilt", "3"),
        ("no_such", "3"),
        ("frames", "1.5"),
        ("lights.0.enabled", "1"),
        ("volume", "x"),
    ],
)
def test_bad_settings_from_text(path: str, text: str) -> None:
    with pytest.raises(SceneError):
        parse_setting(Scene(), path, text)


def test_volumes_are_compared_by_content() -> None:
    a, b = (Volume(np.full((2, 3, 4), 7, dtype=np.int16)) for _ in range(2))
    assert a == b
    assert hash(a) == hash(b)
    assert a != Volume(a.data, spacing=(1, 1, 2))
    assert a != Volume(a.data + 1)
    assert not a.data.flags.writeable


@pytest.mark.parametrize(
    "data",
    [
        np.zeros((2, 2)),
        np.zeros((0, 2, 2)),
        np.array([["a"]]),
        np.full((2, 2, 2), np.nan),
        np.zeros((2, 2, 2), complex),
    ],
)
def test_arrays_that_are_no_volumes(data: np.ndarray) -> None:
    with pytest.raises(SceneError, match=r"volume\.data"):
        Volume(data)


def test_places_of_voxels() -> None:
    volume = Volume(
        np.zeros((4, 3, 2), np.uint8), spacing=(1, 2, 3), direction=((0, 1, 0), (1, 0, 0), (0, 0, 1))
    )
    assert volume.dims == (2, 3, 4)
    assert volume.origin == (0.5, 1, 1.5)
    first = volume.world_from_texture @ np.array([0.25, 1 / 6, 1 / 8, 1])
    np.testing.assert_allclose(first[:3], volume.origin)
    np.testing.assert_allclose(volume.texture_from_world @ volume.world_from_texture, np.eye(4), atol=1e-12)


def test_what_is_not_finite_becomes_the_smallest_value_and_is_told() -> None:
    data = np.ones((2, 2, 2), np.float64)
    data[0, 0, 0], data[1, 1, 1], data[0, 1, 0] = np.nan, -3, np.inf
    volume = Volume(data)
    assert volume.value_range == (-3, 1)
    assert volume.data[0, 0, 0] == volume.data[0, 1, 0] == -3
    assert "2 voxels" in volume.info.notices[0]
