"""Solid cut faces: matter on them looks, and stops light, as if it went on behind the face."""

from __future__ import annotations

import numpy as np
import pytest

import sfumato
from sfumato import Camera, ClipPlane, Light, Scene, SceneError, TransferFunction, Volume
from sfumato.reference import cone as traced
from sfumato.reference import local_occlusion, multidirectional
from sfumato.renderer import Renderer
from sfumato.scene.picking import material_under, surface_under
from sfumato.techniques.frame import DRAG, FULL, Quality

pytestmark = pytest.mark.gpu

N, SIZE = 32, (48, 48)
#: Extinction per mm of the thin matter, whose values are 100; of the values of 200 ten times that.
THIN = 0.03
COLOR = (0.8, 0.5, 0.4)
CUT = ClipPlane((15.5, 15.5, 15.5), (0.0, 1.0, 0.0))


def blocks() -> Volume:
    """A block of thin matter, within it a dense one; air all around."""
    data = np.zeros((N, N, N), dtype=np.int16)
    data[4:-4, 4:-4, 4:-4] = 100
    data[12:-12, 12:-12, 12:-12] = 200
    return Volume(data)


def matter(thin: float) -> TransferFunction:
    dense = 1 - (1 - thin) ** 10
    points = [(40, COLOR, 0.0), (60, COLOR, thin), (140, COLOR, thin), (180, COLOR, dense)]
    return TransferFunction.from_points(points, unit_distance=1.0)


def stage(
    technique: str, solid: bool = True, thin: float = 1 - float(np.exp(-THIN)), **more: object
) -> Scene:
    """The blocks, cut through the middle, seen from the front."""
    volume = blocks()
    camera = Camera.fit(volume.corners(), "front", parallel_projection=True, fill=1.0)
    values = {"clip": (CUT,), "camera": camera, **more}
    return Scene(volume=volume, transfer=matter(thin), technique=technique, solid_cuts=solid, **values)  # type: ignore[arg-type]


def linear(scene: Scene) -> np.ndarray:
    return sfumato.render(scene, SIZE, linear=True).astype(np.float64)


def mean_of(picture: np.ndarray, low: int, high: int) -> np.ndarray:
    """Mean over a square of the picture."""
    return np.asarray(picture[low:high, low:high].mean(axis=(0, 1)))


@pytest.mark.parametrize("technique", ["raycast", "slices"])
def test_a_face_is_as_opaque_as_matter_that_goes_on(technique: str) -> None:
    scene = stage(technique)
    assert scene.volume is not None
    face = mean_of(linear(scene), 9, 15)
    alpha = 1 - np.exp(-THIN * (scene.volume.diagonal + 12))  # so much lies behind it
    assert face[3] == pytest.approx(alpha, abs=0.01)
    assert face[:3] == pytest.approx(alpha * np.array(COLOR), abs=0.01)


def test_what_is_not_shown_stays_open_and_no_cut_changes_nothing() -> None:
    picture = linear(stage("raycast"))
    assert picture[:4, :, 3].max() == 0
    whole = [linear(stage("raycast", solid, clip=())) for solid in (True, False)]
    assert np.array_equal(*whole)
    off = [
        linear(stage("raycast", solid, clip=(ClipPlane(CUT.point, CUT.normal, False),)))
        for solid in (True, False)
    ]
    assert np.array_equal(*off)


def test_a_side_of_the_crop_box_is_a_cut_face_too() -> None:
    """The same picture as of a clip plane there."""
    crop = sfumato.CropBox((0.0, 0.5, 0.0), (1.0, 1.0, 1.0))
    plane, box = (linear(stage("cone", **cut)) for cut in ({}, {"clip": (), "crop": crop}))
    assert np.abs(plane - box).mean() < 0.002


@pytest.mark.parametrize(
    "technique", ["raycast-phong", "multidirectional", "cone", "extinction", "local-occlusion"]
)
def test_thin_matter_looks_like_solid_matter(technique: str) -> None:
    """A face of thin matter has the light of one of opaque matter, though that of the volume is another."""
    pictures = [
        linear(stage(technique, solid, thin)) for solid, thin in ((True, 0.1), (True, 0.97), (False, 0.1))
    ]
    thin, opaque, open_cut = (mean_of(p, 10, 38)[:3].mean() for p in pictures)
    assert thin == pytest.approx(opaque, rel=0.12)
    assert abs(open_cut - opaque) > 2 * abs(thin - opaque)


@pytest.mark.parametrize("technique", ["raycast-phong", "multidirectional", "cone", "extinction"])
def test_a_face_that_turns_away_from_a_lamp_is_dark(technique: str) -> None:
    """Light from behind would come through thin matter; through solid matter it does not."""
    params = {"technique.ambient": 0.0}
    lamp = (Light(tilt=150, rotation=30, aperture=10),)
    dark, front = (
        mean_of(linear(stage(technique, thin=0.1, lights=lights).with_(**params)), 10, 38)[:3].mean()
        for lights in (lamp, (Light(tilt=30, rotation=30, aperture=10),))
    )
    assert dark < 0.05 * front


def test_cone_casts_the_shadows_of_the_reference() -> None:
    """With a lamp that grazes the face of an oblique cut."""
    plane = ClipPlane(CUT.point, (0.3, 1.0, -0.4))
    scene = stage("cone", clip=(plane,), lights=(Light(tilt=50, rotation=60, aperture=20),), frames=4)
    truth = traced.render(scene, SIZE, directions=48)
    assert np.abs(linear(scene) - truth)[..., :3].mean() < 0.015
    compiled, plain = (traced.render(scene, (12, 12), directions=4, compiled=c) for c in (True, False))
    assert compiled == pytest.approx(plain, abs=1e-9)


def test_a_solid_face_casts_a_shadow() -> None:
    """Light from the front does not reach what lies behind a face: here seen from behind, where that face ends."""
    camera = Camera.fit(blocks().corners(), "back", parallel_projection=True, fill=1.0)
    lamp = (Light(tilt=160, rotation=0, aperture=10),)
    for technique in ("multidirectional", "cone"):
        scenes = (stage(technique, solid, 0.1, camera=camera, lights=lamp) for solid in (True, False))
        lit = [mean_of(linear(scene), 8, 14)[:3].mean() for scene in scenes]
        assert lit[0] < 0.2 * lit[1], technique


@pytest.mark.parametrize(
    "technique", ["cone", "multidirectional", "extinction", "local-occlusion", "half-angle"]
)
def test_a_drags_coarse_light_does_not_stay(technique: str) -> None:
    """What is kept of light is the same whether it was worked out for a drag first, or for the still picture."""
    scene = stage(technique, thin=0.1, clip=(ClipPlane(CUT.point, (0.3, 1.0, -0.4)),))

    def last_of(*qualities: Quality) -> np.ndarray:
        renderer = Renderer()
        for quality in qualities:
            picture = renderer.begin(scene, SIZE, quality)
            while not (picture.frames and picture.settled):
                for _ in picture.add_frame():
                    pass
            image = picture.picture()
            picture.release()
        renderer.close()
        return np.asarray(image, dtype=float)

    assert np.array_equal(last_of(DRAG, FULL), last_of(FULL))


def test_the_picked_surface_is_the_face() -> None:
    for solid, depth in ((True, 15.5), (False, None)):
        scene = stage("cone", solid)
        found = surface_under(scene, -0.5, -0.5, 1.0)
        assert (
            (found is None)
            if depth is None
            else found is not None and found[1] == pytest.approx(depth, abs=0.3)
        )
    material = material_under(stage("cone"), -0.5, -0.5, 1.0)
    assert material is not None
    assert material.value == pytest.approx(100)


def test_twins_that_know_open_faces_alone_say_so() -> None:
    scene = stage("multidirectional")
    with pytest.raises(SceneError, match="solid_cuts"):
        multidirectional.render(scene, SIZE)
    with pytest.raises(SceneError, match="solid_cuts"):
        local_occlusion.intensity(scene, np.zeros((1, 3)), np.eye(3)[:1], radius=1, offset=0, samples=1)


def test_it_is_kept_with_the_scene() -> None:
    scene = stage("cone")
    assert Scene.from_json(scene.to_json(), scene.volume).solid_cuts
    with pytest.raises(SceneError, match="solid_cuts"):
        scene.with_(solid_cuts=1)
