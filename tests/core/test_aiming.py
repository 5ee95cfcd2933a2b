"""Lamps that are solved for: their shadow, or highlight, lies where it was wanted; by geometry and by `reference`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sfumato
from sfumato import Camera, Light, Scene, TransferFunction, Volume
from sfumato.reference import cone
from sfumato.reference.medium import Medium
from sfumato.scene.aiming import (
    LIT,
    aimed,
    direction_in_effect,
    highlight_direction,
    lit_place,
    shadow_direction,
    shadow_ends,
)
from sfumato.scene.picking import surface_under, transmittance_between, value_gradient

N = 48
SKIN = (0.9, 0.85, 0.8)


@pytest.fixture(scope="module")
def scene() -> Scene:
    """A ball before a plate that faces the eye."""
    z, y, x = np.mgrid[0:N, 0:N, 0:N] * (2 / (N - 1)) - 1
    data = np.clip((0.3 - np.sqrt(x * x + (y + 0.4) ** 2 + z * z)) * N * 20, 0, 200).astype(np.int16)
    data[:, int(0.85 * N) :, :] = 200
    look = TransferFunction.from_points([(20, SKIN, 0.0), (120, SKIN, 0.9)])
    camera = Camera((N / 2, -120.0, N / 2), (N / 2, N / 2, N / 2))
    return Scene(volume=Volume(data), transfer=look, camera=camera)


def solve(scene: Scene, caster: np.ndarray, place: np.ndarray) -> tuple[Scene, float]:
    """Return the scene whose first lamp was solved for, and how far off it is in degrees."""
    towards = shadow_direction(scene, caster, place)
    assert towards is not None
    found = aimed(scene, scene.lights[0], towards, place, caster)
    return scene.with_({f"lights.0.{name}": value for name, value in found.fields.items()}), found.off


CASTER, PLACE = np.array([24.0, 8.0, 24.0]), np.array([36.0, 40.5, 30.0])
WANTED = (CASTER - PLACE) / np.linalg.norm(CASTER - PLACE)


@pytest.mark.parametrize("attached", ["viewer", "patient"])
def test_a_parallel_lamp_takes_the_direction(scene: Scene, attached: str) -> None:
    start = scene.with_(lights=(Light(attached=attached, intensity=0.7, aperture=11.0),))
    lit, off = solve(start, CASTER, PLACE)
    assert off < 1e-4
    np.testing.assert_allclose(direction_in_effect(lit, lit.lights[0], PLACE), WANTED, atol=1e-9)
    assert replace(lit.lights[0], tilt=37.0, rotation=135.0) == start.lights[0], "nothing else changes"


@pytest.mark.parametrize("technique", ["extinction", "cone"])
@pytest.mark.parametrize("kind", ["point", "spot"])
def test_a_lamp_with_a_place_keeps_its_distance(scene: Scene, kind: str, technique: str) -> None:
    lamp = Light(kind=kind, position=(90.0, -30.0, 60.0), direction=(0.0, 0.0, 1.0))
    lit, off = solve(scene.with_(lights=(lamp,), technique=technique), CASTER, PLACE)
    assert off < 1e-4
    moved = lit.lights[0]
    # What knows lamps in space is lit from beyond the caster, other techniques from a side of the subject.
    pivot = CASTER if technique == "extinction" else np.asarray(lit.volume.center)  # type: ignore[union-attr]
    before = np.linalg.norm(np.asarray(lamp.position) - pivot)
    np.testing.assert_allclose(np.asarray(moved.position), pivot + before * WANTED, atol=1e-9)
    if kind == "spot":
        np.testing.assert_allclose(moved.direction, -WANTED, atol=1e-9)


def test_where_no_lamp_can_the_nearest_is_taken(scene: Scene) -> None:
    for tilt in np.linspace(60, 120, 13):
        # The shadow beside the ball, at nearly the same depth: light from beside the subject.
        towards = np.array([np.sin(np.radians(tilt)), -np.cos(np.radians(tilt)), 0.0])
        lit, off = solve(scene, CASTER, CASTER - 15 * towards)
        edge = 69.0 if tilt <= 90 else 111.0
        inside = 69 < tilt < 111
        assert lit.lights[0].tilt == pytest.approx(edge if inside else tilt, abs=1e-6)
        assert off == pytest.approx(abs(tilt - edge) if inside else 0.0, abs=1e-4)


def test_points_too_near_give_no_direction(scene: Scene) -> None:
    assert shadow_direction(scene, CASTER, CASTER + 0.5) is None


def test_what_is_seen_of_a_soft_surface_lies_before_its_half(scene: Scene) -> None:
    """Depth d below a surface of extinction e comes to the eye by exp(-e d (1 + s)), s the light's secant."""
    data = np.zeros((N, N, N), dtype=np.int16)
    data[:, N // 2 :, :] = 100
    fog = TransferFunction.from_points([(40, SKIN, 0.0), (60, SKIN, 0.5)])
    soft = Scene(volume=Volume(data), transfer=fog, camera=replace(scene.camera, parallel_projection=True))
    half = surface_under(soft, 0.1, 0.2, 1.0)
    assert half is not None
    before = 0.8 * (half[1] - N / 2)
    for tilt in (0.0, 60.0, 80.0):
        towards = np.array([np.sin(np.radians(tilt)), -np.cos(np.radians(tilt)), 0.0])
        found = lit_place(soft, 0.1, 0.2, 1.0, towards)
        assert found is not None
        assert half[::2] == pytest.approx(found.point[::2]), "it lies on the eye's ray"
        assert found.point[1] - N / 2 < before, "the more the light grazes it, the nearer to the front"
        before = found.point[1] - N / 2
        assert found.share > LIT or tilt > 60
    away = lit_place(soft, 0.1, 0.2, 1.0, np.array([0.0, 1.0, 0.0]))
    assert away is not None
    assert away.share < LIT, "it turns away"


def test_the_gradient_is_that_of_the_renderers(scene: Scene) -> None:
    volume = Volume(np.fromfunction(lambda z, y, x: 3 * z + 2 * y - x, (9, 9, 9)), spacing=(2.0, 1.0, 0.5))
    slope = value_gradient(Scene(volume=volume), np.array([[8.0, 4.0, 2.0]]))[0]
    np.testing.assert_allclose(slope, (-0.5, 2.0, 6.0), atol=1e-6)


def test_a_highlight_lies_where_it_is_wanted(scene: Scene) -> None:
    glossy = scene.with_(technique="raycast-phong").with_(
        {
            "technique.specular": 1.0,
            "technique.diffuse": 0.0,
            "technique.ambient": 0.0,
            "technique.shininess": 200.0,
        }
    )
    for x, y in ((0.03, 0.05), (-0.05, 0.02), (0.0, -0.06)):
        place = surface_under(glossy, x, y, 1.0)
        assert place is not None
        towards = highlight_direction(glossy, np.asarray(place))
        assert towards is not None
        found = aimed(glossy, glossy.lights[0], towards, np.asarray(place), np.asarray(place))
        assert found.off < 1e-4
        lit = glossy.with_({f"lights.0.{k}": v for k, v in found.fields.items()})
        picture = sfumato.render(lit, (256, 256), linear=True)[..., :3].sum(axis=2)
        rows, columns = np.mgrid[0:256, 0:256]
        ball = np.hypot(columns - 127.5, rows - 127.5) < 24
        weight = np.where(ball & (picture > 0.7 * picture[ball].max()), picture, 0)
        spot = np.array([(weight * columns).sum(), (weight * rows).sum()]) / weight.sum()
        wanted = np.array([(x + 1) * 128 - 0.5, (1 - y) * 128 - 0.5])
        assert np.linalg.norm(spot - wanted) < 3, (x, y)


# -- by `reference`: where the shadow of a small occluder truly falls ---------------------------------
#: Side of the picture whose pixels count, and of the part around the cursor that is drawn.
SIDE, PART = 512, 7
#: Side of the part around the cursor in which an ideal speck's shadow is looked for.
AROUND = 25
#: Cosine of the angle to the sight from which on a lamp can shine: 69 degrees, and a little more.
SLANT = 0.37
#: Radius of the ideal speck in voxels, about a pixel: where light grazes a slope, the shadow of a larger one is long,
#: and its middle lies beside the place where the ray through the speck's middle ends.
SPECK = 0.4
#: Places of the picture from which pairs are drawn.
PLACES = 2500
#: Pairs by geometry, and how many of them are traced with and without a speck.
PAIRS, TRACED = 20, 3


def coarse(volume: Volume, stride: int) -> Volume:
    """Return every few voxels of a volume, for the ray tracer's sake."""
    data = np.ascontiguousarray(volume.data[::stride, ::stride, ::stride])
    return replace(volume, data=data, spacing=tuple(s * stride for s in volume.spacing))


def seen_at(camera: Camera, point: np.ndarray) -> np.ndarray:
    """Return where a point is seen, in half pictures from the middle, y up."""
    basis, half = camera.basis(), camera.half_extent(1.0)
    rel = np.asarray(point) - camera.position
    return np.array([rel @ basis.right / half[0], rel @ basis.up / half[1]]) / (
        rel @ np.asarray(basis.forward)
    )


def pairs(scene: Scene, rng: np.random.Generator) -> Iterator[tuple[Any, ...]]:
    """Yield random places of cursor and caster whose shadow nothing else hides, and the scene solved for them."""
    assert scene.volume is not None
    assert scene.camera is not None
    voxel, far = scene.volume.min_spacing, float(np.linalg.norm(np.ptp(scene.volume.corners(), axis=0)))
    seen = [(at, surface_under(scene, *at, 1.0)) for at in rng.uniform(-0.8, 0.8, (PLACES, 2))]
    places = [(at, np.asarray(point)) for at, point in seen if point is not None]
    points = np.array([point for _, point in places])
    ways = points[:, None] - points
    lengths = np.linalg.norm(ways, axis=-1)
    # No lamp shines from beside the subject.
    slant = np.abs(ways @ np.asarray(scene.camera.basis().forward)) >= SLANT * lengths
    for one, other in rng.permutation(np.argwhere(slant & (lengths > 8 * voxel) & (lengths < far / 2))):
        (_, caster), (at, place) = places[one], places[other]
        if not _open(scene, caster, place, ways[one, other] / lengths[one, other], far):
            continue
        ends = shadow_ends(scene, caster, place, (at[0], at[1]), 1.0)
        assert ends is not None
        towards, shown = ends
        lit, off = solve(scene, caster, shown.point)
        # Nothing falls on a surface that turns away from the light: the tool says so.
        if off < 0.01 and shown.share >= LIT and _open(scene, caster, place, towards, far):
            yield at, caster, lit


def _open(scene: Scene, caster: np.ndarray, place: np.ndarray, towards: np.ndarray, far: float) -> bool:
    """Tell whether nothing stands between a caster and a place, nor between it and the lamp."""
    assert scene.volume is not None
    voxel = scene.volume.min_spacing
    return (
        transmittance_between(scene, caster - 3 * voxel * towards, place + 2 * voxel * towards) > 0.98
        and transmittance_between(scene, caster + 3 * voxel * towards, caster + far * towards) > 0.98
    )


def traced(scene: Scene, at: np.ndarray) -> np.ndarray:
    """Return the reference's brightness around a place of the picture, shape (PART, PART), the top row first."""
    half = PART / SIDE / 2
    x, y = (at + 1) / 2
    assert scene.camera is not None
    camera = scene.camera.cropped(x - half, y - half, x + half, y + half)
    out = np.zeros((PART, PART, 4))
    for _ in cone.passes(scene.with_(camera=camera, technique="reference"), (PART, PART), out, 8, 1.0):
        pass
    return np.asarray(out[..., :3].sum(axis=2))


def with_speck(scene: Scene, centre: np.ndarray, radius: float) -> Scene:
    """Return the scene with a speck in the volume that is densest in its middle, wherever that is between voxels."""
    volume, transfer = scene.volume, scene.transfer
    assert volume is not None
    assert transfer is not None
    index = np.stack(np.indices(volume.data.shape)[::-1], axis=-1)
    matrix = volume.world_from_texture
    world = ((index + 0.5) / np.array(volume.dims)) @ matrix[:3, :3].T + matrix[:3, 3]
    values = np.linspace(float(volume.data.min()), float(volume.data.max()), 512)
    dense = values[transfer.evaluate(values)[:, 3].argmax()]
    share = np.clip(1.5 - 1.5 * np.linalg.norm(world - centre, axis=-1) / radius, 0, 1)
    data = volume.data + share * np.maximum(dense - volume.data, 0)
    return scene.with_(volume=replace(volume, data=data))


def miss(scene: Scene, at: np.ndarray, caster: np.ndarray) -> float:
    """Return how far, in pixels, the shadow of an ideal speck at the caster is seen from the cursor.

    By the reference's rays and medium: of what each pixel near the cursor sees, weighted by how much light its own
    surface lets through, the share that lies in the shadow of a small ball; the middle of those pixels
    where it is at least half of its largest, as far as they hang together: beyond an edge it falls on something else.
    What else stands in the light, such as the rest of what the caster is a point of, does not count: it would hide the
    speck's shadow in its own.
    """
    assert scene.volume is not None
    assert scene.camera is not None
    half, voxel = AROUND / SIDE / 2, scene.volume.min_spacing
    radius = SPECK * voxel
    x, y = (at + 1) / 2
    near = scene.camera.cropped(x - half, y - half, x + half, y + half)
    task = cone.prepare(
        scene.with_(camera=near, technique="reference", step=0.5), (AROUND, AROUND), 1, 1.0, 0
    )
    towards = np.asarray(scene.lights[0].towards(scene.camera.basis(), scene.volume.center))
    left, bright, dark = np.ones(AROUND**2), np.zeros(AROUND**2), np.zeros(AROUND**2)
    start, slope = task.rays.start, task.rays.slope
    for i in range(task.stack.n):
        ends = np.maximum(task.stack.plane(i), task.z_in), np.minimum(task.stack.plane(i + 1), task.z_out)
        hit = np.flatnonzero((ends[1] > ends[0]) & (left > 1e-3))
        a, b = (start[hit] + slope[hit] * z[hit, None] for z in ends)
        depth = task.medium.between(task.medium.value(a), task.medium.value(b))[0]
        depth = depth * np.linalg.norm(b - a, axis=-1)
        middle = 0.5 * (a + b)
        seen = left[hit] * -np.expm1(-depth) * np.exp(-skin(task.medium, middle, towards, voxel))
        way = middle - caster
        along = way @ towards
        beside = np.linalg.norm(way - np.outer(along, towards), axis=-1)
        bright[hit] += seen
        dark[hit] += seen * ((beside < radius) & (along < 0))
        left[hit] *= np.exp(-depth)
    share = (dark / np.where(bright > 0, bright, 1)).reshape(AROUND, AROUND)
    rows, columns = np.nonzero(_part_nearest_the_middle(share >= 0.5 * max(share.max(), 0.05)))
    return float(np.hypot(rows.mean() - (AROUND - 1) / 2, columns.mean() - (AROUND - 1) / 2))


def _part_nearest_the_middle(marked: np.ndarray) -> np.ndarray:
    """Return the connected part of a square mask that comes nearest to its middle."""
    rows, columns = np.nonzero(marked)
    middle = (len(marked) - 1) / 2
    first = int(np.hypot(rows - middle, columns - middle).argmin())
    part = np.zeros_like(marked)
    part[rows[first], columns[first]] = True
    while True:
        grown = np.pad(part, 1)
        wider = part | (marked & (grown[:-2, 1:-1] | grown[2:, 1:-1] | grown[1:-1, :-2] | grown[1:-1, 2:]))
        if (wider == part).all():
            return part
        part = wider


def skin(medium: Medium, points: np.ndarray, towards: np.ndarray, voxel: float) -> np.ndarray:
    """Return the optical depth of four voxels towards the light."""
    steps = np.arange(0, 4.01, 0.25) * voxel
    values = medium.value(points[:, None] + steps[:, None] * towards)
    return np.asarray(medium.extinction_between(values[:, :-1], values[:, 1:]).sum(axis=1) * 0.25 * voxel)


def darkening(scene: Scene, at: np.ndarray, caster: np.ndarray) -> float:
    """Return the largest share of light that a speck at the caster takes within 3 pixels of the cursor."""
    assert scene.volume is not None
    before = traced(scene, at)
    after = traced(with_speck(scene, caster, 3.0 * scene.volume.min_spacing), at)
    rows, columns = np.mgrid[0:PART, 0:PART] - (PART - 1) / 2
    near = (np.hypot(rows, columns) <= 3) & (before > 0)
    return float((1 - after[near] / before[near]).max())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "stride"),
    [
        ("sample:hand", 2),
        ("sample:skull", 2),
        pytest.param("engine/engine.vti", 3, marks=pytest.mark.real_data),
    ],
)
def test_twenty_shadows_lie_under_the_cursor(name: str, stride: int, data_dir: Path) -> None:
    volume = sfumato.load(name if name.startswith("sample:") else data_dir / name)
    scene = Scene(volume=volume, step=1.0, lights=(Light(aperture=1.0),))
    found = [
        miss(lit, at, caster) for at, caster, lit in islice(pairs(scene, np.random.default_rng(8)), PAIRS)
    ]
    small = scene.with_(volume=coarse(volume, stride))
    dark = [
        darkening(lit, at, caster)
        for at, caster, lit in islice(pairs(small, np.random.default_rng(8)), TRACED)
    ]
    print(
        f"{name}: median {np.median(found):.2f} px, largest {max(found):.2f} px, least dark {min(dark):.0%}"
    )
    assert len(found) == PAIRS
    assert max(found) < 3
    assert min(dark) > 0.5
