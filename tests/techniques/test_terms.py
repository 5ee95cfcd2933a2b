"""Each light and each term by itself sum to the whole picture, for every technique."""

from __future__ import annotations

import numpy as np
import pytest

import sfumato
from sfumato import Light, Scene, SceneError, TransferFunction
from sfumato.scene import fields_of
from sfumato.techniques import techniques

pytestmark = pytest.mark.gpu

SIZE = (40, 32)
LIGHTS = (
    Light(tilt=40, rotation=135, color=(1, 0.8, 0.6)),
    Light(enabled=False, name="off"),
    Light(tilt=120, rotation=20, aperture=12, intensity=0.6, name="rim"),
)
GLOWING = TransferFunction.from_points(
    [(40, (0.9, 0.8, 0.7), 0.0), (120, (0.9, 0.8, 0.7), 0.4, (0.1, 0.0, 0.2)), (220, (0.9, 0.3, 0.2), 0.6)]
)


def scene_for(technique: str, volume: sfumato.Volume, **more: object) -> Scene:
    """A scene in which the technique has every term that it knows."""
    scene = Scene(volume=volume, transfer=GLOWING, technique=technique, lights=LIGHTS, frames=2, step=1.0)
    known = fields_of(type(scene.technique))
    some = {"ambient": 0.3, "specular": 0.4, "directions": 8}
    return scene.with_({f"technique.{k}": v for k, v in some.items() if k in known}).with_(more)


@pytest.mark.parametrize("technique", [i for i in techniques()])
def test_terms_sum_to_the_whole(technique: str, still_life: sfumato.Volume) -> None:
    scene = scene_for(technique, still_life, background=(0.2, 0.4, 0.1, 0.5))
    size = (12, 10) if technique == "reference" else SIZE
    terms = sfumato.render_terms(scene, size)
    whole = sfumato.render(scene, size, linear=True)
    alpha = terms.pop("alpha")
    behind = (1 - alpha[..., None]) * 0.5 * np.array([0.2, 0.4, 0.1])
    np.testing.assert_allclose(sum(terms.values()) + behind, whole[..., :3], atol=1e-4)
    np.testing.assert_allclose(alpha + (1 - alpha) * 0.5, whole[..., 3], atol=1e-6)
    for name, picture in terms.items():
        assert picture.shape == (*size[::-1], 3), name
        assert picture.min() > -1e-4, f"{name} takes light away"
        assert picture.max() > 1e-3, f"{name} is nothing"


def test_what_terms_there_are(still_life: sfumato.Volume) -> None:
    def names(technique: str) -> set[str]:
        return set(sfumato.render_terms(scene_for(technique, still_life), (8, 8)))

    lamps = {f"lights.{k}.{term}" for k in (0, 2) for term in ("diffuse", "specular", "ambient")}
    assert names("multidirectional") == {*lamps, "emission", "alpha"}
    lamps = {name for name in lamps if "ambient" not in name}
    assert names("raycast-phong") == {*lamps, "ambient", "emission", "alpha"}
    assert names("half-angle") == {"lights.0.diffuse", "emission", "alpha"}
    assert names("raycast") == {"ambient", "emission", "alpha"}


def test_without_light_only_the_opacity_is_left(still_life: sfumato.Volume) -> None:
    scene = Scene(volume=still_life, lights=())
    assert set(sfumato.render_terms(scene, (8, 8))) == {"alpha"}
    with pytest.raises(SceneError):
        sfumato.render_terms(Scene(), (8, 8))
