"""Streamlines against flows whose lines are known."""

import json
from pathlib import Path

import numpy as np
import pytest

import sfumato
from sfumato import LoadError, Scene, SceneError, Seeds, Surface, Tracing, Volume
from sfumato.geometry import VectorField, has_vectors, load_field, trace
from sfumato.geometry.seeding import seed_points
from sfumato.io import LoadCancelled


@pytest.fixture(scope="module")
def grid() -> Volume:
    """A box of 40 mm around the origin."""
    return Volume(np.zeros((21, 21, 21), np.float32), (2, 2, 2), (-20, -20, -20))


def positions(grid: Volume) -> np.ndarray:
    z, y, x = np.meshgrid(*[np.linspace(-20, 20, 21)] * 3, indexing="ij")
    return np.stack([x, y, z], axis=-1).astype(np.float32)


@pytest.fixture(scope="module")
def swirl(grid: Volume) -> VectorField:
    """Solid rotation about z, 1 rad/s: lines are circles."""
    p = positions(grid)
    return VectorField.from_array(np.stack([-p[..., 1], p[..., 0], 0 * p[..., 2]], axis=-1), grid)


def one(radius: float) -> Seeds:
    return Seeds(kind="points", places=((radius, 0.0, 3.0),))


def test_rotation_gives_circles(swirl: VectorField) -> None:
    made = trace(Tracing(seeds=one(8), length=2 * np.pi * 8, direction="forward"), swirl)
    points = made.shape.points
    assert made.kind == "streamlines"
    assert np.linalg.norm(points[:, :2], axis=1) == pytest.approx(8, abs=0.02)
    assert points[:, 2] == pytest.approx(3, abs=1e-4)
    assert made.shape.lengths[0] == pytest.approx(2 * np.pi * 8, rel=0.02)
    assert made.scalar_values("speed") == pytest.approx(8, abs=0.1)
    angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    assert made.scalar_values("time") == pytest.approx(angle, abs=0.02)


def test_directions_and_lengths(swirl: VectorField) -> None:
    ends = {}
    for way in ("forward", "backward", "both"):
        points = trace(Tracing(seeds=one(10), length=10, direction=way), swirl).shape.points
        angle = np.arctan2(points[:, 1], points[:, 0])
        ends[way] = (angle.min(), angle.max())
        assert (np.diff(angle) > 0).all(), "one line, along the flow"
    assert ends["forward"] == pytest.approx((0, 1), abs=0.06)
    assert ends["backward"] == pytest.approx((-1, 0), abs=0.06)
    assert ends["both"] == pytest.approx((-1, 1), abs=0.06)


def test_grid_turned_in_space() -> None:
    """A volume whose axes are not the world's: vectors are the world's all the same."""
    turned = Volume(
        np.zeros((9, 9, 9), np.float32), (2, 2, 2), (8, -8, -8), ((0, -1, 0), (1, 0, 0), (0, 0, 1))
    )
    field = VectorField.from_array(np.tile(np.float32([0, 0, 1]), (9, 9, 9, 1)), turned)
    points = trace(Tracing(seeds=Seeds(kind="points", places=((3.0, 2.0, 0.0),))), field).shape.points
    assert np.allclose(points[:, :2], (3, 2), atol=1e-4)
    assert np.ptp(points[:, 2]) > 15


def test_empty_traces_and_masks_are_counted(grid: Volume) -> None:
    flow = np.ma.masked_array(np.tile(np.float32([1, 0, 0]), (21, 21, 21, 1)), mask=False)
    flow[:, :, :8] = np.ma.masked
    field = VectorField.from_array(flow, grid)
    seeds = Seeds(kind="points", places=((5.0, 0.0, 0.0), (100.0, 0.0, 0.0), (-15.0, 0.0, 0.0)))
    made = trace(Tracing(seeds=seeds), field)
    assert made.shape.count == 1
    assert made.shape.points[:, 0].min() > -6.5, "ends where the field is masked"
    assert any("3528 vectors of 9261 are masked" in n for n in made.notices)
    assert any("2 of 3 seeds give no line" in n for n in made.notices)


def test_no_line_at_all_is_an_error(swirl: VectorField) -> None:
    with pytest.raises(
        LoadError, match="none of the 1 seeds gives a streamline; put them where the field is: x -20"
    ):
        trace(Tracing(seeds=Seeds(kind="points", places=((0.0, 500.0, 0.0),))), swirl)
    with pytest.raises(SceneError, match="vector field is needed"):
        trace(Tracing())


def test_cancel(swirl: VectorField) -> None:
    steps: list[float] = []
    seeds = Seeds(count=200, radius=9)
    trace(Tracing(seeds=seeds), swirl, progress=lambda done, _: steps.append(done))
    assert len(steps) > 8
    with pytest.raises(LoadCancelled):
        trace(Tracing(seeds=seeds), swirl, cancel=lambda: True)


def test_sample_and_files_are_traced_again_from_a_scene(tmp_path: Path) -> None:
    made = trace(
        Tracing(path="sample:pipe", seeds=Seeds(kind="line", start=(6, 15, 28), end=(6, 40, 28), count=9))
    )
    scene = Scene(geometry=[made]).with_(**{"geometry.0.colormap": "magma"})
    data = json.loads(json.dumps(scene.to_json()))
    assert "shape" not in data["geometry"][0]
    assert Scene.from_json(data) == scene
    with pytest.raises(SceneError):
        scene.with_(**{"geometry.0.tracing.step": 2})
    data["geometry"][0]["tracing"]["hash"] = "other"
    with pytest.raises(LoadError, match="not the field"):
        Scene.from_json(data)


def test_vtk_files_with_vectors(tmp_path: Path, swirl: VectorField) -> None:
    import pyvista

    pyvista.wrap(swirl.dataset).save(tmp_path / "a.vti")
    pyvista.wrap(swirl.dataset).cast_to_rectilinear_grid().save(tmp_path / "b.vtk")
    for name in ("a.vti", "b.vtk"):
        made = trace(Tracing(path=str(tmp_path / name), array="vectors", seeds=one(5), length=9))
        assert np.linalg.norm(made.shape.points[:, :2], axis=1) == pytest.approx(5, abs=0.02)
    pyvista.ImageData(dimensions=(3, 3, 3)).save(tmp_path / "none.vti")
    (tmp_path / "x.vti").write_text("x")
    for name in ("none.vti", "x.vti", "missing.vti"):
        with pytest.raises(LoadError):
            load_field(tmp_path / name)
    with pytest.raises(LoadError, match="no vectors called"):
        load_field(tmp_path / "a.vti", "nope")


def test_seeds_lie_where_they_should(tmp_path: Path) -> None:
    ball = seed_points(Seeds(center=(1, 2, 3), radius=4, count=3000))
    away = np.linalg.norm(ball - [1, 2, 3], axis=1)
    assert away.max() <= 4
    assert (away < 2).mean() == pytest.approx(1 / 8, abs=0.03), "evenly in the volume"
    plane = seed_points(Seeds(kind="plane", center=(0, 0, 5), edge_u=(4, 0, 0), edge_v=(0, 2, 0), count=500))
    assert np.allclose(plane[:, 2], 5)
    assert np.abs(plane).max(axis=0)[:2] == pytest.approx([2, 1], abs=0.02)
    assert np.allclose(plane.mean(axis=0), (0, 0, 5), atol=0.02)
    line = seed_points(Seeds(kind="line", start=(0, 0, 0), end=(10, 0, 0), count=5))
    assert line[:, 0].tolist() == [0, 2.5, 5, 7.5, 10]
    square = Surface(np.float32([[0, 0, 0], [9, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    on = seed_points(Seeds(kind="surface", path="x", count=100), square)
    assert (on[:, 2] == 0).all()
    assert (on[:, 0] / 9 + on[:, 1] <= 1 + 1e-9).all()


def test_seeds_on_a_surface_file(tmp_path: Path, swirl: VectorField) -> None:
    import pyvista

    pyvista.Sphere(radius=6).save(tmp_path / "s.stl")
    made = trace(
        Tracing(seeds=Seeds(kind="surface", path=str(tmp_path / "s.stl"), count=30), length=1), swirl
    )
    assert np.linalg.norm(made.shape.points, axis=1) == pytest.approx(6, abs=0.6)


@pytest.mark.parametrize(
    "seeds", [{"kind": "points"}, {"kind": "surface"}, {"kind": "plane", "edge_u": (0, 1, 0)}, {"count": 0}]
)
def test_bad_seeds(seeds: dict[str, object]) -> None:
    with pytest.raises(SceneError):
        Seeds(**seeds)


@pytest.mark.real_data
@pytest.mark.parametrize("name", ["carotid_flow/carotid.vtk", "wind_rectgrid/RectGrid2.vtk"])
def test_real_fields(name: str) -> None:
    path = Path(__file__).parents[4] / "shared/data" / name
    if not path.is_file():
        pytest.skip(f"{path} is not there")
    field = load_field(path)
    low, high = field.bounds
    seeds = Seeds(center=tuple((low + high) / 2), radius=float((high - low).min() / 3), count=100)
    made = sfumato.trace(Tracing(seeds=seeds), field)
    assert made.shape.count > 80
    assert (made.bounds[0] >= low - 1e-3).all()
    assert (made.bounds[1] <= high + 1e-3).all()


# -- main directions of tensors --------------------------------------------------------------------
def test_directions_without_a_sign_are_traced_through(tmp_path: Path) -> None:
    """An arc whose directions have random signs, in FSL's two files, turned about in space: lines follow the arc."""
    import nibabel

    x, y = np.meshgrid(np.arange(24.0), np.arange(24.0), indexing="ij")
    radius = np.hypot(x, y)
    ring = (radius > 8) & (radius < 20)
    along = np.stack([-y, x, 0 * x], axis=-1) / np.maximum(radius, 1)[..., None]
    signs = np.random.default_rng(0).choice([-1, 1], (24, 24, 5))
    vectors = np.where(ring[..., None, None], along[:, :, None, :] * signs[..., None], 0).astype(np.float32)
    # Right-handed voxels: FSL turns the first component round.
    affine = np.diag([2.0, 2, 2, 1])
    image = nibabel.Nifti1Image(vectors * np.array([-1, 1, 1], np.float32), affine)
    image.header["intent_code"] = 1007
    nibabel.save(image, tmp_path / "dti_V1.nii.gz")
    nibabel.save(
        nibabel.Nifti1Image(np.repeat(0.7 * ring[:, :, None], 5, 2).astype(np.float32), affine),
        tmp_path / "dti_FA.nii.gz",
    )
    path = str(tmp_path / "dti_FA.nii.gz")
    assert has_vectors(path)
    field = load_field(path)
    assert field.axial
    assert field.bounds == pytest.approx(sfumato_box(path), abs=1e-3)
    seed = Seeds(kind="points", places=((-28 * np.cos(0.7), -28 * np.sin(0.7), 4.0),))
    lines = trace(Tracing(path=path, seeds=seed, min_speed=0.3), field)
    points = lines.shape.points
    away = np.hypot(points[:, 0], points[:, 1])
    assert away == pytest.approx(28, abs=1.5)
    assert lines.shape.lengths.max() > 0.85 * 28 * np.pi / 2, "from end to end"
    assert lines.color_by == "direction"
    world = load_field(path, "world")
    assert world.key != field.key, "the components of other programs run along the world's axes"


def sfumato_box(path: str) -> np.ndarray:
    """The centres of the outermost voxels, as the volume itself has them."""
    volume = sfumato.load(path)
    corners, half = volume.corners(), np.array(volume.spacing) / 2
    return np.stack([corners.min(axis=0) + half, corners.max(axis=0) - half])
