"""The orientation cube: the right letters, turned as the camera is."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import Camera
from sfumato.export.orientation_cube import LEAST, NAMES, CubeInk, cube_pixels, face_at, faces
from sfumato.scene import STANDARD_VIEWS


def from_side(view: str, lean: float = 0.0) -> Camera:
    back, up = STANDARD_VIEWS[view]
    eye = 100 * np.asarray(back) + lean * np.asarray(up) + 0.5 * lean * np.cross(up, back)
    return Camera(position=tuple(map(float, eye)), focal_point=(0.0, 0.0, 0.0), view_up=up)


@pytest.mark.parametrize("view", STANDARD_VIEWS)
def test_a_standard_view_sees_its_own_face_alone(view: str) -> None:
    camera = from_side(view)
    (face,) = faces(camera)
    assert face.view == view
    assert face.facing == pytest.approx(1)
    np.testing.assert_allclose([face.right, face.up], [[face.right[0], 0], [0, face.right[0]]], atol=1e-12)
    assert face_at(camera, 0, 0) == view
    assert face_at(camera, 0.9, 0.9) == "", "beside the cube"


@pytest.mark.parametrize("view", STANDARD_VIEWS)
def test_letters_stand_upright_and_are_not_mirrored(view: str) -> None:
    """Of a face from the front, the letter is the same as of any other letter's face: it is drawn as it is read."""
    from PIL import Image, ImageDraw, ImageFont

    pixels = cube_pixels(from_side(view), 96)
    image = Image.new("L", (96, 96), 255)
    ImageDraw.Draw(image).text((48, 48), NAMES[view][0], 0, font=ImageFont.load_default(43), anchor="mm")
    wanted = 1 - np.asarray(image, float)[30:66, 30:66] / 255
    dark = 1 - pixels[30:66, 30:66, 0]

    def alike(other: np.ndarray) -> float:
        return float(np.corrcoef(dark.ravel(), other.ravel())[0, 1])

    assert alike(wanted) > 0.7
    if NAMES[view][0] in "RLP":
        assert alike(wanted) > alike(wanted[:, ::-1]) + 0.1
    if NAMES[view][0] in "RLPA":
        assert alike(wanted) > alike(wanted[::-1]) + 0.1


def test_three_faces_are_seen_from_a_corner_and_each_can_be_pressed() -> None:
    camera = from_side("front", lean=80)
    seen = faces(camera)
    assert {face.view for face in seen} == {"front", "top", "right"} or len(seen) == 3
    for face in seen:
        assert face_at(camera, *face.middle) == face.view
    corners = [f.middle + a * f.right + b * f.up for f in seen for a in (-1, 1) for b in (-1, 1)]
    assert np.abs(corners).max() < 1, "it stays within its square, however it is turned"


def test_nothing_is_drawn_beside_it_and_unknown_sides_have_other_names() -> None:
    camera = from_side("left")
    known, unknown = cube_pixels(camera, 64), cube_pixels(camera, 64, known=False)
    np.testing.assert_array_equal(known[..., 1], unknown[..., 1])
    assert np.abs(known - unknown).max() > 0.5
    assert known[0, :, 1].max() == 0
    assert known[32, 32, 1] == 1


def test_in_parts_it_is_the_same_and_a_small_picture_has_none() -> None:
    ink = CubeInk.for_picture(from_side("front", 60), (400, 300), dpi=150)
    assert ink is not None
    whole = np.zeros((300, 400, 4), np.uint16)
    ink.draw_on(whole, 0)
    parts = np.zeros_like(whole)
    for top in range(0, 300, 7):
        ink.draw_on(parts[top : top + 7], top)
    np.testing.assert_array_equal(whole, parts)
    assert whole[..., 3].max() == 65535
    assert CubeInk.for_picture(from_side("front"), (400, LEAST)) is None
