"""Local occlusion as a picture: lamps beside it, light that comes by and by, volumes too large for the device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sfumato import Light, Scene, TransferFunction, Volume
from sfumato.export.linear import write_linear
from sfumato.renderer import FULL, Renderer
from sfumato.techniques.local_occlusion import passes, resolve
from sfumato.techniques.local_occlusion.params import LocalOcclusionParams

pytestmark = pytest.mark.gpu

SIZE = (40, 40)
LAMP = Light(tilt=40, aperture=20, rotation=135)
FEW: dict[str, Any] = {"directions": 8, "radius": 6.0, "samples": 8}
WHITE = TransferFunction.from_points([(0.3, (1, 1, 1), 0.0), (0.7, (1, 1, 1), 0.95)], unit_distance=1.0)


def ball_and_plate(n: int = 48) -> Volume:
    """Return a ball before a plate."""
    z, y, x = np.mgrid[:n, :n, :n] + 0.5
    ball = np.clip(0.2 * n - np.sqrt((x - n / 2) ** 2 + (y - n / 3) ** 2 + (z - n / 2) ** 2) + 0.5, 0, 1)
    return Volume(np.maximum(ball, y > 0.8 * n).astype(np.float32))


@pytest.fixture(scope="module")
def renderer() -> Iterator[Renderer]:
    made = Renderer()
    yield made
    made.close()


@pytest.fixture(scope="module")
def scene() -> Scene:
    return Scene(
        volume=ball_and_plate(), transfer=WHITE, lights=(LAMP,), technique=LocalOcclusionParams(**FEW),
        background=(0, 0, 0, 1),
    )  # fmt: skip


def linear(renderer: Renderer, scene: Scene, **changes: Any) -> np.ndarray:
    """Draw one finished frame in linear light."""
    scene = scene.with_({f"technique.{name}": value for name, value in changes.items()})
    job = renderer.begin(scene, SIZE)
    try:
        for _ in job.add_frame():
            pass
        return job.linear()[..., :3]
    finally:
        job.release()


SHADOWS = pytest.mark.parametrize("shadows", ["shadows", "multidirectional"])


@SHADOWS
def test_the_lamps_shadows_alone_are_those_of_their_technique(
    renderer: Renderer, scene: Scene, shadows: str
) -> None:
    alone = linear(renderer, scene, lamps=shadows, mode="mix", share=1.0)
    own = scene.with_(technique={"shadows": "cone"}.get(shadows, shadows))
    np.testing.assert_allclose(alone, linear(renderer, own), atol=1e-6)


@SHADOWS
def test_lamps_and_the_light_around_are_mixed_or_multiplied(
    renderer: Renderer, scene: Scene, shadows: str
) -> None:
    scene = scene.with_({"technique.lamps": shadows, "technique.mode": "mix"})
    around, lamps = linear(renderer, scene, share=0.0), linear(renderer, scene, share=1.0)
    mixed = linear(renderer, scene, share=0.25)
    np.testing.assert_allclose(mixed, 0.75 * around + 0.25 * lamps, atol=1e-5)
    product = linear(renderer, scene, mode="product", brightness=1.0, bias=0.0)
    assert (product <= lamps + 1e-5).all()
    assert product.mean() < 0.9 * lamps.mean()


def test_slope_shading_is_none_where_lamps_are_off(renderer: Renderer, scene: Scene) -> None:
    turned = scene.with_({"lights.0.rotation": 315.0})
    off = linear(renderer, scene, lamps="off")
    assert np.array_equal(off, linear(renderer, turned, lamps="off"))
    assert np.abs(linear(renderer, scene) - linear(renderer, turned)).max() > 0.02


def test_light_comes_by_and_by_and_ends_as_if_it_had_been_waited_for(
    renderer: Renderer, scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = linear(renderer, scene)
    renderer.device.store.clear()
    monkeypatch.setattr(passes, "SECONDS", 0.0)
    painter: Any = renderer.painter(scene)
    shares, frames = [], []
    job = renderer.begin(scene, SIZE, replace(FULL, progressive=True))
    while not shares or not job.settled:
        painter._drawing = 0.0
        for _ in job.add_frame():
            pass
        shares.append(job.light)
        frames.append(job.frames)
    assert len(shares) > 1
    assert (np.diff(shares) > 0).all()
    assert set(frames) == {1}, "pictures in unfinished light do not count"
    np.testing.assert_array_equal(job.linear()[..., :3], whole)
    job.release()


@pytest.mark.parametrize("lamps", ["diffuse", "shadows", "multidirectional"])
def test_progress_never_goes_back(renderer: Renderer, scene: Scene, lamps: str) -> None:
    renderer.device.store.clear()
    job = renderer.begin(scene.with_({"technique.lamps": lamps}), SIZE)
    shares = list(job.add_frame())
    job.release()
    assert len(shares) > 8
    assert (np.diff(shares) >= 0).all()
    assert 0 <= shares[0] < 0.1
    assert shares[-1] == pytest.approx(1)


def test_light_that_was_given_up_goes_on_under_another_camera(renderer: Renderer, scene: Scene) -> None:
    renderer.device.store.clear()
    whole = linear(renderer, scene)
    renderer.device.store.clear()
    moved = scene.with_({"camera.position": (80.0, -60.0, 60.0)})
    for wanted, pieces in ((scene, 4), (moved, 5), (scene, 3)):
        job = renderer.begin(wanted, SIZE, replace(FULL, progressive=True))
        frame = job.add_frame()
        for _ in range(pieces):
            next(frame)
        frame.close()
        job.release()
    np.testing.assert_array_equal(linear(renderer, scene), whole)


def test_a_transfer_function_that_is_edited_all_the_time_ends_as_a_fresh_start(scene: Scene) -> None:
    edited, fresh = Renderer(), Renderer()
    try:
        rng = np.random.default_rng(6)
        for opacity in rng.uniform(0.2, 0.95, 12).tolist():
            shown = scene.with_({"transfer.points.1.opacity": opacity})
            job = edited.begin(shown, SIZE, replace(FULL, progressive=True))
            frame = job.add_frame()
            for _ in range(int(rng.integers(1, 12))):
                next(frame, None)
            frame.close()
            job.release()
        last = scene.with_({"transfer.points.1.opacity": 0.6})
        np.testing.assert_array_equal(linear(edited, last), linear(fresh, last))
    finally:
        edited.close()
        fresh.close()


@pytest.mark.parametrize(
    "lamps",
    ["diffuse", *(pytest.param(name, marks=pytest.mark.slow) for name in ("shadows", "multidirectional"))],
)
def test_a_volume_that_does_not_fit_is_shown_by_its_blocks(renderer: Renderer, lamps: str) -> None:
    n = 96
    z, y, x = np.mgrid[:n, :n, :n] + 0.5
    data = 255 * np.clip(12.5 - np.sqrt((x - 48) ** 2 + (y - 48) ** 2 + (z - 48) ** 2), 0, 1)
    volume = Volume(data.astype(np.uint8))
    transfer = TransferFunction.from_points([(60, (1, 0.8, 0.6), 0.0), (180, (1, 0.8, 0.6), 0.9)])
    params = LocalOcclusionParams(**FEW, reduction=1.0, coarsest=4)
    scene = Scene(volume=volume, transfer=transfer, technique=params, lights=(LAMP,))
    small = Renderer(1_750_000)  # bytes: half of it is less than the volume
    try:
        packed, whole = linear(small, scene, lamps=lamps), linear(renderer, scene, lamps=lamps)
        kept = {name for name, _ in small.device.store.things()}
        assert "volume" not in kept
        assert {"blocks", "local light"} <= kept
        assert np.abs(packed - whole).mean() < 2e-3
        assert whole.max() > 0.3
    finally:
        small.close()


def test_longer_steps_in_coarse_blocks_do_not_change_what_is_even(renderer: Renderer) -> None:
    fog = Volume(np.full((48, 48, 48), 100, dtype=np.uint8))
    transfer = TransferFunction.from_points([(0, (1, 0.5, 0.2), 0.02), (255, (1, 0.5, 0.2), 0.02)])
    params = LocalOcclusionParams(**FEW, reduction=500.0, coarsest=0, lamps="off")
    scene = Scene(volume=fog, transfer=transfer, technique=params)
    long, short = linear(renderer, scene, adaptive=True), linear(renderer, scene, adaptive=False)
    assert long.max() > 0.1
    np.testing.assert_allclose(long, short, atol=0.01)


@pytest.mark.parametrize("emission", [0.0, 0.8])
def test_resolved_light_is_that_of_the_packed_blocks(
    renderer: Renderer, scene: Scene, monkeypatch: pytest.MonkeyPatch, emission: float
) -> None:
    shining = scene.with_({"transfer.points.1.emission": (emission,) * 3})
    shown = shining.with_({"technique.reduction": 1.0, "technique.coarsest": 4, "technique.lamps": "off"})
    fast = linear(renderer, shown)
    assert any(name == "local light, resolved" for name, _ in renderer.device.store.things())
    monkeypatch.setattr(resolve, "SHARE", 0.0)
    slow = linear(renderer, shown)
    assert slow.max() > 0.3
    # Light is kept in halves of a float: 11 bits.
    assert np.abs(fast - slow).max() < 2e-3 * slow.max()


def test_light_above_white_is_kept_through_to_the_tone_map(
    renderer: Renderer, scene: Scene, tmp_path: Path
) -> None:
    shining = scene.with_({"transfer.points.1.emission": (6.0, 3.0, 0.5), "technique.lamps": "off"})
    job = renderer.begin(shining, SIZE)
    for _ in job.add_frame():
        pass
    shown, picture = job.linear(), job.picture()
    job.release()
    assert shown[..., 0].max() > 3
    assert picture[..., 0].max() == 255
    # Four stops less bring back what the tone map clips.
    dim = renderer.begin(shining.with_(exposure=-4.0), SIZE)
    for _ in dim.add_frame():
        pass
    darker = dim.picture()
    dim.release()
    assert 60 < darker[..., 0].max() < 255
    assert darker[..., 0].max() > darker[..., 1].max() > darker[..., 2].max()
    # What lies near is lit by more than the display's white as well: here it shines in the gathering alone.
    assert linear(renderer, shining, emission="gathering").max() > 1.5
    target = tmp_path / "light.npy"
    write_linear(target, shown)
    np.testing.assert_array_equal(np.load(target), shown)
