"""Presets and the first view, on subjects whose truth is known."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest

import sfumato
from sfumato import SceneError, Volume, VolumeInfo
from sfumato.scene import STANDARD_VIEWS
from sfumato.scene.presets import (
    preset,
    presets_for,
    suggest_clip,
    suggest_transfer,
    suggest_view,
)
from sfumato.scene.presets.values import hounsfield_zero, levels, otsu


def ellipsoid(shape: tuple[int, int, int], center: tuple[float, ...], radii: tuple[float, ...]) -> np.ndarray:
    """Signed measure, < 1 within; all in (z, y, x)."""
    grid = np.meshgrid(*(np.arange(n, dtype=np.float32) for n in shape), indexing="ij")
    return np.sqrt(sum(((g - c) / r) ** 2 for g, c, r in zip(grid, center, radii, strict=True)))


def patient(zero: int = 0, table: bool = True, front: int = -1) -> np.ndarray:
    """A trunk of soft tissue with a spine, on a thin curved table behind it; 4 mm voxels; HU + zero."""
    shape = (40, 100, 163)
    _, y, x = np.meshgrid(*(np.arange(n) for n in shape), indexing="ij")
    data = np.full(shape, -1000, dtype=np.int16)
    data[ellipsoid(shape, (20, 45, 80), (60, 25, 40)) < 1] = 40
    data[(x - 80) ** 2 + (y - 60) ** 2 < 25] = 700
    if table:
        arc = np.hypot(x - 80, (y + 60) * 0.9)
        data[(np.abs(arc - 130) < 1.2) & (y > 75)] = 150
    if front > 0:
        data = data[:, ::-1]
    return np.ascontiguousarray(data + np.int16(zero))


def ct(data: np.ndarray, modality: str = "CT", known: bool = True) -> Volume:
    return Volume(data, (4.0, 4.0, 4.0), info=VolumeInfo(modality=modality, orientation_known=known))


# -- what the values mean ---------------------------------------------------------------------------
@pytest.mark.parametrize("modality", ["", "CT"])
@pytest.mark.parametrize("zero", [0, 1024])
def test_hounsfield_units_are_recognised_with_and_without_their_offset(modality: str, zero: int) -> None:
    assert hounsfield_zero(ct(patient(zero), modality)) == zero


def test_mr_and_bytes_are_no_hounsfield_units() -> None:
    assert hounsfield_zero(ct(patient(), "MR")) is None
    assert hounsfield_zero(Volume((patient() > 0).astype(np.uint8) * 200)) is None


def test_a_shift_of_the_values_shifts_the_presets() -> None:
    plain, stored = presets_for(ct(patient())), presets_for(ct(patient(1024)))
    for a, b in zip(plain, stored, strict=True):
        assert a.name == b.name
        assert [p.value + 1024 for p in a.transfer.points] == [p.value for p in b.transfer.points]


def test_otsu_finds_the_middle_between_two_clusters() -> None:
    rng = np.random.default_rng(1)
    values = np.concatenate([rng.normal(20, 4, 50_000), rng.normal(180, 10, 5_000)]).astype(np.float32)
    assert 60 < otsu(values, float(values.max())) < 150


def test_bright_vessels_in_tissue_that_fills_the_volume() -> None:
    data = np.random.default_rng(2).normal(120, 8, (40, 40, 40)).astype(np.float32)
    data[:, :, :6] = 15
    data[:, 17:23, 25:31] = 400
    assert 170 < levels(Volume(data)).surface < 330


# -- the presets --------------------------------------------------------------------------------------
@pytest.mark.parametrize("modality", ["", "CT", "MR", "US"])
def test_every_preset_is_found_by_its_name(modality: str) -> None:
    volume = ct(patient(), modality)
    found = presets_for(volume)
    assert len({p.name for p in found}) == len(found) >= 4
    for p in found:
        assert preset(p.name.upper(), volume) is p
        assert p.description
        assert p.transfer.name == p.name
        assert p.transfer.evaluate(np.linspace(*volume.value_range, 999))[:, 3].max() > 0.05
    assert suggest_transfer(volume) == found[0].transfer


def test_an_unknown_preset_names_the_known_ones() -> None:
    with pytest.raises(SceneError, match=r"Bone.*Skin.*Lung"):
        preset("granite", ct(patient()))


def test_air_is_invisible_and_bone_opaque() -> None:
    opacity = suggest_transfer(ct(patient())).evaluate(np.array([-1000.0, -500.0, 40.0, 700.0]))[:, 3]
    assert opacity[:3].max() == 0
    assert opacity[3] > 0.9


def test_without_bone_the_soft_tissue_comes_first() -> None:
    data = patient(table=False)
    data[data > 300] = 60
    assert presets_for(ct(data))[0].name == "Muscle"


@pytest.mark.parametrize(
    "data",
    [np.zeros((4, 5, 6), np.uint8), np.full((3, 3, 3), 7.5, np.float32), np.zeros((1, 1, 1), np.int16)],
    ids=["zeros", "constant", "one voxel"],
)
@pytest.mark.parametrize("modality", ["", "CT", "MR", "US"])
def test_volumes_with_nothing_in_them_still_get_a_scene(data: np.ndarray, modality: str) -> None:
    scene = sfumato.Scene(volume=Volume(data, info=VolumeInfo(modality=modality)))
    assert scene.transfer is not None
    assert scene.camera is not None


def test_presets_do_not_keep_volumes_alive() -> None:
    volume = ct(patient())
    presets_for(volume)
    suggest_clip(volume)
    gone = weakref.ref(volume)
    del volume
    gc.collect()
    assert gone() is None


# -- the table ----------------------------------------------------------------------------------------
def test_the_table_is_cut_away_and_the_patient_left_whole() -> None:
    volume = ct(patient())
    planes = suggest_clip(volume)
    assert 1 <= len(planes) <= 4
    kept = np.ones(volume.data.shape, dtype=bool)
    z, y, x = (
        4.0 * (g + 0.5) for g in np.meshgrid(*(np.arange(n) for n in volume.data.shape), indexing="ij")
    )
    for plane in planes:
        kept &= np.stack([x, y, z], axis=-1) @ np.array(plane.normal) >= np.dot(plane.normal, plane.point)
    body = ct(patient(table=False)).data > -500
    table = (volume.data > -500) & ~body
    assert kept[body].all()
    assert kept[table].mean() < 0.05


def test_without_a_table_nothing_is_cut() -> None:
    assert suggest_clip(ct(patient(table=False))) == ()
    assert suggest_clip(Volume(np.full((8, 8, 8), 9, np.uint8))) == ()


def test_a_scene_takes_the_planes_with_the_transfer_function_or_not_at_all() -> None:
    volume = ct(patient())
    scene = sfumato.Scene(volume=volume)
    assert scene.clip == suggest_clip(volume)
    assert scene.with_(clip=()).clip == ()
    assert sfumato.Scene(volume=volume, transfer=suggest_transfer(volume)).clip == ()


# -- the first view -----------------------------------------------------------------------------------
def looking(volume: Volume) -> tuple[list[float], list[float]]:
    basis = suggest_view(volume, suggest_transfer(volume)).basis()
    return np.round(basis.forward, 6).tolist(), np.round(basis.up, 6).tolist()


def test_a_known_orientation_is_seen_from_the_front() -> None:
    assert looking(ct(patient())) == ([0, 1, 0], [0, 0, 1])
    assert looking(ct(patient(front=1))) == ([0, 1, 0], [0, 0, 1])


def test_the_table_tells_the_front_where_the_orientation_does_not() -> None:
    assert looking(ct(patient(), known=False)) == ([0, 1, 0], [0, 0, 1])
    assert looking(ct(patient(front=1), known=False)) == ([0, -1, 0], [0, 0, 1])


@pytest.mark.parametrize(("axis", "forward"), [(0, [0, 0, 1]), (2, [-1, 0, 0])])
def test_a_thin_subject_is_seen_along_its_thin_axis(axis: int, forward: list[float]) -> None:
    radii = [30.0, 30.0, 30.0]
    radii[axis] = 5.0
    data = np.where(ellipsoid((70, 70, 70), (35, 35, 35), tuple(radii)) < 1, 200, 3).astype(np.uint8)
    assert looking(Volume(data))[0] == forward


def test_specks_do_not_move_the_camera() -> None:
    data = np.where(ellipsoid((80, 80, 80), (40, 40, 40), (14, 14, 14)) < 1, 200, 0).astype(np.uint8)
    littered = data.copy()
    littered[3:6, 3:6, 3:6] = littered[70:73, 70:73, 5:8] = 200
    clean, dirty = (suggest_view(Volume(d), suggest_transfer(Volume(data))) for d in (data, littered))
    assert np.allclose(clean.focal_point, dirty.focal_point, atol=0.5)
    assert clean.distance == pytest.approx(dirty.distance, rel=0.02)


def test_a_turned_array_shows_the_same_picture_where_the_orientation_is_known() -> None:
    data = np.where(ellipsoid((60, 60, 60), (30, 25, 35), (25, 12, 18)) < 1, 200, 0).astype(np.uint8)
    info = VolumeInfo(orientation_known=True)
    straight = Volume(data, info=info)
    turned = Volume(
        np.ascontiguousarray(data.transpose(1, 0, 2)),
        direction=((1, 0, 0), (0, 0, 1), (0, 1, 0)),
        info=info,
    )
    a, b = (suggest_view(v, suggest_transfer(v)) for v in (straight, turned))
    assert np.allclose(a.position, b.position, atol=0.5)
    assert a.view_up == b.view_up


def test_a_few_slices_show_the_cut_tissue() -> None:
    assert presets_for(ct(patient()[:14]))[0].name == "Muscle"
    assert looking(ct(patient()[:14])) == ([0, 0, 1], [0, -1, 0])


def test_thin_parts_of_the_subject_are_no_table() -> None:
    hand = np.full((80, 60, 60), -1000, np.int16)
    hand[:40, 26:34, 15:45] = 40
    for x in (16, 24, 32, 40):
        hand[40:75, 28:32, x : x + 4] = 40
    volume = Volume(hand, (2.0, 2.0, 2.0), info=VolumeInfo(modality="CT", orientation_known=True))
    assert suggest_clip(volume) == ()


@pytest.mark.parametrize("aspect", [0.5, 1.0, 2.0])
def test_a_view_fits_the_aspect_of_its_picture(aspect: float) -> None:
    data = np.where(ellipsoid((60, 60, 80), (30, 30, 40), (12, 12, 34)) < 1, 200, 0).astype(np.uint8)
    volume = Volume(data)
    camera = suggest_view(volume, suggest_transfer(volume), STANDARD_VIEWS["front"], aspect=aspect)
    inside = np.argwhere(data)[:, ::-1] + 0.5
    basis = camera.basis()
    rel = volume.origin + inside * volume.spacing - np.asarray(camera.position)
    depth = rel @ basis.forward
    half = camera.half_extent(aspect)
    spans = [
        np.abs(rel @ axis / depth).max() / extent
        for axis, extent in zip((basis.right, basis.up), half, strict=True)
    ]
    assert 0.7 < max(spans) < 0.9


# -- two dimensions -----------------------------------------------------------------------------------
def noisy(zero: int = 0) -> np.ndarray:
    """Return a patient whose tissue is uneven, as scans are."""
    data = patient(zero, table=False).astype(np.int16)
    return data + np.random.default_rng(4).normal(0, 12, data.shape).round().astype(np.int16)


def test_glass_skin_shows_steep_boundaries_alone() -> None:
    glass, skin = (preset(name, ct(noisy())).transfer for name in ("Glass skin", "Skin and bone"))
    assert glass.points == skin.points
    (curve,) = glass.regions
    assert curve.shape == "curve"
    bone, flat, steep = np.array([700.0]), np.array([0.0]), np.array([curve.gradient[0] * 5])
    assert glass.evaluate_2d(bone, flat)[0, 3] == 0
    assert glass.evaluate_2d(bone, steep)[0, 3] == pytest.approx(skin.evaluate(bone)[0, 3], abs=0.01)
    assert 1 < curve.gradient[0] < 40, "above the noise"
    stored = preset("Glass skin", ct(noisy(1024))).transfer.regions[0]
    assert stored.gradient == pytest.approx(curve.gradient)
    assert stored.value == pytest.approx([v + 1024 for v in curve.value])


def test_boundaries_are_for_values_of_unknown_meaning() -> None:
    data = np.clip(noisy(1000) / 12, 0, 255).astype(np.uint8)
    assert preset("Boundaries", Volume(data)).transfer.regions
    for modality in ("MR", "US"):
        assert "Boundaries" not in {p.name for p in presets_for(ct(data, modality))}
    assert suggest_view(ct(noisy()), preset("Glass skin", ct(noisy())).transfer) is not None
