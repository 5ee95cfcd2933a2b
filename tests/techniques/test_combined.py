"""Geometry and volume under one light: shadows where geometry says, in all four directions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import sfumato
from sfumato import Camera, ClipPlane, Light, Renderer, Scene, SceneError, TransferFunction, Volume
from sfumato.scene import Geometry, Lines, Surface
from sfumato.techniques.combined.surfaces import SurfacePainter
from sfumato.techniques.footprint import kernel_moments
from sfumato.techniques.light_volume import LightSweeper

pytestmark = pytest.mark.gpu

SOLID = TransferFunction.from_points([(0.0, (1, 1, 1), 0.0), (1, (1, 1, 1), 0.999)], 1.0)
#: Light of all surfaces alike, so that only shadows are seen.
FLAT = {"technique.surface_ambient": 1.0, "technique.surface_diffuse": 0.0, "technique.surface_specular": 0.0}
SIDE, EDGE, WALL = 64, 32, 26


def wall(extra: np.ndarray | None = None) -> Volume:
    """A wall whose face is at y = 26 of 32 mm, and more."""
    y = np.indices((EDGE,) * 3)[1]
    data = np.clip(0.5 + y - WALL, 0, 1)
    return Volume((data if extra is None else np.maximum(data, extra)).astype(np.float32))


def camera(**more: Any) -> Camera:
    return Camera.fit(
        np.array([[0.0, 0, 0], [EDGE] * 3]), "front", parallel_projection=True, fill=1.0, **more
    )


def stage(
    *geometry: Geometry,
    light: Light | None = None,
    volume: Volume | None = None,
    by: str = "cone",
    **more: Any,
) -> Scene:
    values: dict[str, Any] = {"camera": camera(), "technique": "combined", "transfer": SOLID, **more}
    lights = (light or Light(tilt=35, aperture=8),)
    return Scene(volume=volume or wall(), geometry=geometry, lights=lights, **values).with_(
        FLAT, **{"technique.light": by}
    )


def tube(y: float = 14.0, z: float = 16.0, radius: float = 1.2, **more: Any) -> Geometry:
    """A tube along x."""
    return Geometry(Lines.of([np.array([[-20.0, y, z], [52, y, z]])]), radius=radius, sides=16, **more)


def ball(center: tuple[float, float, float], radius: float, **more: Any) -> Geometry:
    turn, rise = np.meshgrid(np.linspace(0, 2 * np.pi, 25)[:-1], np.linspace(0, np.pi, 13)[1:-1])
    ring = np.stack(
        [np.cos(turn) * np.sin(rise), np.sin(turn) * np.sin(rise), np.cos(rise)], axis=-1
    ).reshape(-1, 3)
    points = np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]]) * radius + center
    k, j = np.meshgrid(np.arange(24), np.arange(10))
    a, b, c, d = j * 24 + k, j * 24 + (k + 1) % 24, (j + 1) * 24 + k, (j + 1) * 24 + (k + 1) % 24
    around = np.arange(24)
    triangles = np.concatenate([
        np.stack([a, c, d], -1).reshape(-1, 3), np.stack([a, d, b], -1).reshape(-1, 3),
        np.stack([around, (around + 1) % 24, np.full(24, 264)], -1)[:, [2, 0, 1]],
        np.stack([240 + around, np.full(24, 265), 240 + (around + 1) % 24], -1),
    ])  # fmt: skip
    return Geometry(Surface(points=points, triangles=triangles.astype(np.uint32)), color=(1, 1, 1), **more)


def plate(y: float, half: float = 40.0, middle: float = 16.0, **more: Any) -> Geometry:
    """A square that faces the viewer."""
    corners = np.array([[-half, 0, -half], [half, 0, -half], [half, 0, half], [-half, 0, half]])
    points = corners + np.array([middle, y, middle])
    return Geometry(
        Surface(points=points, triangles=np.array([[0, 1, 2], [0, 2, 3]], np.uint32)), color=(1, 1, 1), **more
    )


def light_of(scene: Scene, side: int = SIDE) -> np.ndarray:
    """The red channel."""
    return sfumato.render(scene, (side, side), linear=True)[..., 0].astype(np.float64)


def shadow_on_wall(scene: Scene, side: int = SIDE) -> np.ndarray:
    """What a scene's geometry takes of the light on the wall, where geometry itself is not seen."""
    bare = light_of(scene.with_(geometry=()), side)
    hidden = (
        sfumato.render(scene.with_(**{"technique.show": "geometry"}), (side, side), linear=True)[..., 3] > 0
    )
    return np.where(hidden, np.nan, 1 - light_of(scene, side) / np.maximum(bare, 1e-3))


BOTH = pytest.mark.parametrize("by", ["cone", "multidirectional"])


@BOTH
@pytest.mark.parametrize(("tilt", "aperture", "rotation"), [(35, 6, 90), (55, 10, 90), (45, 15, -90)])
def test_a_tubes_shadow_lies_where_geometry_says(
    tilt: float, aperture: float, rotation: float, by: str
) -> None:
    """Place within 1.25 mm (a texel), width within 20 %, for a tube 12 mm before a wall.

    The published footprint is not even about the cone's axis: a shadow's place follows its centroid.
    """
    radius, above = 1.2, np.sign(rotation)
    light = Light(tilt=tilt, aperture=aperture, rotation=rotation)
    scene = stage(tube(z=16 + above * 6, radius=radius), light=light, frames=2, by=by)
    profile = np.nan_to_num(shadow_on_wall(scene)[:, 20:44]).mean(axis=1)
    at = EDGE * (1 - (np.arange(SIDE) + 0.5) / SIDE)
    dark = np.nan_to_num(np.maximum(profile, 0))
    place = float((dark * at).sum() / dark.sum())
    slope = np.tan(np.radians(tilt)) if by == "cone" else kernel_moments(tilt, aperture).mean
    assert place == pytest.approx(16 + above * 6 - above * 12 * slope, abs=1.25)
    width = float(dark.sum() * EDGE / SIDE)
    assert width == pytest.approx(2 * radius / np.cos(np.radians(tilt)), rel=0.2)


@BOTH
def test_a_translucent_slab_darkens_a_tube_by_its_transmittance(by: str) -> None:
    y = np.indices((EDGE,) * 3)[1]
    slab = ((y >= 6) & (y < 10)).astype(np.float32) * 0.5
    clear = TransferFunction.from_points(
        [(0.0, (1, 1, 1), 0.0), (0.5, (1, 1, 1), 0.2), (1, (1, 1, 1), 0.2)], 1.0
    )
    scene = stage(
        tube(y=18, radius=2), volume=Volume(slab), transfer=clear, light=Light(tilt=0, aperture=4), by=by
    ).with_(**{"technique.show": "partial"})
    shown = sfumato.render(scene, (SIDE, SIDE), linear=True)
    tubes = shown[..., 3] > 0
    # Half a voxel of the slab's skins lies beyond it on either side: linear from 0 to 0.2 opacity.
    inner = -np.log(0.8) * 4
    assert float(np.median(shown[tubes][:, 0])) == pytest.approx(np.exp(-inner), rel=0.08)


@BOTH
def test_light_on_surfaces_does_not_step_from_slice_to_slice(by: str) -> None:
    """A plate sinks into fog by a fifth of a slice at a time: it darkens evenly, as Beer's law says (Alg. 4)."""
    fog = TransferFunction.from_points([(0.0, (1, 1, 1), 0.08), (1, (1, 1, 1), 0.08)], 1.0)
    depths, shown = 10 + 0.1 * np.arange(8), []
    for y in depths:
        scene = stage(plate(float(y)), volume=Volume(np.ones((EDGE,) * 3, np.float32)), transfer=fog,
                      light=Light(tilt=0, aperture=4), by=by).with_(**{"technique.show": "partial"})  # fmt: skip
        middle = sfumato.render(scene, (16, 16), linear=True)[6:10, 6:10, 0]
        shown.append(float(middle.mean()))
    wanted = 0.92**depths
    assert np.array(shown) == pytest.approx(wanted, rel=0.015)
    assert np.diff(np.log(shown)) == pytest.approx(np.diff(np.log(wanted)), abs=0.006), "evenly"


@BOTH
def test_geometry_hidden_by_geometry_still_casts(by: str) -> None:
    light = Light(tilt=45, aperture=6, rotation=0)
    screen, behind = plate(6.0, half=4.0, middle=20.0), ball((20.0, 14.0, 20.0), 3.0)
    shadow = shadow_on_wall(stage(screen, behind, light=light, by=by))
    alone = shadow_on_wall(stage(screen, light=light, by=by))
    # The ball's shadow falls 12 mm to the left of it, the screen's 20.
    row, column = round(SIDE * (1 - 20 / EDGE)), round(SIDE * 8 / EDGE)
    assert shadow[row - 1 : row + 2, column - 1 : column + 2].min() > 0.8
    assert alone[row - 2 : row + 3, column + 4 : column + 8].max() < 0.15


def test_a_scene_without_a_volume_has_geometrys_shadows() -> None:
    light = Light(tilt=40, aperture=8, rotation=0)
    scene = Scene(geometry=(plate(26.0, half=16.0), ball((16, 16, 16), 3)), technique="combined", camera=camera(),
                  lights=(light,)).with_(FLAT)  # fmt: skip
    shown = light_of(scene)
    row, column = SIDE // 2, round(SIDE * (16 - 10 * np.tan(np.radians(40))) / EDGE)
    assert shown[row - 1 : row + 2, column - 1 : column + 2].mean() < 0.2
    assert shown[8:20, 40:56].mean() == pytest.approx(1, abs=0.03), "and no acne"
    assert float(np.median(shown)) == pytest.approx(1, abs=0.01)


def test_a_mesh_casts_as_the_same_shape_of_voxels() -> None:
    """Shadow on the wall: RMSE below 0.06 of full light."""
    x, y, z = (np.indices((EDGE,) * 3)[k] + 0.5 for k in (2, 1, 0))
    light = Light(tilt=35, aperture=12, rotation=140)
    solid = np.clip(0.5 + 4 - np.sqrt((x - 16) ** 2 + (y - 14) ** 2 + (z - 16) ** 2), 0, 1)
    mesh = light_of(stage(ball((16, 14, 16), 4.0), light=light, frames=2))
    voxels = light_of(stage(light=light, volume=wall(solid), frames=2))
    away = np.hypot(*(np.indices((SIDE, SIDE)) - SIDE / 2 + 0.5)) * EDGE / SIDE > 5
    assert np.sqrt(np.mean((mesh - voxels)[away] ** 2)) < 0.06


@BOTH
@pytest.mark.parametrize("from_volume", [True, False])
def test_a_mesh_receives_shadows_as_the_same_shape_of_voxels(by: str, from_volume: bool) -> None:
    """A small ball's shadow on a large one: darkness within 0.13 on the mean, its middle within a millimetre."""
    x, y, z = (np.indices((EDGE,) * 3)[k] + 0.5 for k in (2, 1, 0))

    def voxels(center: tuple[float, float, float], radius: float) -> np.ndarray:
        away = np.sqrt(sum((p - c) ** 2 for p, c in zip((x, y, z), center, strict=True)))
        return np.clip(0.5 + radius - away, 0, 1)

    light, large, small = Light(tilt=40, aperture=8, rotation=0), (13.0, 19.0, 16.0), (22.0, 6.0, 16.0)
    caster = () if from_volume else (ball(small, 2.5),)
    cast = voxels(small, 2.5) if from_volume else np.zeros((EDGE,) * 3)
    rows, columns = (np.indices((SIDE, SIDE)) + 0.5) * EDGE / SIDE
    inside = np.hypot(columns - large[0], EDGE - rows - large[2]) < 4
    shadows = []
    for receiver, solid in (((ball(large, 6.0),), np.zeros((EDGE,) * 3)), ((), voxels(large, 6.0))):
        lit = light_of(stage(*receiver, light=light, volume=wall(solid), frames=4, by=by))
        dark = light_of(
            stage(*receiver, *caster, light=light, volume=wall(np.maximum(solid, cast)), frames=4, by=by)
        )
        shadows.append(np.where(inside, 1 - dark / np.maximum(lit, 0.05), 0))
    mesh, solid = (np.clip(s, 0, 1) for s in shadows)
    assert mesh.max() > 0.7
    assert np.abs(mesh - solid)[inside].mean() < 0.13
    middles = [np.array([(s * p).sum() for p in (columns, rows)]) / s.sum() for s in (mesh, solid)]
    assert np.abs(middles[0] - middles[1]).max() < 1


@pytest.mark.parametrize("parallel", [False, True])
def test_a_point_is_seen_where_the_camera_projects_it(parallel: bool) -> None:
    size, point = (80, 56), np.array([19.0, 9.0, 23.0])
    eye = Camera(position=(30, -60, 40), focal_point=(16, 16, 16), view_angle=35, parallel_projection=parallel,
                 parallel_scale=22.0, window_center=(0.1, -0.15))  # fmt: skip
    scene = Scene(geometry=(ball(tuple(point), 1.0),), technique="combined", camera=eye)
    alpha = sfumato.render(scene, size, linear=True)[..., 3]
    rows, columns = np.indices(alpha.shape)
    seen = np.array([(columns * alpha).sum(), (rows * alpha).sum()]) / alpha.sum() + 0.5
    basis = eye.basis()
    x, y, depth = ((point - eye.position) @ np.array(axis) for axis in (basis.right, basis.up, basis.forward))
    across = np.array([x, y]) / (1 if parallel else depth)
    ndc = across / eye.half_extent(size[0] / size[1]) - eye.window_center
    wanted = (ndc * (1, -1) + 1) / 2 * size
    assert np.abs(seen - wanted).max() < 1


def test_rays_end_at_surfaces() -> None:
    """A translucent block before and behind a plate: the picture's colour is that of what lies before it."""
    fog = TransferFunction.from_points([(0.0, (0, 1, 0), 0.0), (1, (0, 1, 0), 0.05)], 1.0)
    block = Volume(np.ones((EDGE,) * 3, np.float32))
    shown = {}
    for y in (8.0, 20.3):
        # Without lamps the surface is black, and the volume too: only opacity tells, so light comes from emission.
        glow = TransferFunction.from_points(
            [(p.value, p.color, p.opacity, (0, 1, 0)) for p in fog.points], 1.0
        )
        scene = stage(plate(y, half=40.0), volume=block, transfer=glow).with_(**{"lights.0.enabled": False})
        shown[y] = float(np.median(sfumato.render(scene, (16, 16), linear=True)[..., 1]))
    for y, green in shown.items():
        assert green == pytest.approx(1 - 0.95**y, rel=0.03)


@pytest.mark.parametrize(
    "switch", ["geometry_on_volume", "volume_on_volume", "geometry_on_geometry", "volume_on_geometry"]
)
@BOTH
def test_each_interaction_can_be_switched_off(switch: str, by: str) -> None:
    light = Light(tilt=40, aperture=4, rotation=0)
    caster: Any = ball((22, 10, 16), 3.0)
    x, y, z = (np.indices((EDGE,) * 3)[k] + 0.5 for k in (2, 1, 0))
    solid = np.clip(0.5 + 3 - np.sqrt((x - 22) ** 2 + (y - 10) ** 2 + (z - 16) ** 2), 0, 1)
    from_volume = switch.startswith("volume")
    on_volume = switch.endswith("volume")
    geometry = [] if from_volume else [caster]
    if not on_volume:
        geometry.append(plate(22.0))
    scene = stage(*geometry, light=light, volume=wall(solid if from_volume else None), by=by)
    row, column = (
        SIDE // 2,
        round(SIDE * (22 - ((WALL if on_volume else 22) - 10) * np.tan(np.radians(40))) / EDGE),
    )
    lit, dark = (
        light_of(scene.with_(**{f"technique.{switch}": on}))[
            row - 1 : row + 2, column - 1 : column + 2
        ].mean()
        for on in (False, True)
    )
    assert dark < 0.25
    assert lit > 0.9


def test_contact_shadows_lie_under_tubes_and_leave_no_halo() -> None:
    light = Light(tilt=0, aperture=25)
    scene = stage(
        plate(20.0), tube(y=18.2, radius=1.5), volume=Volume(np.zeros((EDGE,) * 3, np.float32)), light=light
    )
    near = light_of(scene.with_(**{"technique.show": "vicinity"}))[:, SIDE // 2]
    far = light_of(
        scene.with_(geometry=(plate(20.0), tube(y=4.0, radius=1.5)), **{"technique.show": "vicinity"})
    )
    beside = SIDE // 2 + 3  # 1.75 mm from its axis
    assert near[beside] < 0.9
    assert near[4] == 1
    assert far.min() == 1, (
        "a tube far before a surface leaves no halo on it, nor does any surface shade itself"
    )


def test_tiles_are_parts_of_the_whole() -> None:
    renderer, scene = Renderer(), stage(tube(), ball((10, 18, 8), 3.0))
    pictures = []
    for part in (None, (20, 24, 24, 16)):
        job = renderer.begin(scene, (SIDE, SIDE), part=part)
        for _ in job.add_frame():
            pass
        pictures.append(job.linear())
        job.release()
    renderer.close()
    assert np.abs(pictures[0][24:40, 20:44] - pictures[1]).max() < 2e-3


def test_clip_planes_cut_geometry_by_choice() -> None:
    plane = ClipPlane((16, 16, 16), (1, 0, 0))
    shown = {}
    for clipped in (True, False):
        scene = stage(tube(y=10, clipped=clipped), clip=(plane,)).with_(**{"technique.show": "geometry"})
        alpha = sfumato.render(scene, (SIDE, SIDE), linear=True)[..., 3]
        shown[clipped] = alpha[SIDE // 2, [SIDE // 4, 3 * SIDE // 4]]
    assert shown[True].tolist() == [0, 1]
    assert shown[False].tolist() == [1, 1]


def test_only_what_moved_is_swept(monkeypatch: pytest.MonkeyPatch) -> None:
    swept: list[Any] = []
    whole = LightSweeper.sweep

    def sweep(self: LightSweeper, *arguments: Any) -> Iterator[float]:
        swept.append(arguments[2])
        return whole(self, *arguments)

    monkeypatch.setattr(LightSweeper, "sweep", sweep)
    renderer = Renderer()

    def draw(scene: Scene) -> int:
        before = len(swept)
        job = renderer.begin(scene, (24, 24))
        for _ in job.add_frame():
            pass
        job.release()
        return len(swept) - before

    fixed = Light(tilt=35, aperture=8, attached="patient")
    scene = stage(tube(), light=fixed)
    assert draw(scene) == 1
    assert draw(scene.with_(**{"technique.surface_diffuse": 0.4, "technique.vicinity": 0.5})) == 0
    assert draw(scene.with_(camera=camera().cropped(0.2, 0.2, 0.8, 0.8))) == 0
    assert draw(scene.with_(geometry=(tube(visible=False),))) == 1
    assert draw(scene.with_(geometry=(tube(radius=2.0),))) == 1
    assert draw(scene.with_(**{"technique.volume_on_geometry": False})) == 1, (
        "surfaces need a light of their own"
    )
    assert draw(scene.with_(**{"lights.0.tilt": 40})) == 1
    kept = [item for item in renderer.gpu_objects() if item.name.startswith(("geometry", "shadow casters"))]
    assert kept, "buffers are listed"
    renderer.close()


def test_surfaces_are_drawn_again_only_where_they_look_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = stage(tube(), plate(22.0, 6.0))
    drawn: list[int] = []
    piece = SurfacePainter._piece

    def counted(self: SurfacePainter, target: Any, program: Any, mesh: Any, first: int) -> None:
        drawn.append(first)
        piece(self, target, program, mesh, first)

    monkeypatch.setattr(SurfacePainter, "_piece", counted)
    plane = ClipPlane((1.0, 0.0, 0.0), (EDGE / 2,) * 3)
    changes: list[tuple[dict[str, Any], int]] = [
        ({}, 2), ({"lights.0.tilt": 50.0}, 0), ({"technique.vicinity": 0.5}, 0), ({"camera.parallel_scale": 12.0}, 2),
        ({"geometry.0.color": (1.0, 0.0, 0.0)}, 2), ({"geometry.1.visible": False}, 1), ({"clip": (plane,)}, 1),
        ({"geometry.0.clipped": False}, 1), ({"clip": ()}, 0),
    ]  # fmt: skip
    renderer = Renderer()

    def draw(scene: Scene) -> np.ndarray:
        drawn.clear()
        job = renderer.begin(scene, (SIDE, SIDE))
        try:
            for _ in job.add_frame():
                pass
            return job.linear()
        finally:
            job.release()

    for changed, pieces in changes:
        scene = scene.with_(changed)
        picture = draw(scene)
        assert len(drawn) == pieces, changed
        renderer.painter(scene).surfaces.forget()  # type: ignore[attr-defined]
        np.testing.assert_array_equal(picture, draw(scene), str(changed))
    renderer.close()


def test_up_to_four_coloured_lamps() -> None:
    lamps = tuple(Light(tilt=35, aperture=8, rotation=90 * k, color=c, intensity=0.5)
                  for k, c in enumerate([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]))  # fmt: skip
    scene = stage(ball((16, 12, 16), 3.0)).with_(lights=lamps)
    shown = sfumato.render(scene, (SIDE, SIDE), linear=True)
    left, below = shown[SIDE // 2, 12], shown[SIDE - 12, SIDE // 2]
    assert left[0] < 0.7 * left[1], "the red lamp on the right has its shadow on the left"
    assert below[1] < 0.7 * below[0]


def test_what_cannot_be_drawn_is_said_in_one_line() -> None:
    with pytest.raises(SceneError, match="combined"):
        sfumato.render(Scene(geometry=(tube(),), technique="cone"), (8, 8))
    with pytest.raises(SceneError, match="volume"):
        sfumato.render(Scene(technique="combined"), (8, 8))
    nothing = Scene(geometry=(tube(visible=False),), technique="combined")
    assert sfumato.render(nothing, (8, 8)).max() == 0
    with pytest.raises(SceneError, match="show"):
        Scene(technique="combined").with_(**{"technique.show": "depth"})
