"""Blocks of many resolutions and directions of rays (Hernell2007, 4.1-4.2), without a device."""

from __future__ import annotations

import numpy as np
import pytest

from sfumato import TransferFunction
from sfumato.colorimetry import cielab
from sfumato.techniques.local_occlusion.directions import SETS, directions, nearest_count, preferred
from sfumato.techniques.local_occlusion.levels import TEXELS, choose, errors, looks
from sfumato.techniques.local_occlusion.packing import NONE, pack, packed_voxels
from sfumato.techniques.local_occlusion.pyramid import EDGE, FINEST, LEVELS, build_pyramid

RAMP = TransferFunction.from_points([(100, (0, 0, 0), 0.0), (200, (1, 1, 1), 0.8)])


def noise(shape: tuple[int, int, int], dtype: type = np.uint8) -> np.ndarray:
    return np.random.default_rng(3).integers(0, np.iinfo(dtype).max, shape).astype(dtype)


@pytest.mark.parametrize("shape", [(32, 48, 16), (20, 17, 33)])
def test_levels_are_means(shape: tuple[int, int, int]) -> None:
    voxels = noise(shape, np.uint16)
    pyramid = build_pyramid(voxels)
    assert pyramid.grid == tuple(-(-n // EDGE) for n in shape)
    np.testing.assert_array_equal(pyramid.levels[FINEST][: shape[0], : shape[1], : shape[2]], voxels)
    for level in range(LEVELS):
        edge = EDGE >> level
        fine = pyramid.levels[FINEST]
        z, y, x = (n // edge for n in fine.shape)
        mean = fine.reshape(z, edge, y, edge, x, edge).mean(axis=(1, 3, 5))
        np.testing.assert_allclose(pyramid.levels[level], mean, atol=2.0)


def test_every_texel_of_a_packed_volume_is_found_both_ways() -> None:
    voxels = noise((64, 48, 80))
    pyramid = build_pyramid(voxels)
    levels = np.random.default_rng(4).choice([0, 1, 2, 3, 4, NONE], pyramid.grid).astype(np.uint8)
    packing = pack(levels)
    packed = packed_voxels(pyramid, packing)
    assert packed.shape[::-1] == packing.size
    for block in np.argwhere(levels != NONE):
        x, y, z, both = map(int, packing.index[tuple(block)])
        level, around = both & 255, tuple(slice(max(b - 1, 0), b + 2) for b in block)
        assert level == levels[tuple(block)]
        assert both >> 8 == levels[around].min()
        res = 1 << level
        expected = pyramid.levels[level][tuple(slice(b * res, (b + 1) * res) for b in block)]
        np.testing.assert_array_equal(packed[z : z + res, y : y + res, x : x + res], expected)
        # And back, as the shader does it.
        brick = packing.bricks[z // EDGE, y // EDGE, x // EDGE]
        sub, edge = np.array([x, y, z]) % EDGE >> level, EDGE >> level
        entry = packing.blocks[brick[1] + sub[0] + edge * (sub[1] + edge * sub[2])]
        assert brick[0] == level
        assert entry.tolist() == [*block[::-1], 1]
    assert packing.texels == TEXELS[levels[levels != NONE]].sum()


def test_nothing_to_pack_is_one_brick_that_holds_nothing() -> None:
    packing = pack(np.full((2, 2, 2), NONE, dtype=np.uint8))
    assert packing.size == (EDGE,) * 3
    assert (packing.bricks[..., 0] == NONE).all()


def test_significance_is_zero_where_the_transfer_function_is_flat() -> None:
    voxels = noise((16, 16, 48)) // 3  # all below the ramp: nothing is seen
    voxels[:, :, 16:32] = 100 + noise((16, 16, 16)) // 3  # on the ramp
    voxels[:, :, 32:] = 150  # on the ramp, but homogeneous
    error = errors(build_pyramid(voxels), np.arange(3), looks(RAMP, (0, 255)))
    assert not error[0].any()
    assert (error[1, :FINEST] > 10).all()
    assert not error[2].any()
    assert error[1, FINEST] == 0


def test_fewer_texels_go_where_they_matter_least() -> None:
    error = np.array([[100.0, 90, 60, 20, 0], [1.0, 0.9, 0.6, 0.2, 0], [0.0, 0, 0, 0, 0]])
    assert choose(error, 1e9, 0).tolist() == [4, 4, 0]
    assert choose(error, 1e9, 2).tolist() == [4, 4, 2]
    few = choose(error, 4096 + 600, 0)
    assert few[0] == 4
    assert few[1] < 4
    assert TEXELS[few].sum() <= 4696
    assert choose(error, 1, 1).tolist() == [1, 1, 1]


def test_cielab_of_known_colours() -> None:
    np.testing.assert_allclose(cielab(np.array([1.0, 1, 1])), [100, 0, 0], atol=1e-6)
    np.testing.assert_allclose(cielab(np.array([1.0, 0, 0])), [53.24, 80.09, 67.20], atol=0.05)


@pytest.mark.parametrize("count", list(SETS))
def test_directions_are_even(count: int) -> None:
    units, weights = directions(count)
    assert units.shape == (count, 3)
    np.testing.assert_allclose(np.linalg.norm(units, axis=1), 1)
    np.testing.assert_allclose(weights.mean(), 1)
    # Sums over them are integrals: of x, of x^2, of xy.
    np.testing.assert_allclose(weights @ units / count, 0, atol=1e-9)
    np.testing.assert_allclose((units.T * weights) @ units / count, np.eye(3) / 3, atol=1e-9)
    # The first four are already all around.
    assert np.linalg.norm(units[:4].mean(axis=0)) < 0.5


def test_a_preferred_direction_gets_more_and_the_sum_stays() -> None:
    units, weights = directions(32)
    towards = np.array([0.0, 0.0, 1.0])
    some = preferred(units, weights, towards, 1.0)
    np.testing.assert_allclose(some.mean(), 1)
    assert (some[units[:, 2] < 0] == 0).all()
    np.testing.assert_allclose(preferred(units, weights, towards, 0.0), weights)


def test_the_nearest_set_is_taken() -> None:
    assert [nearest_count(n) for n in (1, 5, 30, 100, 128, 512)] == [1, 4, 32, 80, 128, 512]
