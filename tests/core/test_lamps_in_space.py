"""Lamps that stand somewhere: what a point gets of them, and what they may not be."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfumato import Camera, Light, Scene, SceneError
from sfumato.scene import MAX_LIGHTS, Param, TechniqueParams, fields_of, parse_setting
from sfumato.scene.lamps import arriving, beam, directions_towards, falloff, half_angles
from sfumato.scene.light import shining
from sfumato.scene.params import from_json, to_json
from sfumato.techniques import techniques

BASIS = Camera((0, -10, 0)).basis()
TARGET = (0.0, 0.0, 0.0)


def at(*points: tuple[float, float, float]) -> np.ndarray:
    return np.array(points, dtype=float)


@pytest.mark.parametrize("kind", ["point", "spot", "area"])
@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf, 1e30])
@pytest.mark.parametrize("field", ["position", "direction", "axis"])
def test_a_lamp_stands_and_points_somewhere(kind: str, field: str, wrong: float) -> None:
    with pytest.raises(SceneError, match=field) as caught:
        Light(kind=kind, **{field: (0.0, wrong, 0.0)})
    assert caught.value.path == f"{field}.1"
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "bad",
    [
        {"kind": "point", "radius": 0.0},
        {"kind": "point", "radius": math.inf},
        {"kind": "spot", "direction": (0.0, 0.0, 0.0)},
        {"kind": "spot", "direction": (1e-200, 0.0, 0.0)},
        {"kind": "spot", "spread": 90.0},
        {"kind": "spot", "edge": -1.0},
        {"kind": "area", "direction": (0.0, 0.0, 0.0)},
        {"kind": "area", "shape": "tube", "axis": (0.0, 0.0, 0.0)},
        {"kind": "area", "shape": "cube"},
        {"kind": "area", "size": (0.0, 1.0)},
        {"kind": "point", "reach": 0.0},
        {"kind": "point", "reach": math.nan},
        {"kind": "lantern"},
    ],
)
def test_impossible_lamps_are_refused_by_name(bad: dict[str, Any]) -> None:
    field = list(bad)[-1]
    with pytest.raises(SceneError) as caught:
        Light(**bad)
    assert caught.value.path.split(".")[0] == field


def test_what_a_lamp_does_not_use_may_be_anything() -> None:
    assert Light(kind="area", shape="sphere", direction=(0, 0, 0), axis=(0, 0, 0)).placed
    assert not Light(direction=(0, 0, 0)).placed


def test_a_ball_fills_the_cone_it_is_seen_under() -> None:
    for lamp in (Light(kind="point", radius=3), Light(kind="area", shape="sphere", radius=3)):
        angles = half_angles(lamp, at((6, 0, 0), (0, 300, 0), (0, 0, 1), (0, 0, 0)))
        np.testing.assert_allclose(angles, [30, math.degrees(math.asin(0.01)), 90, 90])
    np.testing.assert_allclose(half_angles(Light(aperture=20), at((1, 2, 3), (0, 0, 0))), 20)


def _solid_angle(surface: np.ndarray, normals: np.ndarray | None, area: float, point: np.ndarray) -> float:
    """Return the solid angle of small pieces of a surface, by summing; convex ones count from both sides."""
    away = surface - point
    far = np.linalg.norm(away, axis=1)
    assert normals is not None
    cosine = np.abs((away / far[:, None] * normals).sum(axis=1))
    return float((cosine / far**2).mean() * area)


@pytest.mark.parametrize("point", [(0.0, 90.0, 0.0), (60.0, 80.0, 0.0), (40.0, 70.0, 50.0)])
def test_surfaces_look_as_large_as_the_disc_they_are_taken_for(point: tuple[float, float, float]) -> None:
    """Explicit sums over the surface against the area of the cone."""
    rng = np.random.default_rng(3)
    u, v = rng.random((2, 20000))
    lamp = Light(kind="area", size=(8, 5), direction=(0, 1, 0), axis=(1, 0, 1))
    width, height = lamp.sides
    places = (u - 0.5)[:, None] * 8 * width + (v - 0.5)[:, None] * 5 * height
    normals = np.broadcast_to([0.0, 1.0, 0.0], places.shape)
    wanted = _solid_angle(places, normals, 40, np.array(point))
    got = 2 * math.pi * (1 - math.cos(math.radians(half_angles(lamp, at(point))[0])))
    assert got == pytest.approx(wanted, rel=0.02)

    tube = Light(kind="area", shape="tube", axis=(0, 0, 1), size=(12, 1), radius=0.5)
    turn = 2 * math.pi * u
    normals = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    places = 0.5 * normals + (v - 0.5)[:, None] * [0, 0, 12]
    # Half of the mantle hides the other half; one of the ends is seen.
    wanted = 0.5 * _solid_angle(places, normals, 2 * math.pi * 0.5 * 12, np.array(point))
    wanted += math.pi * 0.25 * abs(point[2]) / math.hypot(*point) ** 3
    got = 2 * math.pi * (1 - math.cos(math.radians(half_angles(tube, at(point))[0])))
    assert got == pytest.approx(wanted, rel=0.02)


def test_a_rectangle_is_nothing_edge_on_and_dark_behind() -> None:
    lamp = Light(kind="area", direction=(0, 2, 0), size=(10, 10))
    assert half_angles(lamp, at((50, 0, 0)))[0] == pytest.approx(0, abs=1e-6)
    np.testing.assert_allclose(beam(lamp, at((0, 5, 0), (0, -5, 0), (5, 5, 0))), [1, 0, math.sqrt(0.5)])


def test_sides_are_orthonormal_whatever_the_axis() -> None:
    for axis in ((1, 0, 0), (0, 3, 0), (0, 0, 0), (1, 1, 1)):
        lamp = Light(kind="area", direction=(0, 5, 0), axis=axis)
        frame = np.array([*lamp.sides, np.array(lamp.direction) / 5])
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(Light(kind="area", direction=(0, 5, 0), axis=(1, 1, 0)).sides[0], (1, 0, 0))


def test_light_halves_at_its_reach() -> None:
    lamp = Light(kind="point", position=(1, 0, 0), reach=4)
    np.testing.assert_allclose(falloff(lamp, at((1, 0, 0), (1, 4, 0), (1, 0, 12))), [1, 0.5, 0.1])
    np.testing.assert_allclose(falloff(Light(kind="point"), at((1e6, 0, 0))), 1)


def test_a_spot_is_full_inside_dark_outside_and_smooth_between() -> None:
    lamp = Light(kind="spot", direction=(0, 3, 0), spread=40, edge=10)
    turn = np.radians(np.linspace(0, 180, 722))
    points = 7 * np.stack([np.sin(turn), np.cos(turn), 0 * turn], axis=1)
    factor, degrees = beam(lamp, points), np.degrees(turn)
    np.testing.assert_allclose(factor[degrees <= 30], 1)
    np.testing.assert_allclose(factor[degrees >= 40 + 1e-9], 0, atol=1e-12)
    assert (np.diff(factor) <= 1e-12).all()
    assert np.abs(np.diff(factor)).max() < 0.06, "no step"
    hard = beam(Light(kind="spot", direction=(0, 3, 0), spread=40, edge=0), points)
    np.testing.assert_array_equal(hard > 0.5, degrees < 40)
    wide = beam(Light(kind="spot", direction=(0, 3, 0), spread=3, edge=60), points)
    assert wide[0] == 1, "an edge wider than the beam starts at its middle"


@given(st.tuples(*[st.floats(-1e3, 1e3)] * 3), st.sampled_from(["directional", "point", "spot", "area"]))
@settings(max_examples=60, deadline=None)
def test_directions_are_unit_vectors_and_shares_are_shares(
    point: tuple[float, float, float], kind: str
) -> None:
    lamp = Light(kind=kind, position=(1, 2, 3), reach=20)
    towards = directions_towards(lamp, at(point), BASIS, TARGET)[0]
    assert np.linalg.norm(towards) == pytest.approx(1)
    assert 0 <= arriving(lamp, at(point))[0] <= 1
    assert 0 <= half_angles(lamp, at(point))[0] <= 90
    if kind != "directional":
        away = np.subtract(lamp.position, point)
        assert np.linalg.norm(np.cross(away, towards)) < 1e-6 * max(1.0, float(np.linalg.norm(away)))


def test_a_technique_uses_its_first_lamps() -> None:
    lamps = tuple(Light(name=str(i), enabled=i != 1) for i in range(MAX_LIGHTS))
    for technique in techniques().values():
        scene = Scene(lights=lamps, technique=technique.id)
        names = [light.name for light in shining(lamps)]
        assert [light.name for light in scene.active_lights] == names[: technique.max_lights]
    assert [light.name for light in Scene(lights=lamps).active_lights] == ["0", "2", "3", "4"]
    with pytest.raises(SceneError, match="at most 16"):
        Scene(lights=lamps + lamps[:1])


def test_lamps_of_all_kinds_survive_a_file() -> None:
    lamps = (
        Light(kind="point", position=(1, 2, 3), radius=2, reach=50),
        Light(kind="spot", direction=(1, 0, 0), spread=20, edge=8),
        Light(kind="area", shape="tube", axis=(0, 0, 2), size=(30, 1)),
        Light(kind="area", shape="sphere", radius=7),
        Light(),
    )
    scene = Scene(lights=lamps)
    assert Scene.from_json(json.loads(json.dumps(scene.to_json()))) == scene


# -- parameters that may have no value --------------------------------------------------------------
@dataclass(frozen=True)
class Cone(TechniqueParams):
    angle: Annotated[float | None, Param("Angle", unit="deg", gt=0, lt=90, none_label="from lamp")] = None
    cells: Annotated[int | None, Param("Cells", ge=16, none_label="automatic")] = 32


def test_no_value_is_a_value() -> None:
    fields = fields_of(Cone)
    assert fields["angle"].optional
    assert (fields["angle"].kind, fields["cells"].kind) == (float, int)
    assert not fields_of(Light)["tilt"].optional
    for given_ in (Cone(), Cone(angle=12.5, cells=None), Cone(cells=64)):
        assert from_json(Cone, json.loads(json.dumps(to_json(given_)))) == given_
    for wrong in (0, 90, math.nan, "wide", True):
        with pytest.raises(SceneError, match=r"or none \(from lamp\)"):
            Cone(angle=wrong)  # type: ignore[arg-type]
    with pytest.raises(SceneError, match="whole"):
        Cone(cells=20.5)  # type: ignore[arg-type]


def test_none_is_a_word_on_the_command_line() -> None:
    scene = Scene(lights=(Light(kind="point", reach=4.0),))
    assert parse_setting(scene, "lights.0.reach", "none") is None
    assert parse_setting(scene, "lights.0.reach", "null") is None
    assert parse_setting(scene, "lights.0.reach", "12") == 12.0
    assert parse_setting(scene, "lights.0.name", "none") == "none"
    with pytest.raises(SceneError, match="none"):
        parse_setting(scene, "lights.0.reach", "far")
    with pytest.raises(SceneError):
        parse_setting(scene, "lights.0.radius", "none")
