"""Files of tracts and meshes, written here by other libraries, become geometry in LPS millimetres."""

import json
import struct
import zipfile
from pathlib import Path

import nibabel
import numpy as np
import pytest
from nibabel.streamlines import TckFile, Tractogram, TrkFile

import sfumato
from sfumato import Geometry, Lines, LoadError, Scene, SceneError, Surface
from sfumato.geometry import is_geometry, load_geometry, mesh_of, outside_notice
from sfumato.io import LoadCancelled

#: RAS mm, as nibabel's users know them.
LINES = [
    np.array([[1, 2, 3], [4, 5, 6], [7, 8, 9.5]], np.float32),
    np.array([[-1, 0, 0], [0, 0, 1]], np.float32),
]
LPS = [line * np.array([-1, -1, 1]) for line in LINES]


def lines_in(geometry: Geometry) -> list[np.ndarray]:
    assert isinstance(geometry.shape, Lines)
    return np.split(geometry.shape.points, geometry.shape.offsets[1:-1])


def same(geometry: Geometry, wanted: list[np.ndarray] = LPS) -> bool:
    found = lines_in(geometry)
    return len(found) == len(wanted) and all(
        np.allclose(a, b, atol=1e-4) for a, b in zip(found, wanted, strict=True)
    )


def write_trk(path: Path, lines: list[np.ndarray] = LINES, *, per_line: bool = True) -> Path:
    values = {"fa": [np.full((len(line), 1), i + 0.5, np.float32) for i, line in enumerate(lines)]}
    weights = {"weight": [[float(i)] for i in range(len(lines))]} if per_line else None
    tractogram = Tractogram(lines, weights, values, affine_to_rasmm=np.eye(4))
    affine = np.array([[2, 0, 0, -80], [0, 0, -2, 90], [0, 3, 0, -60], [0, 0, 0, 1.0]])
    base = {
        "voxel_to_rasmm": affine,
        "voxel_sizes": (2, 3, 2),
        "dimensions": (80, 90, 70),
        "voxel_order": "RSP",
    }
    TrkFile(tractogram, base).save(str(path))
    return path


def write_trx(path: Path, positions: np.ndarray, offsets: list[int], extra: dict[str, np.ndarray] | None = None,
              header: dict[str, object] | None = None, compression: int = zipfile.ZIP_STORED) -> Path:  # fmt: skip
    with zipfile.ZipFile(path, "w", compression) as archive:
        archive.writestr("header.json", json.dumps({"NB_STREAMLINES": 2, **(header or {})}))
        archive.writestr(f"positions.3.{positions.dtype}", positions.tobytes())
        archive.writestr("offsets.uint64", np.array(offsets, "<u8").tobytes())
        for name, values in (extra or {}).items():
            archive.writestr(name, values.tobytes())
    return path


def poly_of(lines: list[np.ndarray]) -> "pyvista.PolyData":  # type: ignore[name-defined]  # noqa: F821
    import pyvista

    cells = np.concatenate(
        [[len(line), *range(at, at + len(line))] for line, at in zip(lines, (0, 3), strict=True)]
    )
    return pyvista.PolyData(np.concatenate(lines).astype(np.float32), lines=cells)


# -- formats ---------------------------------------------------------------------------------------
def test_trk_lies_where_its_affine_says(tmp_path: Path) -> None:
    geometry = load_geometry(write_trk(tmp_path / "a.trk"))
    assert same(geometry)
    assert geometry.kind == "tracts"
    assert geometry.notices == ()
    assert set(geometry.scalar_names) == {"fa", "weight"}
    assert geometry.scalar_values("fa").tolist() == [0.5] * 3 + [1.5] * 2
    assert geometry.scalar_values("weight").tolist() == [0] * 3 + [1] * 2


def test_trk_without_affine_says_so(tmp_path: Path) -> None:
    path = write_trk(tmp_path / "a.trk")
    data = bytearray(path.read_bytes())
    data[440:504] = bytes(64)  # vox_to_ras
    path.write_bytes(data)
    assert any("no affine" in n for n in load_geometry(path).notices)


def test_tck(tmp_path: Path) -> None:
    TckFile(Tractogram(LINES, affine_to_rasmm=np.eye(4))).save(str(tmp_path / "a.tck"))
    assert same(load_geometry(tmp_path / "a.tck"))


@pytest.mark.parametrize("compression", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("kind", ["float16", "float32", "float64"])
def test_trx(tmp_path: Path, compression: int, kind: str) -> None:
    extra = {
        "dpv/fa.float32": np.arange(5, dtype=np.float32),
        "dps/w.float16": np.array([3, 4], np.float16),
        "dpv/dir.3.float32": np.tile(np.float32([3, 4, 0]), (5, 1)),
        "groups/left.uint32": np.array([1], np.uint32),
        "dps/broken.float32": np.zeros(7, np.float32),
    }
    path = write_trx(
        tmp_path / "a.trx", np.concatenate(LINES).astype(kind), [0, 3, 5], extra, None, compression
    )
    geometry = load_geometry(path)
    assert same(geometry)
    assert {n: geometry.scalar_values(n).tolist() for n in geometry.scalar_names} == {
        "fa": [0, 1, 2, 3, 4], "w": [3, 3, 3, 4, 4], "dir": [5] * 5, "group": [0, 0, 0, 1, 1],
    }  # fmt: skip
    assert len(geometry.notices) == 1
    assert "broken" in geometry.notices[0]


def test_trx_without_the_last_offset_and_as_a_folder(tmp_path: Path) -> None:
    path = write_trx(tmp_path / "a.trx", np.concatenate(LINES), [0, 3])
    assert same(load_geometry(path))
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path / "folder.trx")
    assert same(load_geometry(tmp_path / "folder.trx"))


@pytest.mark.parametrize("suffix", [".vtp", ".vtk"])
@pytest.mark.parametrize("binary", [True, False])
def test_poly_data_lines(tmp_path: Path, suffix: str, binary: bool) -> None:
    poly = poly_of(LPS)
    poly.point_data["s"] = np.arange(5.0)
    poly.cell_data["c"] = [7.0, 8.0]
    poly.save(tmp_path / f"a{suffix}", binary=binary)
    geometry = load_geometry(tmp_path / f"a{suffix}")
    assert same(geometry)
    assert geometry.scalar_values("s").tolist() == [0, 1, 2, 3, 4]
    assert geometry.scalar_values("c").tolist() == [7, 7, 7, 8, 8]
    assert any("does not name its space" in n for n in geometry.notices)
    assert same(load_geometry(tmp_path / f"a{suffix}", space="RAS"), LINES)


def test_the_space_that_a_file_names_is_heeded(tmp_path: Path) -> None:
    poly = poly_of(LINES)
    poly.field_data["SPACE"] = ["RAS"]
    poly.save(tmp_path / "a.vtp")
    assert same(load_geometry(tmp_path / "a.vtp"))
    poly_of(LINES).save(tmp_path / "b.vtk")
    text = (tmp_path / "b.vtk").read_bytes()
    (tmp_path / "b.vtk").write_bytes(text.replace(text.split(b"\n")[1], b"made by hand SPACE=RAS", 1))
    assert same(load_geometry(tmp_path / "b.vtk"))
    assert load_geometry(tmp_path / "b.vtk").notices == ()


@pytest.mark.parametrize("suffix", [".stl", ".ply", ".obj", ".vtp", ".vtk"])
def test_surfaces_face_out(tmp_path: Path, suffix: str) -> None:
    import pyvista

    sphere = pyvista.Sphere(radius=10, center=(1, 2, 3), theta_resolution=24, phi_resolution=24)
    pyvista.PolyData(sphere.points, sphere.faces).save(tmp_path / f"s{suffix}")
    geometry = load_geometry(tmp_path / f"s{suffix}")
    assert isinstance(geometry.shape, Surface)
    assert geometry.bounds.mean(axis=0) == pytest.approx([1, 2, 3], abs=0.1)
    mesh = mesh_of(geometry)
    out = mesh.points - np.float32([1, 2, 3])
    assert (np.einsum("ij,ij->i", out, mesh.normals) > 9.5).all()
    p = mesh.points[mesh.triangles]
    faces = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    assert (np.einsum("ij,ij->i", faces, out[mesh.triangles[:, 0]]) > 0).all()


def test_sharp_edges_stay_sharp_and_colours_are_read(tmp_path: Path) -> None:
    import pyvista

    cube = pyvista.Cube().triangulate().clean()
    head = f"ply\nformat ascii 1.0\nelement vertex {cube.n_points}\n"
    head += "".join(f"property float {a}\n" for a in "xyz") + "".join(
        f"property uchar {c}\n" for c in ("red", "green", "blue")
    )
    head += f"element face {cube.n_cells}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = [f"{x} {y} {z} 255 188 0" for x, y, z in cube.points]
    rows += ["3 " + " ".join(map(str, face)) for face in cube.regular_faces]
    (tmp_path / "c.ply").write_text(head + "\n".join(rows) + "\n")
    geometry = load_geometry(tmp_path / "c.ply")
    mesh = mesh_of(geometry)
    assert np.sort(np.abs(mesh.normals), axis=1) == pytest.approx(np.tile([0, 0, 1], (24, 1)), abs=1e-6)
    assert geometry.color_by == "file"
    assert np.allclose(mesh.colors, (1, 0.5, 0), atol=5e-3)


# -- bad input -------------------------------------------------------------------------------------
def test_bad_lines_are_left_out_and_counted(tmp_path: Path) -> None:
    nan = LINES[0].copy()
    nan[1] = np.nan
    long = np.arange(18, dtype=np.float32).reshape(6, 3)
    long[3] = np.nan
    geometry = load_geometry(
        write_trk(tmp_path / "a.trk", [LINES[1], LINES[0][:1], nan, long], per_line=False)
    )
    assert [len(line) for line in lines_in(geometry)] == [2, 3, 2]
    text = " ".join(geometry.notices)
    assert "1 line of one point" in text
    assert "2 lines with 2 points that are NaN or far away cut there, 1 of them left out whole" in text


def test_nothing_to_show_is_an_error_with_counts(tmp_path: Path) -> None:
    with pytest.raises(LoadError, match=r"nothing to show \(1 line of one point left out\)"):
        load_geometry(write_trk(tmp_path / "a.trk", [LINES[0][:1]]))


def test_outside_the_volume_is_counted(tmp_path: Path) -> None:
    volume = sfumato.Volume(np.zeros((10, 10, 10), np.uint8))
    lines = Geometry(Lines.of([[[1, 1, 1], [2, 2, 2]], [[1, 1, 1], [20, 2, 2]], [[-9, 1, 1], [-8, 2, 2]]]))
    assert outside_notice(lines, volume.texture_from_world) == (
        "2 lines of 3 leave the volume, 1 of them lie outside it altogether."
    )
    far = Geometry(Surface(np.eye(3) + 50, np.array([[0, 1, 2]])))
    assert "another scan" in outside_notice(far, volume.texture_from_world)
    assert outside_notice(Geometry(Lines.of([[[1, 1, 1], [2, 2, 2]]])), volume.texture_from_world) == ""


def _truncated(path: Path) -> Path:
    path.write_bytes(path.read_bytes()[:-40])
    return path


def _bad_files(folder: Path) -> dict[str, Path]:
    made = {"missing": folder / "no.trk"}
    for suffix in (".trk", ".tck", ".trx", ".vtp", ".vtk", ".stl", ".ply", ".obj"):
        for kind, data in (
            ("empty", b""),
            ("text", b"nothing of the kind\n" * 20),
            ("noise", bytes(range(256)) * 8),
        ):
            made[f"{kind}{suffix}"] = folder / f"{kind}{suffix}"
            made[f"{kind}{suffix}"].write_bytes(data)
    made["png"] = folder / "a.png"
    made["png"].write_bytes(b"")
    made["cut trx"] = write_trx(folder / "cut.trx", np.concatenate(LINES)[:4], [0, 3, 5])
    made["odd trx"] = write_trx(folder / "odd.trx", np.concatenate(LINES), [0, 4, 3])
    points = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 99999999999 float\n0 0 0\n"
    made["claim"] = folder / "claim.vtk"
    made["claim"].write_text(points)
    made["index"] = folder / "index.vtk"
    made["index"].write_text(points.replace("99999999999", "2") + "1 1 1\nLINES 1 3\n2 0 7\n")
    made["points"] = folder / "points.vtk"
    made["points"].write_text(points.replace("99999999999", "1"))
    made["volume"] = folder / "volume.vtk"
    made["volume"].write_text(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
    )
    made["huge trk"] = folder / "huge.trk"
    made["huge trk"].write_bytes(
        write_trk(folder / "b.trk").read_bytes()[:1000] + struct.pack("<i", 2**31 - 1)
    )
    made["negative trk"] = folder / "negative.trk"
    made["negative trk"].write_bytes(write_trk(folder / "b.trk").read_bytes()[:1000] + struct.pack("<i", -5))
    return made


def test_bad_files_give_one_line(tmp_path: Path) -> None:
    for what, path in _bad_files(tmp_path).items():
        with pytest.raises(LoadError) as caught:
            load_geometry(path)
        assert "\n" not in str(caught.value), what
        assert str(path) in str(caught.value), what


def test_unknown_space_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="LPS or RAS"):
        load_geometry(tmp_path / "a.stl", space="MNI")


# -- progress, scenes ------------------------------------------------------------------------------
def test_progress_and_cancel(tmp_path: Path) -> None:
    many = [np.random.default_rng(i).random((2000, 3)).astype(np.float32) for i in range(150)]
    path = write_trk(tmp_path / "a.trk", many)
    steps: list[float] = []
    load_geometry(path, progress=lambda fraction, _: steps.append(fraction))
    assert steps == sorted(steps)
    assert steps[-1] == 1
    assert len(steps) > 5
    with pytest.raises(LoadCancelled):
        load_geometry(path, cancel=lambda: len(steps.append(0) or steps) > len(steps) - 1)


def test_scene_names_its_geometry_by_path_and_hash(tmp_path: Path) -> None:
    write_trk(tmp_path / "a.trk")
    (tmp_path / "sub").mkdir()
    geometry = load_geometry(tmp_path / "a.trk")
    scene = Scene(geometry=[geometry]).with_(**{"geometry.0.radius": 0.7, "geometry.0.color_by": "scalar"})
    scene.save(tmp_path / "s.sfumato")
    data = json.loads((tmp_path / "s.sfumato").read_text())
    assert data["geometry"][0]["path"] == "a.trk"
    assert "shape" not in data["geometry"][0]
    again = Scene.open(tmp_path / "s.sfumato")
    assert again.geometry[0].shape == geometry.shape
    assert (again.geometry[0].radius, again.geometry[0].color_by) == (0.7, "scalar")
    write_trk(tmp_path / "a.trk", LINES[:1])
    with pytest.raises(LoadError, match="content differs"):
        Scene.open(tmp_path / "s.sfumato")


def test_is_geometry(tmp_path: Path) -> None:
    files = _bad_files(tmp_path)
    assert is_geometry(files["claim"])
    assert not is_geometry(files["volume"])
    assert is_geometry("x.TRK")
    assert not is_geometry("x.nii.gz")


@pytest.mark.real_data
def test_real_tracts_lie_in_their_scan() -> None:
    folder = Path(__file__).parents[4] / "shared/data/tracts_stanford_hardi"
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there")
    volume = sfumato.load(next(folder.glob("*.nii.gz")))
    for path, count in ((next(folder.glob("*.trk")), 1241), (next(folder.glob("*.trx")), 508)):
        geometry = load_geometry(path)
        assert geometry.shape.count == count
        assert geometry.notices == ()
        assert outside_notice(geometry, volume.texture_from_world) == ""
        # Tracts run through the brain: the scan is bright there.
        index = nibabel.affines.apply_affine(volume.texture_from_world, geometry.shape.points)
        voxels = np.floor(index * volume.dims).astype(int)
        assert np.median(volume.data[tuple(voxels.T[::-1])]) > np.median(volume.data)
