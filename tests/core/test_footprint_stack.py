"""The footprint's stencil, the sheared lattice and its tiles: exact where they say so."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfumato import Camera
from sfumato.reference import footprint as twin
from sfumato.techniques.footprint import (
    Stencil,
    cone_directions,
    effective_secant,
    kernel_moments,
    lit_surface,
    secants,
    slab_table,
    stencil_for,
)
from sfumato.techniques.stack import SHEAR_UNIT, Lattice, Stack, View
from sfumato.techniques.tiles import list_tiles

#: Tilt and aperture in degrees.
CONES = [(0, 20), (37, 20), (37, 1), (60, 25), (80, 9), (130, 20), (180, 60)]


def moments_of(stencil: Stencil) -> np.ndarray:
    """Return (sum, xx, xy, yy) of a stencil's weights."""
    taps = np.array(stencil.taps, dtype=float)
    weights = np.array(stencil.weights)
    second = [2 * (weights * taps[:, a] * taps[:, b]).sum() for a, b in ((0, 0), (0, 1), (1, 1))]
    return np.array([stencil.center + 2 * weights.sum(), *second])


@given(st.floats(1e-6, 60), st.floats(1e-6, 60), st.floats(0, math.pi))
@settings(max_examples=150, deadline=None)
def test_stencils_have_exactly_the_covariance_asked_for(along: float, across: float, turn: float) -> None:
    c, s = math.cos(turn), math.sin(turn)
    wanted = along * c * c + across * s * s, (along - across) * c * s, along * s * s + across * c * c
    stencil = stencil_for(*wanted)
    assert stencil.center >= 0
    assert min(stencil.weights) >= 0
    np.testing.assert_allclose(moments_of(stencil), (1, *wanted), rtol=1e-6, atol=1e-7)


def test_no_blur_is_the_texel_itself() -> None:
    stencil = stencil_for(0, 0, 0)
    assert stencil.center == pytest.approx(1)
    assert sum(stencil.weights) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(("tilt", "aperture"), CONES)
@pytest.mark.parametrize("falloff", ["linear", "gaussian"])
def test_moments_are_those_of_the_kernel_on_a_fine_grid(tilt: float, aperture: float, falloff: str) -> None:
    moments = kernel_moments(tilt, aperture, falloff)
    shape = twin.ellipse(180 - tilt if tilt > 90 else tilt, aperture)
    u, v = np.meshgrid(np.linspace(-1, 1, 801), np.linspace(-1, 1, 801))
    x, y = shape.C + u * shape.A, v * shape.B
    k = twin.larger_root(x, y, shape)
    weight = np.where(k <= 1, 1 - k if falloff == "linear" else np.exp(-(k**2) / (2 / 9)), 0)
    weight /= weight.sum()
    mean = (weight * x).sum()
    assert moments.mean == pytest.approx(mean, rel=2e-3, abs=1e-4)
    assert moments.along == pytest.approx((weight * (x - mean) ** 2).sum(), rel=1e-2)
    assert moments.across == pytest.approx((weight * y**2).sum(), rel=1e-2)


def test_the_paper_s_centroid() -> None:
    assert kernel_moments(37, 20).mean == pytest.approx(0.881, abs=0.002)


@pytest.mark.parametrize(("tilt", "aperture"), CONES)
def test_directions_are_uniform_in_the_cone(tilt: float, aperture: float) -> None:
    directions = cone_directions(tilt, aperture, 4000)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    axis = np.array([math.sin(math.radians(tilt)), 0, math.cos(math.radians(tilt))])
    cosine = directions @ axis
    edge = math.cos(math.radians(aperture))
    assert cosine.min() >= edge - 1e-9
    # Uniform in solid angle is uniform in the cosine.
    assert cosine.mean() == pytest.approx((1 + edge) / 2, abs=1e-3 * (1 - edge) + 1e-6)


@pytest.mark.parametrize(("tilt", "aperture"), [c for c in CONES if c[0] < 90])
def test_a_solid_wall_is_equally_bright_however_finely_it_is_cut(tilt: float, aperture: float) -> None:
    table = slab_table(((tilt, aperture),), 1.5)[0, :, 0]
    secant = effective_secant(tilt, aperture)
    assert lit_surface(tilt, aperture) == pytest.approx(np.mean(1 / (1 + secants(tilt, aperture))))
    assert table[-1] == pytest.approx(1, abs=1e-3)
    for depth in (0.05, 0.3, 2.0):
        returned = np.interp(1 - math.exp(-depth), np.linspace(0, 1, len(table)), table)
        total = returned / (1 - math.exp(-depth * (1 + secant)))
        assert total == pytest.approx(1, abs=0.05)


def a_stack(step: float = 0.7, jitter: float = 0.3) -> tuple[Stack, np.ndarray]:
    corners = np.array([[x, y, z] for x in (0, 40) for y in (0, 30) for z in (0, 20)], dtype=float)
    camera = Camera((70, -90, 50), (20, 15, 10))
    return Stack.through(View.of(camera), corners, step, jitter), corners


@given(st.floats(0.1, 3), st.floats(0, 0.999))
@settings(max_examples=40, deadline=None)
def test_slabs_cover_the_box(step: float, jitter: float) -> None:
    stack, corners = a_stack(step, jitter)
    depth = stack.view.coordinates(corners)[:, 2]
    assert depth.min() - step <= stack.z0 <= depth.min()
    assert stack.depth(stack.count) >= depth.max() - 1e-9
    assert stack.depth(stack.count - 1) < depth.max()
    assert stack.slabs_of(depth.min(), depth.max()) == (
        stack.slabs_of(depth.min(), depth.min())[0],
        stack.count,
    )


lattices = st.builds(
    lambda mean, rotation, rear, texel: Lattice.over(
        a_stack()[0], texel, mean, rotation, rear, (0.2, -0.3), 2
    ),
    st.floats(0, 6),
    st.floats(0, 360),
    st.booleans(),
    st.floats(0.2, 2),
)


@given(lattices, st.integers(0, 5000))
@settings(max_examples=60, deadline=None)
def test_columns_are_carried_exactly(lattice: Lattice, plane: int) -> None:
    base, carried = lattice.base(plane), lattice.carried(plane)
    assert ((carried >= 0) & (carried < 1)).all()
    # Whole and fraction together are the shear, with no rounding at all.
    assert [int(b) * SHEAR_UNIT + round(c * SHEAR_UNIT) for b, c in zip(base, carried, strict=True)] == [
        plane * s for s in lattice.shear
    ]


@given(lattices, st.integers(0, 60))
@settings(max_examples=40, deadline=None)
def test_a_column_runs_straight_along_the_centroid(lattice: Lattice, plane: int) -> None:
    base = lattice.base(plane)
    texel = np.array([3.5, 4.5, 1])
    ends = [lattice.positions(k, base) @ texel for k in (plane, plane + 1)]
    slope = (ends[1] - ends[0]) / lattice.texel
    np.testing.assert_allclose(slope[:2], -np.asarray(lattice.shear) / SHEAR_UNIT, atol=1e-9)
    assert ends[1][2] - ends[0][2] == pytest.approx(lattice.stack.step)
    # The same column, counted on the next plane, lies at the same place.
    moved = texel + np.append(base - lattice.base(plane + 1), 0)
    np.testing.assert_allclose(
        lattice.positions(plane + 1, lattice.base(plane + 1)) @ moved, ends[1], atol=1e-9
    )


@given(lattices, st.integers(0, 2**32 - 1))
@settings(max_examples=30, deadline=None)
def test_full_tiles_cover_every_visible_block(lattice: Lattice, seed: int) -> None:
    random, stack = np.random.default_rng(seed), lattice.stack
    far = stack.depth(stack.count)
    low, high = np.append(stack.low, stack.z0 + stack.step), np.append(stack.high, far)
    half = np.array([1.5, 1.0, 2.0])
    centers = random.uniform(low + half, high - half, (5, 3))
    tiles = list_tiles(lattice, [(centers, half)], 0.1, 1)
    for _ in range(40):
        point = random.choice(centers) + random.uniform(-half, half)
        slab = int((point[2] - stack.z0) // stack.step)
        plane = slab + lattice.rear
        column = (point[:2] - lattice.origin) / lattice.texel + np.asarray(lattice.shear) * plane / SHEAR_UNIT
        tile = np.floor((column - tiles.low) / tiles.tiling.edge).astype(int)
        (first, count), _hollow = tiles.of_slab(slab)
        runs = tiles.tiles[first : first + count].astype(int)
        covered = (runs[:, 1] == tile[1]) & (runs[:, 0] <= tile[0]) & (tile[0] < runs[:, 0] + runs[:, 2])
        assert covered.any()
    assert len(tiles.kinds[0]) == stack.count // tiles.tiling.group + 1


def test_no_visible_block_no_tile() -> None:
    lattice = Lattice.over(a_stack()[0], 1.0, 0.8, 135, False, (0, 0), 1)
    tiles = list_tiles(lattice, [(np.empty((0, 3)), np.ones(3))], 0.1, 0)
    assert len(tiles.tiles) == 0
