"""Moves of the camera: what the hand does is what the picture does."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sfumato import Camera, Scene, Volume, VolumeInfo
from sfumato.scene import STANDARD_VIEWS
from sfumato_ui import camera_moves

START = Camera(position=(10.0, -500.0, 5.0), focal_point=(10.0, 20.0, 5.0))


def project(camera: Camera, point: tuple[float, float, float]) -> tuple[float, float]:
    """Return where a point lies, in picture heights from the centre."""
    basis = camera.basis()
    arm = np.subtract(point, camera.position)
    depth = float(arm @ np.asarray(basis.forward))
    half = camera.half_extent(1.0)[1]
    scale = 1.0 if camera.parallel_projection else depth
    return tuple(float(arm @ np.asarray(axis)) / (2 * half * scale) for axis in (basis.right, basis.up))  # type: ignore[return-value]


def test_dragging_right_turns_the_front_to_the_right() -> None:
    nose = (10.0, -80.0, 5.0)
    assert project(camera_moves.orbit(START, 20, 0), nose)[0] > 0.01


def test_dragging_down_looks_from_above() -> None:
    assert camera_moves.orbit(START, 0, 30).position[2] > START.position[2]


@given(st.lists(st.tuples(st.floats(-200, 200), st.floats(-200, 200)), max_size=6))
def test_orbit_keeps_distance_and_never_flips(moves: list[tuple[float, float]]) -> None:
    camera = START
    for azimuth, elevation in moves:
        camera = camera_moves.orbit(camera, azimuth, elevation)
    assert camera.distance == pytest.approx(START.distance)
    assert camera.basis().up[2] > 0


@pytest.mark.parametrize("parallel", [False, True])
def test_pan_moves_the_subject_with_the_hand(parallel: bool) -> None:
    start = camera_moves.with_projection(START, parallel)
    moved = camera_moves.pan(start, 0.2, -0.1)
    assert project(moved, START.focal_point) == pytest.approx((0.2, -0.1))


@pytest.mark.parametrize("parallel", [False, True])
def test_zoom_keeps_what_is_under_the_cursor(parallel: bool) -> None:
    start = camera_moves.with_projection(START, parallel)
    under = project(start, (70.0, 20.0, 45.0))
    closer = camera_moves.zoom(start, 1.7, *under)
    assert project(closer, (70.0, 20.0, 45.0)) == pytest.approx(under)
    assert camera_moves.picture_half_height(closer) == pytest.approx(
        camera_moves.picture_half_height(start) / 1.7
    )


def test_zoom_stays_within_bounds() -> None:
    camera = START
    for _ in range(200):
        camera = camera_moves.zoom(camera, 1.5, size=100.0)
    assert camera_moves.picture_half_height(camera) == pytest.approx(camera_moves.NEAREST * 100)


def test_lens_and_projection_keep_the_size() -> None:
    half = camera_moves.picture_half_height(START)
    for camera in (
        camera_moves.with_lens(START, 70),
        camera_moves.with_projection(START, True),
        camera_moves.with_projection(camera_moves.with_projection(START, True), False),
    ):
        assert camera_moves.picture_half_height(camera) == pytest.approx(half)


@pytest.mark.parametrize("view", STANDARD_VIEWS)
def test_views_and_letters(view: str) -> None:
    letters = camera_moves.edge_letters(camera_moves.from_side(START, view))
    expected = {
        "front": "LRSI",
        "back": "RLSI",
        "left": "PASI",
        "right": "APSI",
        "top": "RLAP",
        "bottom": "LRAP",
    }[view]
    assert "".join(letters[edge] for edge in ("right", "left", "top", "bottom")) == expected


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("view", ["", *STANDARD_VIEWS])
def test_the_whole_is_seen_from_every_side_in_every_picture(view: str, parallel: bool) -> None:
    data = np.zeros((20, 30, 60), np.uint8)
    data[2:-2, 2:-2, 2:-2] = 200
    volume = Volume(data, info=VolumeInfo(orientation_known=True))
    tilted = camera_moves.orbit(camera_moves.with_lens(START, 60), 33, 21)
    scene = Scene(volume=volume, camera=camera_moves.with_projection(tilted, parallel))
    for aspect in (0.5, 1.0, 2.0):
        camera = camera_moves.whole_view(scene, aspect, view)
        assert camera is not None
        assert camera.parallel_projection is parallel
        basis, half = camera.basis(), camera.half_extent(aspect)
        corners = volume.corners() * 0.8 + np.mean(volume.corners(), axis=0) * 0.2
        seen = corners - camera.position
        depth = 1.0 if parallel else seen @ basis.forward
        spans = [
            np.abs(seen @ a / depth).max() / h for a, h in zip((basis.right, basis.up), half, strict=True)
        ]
        assert 0.6 < max(spans) < 0.95
