"""What no shadow takes away: a share of each lamp, and nothing where no lamp shines."""

import numpy as np
import pytest

import sfumato
from sfumato import Camera, Light, Scene, TransferFunction, Volume

SIDE = 64


@pytest.fixture
def before_a_wall() -> Scene:
    """Return a ball before a wall that faces the viewer, lit from the top left."""
    z, y, x = np.mgrid[0:40, 0:40, 0:40]
    ball = np.sqrt((x - 16) ** 2 + (y - 14) ** 2 + (z - 24) ** 2) < 6
    volume = Volume(np.where(ball | (y > 32), 200, 0).astype(np.uint8))
    solid = TransferFunction.from_points([(90, (0.5, 0.5, 0.5), 0.0), (110, (0.5, 0.5, 0.5), 0.999)])
    camera = Camera(
        position=(20, -100, 20),
        focal_point=(20, 20, 20),
        view_up=(0, 0, 1),
        parallel_projection=True,
        parallel_scale=16,
    )
    return Scene(volume=volume, transfer=solid, camera=camera, lights=(Light(aperture=10),))


def test_ambient_fills_shadows_and_leaves_full_light_alone(before_a_wall: Scene) -> None:
    plain = sfumato.render(before_a_wall, (SIDE, SIDE), linear=True)[..., 0]
    filled = sfumato.render(before_a_wall.with_(**{"technique.ambient": 0.3}), (SIDE, SIDE), linear=True)[
        ..., 0
    ]
    wall = plain[50:, :8]  # far from the shadow, which falls to the lower right of the ball
    assert filled[50:, :8] == pytest.approx(wall, abs=2e-3)
    assert plain.min() < 0.01
    assert filled.min() > 0.25 * float(np.median(wall))


@pytest.mark.parametrize("technique", ["multidirectional", "directional"])
def test_muted_lamps_leave_the_subject_dark(before_a_wall: Scene, technique: str) -> None:
    scene = before_a_wall.with_(technique=technique).with_(**{"lights.0.enabled": False})
    picture = sfumato.render(scene, (SIDE, SIDE), linear=True)
    assert picture[..., :3].max() == 0
    assert picture[..., 3].max() > 0.99


def test_the_ray_traced_reference_agrees(before_a_wall: Scene) -> None:
    from sfumato.reference import cone

    scene = before_a_wall.with_(**{"technique.ambient": 0.3})
    traced = cone.render(scene, (32, 32), directions=16)[..., 0]
    drawn = sfumato.render(scene, (32, 32), linear=True)[..., 0]
    assert drawn[26:, :4] == pytest.approx(traced[26:, :4], abs=5e-3)  # full light
    assert drawn.min() == pytest.approx(traced.min(), abs=0.02)  # deep shadow
