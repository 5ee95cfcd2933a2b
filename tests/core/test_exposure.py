"""Exposure, white balance and tone curve: what they promise, on numbers and on pictures of every rig."""

from __future__ import annotations

import numpy as np
import pytest

import sfumato
from sfumato import Camera, Light, Scene, SceneError, TransferFunction, Volume
from sfumato.export.encode import bent, encode16, srgb
from sfumato.exposure import automatic_exposure, exposure_for
from sfumato.scene.rigs import rigs
from sfumato.scene.white import WHITE, balance_matrix, chromaticity, lamp_color, lamp_temperature


def flat(value: float) -> np.ndarray:
    """Return a picture of one grey, premultiplied by an opacity of a half."""
    return np.full((10, 10, 4), [value / 2, value / 2, value / 2, 0.5], dtype=np.float32)


def test_bright_parts_get_the_brightness_of_their_own_colour() -> None:
    assert exposure_for(flat(0.1), flat(0.4)) == pytest.approx(2.0)
    assert exposure_for(flat(0.8), flat(0.4)) == pytest.approx(-1.0)
    assert exposure_for(flat(0.38), flat(0.4)) == 0, "what nobody sees is left alone"
    assert exposure_for(flat(0.0), flat(0.4)) == 0, "no light is not too little"
    assert exposure_for(np.zeros((4, 4, 4), np.float32), np.zeros((4, 4, 4), np.float32)) == 0
    assert exposure_for(flat(1e-6), flat(0.4)) == 5, "there is an end to it"


@pytest.fixture(scope="module")
def ball() -> Scene:
    z, y, x = np.mgrid[0:32, 0:32, 0:32] * (2 / 31) - 1
    data = np.clip((0.7 - np.sqrt(x * x + y * y + z * z)) * 200, 0, 200).astype(np.int16)
    skin = TransferFunction.from_points([(20, (0.5, 0.4, 0.35), 0.0), (60, (0.5, 0.4, 0.35), 0.9)])
    camera = Camera((16.0, -80.0, 16.0), (16.0, 16.0, 16.0))
    return Scene(volume=Volume(data), transfer=skin, camera=camera, step=1.0)


@pytest.mark.gpu
@pytest.mark.parametrize("rig", list(rigs()))
def test_no_rig_is_too_dark(ball: Scene, rig: str) -> None:
    lit = ball.with_(lights=rigs()[rig].lights)
    exposed = lit.with_(exposure=automatic_exposure(lit))
    own = sfumato.render(ball.with_(technique="raycast"), (64, 64), linear=True)
    shown = own[..., 3] > 0.5
    picture = sfumato.render(exposed, (64, 64), linear=True) * 2.0**exposed.exposure
    bright = np.quantile(picture[shown, 1], 0.95) / np.quantile(own[shown, 1], 0.95)
    assert 0.75 < bright < 1.5, (rig, exposed.exposure)


# -- white -------------------------------------------------------------------------------------------
def test_a_black_body_has_the_colours_of_the_tables() -> None:
    # CIE 015: illuminant A is a black body of 2856 K at (0.4476, 0.4074).
    assert chromaticity(2856) == pytest.approx((0.4476, 0.4074), abs=0.0015)
    # Planck's law at 5000 and 10000 K (Wyszecki and Stiles 1982, table I(3.11)).
    assert chromaticity(5000) == pytest.approx((0.3451, 0.3516), abs=0.0015)
    assert chromaticity(10000) == pytest.approx((0.2807, 0.2884), abs=0.0015)


@pytest.mark.parametrize("kelvin", [1900, 2700, 4000, WHITE, 9000, 20000])
def test_the_balance_of_a_lamp_makes_its_light_grey(kelvin: float) -> None:
    color = lamp_color(kelvin)
    assert max(color) == 1
    assert lamp_temperature(color) == pytest.approx(kelvin, rel=0.01)
    grey = balance_matrix(kelvin) @ color
    assert np.ptp(grey) < (1e-9 if kelvin >= 1950 else 0.02)


def test_other_colours_are_of_no_temperature() -> None:
    assert lamp_temperature((0.1, 1.0, 0.1)) is None
    assert lamp_temperature((0.0, 0.0, 0.0)) is None
    np.testing.assert_array_equal(balance_matrix(WHITE), np.eye(3))


# -- the picture -------------------------------------------------------------------------------------
@pytest.mark.gpu
def test_the_picture_has_all_of_it(ball: Scene) -> None:
    """The GPU's 8 bits and the 16 of a print follow the same arithmetic, which a scene keeps."""
    warm = ball.with_(
        lights=(Light(color=lamp_color(2700), tilt=10.0, intensity=1.7),),
        exposure=0.6, white_balance=3200.0, tone_curve="soft",
    )  # fmt: skip
    linear, seen = sfumato.render(warm, (48, 48), linear=True), sfumato.render(warm, (48, 48))
    straight = linear[..., :3] / np.maximum(linear[..., 3:], 1e-9)
    balanced = straight @ (2**0.6 * balance_matrix(3200.0)).T
    wanted = 255 * srgb(np.clip(bent(balanced), 0, 1))
    shown = linear[..., 3] > 0.02
    assert balanced[shown].max() > 1, "something would be clipped"
    assert bent(balanced)[shown].max() < 1
    np.testing.assert_allclose(seen[shown, :3], wanted[shown], atol=1.01)
    print16 = encode16(linear, 0.6, 3200.0, "soft")
    np.testing.assert_allclose(print16[shown, :3] / 257, wanted[shown], atol=0.1)
    assert Scene.from_json(warm.to_json(), warm.volume) == warm
    old = {k: v for k, v in warm.to_json().items() if k not in ("white_balance", "tone_curve")}
    assert Scene.from_json(old, warm.volume) == warm.with_(white_balance=WHITE, tone_curve="clip")
    with pytest.raises(SceneError, match="tone_curve"):
        warm.with_(tone_curve="film")
    with pytest.raises(SceneError, match="white_balance"):
        warm.with_(white_balance=0.0)
