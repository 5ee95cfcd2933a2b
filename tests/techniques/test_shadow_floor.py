"""The shadow floor: what lies in full shadow keeps exactly that share of its light, and nothing else changes."""

from __future__ import annotations

import json

import numpy as np
import pytest

import sfumato
from sfumato import Camera, Light, Scene, SceneError, TransferFunction, Volume
from sfumato.techniques import techniques

pytestmark = pytest.mark.gpu
N, FLOOR = 40, 0.3
SIZE = (40, 40)


@pytest.fixture(scope="module")
def scene() -> Scene:
    """A beam before a plate; the lamp from above shadows a band of the plate below the beam."""
    data = np.zeros((N, N, N), dtype=np.uint8)
    data[:, 32:, :] = 200
    data[22:26, 8:20, :] = 200
    white = TransferFunction.from_points([(90, (1, 1, 1), 0.0), (110, (1, 1, 1), 0.999)])
    camera = Camera((20.0, -150.0, 20.0), (20.0, 20.0, 20.0))
    lamp = Light(tilt=40.0, rotation=90.0, aperture=1.0)
    return Scene(volume=Volume(data), transfer=white, camera=camera, lights=(lamp,), step=0.5)


def drawn(scene: Scene) -> np.ndarray:
    return sfumato.render(scene, SIZE, linear=True)[..., 0]


#: Techniques that light by lamps' shadows from the start.
FLOORED = [
    "cone",
    "multidirectional",
    "directional",
    "extinction",
    "half-angle",
    pytest.param("reference", marks=pytest.mark.slow),
]
#: Techniques whose shadows of a nearly parallel lamp are black.
BLACK = ("cone", "multidirectional", "half-angle")


@pytest.mark.parametrize("technique", FLOORED)
def test_a_fully_shadowed_receiver_keeps_exactly_the_floor(scene: Scene, technique: str) -> None:
    start = scene.with_(technique=technique)
    if technique == "reference":
        start = start.with_(**{"technique.directions": 4})
    if hasattr(start.technique, "ambient"):
        start = start.with_(**{"technique.ambient": 0.0})
    plain, floored = drawn(start), drawn(start.with_(shadow_floor=FLOOR))
    # Where light falls unhindered: the same scene whose floor is all but 1.
    full = drawn(start.with_(shadow_floor=0.999999))
    plate = full > 0.3 * full.max()
    dark, bright = plate & (plain < 0.002 * full), plate & (plain > 0.7 * full)
    assert dark.sum() > 5 or technique not in BLACK, "there is a full shadow"
    assert bright.sum() > 50, "and light"
    np.testing.assert_allclose(floored[dark] / full[dark], FLOOR, atol=0.001)
    assert (floored[plate] >= (FLOOR - 0.001) * full[plate]).all()
    assert (floored[plate] >= 0.999 * plain[plate]).all()
    # What light reaches stays as it is, but for what lies within its own skin.
    np.testing.assert_allclose(floored[bright], plain[bright], rtol=0.07)


@pytest.mark.parametrize(
    "technique", [t.id for t in techniques().values() if not t.floor or t.id == "local-occlusion"]
)
def test_techniques_without_shadows_of_lamps_know_no_floor(scene: Scene, technique: str) -> None:
    start = scene.with_(technique=technique)
    np.testing.assert_array_equal(drawn(start), drawn(start.with_(shadow_floor=FLOOR)))


def test_it_is_kept_in_scenes_and_checked(scene: Scene) -> None:
    kept = scene.with_(shadow_floor=FLOOR)
    data = json.loads(json.dumps(kept.to_json()))
    assert data["shadow_floor"] == FLOOR
    assert Scene.from_json(data, scene.volume) == kept
    del data["shadow_floor"]
    assert Scene.from_json(data, scene.volume).shadow_floor == 0
    for wrong in (1.0, -0.1, float("nan")):
        with pytest.raises(SceneError, match="shadow_floor"):
            scene.with_(shadow_floor=wrong)
