"""Moving a light moves the shading: no step of a full orbit makes a picture, or a part of it, jump."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest

from sfumato import Scene
from sfumato.techniques import Technique, techniques

pytestmark = pytest.mark.gpu

LIT = [t for t in techniques().values() if t.lit and t.id != "directional"]
STEADY = [t for t in LIT if not t.orbit_pops]
POPPING = [t for t in LIT if t.orbit_pops]
SIDE, BLOCKS, STEPS = 64, 8, 24
#: What of the largest change over a step may still be there over a 32nd of it. A smooth change leaves a 32nd,
#: a jump all; voxels and slices make shading a little uneven.
LEFT_OVER = 0.35
#: Changes below this (of 1, linear) cannot be seen.
FLOOR = 2 / 255
HALVINGS = 5

Draw = Callable[[Scene, int], np.ndarray]
Means = Callable[[float], np.ndarray]


def block_means(picture: np.ndarray) -> np.ndarray:
    """Return the means of 8 x 8 blocks and, last, of the whole picture; shape (65, 3)."""
    blocks = min(BLOCKS, len(picture))
    parts = picture[..., :3].reshape(blocks, -1, blocks, picture.shape[1] // blocks, 3)
    return np.vstack([parts.mean(axis=(1, 3)).reshape(-1, 3), picture[..., :3].mean(axis=(0, 1))])


def change(a: np.ndarray, b: np.ndarray, part: int) -> float:
    return float(np.abs(a - b)[part].max())


def left_over(means: Means, low: float, high: float, part: int) -> float:
    """Return what is left of a part's change when the step is halved again and again, at the larger half."""
    ends = means(low), means(high)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        at = means(middle)
        if change(ends[0], at, part) >= change(at, ends[1], part):
            high, ends = middle, (ends[0], at)
        else:
            low, ends = middle, (at, ends[1])
    return change(*ends, part)


def assert_no_pop(means: Means, at: np.ndarray) -> None:
    """Check that the largest change of any block, and of the whole picture, is the sum of small ones."""
    seen = [means(x) for x in at]
    steps = np.abs(np.diff(seen, axis=0)).max(axis=2)
    blocks = steps[:, :-1]
    step, block = np.unravel_index(np.argmax(blocks), blocks.shape)
    whole = int(np.argmax(steps[:, -1]))
    for k, part in ((int(step), int(block)), (whole, steps.shape[1] - 1)):
        largest = float(steps[k, part])
        rest = left_over(means, at[k], at[k + 1], part)
        told = f"at {at[k]:.0f}..{at[k + 1]:.0f}: {rest:.3f} of {largest:.3f} at once"
        assert rest <= max(LEFT_OVER * largest, FLOOR), told


@pytest.mark.parametrize("technique", STEADY, ids=lambda t: t.id)
def test_orbit_has_no_pop(
    technique: Technique, still: Callable[..., Scene], draw: Draw, side_of: Callable[[str, int], int]
) -> None:
    side = side_of(technique.id, SIDE)
    steps = STEPS if side == SIDE else 6

    def means(rotation: float) -> np.ndarray:
        return block_means(draw(still(technique.id, tilt=50, rotation=rotation % 360, step=1.0), side))

    assert_no_pop(means, np.linspace(0, 360, steps + 1))


@pytest.mark.parametrize("technique", POPPING, ids=lambda t: t.id)
def test_the_picture_jumps_where_the_light_passes_beside_the_subject(
    technique: Technique, still: Callable[..., Scene], draw: Draw
) -> None:
    """Half-angle slices turn by 90 degrees there (Soltesova2010, section 5.1): what it is shown for."""

    def means(tilt: float) -> np.ndarray:
        # A surface that faces the viewer keeps its colour, however much the light grazes it; not wanted here.
        dimmed = 1 / (1 + 1 / abs(math.cos(math.radians(tilt))))
        scene = still(technique.id, tilt=tilt, aperture=0.2).with_({"lights.0.intensity": dimmed})
        return block_means(draw(scene, SIDE))

    seen = [means(tilt) for tilt in (89.1, 89.7, 90.3, 90.9)]
    before, jump, after = (np.abs(b - a).max() for a, b in itertools.pairwise(seen))
    assert jump > 2 * max(before, after)
    assert jump > 3 * FLOOR


def test_a_jump_is_found() -> None:
    def means(x: float) -> np.ndarray:
        return np.array([[x / 100, 0, 0], [0.3 if x > 7.3 else 0.0, 0, 0], [0, 0, 0]])

    with pytest.raises(AssertionError, match="at once"):
        assert_no_pop(means, np.linspace(0, 10, 11))
