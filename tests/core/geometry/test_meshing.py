"""Lines become tubes: closed, outward, of the right size, coloured and filtered as asked."""

import dataclasses
import json

import numpy as np
import pytest
from scipy.spatial import cKDTree

import sfumato
from sfumato import Geometry, Lines, Roi, Scene, SceneError, Surface
from sfumato.geometry import mesh_of, meshing
from sfumato.geometry.polyline import Strand, smoothed
from sfumato.geometry.tubes import frames_of, tangents_of

STRAIGHT = [[0, 0, 0], [10, 0, 0]]


def helix(points: int = 200) -> np.ndarray:
    t = np.linspace(0, 6, points)
    return 20 * np.stack([np.cos(t), np.sin(t), t / 3], axis=1)


def faces(mesh: sfumato.Mesh) -> np.ndarray:
    return mesh.points[mesh.triangles].astype(float)


def volume(mesh: sfumato.Mesh) -> float:
    p = faces(mesh)
    return float(np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])).sum() / 6)


def test_straight_tube_is_a_closed_prism_facing_out() -> None:
    mesh = mesh_of(Geometry(Lines.of([STRAIGHT]), radius=1, sides=24))
    assert mesh.bounds == pytest.approx(np.array([[0, -1, -1], [10, 1, 1]]), abs=1e-5)
    assert volume(mesh) == pytest.approx(12 * np.sin(np.pi / 12) * 10, rel=1e-5)
    p = faces(mesh)
    outward = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    assert (np.einsum("ij,ij->i", outward, mesh.normals[mesh.triangles].mean(axis=1)) > 0).all()
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1, abs=1e-5)


def test_every_edge_of_a_tube_belongs_to_two_triangles() -> None:
    mesh = mesh_of(Geometry(Lines.of([helix()]), radius=1, sides=7))
    _, corner = np.unique(mesh.points, axis=0, return_inverse=True)
    t = corner.ravel()[mesh.triangles.astype(int)]
    edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_helix_has_the_volume_of_its_length() -> None:
    geometry = Geometry(Lines.of([helix(2000)]), radius=0.5, sides=32)
    expected = geometry.shape.lengths[0] * 16 * np.sin(np.pi / 16) * 0.25
    assert volume(mesh_of(geometry)) == pytest.approx(expected, rel=2e-3)


def test_frames_stay_across_the_line_and_turn_little() -> None:
    line = Strand(helix(400).astype(np.float32), np.zeros(400, int), np.empty((400, 0), np.float32))
    tangents = tangents_of(line)
    u, v = frames_of(line, tangents)
    assert np.abs((u * tangents).sum(axis=1)).max() < 1e-4
    assert np.abs((u * v).sum(axis=1)).max() < 1e-4
    # The part of a frame's change that is about the tangent is twist: there is none.
    assert np.abs((np.diff(u, axis=0) * v[:-1]).sum(axis=1)).max() < 2e-3


def test_lines_are_not_joined_to_each_other() -> None:
    two = mesh_of(Geometry(Lines.of([STRAIGHT, np.add(STRAIGHT, 50)]), radius=1, sides=8))
    one = mesh_of(Geometry(Lines.of([STRAIGHT]), radius=1, sides=8))
    assert len(two.triangles) == 2 * len(one.triangles)
    assert volume(two) == pytest.approx(2 * volume(one), rel=1e-4)


def test_repeated_points_and_hairpins_leave_no_hole() -> None:
    line = [[0, 0, 0], [0, 0, 0], [5, 0, 0], [5, 0, 0], [0, 0, 0], [0, 5, 0]]
    mesh = mesh_of(Geometry(Lines.of([line]), radius=1, sides=8))
    assert np.isfinite(mesh.points).all()
    assert np.isfinite(mesh.normals).all()


def test_smoothing_keeps_ends_and_lies_on_the_spline() -> None:
    points = np.array([[0, 0, 0], [1, 1, 0], [2, 0, 0], [3, 1, 0]], np.float32)
    strand = Strand(points, np.zeros(4, int), np.empty((4, 0), np.float32))
    made = smoothed(strand, 4)
    assert np.allclose(made.points[[0, -1]], points[[0, -1]])
    knot = (points[0] + 4 * points[1] + points[2]) / 6
    assert np.linalg.norm(made.points - knot, axis=1).min() < 1e-6
    assert len(made.points) == 13


def test_smoothing_keeps_lines_apart() -> None:
    lines = Lines.of([helix(50), helix(70) + 500])
    mesh = mesh_of(Geometry(lines, radius=1, sides=6, smoothing=2))
    near = np.linalg.norm(mesh.points - helix(50).mean(axis=0), axis=1) < 100
    assert not near.all()
    assert (np.linalg.norm(mesh.points[~near] - (helix(70) + 500).mean(axis=0), axis=1) < 100).all()


def test_colours() -> None:
    ramp = Geometry(
        Lines.of([[[0, 0, 0], [5, 0, 0], [10, 0, 0]]], [("s", [[0.0, 0.5, np.nan]])]),
        radius=1, sides=3, color_by="scalar", colormap="gray",
    )  # fmt: skip
    mesh = mesh_of(ramp)
    at = {x: mesh.colors[np.isclose(mesh.points[:, 0], x)] for x in (0, 5, 10)}
    assert np.allclose(at[0], 0, atol=1e-3)
    assert np.allclose(at[5], 1, atol=1e-3)
    assert np.allclose(at[10], 0.2, atol=1e-6), "no value"
    assert np.allclose(mesh_of(Geometry(ramp.shape, color_by="direction")).colors, (1, 0, 0))
    assert np.allclose(mesh_of(Geometry(ramp.shape, color=(0.1, 0.2, 0.3))).colors, (0.1, 0.2, 0.3))


def test_radius_by_scalar() -> None:
    lines = Lines.of([STRAIGHT], [("s", [[1.0, 3.0]])])
    mesh = mesh_of(Geometry(lines, radius=2, radius_by="s", thinnest=0.5, sides=16))
    thin, thick = (np.abs(mesh.points[np.isclose(mesh.points[:, 0], x), 1]).max() for x in (0, 10))
    assert (thin, thick) == (pytest.approx(1), pytest.approx(2))


@pytest.mark.parametrize(
    ("filters", "count"),
    [
        ({}, 3),
        ({"min_length": 5}, 2),
        ({"max_length": 15}, 2),
        ({"rois": (Roi(center=(0, 0, 0), size=(1, 1, 1)),)}, 2),
        ({"rois": (Roi(center=(10, 0, 0), size=(1, 1, 1), keep="ends"),)}, 1),
        ({"rois": (Roi(kind="box", center=(10, 0, 0), size=(2, 2, 2), keep="outside"),)}, 1),
        # Between two points a line passes through a region as well.
        ({"rois": (Roi(center=(15, 0.5, 0), size=(1, 1, 1)),)}, 1),
        ({"rois": (Roi(center=(15, 1.5, 0), size=(1, 1, 1)),)}, 0),
        ({"rois": (Roi(kind="box", center=(15, 0.5, 0), size=(1, 1, 1)),)}, 1),
        ({"rois": (Roi(kind="box", center=(5, 1.5, 0), size=(1, 1, 1)),)}, 0),
        ({"rois": (Roi(kind="box", center=(5, 1.5, 0), size=(1, 1, 1), keep="outside"),)}, 3),
        ({"min_length": 1000}, 0),
    ],
)
def test_filters(filters: dict[str, object], count: int) -> None:
    lines = Lines.of([[[0, 0, 0], [10, 0, 0], [20, 0, 0]], STRAIGHT, [[0, 50, 0], [0, 52, 0]]])
    mesh = mesh_of(Geometry(lines, radius=0.1, sides=3, **filters))
    assert len(mesh.triangles) == count * (6 + 2)  # the middle of the long one is on its chord: it goes


def test_random_part_is_repeatable_and_grows() -> None:
    lines = Lines.of([np.add(STRAIGHT, [0, i, 0]) for i in range(400)])
    few, more = (mesh_of(Geometry(lines, sides=3, radius=0.1, fraction=f)) for f in (0.25, 0.5))
    assert 0.15 * 400 * 8 < len(few.triangles) < 0.35 * 400 * 8
    assert set(few.points[:, 1]) < set(more.points[:, 1])


def wavy(count: int, points: int, seed: int) -> Lines:
    rng = np.random.default_rng(seed)
    steps = np.cumsum(rng.normal(0, 0.3, (count, points, 3)) + np.array([1, 0, 0]), axis=1)
    return Lines.of([line + 40 * rng.random(3) for line in steps])


@pytest.mark.parametrize(("count", "budget"), [(100, 10_000), (600, 10_000), (100, 100_000)])
def test_the_budget_of_triangles_holds(count: int, budget: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """First fewer sides, then fewer points within 4 radii of the lines, then fewer lines, evenly."""
    monkeypatch.setattr(meshing, "BUDGET_TRIANGLES", budget)
    monkeypatch.setattr(meshing, "MOVING_TRIANGLES", budget // 4)
    geometry = Geometry(wavy(count, 60, budget), radius=0.2)
    mesh = mesh_of(geometry)
    assert budget / 4 < len(mesh.triangles) <= 1.05 * budget
    assert mesh.coarse is not None
    assert len(mesh.coarse.triangles) <= 1.1 * budget // 4
    assert mesh.coarse.shown <= mesh.shown <= count
    assert mesh.axes is not None
    ends = cKDTree(
        np.concatenate(
            [
                np.linspace(a, b, 8)
                for a, b in zip(geometry.shape.points, geometry.shape.points[1:], strict=False)
            ]
        )
    )
    assert ends.query(mesh.axes[:, :3])[0].max() < 4 * 0.2


def test_a_fine_surface_has_a_coarse_one_of_the_same_size_and_shape(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(meshing, "MOVING_TRIANGLES", 2000)
    x, y = np.meshgrid(np.linspace(0, 10, 80), np.linspace(0, 10, 80))
    points = np.stack([x, y, np.sin(x)], axis=-1).reshape(-1, 3)
    a = (np.arange(79)[:, None] * 80 + np.arange(79)).ravel()
    triangles = np.concatenate([np.stack([a, a + 1, a + 80], 1), np.stack([a + 1, a + 81, a + 80], 1)])
    mesh = mesh_of(Geometry(Surface(points, triangles)))
    coarse = mesh.coarse
    assert coarse is not None
    assert 500 < len(coarse.triangles) < 4000

    def area(m: sfumato.Mesh) -> float:
        p = faces(m)
        return float(np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum() / 2)

    assert area(coarse) == pytest.approx(area(mesh), rel=0.1)
    assert coarse.bounds == pytest.approx(mesh.bounds, abs=0.3)


def test_mesh_is_kept_and_read_only() -> None:
    geometry = Geometry(Lines.of([STRAIGHT]))
    mesh = mesh_of(geometry)
    assert mesh_of(dataclasses.replace(geometry, visible=False)) is mesh
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0] = 0


def test_scene_round_trip_and_paths() -> None:
    lines = Geometry(Lines.of([helix()], [("s", [np.arange(200.0)])]), name="one", rois=(Roi(),))
    square = Surface(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]]))
    scene = Scene(geometry=[lines, Geometry(square)])
    assert Scene.from_json(json.loads(json.dumps(scene.to_json()))) == scene
    assert scene.camera is not None, "fitted to what is there"
    changed = scene.with_(**{"geometry.0.radius": 1, "geometry.1.visible": False})
    assert (changed.geometry[0].radius, changed.geometry[1].visible) == (1.0, False)
    assert hash(changed) != hash(scene)
    assert changed.geometry[0].key != scene.geometry[0].key
    assert changed.geometry[1].mesh_key == scene.geometry[1].mesh_key


@pytest.mark.parametrize(
    ("field", "value"),
    [("radius", -1), ("color_by", "file"), ("color_by", "scalar"), ("scalar", "x"), ("kind", "surface"),
     ("scalar_range", (2, 1)), ("fraction", 0), ("shape", 3), ("rois", (1,))],
)  # fmt: skip
def test_bad_fields_are_named(field: str, value: object) -> None:
    with pytest.raises(SceneError) as caught:
        Geometry(**{"shape": Lines.of([STRAIGHT]), field: value})
    assert caught.value.path.split(".")[0] == field


@pytest.mark.parametrize(
    "make",
    [
        lambda: Lines(np.zeros((3, 3)), np.array([0, 1, 3])),
        lambda: Lines(np.full((2, 3), np.nan), np.array([0, 2])),
        lambda: Lines(np.zeros((2, 3)), np.array([0, 2]), (("s", np.zeros(3)),)),
        lambda: Lines.of([]),
        lambda: Surface(np.zeros((2, 3)), np.array([[0, 1, 2]])),
        lambda: Geometry.from_json({"shape": {"points": ["<f4", [1 << 40, 3], ""]}}),
        lambda: Geometry.from_json({"shape": {"points": ["<f4", [2, 3], "AAAA"], "offsets": []}}),
        lambda: Geometry.from_json({"no_such": 1}),
        lambda: Geometry.from_json([]),
        lambda: mesh_of(
            Geometry(Lines.of([STRAIGHT], [("s", [[0, 1]])]), color_by="scalar", colormap="nope")
        ),
    ],
)
def test_bad_shapes_are_refused(make) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(SceneError):
        make()
