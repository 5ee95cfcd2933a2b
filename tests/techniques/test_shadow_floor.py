"""The shadow floor: max(V, f) pixel by pixel, V being the share of its light that shadows leave; and the audit of V."""

from __future__ import annotations

import json

import numpy as np
import pytest

import sfumato
from sfumato import Camera, Light, Scene, SceneError, TransferFunction, Volume
from sfumato.audit import SHOWN, visibility
from sfumato.export.encode import srgb
from sfumato.renderer import renderer_of_this_thread
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


#: Techniques in which something can be in the way of light.
FLOORED = [
    "cone",
    "multidirectional",
    "directional",
    "extinction",
    "half-angle",
    "combined",
    "local-occlusion",
    pytest.param("reference", marks=pytest.mark.slow),
]
#: Techniques whose shadows of a nearly parallel lamp are black.
BLACK = ("cone", "multidirectional", "half-angle")


def both(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return the picture and the same without shadows, linear, shape (height, width, 4)."""
    renderer = renderer_of_this_thread()
    job = renderer.begin(scene, SIZE, audited=True)
    for _ in range(4 if scene.technique_id == "local-occlusion" else 1):
        for _ in job.add_frame():
            pass
    assert job._unshadowed is not None
    lit, full = job.linear(), job._mean(job._unshadowed)
    job.release()
    return lit, full


@pytest.mark.parametrize("technique", FLOORED)
def test_it_lifts_what_is_darker_and_nothing_else(scene: Scene, technique: str) -> None:
    start = scene.with_(technique=technique)
    if technique == "reference":
        start = start.with_(**{"technique.directions": 4})
    if hasattr(start.technique, "ambient"):
        start = start.with_(**{"technique.ambient": 0.0})
    plain, full = both(start)
    floored, again = both(start.with_(shadow_floor=FLOOR))
    np.testing.assert_array_equal(again, full)
    if technique != "local-occlusion":  # whose own light is around everything
        dark = (plain[..., 0] < 0.02 * full[..., 0]) & (full[..., 3] > 0.5)
        assert dark.sum() > 5 or technique not in BLACK, "there is a full shadow"
    assert (plain[..., 0] > 0.7 * full[..., 0]).sum() > 50, "and light"
    np.testing.assert_allclose(floored[..., 0], np.maximum(plain[..., 0], FLOOR * full[..., 0]), rtol=1e-6)
    shown = sfumato.render(start.with_(shadow_floor=FLOOR), SIZE)
    if technique != "local-occlusion":
        np.testing.assert_allclose(shown[..., 0], coded(floored), atol=1)


@pytest.mark.parametrize("technique", [t for t in FLOORED if t not in ("extinction", "local-occlusion")])
def test_without_shadows_a_wall_has_its_own_colour(scene: Scene, technique: str) -> None:
    """What shadows are measured by is the tissue's colour in the lamp's, however soft or slanting its surface is.

    Not so where lamps shade by the surface's slope (`extinction`) or are not all of the light (`local-occlusion`).
    """
    start = scene.with_(technique=technique)
    if technique == "reference":
        start = start.with_(**{"technique.directions": 4})
    _, full = both(start)
    own = drawn(start.with_(technique="raycast"))
    np.testing.assert_allclose(full[..., 0], own, atol=0.02)


@pytest.mark.parametrize("technique", [t.id for t in techniques().values() if not t.shadows])
def test_techniques_without_shadows_know_no_floor(scene: Scene, technique: str) -> None:
    start = scene.with_(technique=technique)
    np.testing.assert_array_equal(drawn(start), drawn(start.with_(shadow_floor=FLOOR)))


def coded(linear: np.ndarray) -> np.ndarray:
    """Return the red of a premultiplied picture as 8-bit sRGB."""
    return 255 * srgb(np.clip(linear[..., 0] / np.maximum(linear[..., 3], 1e-6), 0, 1))


# -- the audit ----------------------------------------------------------------------------------------
@pytest.mark.parametrize("technique", [t.id for t in techniques().values() if t.id != "reference"])
def test_an_audit_marks_what_is_darker_than_its_threshold(scene: Scene, technique: str) -> None:
    start = scene.with_(technique=technique)
    renderer = renderer_of_this_thread()
    job = renderer.begin(start, SIZE, audited=True)
    for _ in job.add_frame():
        pass
    found, all_of_it = job.audit(0.25), job.audit(1.0)
    lit, picture = job.linear(), job.picture()
    job.release()
    if not techniques()[technique].shadows:
        assert found.share == 0
        return
    _, full = both(start)
    shown = full[..., 3] >= SHOWN
    assert found.share <= all_of_it.share
    if technique != "local-occlusion":
        assert found.share == pytest.approx((visibility(lit, full) < 0.25)[shown].mean(), abs=1e-6)
    if technique in BLACK:
        assert found.share > 0.02, "the beam's shadow is found"
    colored = np.ptp(found.picture[..., :3].astype(int), axis=-1) > 0
    assert colored.sum() == round(found.share * shown.sum()), "the rest is grey"
    assert (found.picture[~colored, 3] == picture[~colored, 3]).all()
    # With a floor as high as the threshold nothing is left to be found.
    floored = renderer.begin(start.with_(shadow_floor=0.26), SIZE, audited=True)
    for _ in floored.add_frame():
        pass
    assert floored.audit(0.25).share == 0
    floored.release()


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
