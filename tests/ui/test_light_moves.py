"""The dial's geometry."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sfumato import Light
from sfumato.scene import tilt_is_possible
from sfumato_ui import light_moves


@given(st.floats(0.5, 179.5), st.floats(0, 359.9))
def test_disc_and_angles_are_inverse(tilt: float, rotation: float) -> None:
    back = light_moves.from_disc(*light_moves.to_disc(tilt, rotation))
    assert back[0] == pytest.approx(tilt, abs=0.05 if 88 < tilt < 90 else 1e-4)
    assert math.cos(math.radians(back[1] - rotation)) == pytest.approx(1)


def test_top_left_is_top_left() -> None:
    x, y = light_moves.to_disc(37, 135)
    assert x < 0 < y


@given(st.floats(1, 80), st.floats(-3, 3), st.floats(-3, 3))
def test_a_moved_light_is_always_possible(aperture: float, dx: float, dy: float) -> None:
    moved = light_moves.moved(Light(tilt=0, aperture=aperture), dx, dy)
    assert tilt_is_possible(moved["tilt"], aperture)
    Light(aperture=aperture, **moved)


@given(st.floats(0, 89), st.booleans())
def test_largest_aperture_is_possible(tilt: float, rear: bool) -> None:
    tilt = 180 - tilt if rear else tilt
    aperture = light_moves.largest_aperture(tilt)
    if aperture > light_moves.MIN_APERTURE:
        Light(tilt=tilt, aperture=aperture)


def test_cone_outline_surrounds_the_lamp_at_its_aperture() -> None:
    light = Light(tilt=30, rotation=200, aperture=20)
    axis = light_moves.direction(30, 200)
    for place in light_moves.cone_outline(light):
        edge = light_moves.direction(*light_moves.from_disc(*place))
        assert math.degrees(math.acos(edge @ axis)) == pytest.approx(20, abs=0.01)
