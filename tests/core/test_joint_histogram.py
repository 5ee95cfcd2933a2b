"""The joint histogram of values and gradient magnitudes, whose gradient is the renderer's."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import Scene, Volume
from sfumato.scene.joint_histogram import (
    BINS,
    JointHistogram,
    joint_histogram,
    known_histogram,
    sampled,
    steepest_possible,
)
from sfumato.scene.picking import value_gradient

SPACING = (0.5, 2.0, 1.5)


def ramp(dtype: type = np.float32) -> Volume:
    """Return values that grow by 30 per mm along x, 4 along y and 12 along z: 32.5576 per mm in all."""
    z, y, x = np.mgrid[0:20, 0:24, 0:28]
    data = 30 * SPACING[0] * x + 4 * SPACING[1] * y + 12 * SPACING[2] * z
    return Volume(data.astype(dtype), SPACING)


def of(volume: Volume) -> JointHistogram:
    counted = joint_histogram(volume)
    assert counted is not None
    return counted


@pytest.mark.parametrize("dtype", [np.float32, np.int16])
def test_a_ramp_lies_in_the_bin_of_its_slope(dtype: type) -> None:
    volume = ramp(dtype)
    slope = float(np.sqrt(30**2 + 4**2 + 12**2))
    counted = of(volume)
    inside = counted.counts[counted.bin_of(0, slope)[0]].sum()
    assert inside == 18 * 22 * 26, "all but the voxels at the faces"
    assert counted.counts.sum() == volume.data.size
    assert counted.steepest == pytest.approx(slope, rel=1e-5)
    # At a face the renderer reads the value at the face beyond it: half the slope is left across it.
    assert counted.counts[counted.bin_of(0, np.sqrt(15**2 + 4**2 + 12**2))[0]].sum() >= 2 * 18 * 22


def test_the_gradient_is_the_renderers() -> None:
    data = np.random.default_rng(5).integers(-200, 900, (7, 8, 9)).astype(np.int16)
    turned = ((0.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
    volume = Volume(data, SPACING, direction=turned)
    values, gradients = (np.concatenate(part) for part in zip(*sampled(volume), strict=True))
    z, y, x = np.mgrid[0:7, 0:8, 0:9]
    texture = (np.stack([x, y, z], axis=-1).reshape(-1, 3) + 0.5) / volume.dims
    matrix = volume.world_from_texture
    points = texture @ matrix[:3, :3].T + matrix[:3, 3]
    expected = np.linalg.norm(value_gradient(Scene(volume=volume), points), axis=1)
    np.testing.assert_allclose(gradients, expected, rtol=1e-5)
    np.testing.assert_array_equal(values, data.ravel())
    assert gradients.max() <= steepest_possible(volume)


def test_a_large_volume_is_thinned_but_not_its_gradient() -> None:
    volume = ramp()
    values, gradients = (np.concatenate(part) for part in zip(*sampled(volume, 500), strict=True))
    assert 200 < len(values) < 1000
    assert np.median(gradients) == pytest.approx(np.sqrt(30**2 + 4**2 + 12**2), rel=1e-5)


@pytest.mark.parametrize(
    "data",
    [
        np.full((4, 4, 4), 7, np.uint8),
        np.zeros((1, 1, 1), np.float32),
        np.array([[[0, 3]]], np.int16),
        np.where(np.arange(27).reshape(3, 3, 3) == 4, np.nan, np.arange(27).reshape(3, 3, 3)),
        np.linspace(-1e30, 1e30, 64, dtype=np.float32).reshape(4, 4, 4),
    ],
    ids=["constant", "one voxel", "two voxels", "NaN", "huge"],
)
def test_odd_volumes_have_a_sane_one(data: np.ndarray) -> None:
    counted = of(Volume(data))
    assert counted.counts.sum() == data.size
    assert counted.values[0] < counted.values[1]
    assert 0 == counted.gradients[0] < counted.gradients[1]
    assert np.isfinite(counted.heights).all()
    assert counted.heights.max() == pytest.approx(1)
    assert counted.counts.shape[1] <= BINS[0]
    assert 0 < counted.usual <= counted.gradients[1]
    assert counted.usual / counted.gradients[1] * counted.counts.shape[0] <= BINS[1] + 1


def test_whole_numbers_make_no_comb() -> None:
    data = np.random.default_rng(1).integers(0, 700, (40, 40, 40)).astype(np.int16)
    column = of(Volume(data)).counts.sum(axis=0)
    assert column[1:-2].min() > 0.7 * np.median(column)


def test_it_is_counted_once_for_each_content_and_can_be_stopped() -> None:
    volume = ramp()
    assert joint_histogram(Volume(np.ones((3, 3, 3))), stop=lambda: True) is None
    assert known_histogram(volume) is None
    counted = of(volume)
    assert known_histogram(ramp()) is counted, "volumes of one key share it"
