"""Slices against volumes whose values are known at every point of the world."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sfumato import Volume, VolumeInfo
from sfumato.slicing import (
    CUTS,
    Cut,
    Frame,
    ValueWindow,
    cuts_of,
    first_point,
    fitting_scale,
    sample,
    step_along,
    value_at,
    windows_for,
)

KNOWN = VolumeInfo(orientation_known=True)
SLOPE, LEVEL = np.array([1.5, -2.0, 0.75]), 40.0
TURNS = {
    "straight": np.eye(3),
    "oblique": Rotation.from_euler("xyz", (20, -35, 50), degrees=True).as_matrix(),
    "mirrored": np.diag([-1.0, 1.0, -1.0]) @ Rotation.from_euler("z", 10, degrees=True).as_matrix(),
    "left-handed": np.diag([1.0, 1.0, -1.0]),
    "permuted": np.eye(3)[[2, 0, 1]],
}


def ramp(direction: np.ndarray, dtype: type = np.float32) -> Volume:
    """A volume whose value is a linear function of the world's place; anisotropic, somewhere in space."""
    spacing, origin = np.array([0.7, 1.1, 2.5]), np.array([-12.0, 30.0, 5.0])
    z, y, x = np.mgrid[0:14, 0:20, 0:24]
    places = origin + np.stack([x, y, z], axis=-1) @ (np.asarray(direction) * spacing).T
    return Volume(
        (places @ SLOPE + LEVEL).astype(dtype), tuple(spacing), tuple(origin), tuple(map(tuple, direction)), KNOWN
    )  # fmt: skip


@pytest.mark.parametrize("cut", CUTS, ids=lambda cut: cut.id)
@pytest.mark.parametrize("turn", TURNS)
def test_a_ramp_reads_back_exactly(turn: str, cut: Cut) -> None:
    volume = ramp(TURNS[turn])
    middle = np.add(volume.center, (0.3, -0.2, 0.4))
    frame = Frame(cut, tuple(middle), 0.31, 90, 70)
    values = sample(volume, frame)
    rows, columns = np.mgrid[0:70, 0:90]
    places = np.stack(
        [frame.point(x + 0.5, y + 0.5) for y, x in zip(rows.ravel(), columns.ravel(), strict=True)]
    )
    # Inside by half a voxel: the outermost half voxel is constant.
    matrix = volume.texture_from_world
    index = (places @ matrix[:3, :3].T + matrix[:3, 3]) * volume.dims - 0.5
    within = ((index >= 0) & (index <= np.array(volume.dims) - 1)).all(axis=1).reshape(70, 90)
    outside = ((index < -0.51) | (index > np.array(volume.dims) - 0.49)).any(axis=1).reshape(70, 90)
    assert within.sum() > 300
    expected = (places @ SLOPE + LEVEL).reshape(70, 90)
    assert np.abs(values - expected)[within].max() < 2e-4
    assert np.isnan(values[outside]).all()
    assert np.isfinite(values[within]).all()
    for k in np.flatnonzero(within.ravel())[::97]:
        assert value_at(volume, places[k]) == pytest.approx(expected.ravel()[k], abs=2e-4)
    assert np.isnan(value_at(volume, volume.corners().max(axis=0) + 5))


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint16, np.int8])
def test_whole_numbers_are_interpolated_between(dtype: type) -> None:
    data = np.arange(8, dtype=dtype)[:, None, None] * np.ones((8, 6, 6), dtype=dtype)
    volume = Volume(data, info=KNOWN)
    assert value_at(volume, (3.0, 3.0, 3.75)) == pytest.approx(3.25)


@pytest.mark.parametrize("turn", TURNS)
def test_the_patients_sides_are_where_the_letters_say(turn: str) -> None:
    towards = {
        "L": (1, 0, 0),
        "R": (-1, 0, 0),
        "P": (0, 1, 0),
        "A": (0, -1, 0),
        "S": (0, 0, 1),
        "I": (0, 0, -1),
    }
    volume = ramp(TURNS[turn])
    for cut in CUTS:
        x = {side: float(np.dot(cut.right, way)) for side, way in towards.items()}
        y = {side: float(np.dot(cut.up, way)) for side, way in towards.items()}
        letters = cut.letters
        assert x[letters["right"]] == 1
        assert x[letters["left"]] == -1
        assert y[letters["top"]] == 1
        assert y[letters["bottom"]] == -1
        # And the picture's values grow to the right as the world's do.
        values = sample(volume, Frame(cut, volume.center, 0.2, 9, 9))
        assert np.sign(values[4, 8] - values[4, 0]) == np.sign(np.dot(cut.right, SLOPE))
        assert np.sign(values[0, 4] - values[8, 4]) == np.sign(np.dot(cut.up, SLOPE))


def test_radiologists_sides() -> None:
    axial, coronal, sagittal = CUTS
    for cut in (axial, coronal):
        assert cut.letters["left"] == "R", "the patient's right is on the viewer's left"
    assert tuple(axial.back) == (0, 0, -1), "seen from the feet"
    assert tuple(coronal.back) == (0, -1, 0), "seen from the front"
    assert tuple(sagittal.back) == (1, 0, 0), "seen from the left"


def test_without_known_sides_slices_follow_the_array() -> None:
    turn = TURNS["oblique"]
    volume = Volume(ramp(turn).data, (0.7, 1.1, 2.5), direction=tuple(map(tuple, turn)))
    for cut, axis in zip(cuts_of(volume), (2, 1, 0), strict=True):
        assert abs(cut.back @ turn[:, axis]) == pytest.approx(1)
        assert not set(cut.letters.values()) & set("RLAPSI")
        assert step_along(volume, cut.back) == volume.spacing[axis]
        values = sample(volume, Frame(cut, first_point(volume), 0.05, 5, 5))
        assert np.isfinite(values).all()
    # The first row of the first slice is on top, its first column on the left.
    values = sample(volume, Frame(cuts_of(volume)[0], first_point(volume), 0.3, 99, 99))
    ys, xs = np.nonzero(np.isfinite(values))
    slice_ = volume.data[7]
    assert values[ys.min(), xs.min()] == pytest.approx(slice_[0, 0], abs=1.0)
    assert values[ys.max(), xs.min()] == pytest.approx(slice_[-1, 0], abs=1.0)


def test_a_frame_is_the_picture_of_its_camera() -> None:
    frame = Frame(CUTS[2], (3.0, 4.0, 5.0), 0.5, 40, 30)
    basis = frame.camera.basis()
    assert np.allclose([basis.right, basis.up, basis.back], frame.cut.axes)
    assert frame.camera.half_extent(40 / 30) == pytest.approx((10.0, 7.5))
    assert np.allclose(frame.point(20, 15), (3, 4, 5))
    assert np.allclose(frame.point(0, 0), (3, 4 - 10, 5 + 7.5))


def test_one_scale_fits_all_panes() -> None:
    volume = Volume(np.zeros((10, 20, 40), np.uint8), (1, 2, 3), info=KNOWN)  # 40 x 40 x 30 mm
    scale = fitting_scale(volume, [(cut, 100, 50) for cut in CUTS])
    assert scale == pytest.approx(40 / 50), "the axial slice's height decides"


@pytest.mark.parametrize("shape", [(1, 20, 30), (20, 1, 30), (20, 30, 1), (1, 1, 1)])
def test_a_single_layer_is_seen(shape: tuple[int, int, int]) -> None:
    volume = Volume(np.full(shape, 7, np.uint8), (1, 1, 4), info=KNOWN)
    for cut in CUTS:
        values = sample(volume, Frame(cut, first_point(volume), 0.5, 31, 31))
        assert values[15, 15] == 7
        assert set(np.unique(values[np.isfinite(values)])) == {7}
    assert all(named.window.width > 0 for named in windows_for(volume))


# -- window and level --------------------------------------------------------------------------------
def test_a_window_maps_its_ends_to_black_and_white() -> None:
    window = ValueWindow(40, 400)
    assert (window.low, window.high) == (-160, 240)
    grey = window.grey(np.array([-1000, -160, 40, 240, 3000, np.nan], np.float32))
    assert grey.tolist() == [0, 0, 128, 255, 255, 0]


def test_a_drag_widens_and_raises() -> None:
    window = ValueWindow(40, 400)
    assert window.dragged(1, 0).width == pytest.approx(400 * np.e)
    assert window.dragged(0, 0.5).level == 240
    assert window.dragged(1, 0).dragged(-1, 0) == window
    volume = Volume(np.arange(8, dtype=np.int16).reshape(2, 2, 2))
    assert window.dragged(-99, 0).limited(volume).width == 1
    assert np.isfinite(window.dragged(99, 99).limited(volume).level)


def ct(offset: int = 0) -> Volume:
    """Air, soft tissue and bone in Hounsfield units, stored with an offset."""
    rng = np.random.default_rng(1)
    data = np.full((24, 24, 24), -1000)
    data[4:20, 4:20, 4:20] = 45
    data[10:14, 10:14, 4:20] = 1200
    return Volume(
        (data + rng.integers(-8, 9, data.shape) + offset).astype(np.int16), info=VolumeInfo(modality="CT")
    )


@pytest.mark.parametrize("offset", [0, 1024])
def test_hounsfield_volumes_have_the_usual_windows(offset: int) -> None:
    windows = {named.name: named.window for named in windows_for(ct(offset))}
    assert list(windows) == ["Soft tissue", "Lung", "Bone", "Brain", "Automatic", "Whole range"]
    assert windows["Soft tissue"] == ValueWindow(40 + offset, 400)
    assert windows["Lung"].level == -600 + offset


def test_other_volumes_start_with_what_is_in_them() -> None:
    rng = np.random.default_rng(2)
    data = np.zeros((40, 40, 40), np.float32)
    data[::7, ::7, ::7] = rng.uniform(0.2, 0.8, data[::7, ::7, ::7].shape)  # one voxel in 343
    data[20, 20, 20] = 1e6
    (automatic, whole) = windows_for(Volume(data))
    assert (automatic.name, whole.name) == ("Automatic", "Whole range")
    assert 0.1 < automatic.window.low < 0.3
    assert 0.7 < automatic.window.high < 0.9
    assert whole.window.width == pytest.approx(1e6)
    assert windows_for(Volume(np.full((3, 3, 3), 5, np.uint8)))[0].window == ValueWindow(5, 1)


def test_a_mask_is_white_on_black() -> None:
    data = np.zeros((9, 9, 9), np.uint8)
    data[2:5] = 3
    assert windows_for(Volume(data))[0].window == ValueWindow(1.5, 3)
