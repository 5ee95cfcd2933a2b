"""Rigs as files: lamps come back, fit a volume of another size, and what is no rig is refused in a line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from sfumato import Light, LoadError, SceneError, Volume
from sfumato.scene.rig_files import fitted, load_rig, normalised, rig_from_json, rig_to_json, save_rig
from sfumato.scene.rigs import Rig

LAMPS = (
    Light(name="key", tilt=30.0, rotation=100.0, color=(1.0, 0.8, 0.6), intensity=0.7, solo=True),
    Light(kind="point", position=(40.0, 10.0, -5.0), radius=2.0, reach=30.0),
    Light(kind="spot", position=(0.0, 0.0, 90.0), direction=(0.0, 0.0, -1.0), spread=20.0),
    Light(kind="area", shape="rectangle", position=(9.0, 9.0, 9.0), size=(8.0, 4.0)),
)
SMALL = Volume(np.zeros((10, 20, 30), np.uint8))
#: Three times as large, and elsewhere.
LARGE = Volume(np.zeros((10, 20, 30), np.uint8), spacing=(3.0, 3.0, 3.0), origin=(5.0, -7.0, 100.0))


def test_they_come_back(tmp_path: Path) -> None:
    save_rig(tmp_path / "a.sfumato-rig", "My lamps", LAMPS, SMALL)
    rig = load_rig(tmp_path / "a.sfumato-rig")
    assert rig.title == "My lamps"
    back = fitted(rig.lights, SMALL)
    assert back[0] == Light(name="key", tilt=30.0, rotation=100.0, color=(1.0, 0.8, 0.6), intensity=0.7)
    for lamp, kept in zip(LAMPS[1:], back[1:], strict=True):
        assert kept.position == pytest.approx(lamp.position)
        assert kept.radius == pytest.approx(lamp.radius)
        assert kept.size == pytest.approx(lamp.size)
        assert kept.direction == lamp.direction
    assert back[1].reach == pytest.approx(30.0)
    assert [p.name for p in tmp_path.iterdir()] == ["a.sfumato-rig"], "nothing else is left"


def test_they_fit_a_volume_of_another_size() -> None:
    moved = fitted(normalised(LAMPS, SMALL), LARGE)
    for lamp, there in zip(LAMPS[1:], moved[1:], strict=True):
        way = np.asarray(lamp.position) - SMALL.center
        np.testing.assert_allclose(np.asarray(there.position) - LARGE.center, 3 * way)
        assert there.radius == pytest.approx(3 * lamp.radius)
    assert moved[0].tilt == 30.0


def test_what_is_no_rig_is_refused(tmp_path: Path) -> None:
    good = rig_to_json(load_saved(tmp_path))
    for change, words in (
        ({"sfumato-rig": 2}, "version 1"),
        ({"lights": []}, "1 to 16"),
        ({"lights": "all"}, "1 to 16"),
        ({"lights": [{"tilt": "low"}]}, "lights.0.tilt"),
        ({"lights": [{"tint": 3}]}, "tint"),
        ({"name": 7}, "text"),
    ):
        with pytest.raises(SceneError, match=words):
            rig_from_json({**good, **change})
    for text in ("", "[1, 2]", "{", json.dumps({"lights": []}), "[" * 5000):
        (tmp_path / "bad.sfumato-rig").write_text(text)
        with pytest.raises(LoadError, match="not a rig"):
            load_rig(tmp_path / "bad.sfumato-rig")
    with pytest.raises(LoadError, match="No such file"):
        load_rig(tmp_path / "none.sfumato-rig")


def load_saved(folder: Path) -> Rig:
    save_rig(folder / "good.sfumato-rig", "good", LAMPS, SMALL)
    return load_rig(folder / "good.sfumato-rig")
