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
from sfumato.scene.aiming import aimed, direction_in_effect, highlight_direction, shadow_direction
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
    voxel, far = scene.volume.min_spacing, float(np.linalg.norm(np.ptp(scene.volume.corners(), axis=0)))
    while True:
        at = rng.uniform(-0.8, 0.8, (2, 2))
        points = [surface_under(scene, *place, 1.0) for place in at]
        if any(point is None for point in points):
            continue
        caster, place = (np.asarray(point) for point in points)
        towards = shadow_direction(scene, caster, place)
        if towards is None or not 8 * voxel < np.linalg.norm(caster - place) < far / 2:
            continue
        lit, off = solve(scene, caster, place)
        free = transmittance_between(scene, caster - 3 * voxel * towards, place + 2 * voxel * towards) > 0.98
        open_ = transmittance_between(scene, caster + 3 * voxel * towards, caster + far * towards) > 0.98
        slope = value_gradient(scene, place[None])[0]
        # A ray that grazes the surface goes on for long until half of it is lost.
        steep = abs(float(slope @ towards)) > 0.25 * float(np.linalg.norm(slope))
        if off < 0.01 and free and open_ and steep:
            yield at[1], caster, lit


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
    """Return how far, in pixels, the ray of light through the caster meets the surface from the cursor.

    Light as the reference has it, from its own cone's middle; it meets the surface where half of it is lost.
    """
    assert scene.volume is not None
    assert scene.camera is not None
    medium, voxel = Medium(scene), scene.volume.min_spacing
    away = -cone.cones(scene, 1)[0].directions[0]
    steps = np.arange(3 * voxel, np.linalg.norm(np.ptp(scene.volume.corners(), axis=0)), 0.1 * voxel)
    values = medium.value(caster + steps[:, None] * away)
    depth = np.cumsum(medium.extinction_between(values[:-1], values[1:])) * 0.1 * voxel
    met = caster + steps[int(np.searchsorted(depth, np.log(2)))] * away
    return float(np.linalg.norm(seen_at(scene.camera, met) - at)) * SIDE / 2


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
    scene = Scene(volume=coarse(volume, stride), step=1.0, lights=(Light(aperture=1.0),))
    found, dark = [], []
    for at, caster, lit in islice(pairs(scene, np.random.default_rng(8)), PAIRS):
        found.append(miss(lit, at, caster))
        if len(dark) < TRACED:
            dark.append(darkening(lit, at, caster))
    print(
        f"{name}: median {np.median(found):.2f} px, largest {max(found):.2f} px, least dark {min(dark):.0%}"
    )
    assert max(found) < 3
    assert min(dark) > 0.5
