"""Half-angle slicing: its geometry, and what its pictures have to agree with."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sfumato
from sfumato import Camera, ClipPlane, Light, Scene, TransferFunction, Volume
from sfumato.renderer import Renderer
from sfumato.techniques.half_angle.params import HalfAngleParams
from sfumato.techniques.half_angle.slices import LightGrid, Slices, half_vector

HARD = HalfAngleParams(softness=False)
BOX = Volume(np.zeros((2, 3, 4), np.uint8), spacing=(9, 8, 7)).corners()
directions = (
    st.tuples(*[st.floats(-1, 1)] * 3)
    .filter(lambda v: math.hypot(*v) > 0.1)
    .map(lambda v: np.array(v) / math.hypot(*v))
)

Draw = Callable[[Scene, int], np.ndarray]


# -- geometry -----------------------------------------------------------------------------------------
@given(directions, directions)
@settings(max_examples=50, deadline=None)
def test_the_half_vector_stands_evenly_between_both(back: np.ndarray, towards: np.ndarray) -> None:
    axis, reverse = half_vector(back, towards)
    assert np.linalg.norm(axis) == pytest.approx(1)
    assert reverse == (back @ towards < 0)
    assert axis @ towards == pytest.approx(abs(axis @ back))
    assert axis @ towards > math.cos(math.radians(45)) - 1e-9


@given(directions, st.floats(0, 0.999))
@settings(max_examples=40, deadline=None)
def test_sections_add_up_to_the_box(axis: np.ndarray, jitter: float) -> None:
    slices = Slices.through(axis, BOX, BOX, 0.25, jitter)
    corners = slices.triangles(BOX).reshape(slices.count, -1, 3, 3).astype(float)
    np.testing.assert_allclose(
        corners @ axis, np.broadcast_to(slices.heights[:, None, None], corners.shape[:3]), atol=1e-4
    )
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0]), axis=2
    )
    volume = areas.sum() * slices.spacing
    assert volume == pytest.approx(36 * 24 * 14, rel=0.03)


def test_slices_of_a_part_are_slices_of_the_whole() -> None:
    axis = np.array([0.6, 0.0, 0.8])
    whole = Slices.through(axis, BOX, BOX, 0.5, 0.3)
    part = Slices.through(axis, BOX, BOX * 0.5, 0.5, 0.3)
    assert 0 < part.count < whole.count
    assert all(np.abs(whole.heights - h).min() < 1e-9 for h in part.heights)


@given(directions, directions)
@settings(max_examples=40, deadline=None)
def test_a_texel_s_column_runs_along_the_light(back: np.ndarray, towards: np.ndarray) -> None:
    axis, reverse = half_vector(back, towards)
    right = np.cross(np.eye(3)[np.argmin(np.abs(back))], back)
    right /= np.linalg.norm(right)
    upright = np.array([right, np.cross(back, right), -back if reverse else back])
    grid = LightGrid.over(BOX, towards, upright, 0.7, (0.3, -0.4))
    np.testing.assert_allclose(grid.axes @ grid.axes.T, np.eye(2), atol=1e-9)
    np.testing.assert_allclose(grid.axes @ towards, 0, atol=1e-9)
    matrix, slope = grid.columns(axis)
    texel = np.array([5.5, 7.25, 1])
    for height in (-3.0, 11.0):
        point = matrix @ texel + slope * height
        assert point @ axis == pytest.approx(height)
        at = grid.coordinates_from_world @ np.append(point, 1) * grid.size
        np.testing.assert_allclose(at, texel[:2], atol=1e-6)
    inside = grid.coordinates_from_world @ np.column_stack([BOX, np.ones(8)]).T
    assert 0 < inside.min() < inside.max() < 1


# -- pictures -----------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def wall() -> Callable[..., Scene]:
    """Return a solid white wall that faces the viewer, perhaps with a block before it."""

    def scene(block: bool = False, **more: Any) -> Scene:
        data = np.zeros((32, 32, 32), np.uint8)
        data[:, 22:28] = 200
        if block:
            data[12:20, 4:8, 12:20] = 200
        volume = Volume(data)
        transfer = TransferFunction.from_points([(50, (1, 1, 1), 0), (150, (1, 1, 1), 0.9)])
        camera = Camera.fit(volume.corners(), parallel_projection=True, fill=1)
        return Scene(**{"volume": volume, "transfer": transfer, "camera": camera, "technique": HARD, **more})

    return scene


@pytest.mark.gpu
@pytest.mark.parametrize("tilt", [0, 37, 60])
@pytest.mark.parametrize("step", [0.5, 1.0])
def test_a_lit_wall_has_its_own_colour(
    tilt: float, step: float, wall: Callable[..., Scene], draw: Draw
) -> None:
    light = Light(tilt=tilt, aperture=5, intensity=0.5)
    middle = draw(wall(step=step, lights=[light], frames=4), 32)[12:20, 12:20]
    # The light's way and the eye's through a slab differ on a wall that slants: the rest of the error.
    assert middle[..., 0].mean() == pytest.approx(0.5, rel=0.04 if step < 1 else 0.2)
    assert middle[..., 3].min() > 0.99


@pytest.mark.gpu
def test_a_shadow_falls_away_from_the_light_and_can_be_cut_away(
    wall: Callable[..., Scene], draw: Draw
) -> None:
    lights = [Light(tilt=45, aperture=5, rotation=0)]
    # The block ends 14 to 18 mm before the wall: its shadow lies that far to the left.
    shadow, other = (slice(14, 18), slice(0, 3)), (slice(14, 18), slice(29, 32))
    picture = draw(wall(True, lights=lights), 32)[..., 0]
    assert picture[shadow].max() < 0.1
    assert picture[other].min() > 0.8
    clip = [ClipPlane((0, 15, 0), (0, 1, 0))]
    assert draw(wall(True, lights=lights, clip=clip), 32)[..., 0][shadow].min() > 0.8


@pytest.mark.gpu
def test_opacity_is_that_of_the_ray_caster(still: Callable[..., Scene], draw: Draw) -> None:
    expected = draw(still("raycast", frames=4), 48)
    for tilt in (40, 130):
        picture = draw(still("half-angle", tilt=tilt, frames=4), 48)
        assert np.abs(picture - expected)[..., 3].mean() < 0.01


@pytest.mark.gpu
def test_without_a_light_it_is_dark(still: Callable[..., Scene], draw: Draw) -> None:
    picture = draw(still("half-angle", lights=()), 24)
    assert picture[..., :3].max() == 0
    assert draw(still("half-angle", lights=(Light(enabled=False), Light())), 24)[..., :3].max() > 0.1


@pytest.mark.gpu
def test_soft_shadows_are_softer(wall: Callable[..., Scene], draw: Draw) -> None:
    lights = [Light(tilt=40, aperture=30, rotation=0)]
    hard, soft = (
        draw(wall(True, lights=lights, technique=HalfAngleParams(softness=s)), 32)[16, :, 0]
        for s in (False, True)
    )
    steepest = [np.abs(np.diff(row[2:12])).max() for row in (hard, soft)]
    assert steepest[1] < 0.8 * steepest[0]


@pytest.mark.gpu
def test_a_cancelled_frame_leaves_no_blending_behind(still: Callable[..., Scene]) -> None:
    renderer = Renderer()
    expected = renderer.begin(still("raycast"), (24, 24))
    list(expected.add_frame())
    cancelled = renderer.begin(still("half-angle"), (24, 24))
    next(iter(cancelled.add_frame()))
    again = renderer.begin(still("raycast"), (24, 24))
    list(again.add_frame())
    assert np.array_equal(again.picture(), expected.picture())
    with pytest.raises(sfumato.SceneError):
        cancelled.picture()
    renderer.close()
