"""Geometry and voxels of each other format, against writers and readers that are not ours."""

from __future__ import annotations

import json
from pathlib import Path

import nibabel
import numpy as np
import pytest
import SimpleITK as sitk  # noqa: N813  (its own documentation does so)
import tifffile
import zarr

from sfumato import LoadError, Volume
from sfumato.io import guess_raw, load, load_raw

#: A rotation by 30 degrees about an oblique axis.
TURN = np.array([[0.91, -0.24, 0.33], [0.33, 0.91, -0.24], [-0.24, 0.33, 0.91]])
TURN = np.linalg.svd(TURN)[0] @ np.linalg.svd(TURN)[2]
SPACING = np.array([0.5, 0.75, 2.0])
ORIGIN = np.array([10.0, -20.0, 30.0])


def check(
    volume: Volume, data: np.ndarray, direction: np.ndarray = TURN, origin: np.ndarray = ORIGIN
) -> None:
    np.testing.assert_array_equal(volume.data, data)
    np.testing.assert_allclose(volume.spacing, SPACING, rtol=1e-5)
    np.testing.assert_allclose(volume.direction, direction, atol=1e-5)
    np.testing.assert_allclose(volume.origin, origin, atol=1e-4)


def itk_image(data: np.ndarray) -> sitk.Image:
    image = sitk.GetImageFromArray(data)
    image.SetSpacing(SPACING.tolist())
    image.SetOrigin(ORIGIN.tolist())
    image.SetDirection(TURN.ravel().tolist())
    return image


# -- NIfTI -----------------------------------------------------------------------------------------
def ras_affine(axes: np.ndarray = TURN * SPACING) -> np.ndarray:
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = axes, ORIGIN
    return np.diag([-1, -1, 1, 1]) @ affine


@pytest.mark.parametrize("kind", [nibabel.Nifti1Image, nibabel.Nifti2Image])
@pytest.mark.parametrize("form", ["sform", "qform"])
@pytest.mark.parametrize("end", [".nii", ".nii.gz"])
def test_nifti(tmp_path: Path, ramp: np.ndarray, kind: type, form: str, end: str) -> None:
    image = kind(ramp.T, None)
    image.header.set_xyzt_units("mm")
    (image.set_sform if form == "sform" else image.set_qform)(ras_affine(), code=1)
    nibabel.save(image, tmp_path / f"a{end}")
    volume = load(tmp_path / f"a{end}")
    check(volume, ramp)
    assert volume.info.orientation_known


def test_nifti_left_handed_qform(tmp_path: Path, ramp: np.ndarray) -> None:
    image = nibabel.Nifti1Image(ramp.T, None)
    mirrored = TURN * [1, 1, -1]
    image.set_qform(ras_affine(mirrored * SPACING), code=1)
    nibabel.save(image, tmp_path / "a.nii")
    check(load(tmp_path / "a.nii"), ramp, mirrored)


def test_nifti_by_simpleitk(tmp_path: Path, ramp: np.ndarray) -> None:
    sitk.WriteImage(itk_image(ramp), str(tmp_path / "a.nii.gz"))
    check(load(tmp_path / "a.nii.gz"), ramp)


def test_nifti_without_orientation(tmp_path: Path, ramp: np.ndarray) -> None:
    image = nibabel.Nifti1Image(ramp.T, None)
    image.header["pixdim"][1:4] = SPACING
    image.header["qform_code"] = image.header["sform_code"] = 0
    nibabel.save(image, tmp_path / "a.nii")
    volume = load(tmp_path / "a.nii")
    np.testing.assert_allclose(volume.spacing, SPACING)
    assert not volume.info.orientation_known
    assert volume.direction[2] == (0, 0, 1)


def test_nifti_micrometres_and_scaling(tmp_path: Path, ramp: np.ndarray) -> None:
    image = nibabel.Nifti1Image(ramp.T, ras_affine())
    image.header.set_xyzt_units("micron")
    image.header.set_slope_inter(0.5, 3)
    nibabel.save(image, tmp_path / "a.nii")
    volume = load(tmp_path / "a.nii")
    np.testing.assert_allclose(volume.spacing, SPACING / 1000)
    np.testing.assert_allclose(volume.data, nibabel.load(tmp_path / "a.nii").get_fdata().T, rtol=1e-6)


def test_nifti_whole_offset_stays_whole(tmp_path: Path, ramp: np.ndarray) -> None:
    image = nibabel.Nifti1Image(ramp.T, ras_affine())
    nibabel.save(image, tmp_path / "a.nii")
    raw = bytearray((tmp_path / "a.nii").read_bytes())
    raw[112:120] = np.array([1, -1024], "<f4").tobytes()
    (tmp_path / "a.nii").write_bytes(raw)
    volume = load(tmp_path / "a.nii")
    assert volume.data.dtype == np.int16
    np.testing.assert_array_equal(volume.data, ramp - 1024)


def test_sheared_nifti_is_straightened(tmp_path: Path) -> None:
    shear = np.array([[1, 0, 0.3], [0, 1, 0], [0, 0, 1.0]])
    z, y, x = np.mgrid[:8, :9, :10].astype(np.float32)
    world = np.stack([x, y, z], axis=-1) @ shear.T + ORIGIN
    data = world @ np.array([1.0, 2.0, 3.0])  # linear in space: interpolation is exact
    nibabel.save(nibabel.Nifti1Image(data.T.astype(np.float32), ras_affine(shear)), tmp_path / "a.nii")
    volume = load(tmp_path / "a.nii")
    assert "right angles" in volume.info.notices[0]
    middle = np.array(volume.dims) // 2
    place = np.asarray(volume.direction) * volume.spacing @ middle + volume.origin
    assert volume.data[tuple(middle[::-1])] == pytest.approx(place @ [1, 2, 3], abs=1e-2)


def test_4d_and_colour_nifti(tmp_path: Path, ramp: np.ndarray) -> None:
    both = np.stack([ramp.T, ramp.T + 500], axis=-1)
    nibabel.save(nibabel.Nifti1Image(both, ras_affine()), tmp_path / "4d.nii.gz")
    first, second = load(tmp_path / "4d.nii.gz"), load(tmp_path / "4d.nii.gz", frame=1)
    check(first, ramp)
    assert "2 frames" in first.info.notices[0]
    check(second, ramp + 500)
    colours = np.zeros(ramp.T.shape, dtype=[("R", "u1"), ("G", "u1"), ("B", "u1")])
    colours["G"] = 100
    colours["R"][3:] = 200
    nibabel.save(nibabel.Nifti1Image(colours, ras_affine()), tmp_path / "rgb.nii")
    volume = load(tmp_path / "rgb.nii")
    assert set(np.unique(volume.data)) == {72, 114}
    assert "colour" in volume.info.notices[0]


def test_analyze_pair(tmp_path: Path, ramp: np.ndarray) -> None:
    image = nibabel.AnalyzeImage(ramp.T, None)
    image.header.set_zooms(SPACING)
    nibabel.save(image, tmp_path / "a.img")
    for name in ("a.img", "a.hdr"):
        volume = load(tmp_path / name)
        np.testing.assert_array_equal(volume.data, ramp)
        np.testing.assert_allclose(volume.spacing, SPACING)
        assert not volume.info.orientation_known


# -- NRRD, MetaImage, MINC --------------------------------------------------------------------------
@pytest.mark.parametrize("name", ["a.nrrd", "a.nhdr", "a.mha", "a.mhd"])
@pytest.mark.parametrize("packed", [False, True])
def test_itk_formats(tmp_path: Path, ramp: np.ndarray, name: str, packed: bool) -> None:
    sitk.WriteImage(itk_image(ramp), str(tmp_path / name), packed)
    volume = load(tmp_path / name)
    check(volume, ramp)
    assert volume.info.orientation_known


def test_nrrd_in_ras_and_sheared(tmp_path: Path, ramp: np.ndarray) -> None:
    axes = ras_affine()[:3, :3]
    vectors = " ".join("(" + ",".join(f"{c:.9f}" for c in axes[:, k]) + ")" for k in range(3))
    header = f"NRRD0004\ntype: short\ndimension: 3\nspace: RAS\nsizes: 7 6 5\nspace directions: {vectors}\n"
    header += "endian: big\nencoding: raw\nspace origin: (-10,20,30)\n\n"
    (tmp_path / "a.nrrd").write_bytes(header.encode() + ramp.astype(">i2").tobytes())
    check(load(tmp_path / "a.nrrd"), ramp)
    skewed = header.replace(vectors, "(1,0,0) (0.5,1,0) (0,0,1)")
    (tmp_path / "b.nrrd").write_bytes(skewed.encode() + ramp.astype(">i2").tobytes())
    assert "right angles" in load(tmp_path / "b.nrrd").info.notices[0]


def test_large_nrrd_and_meta_are_mapped(tmp_path: Path) -> None:
    data = np.arange(8 * 10 * 12, dtype=np.int16).reshape(8, 10, 12)
    for name in ("a.nrrd", "a.mhd", "a.mha"):
        sitk.WriteImage(itk_image(data), str(tmp_path / name), False)
        volume = load(tmp_path / name, budget_bytes=data.nbytes // 4)
        assert volume.data.nbytes <= data.nbytes // 4
        assert "Reduced from 12 x 10 x 8" in volume.info.notices[0]


def test_meta_without_orientation(tmp_path: Path, ramp: np.ndarray) -> None:
    text = (
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 7 6 5\n"
    )
    (tmp_path / "a.mhd").write_text(
        text + "ElementSpacing = 0.5 0.75 2\nElementType = MET_SHORT\nElementDataFile = a.raw\n"
    )
    (tmp_path / "a.raw").write_bytes(ramp.astype("<i2").tobytes())
    for name in ("a.mhd", "a.raw"):
        volume = load(tmp_path / name)
        check(volume, ramp, np.eye(3), SPACING / 2)
        assert not volume.info.orientation_known


def test_minc_agrees_with_nibabel(tmp_path: Path, ramp: np.ndarray) -> None:
    sitk.WriteImage(itk_image(ramp), str(tmp_path / "a.mnc"))
    theirs, volume = nibabel.load(tmp_path / "a.mnc"), load(tmp_path / "a.mnc")
    ours = np.asarray(volume.direction) * volume.spacing
    for index in ((0, 0, 0), (4, 5, 6), (1, 2, 3)):
        world = np.diag([-1, -1, 1]) @ (ours @ index[::-1] + volume.origin)
        place = np.linalg.inv(theirs.affine) @ [*world, 1]
        near = tuple(round(float(c)) for c in place[:3])
        np.testing.assert_allclose(place[:3], near, atol=1e-3)
        assert theirs.get_fdata()[near] == pytest.approx(volume.data[index], abs=0.6)


def test_vector_image_becomes_length(tmp_path: Path) -> None:
    vectors = np.zeros((4, 5, 6, 3), dtype=np.float32)
    vectors[..., 0], vectors[..., 1] = 3, 4
    vectors[0, 0, 0] = 0
    sitk.WriteImage(sitk.GetImageFromArray(vectors, isVector=True), str(tmp_path / "a.nrrd"))
    volume = load(tmp_path / "a.nrrd")
    assert volume.value_range == (0, 5)
    assert "vectors" in volume.info.notices[0]


# -- VTK -------------------------------------------------------------------------------------------
def test_vti_with_direction_extent_and_cells(tmp_path: Path, ramp: np.ndarray) -> None:
    import pyvista

    grid = pyvista.ImageData(dimensions=(7, 6, 5), spacing=SPACING, origin=ORIGIN)
    grid.direction_matrix = TURN
    grid.point_data["density"] = ramp.ravel()
    grid.save(tmp_path / "a.vti")
    check(load(tmp_path / "a.vti"), ramp)
    cells = pyvista.ImageData(dimensions=(8, 7, 6), spacing=SPACING, origin=ORIGIN)
    cells.cell_data["density"] = ramp.ravel()
    cells.save(tmp_path / "b.vti")
    check(load(tmp_path / "b.vti"), ramp, np.eye(3), ORIGIN + SPACING / 2)
    cells.save(tmp_path / "c.vtk")
    check(load(tmp_path / "c.vtk"), ramp, np.eye(3), ORIGIN + SPACING / 2)


def test_rectilinear_grid_is_resampled(tmp_path: Path) -> None:
    import pyvista

    x = np.array([0, 1, 2, 4, 5.0])
    grid = pyvista.RectilinearGrid(x, np.arange(4.0), np.arange(3.0))
    grid.point_data["v"] = grid.points[:, 0] * 10
    grid.save(tmp_path / "a.vtr")
    volume = load(tmp_path / "a.vtr")
    np.testing.assert_allclose(
        volume.data[0, 0], 10 * volume.spacing[0] * np.arange(volume.dims[0]), atol=1e-4
    )
    assert "unevenly" in volume.info.notices[0]


def test_poly_data_is_no_volume(tmp_path: Path) -> None:
    import pyvista

    pyvista.Sphere().save(tmp_path / "a.vtk")
    with pytest.raises(LoadError, match="polydata, which is not a volume"):
        load(tmp_path / "a.vtk")


# -- TIFF ------------------------------------------------------------------------------------------
def test_imagej_tiff(tmp_path: Path, ramp: np.ndarray) -> None:
    tifffile.imwrite(
        tmp_path / "a.tif",
        ramp,
        imagej=True,
        resolution=(1 / 500, 1 / 750),
        metadata={"spacing": 2000, "unit": "um", "axes": "ZYX"},
    )
    volume = load(tmp_path / "a.tif")
    np.testing.assert_array_equal(volume.data, ramp)
    assert volume.spacing == pytest.approx(SPACING, rel=1e-4)


@pytest.mark.parametrize("compression", [None, "zlib"])
def test_ome_and_plain_tiff(tmp_path: Path, ramp: np.ndarray, compression: str | None) -> None:
    stacks = np.stack([ramp, ramp + 1000])
    about = {"axes": "CZYX", "PhysicalSizeX": 500, "PhysicalSizeY": 750, "PhysicalSizeZ": 2000}
    tifffile.imwrite(tmp_path / "a.ome.tif", stacks, metadata=about, compression=compression)
    volume = load(tmp_path / "a.ome.tif", frame=1)
    np.testing.assert_array_equal(volume.data, ramp + 1000)
    assert volume.spacing == pytest.approx(SPACING)
    tifffile.imwrite(tmp_path / "b.tif", ramp, compression=compression, metadata=None)
    np.testing.assert_array_equal(load(tmp_path / "b.tif").data, ramp)


def test_colour_tiff(tmp_path: Path) -> None:
    pages = np.zeros((4, 5, 6, 3), dtype=np.uint8)
    pages[1:] = (200, 100, 0)
    tifffile.imwrite(tmp_path / "a.tif", pages, photometric="rgb")
    volume = load(tmp_path / "a.tif")
    assert volume.dims == (6, 5, 4)
    assert volume.value_range == (0, 114)


@pytest.mark.parametrize("end", ["tif", "png"])
def test_folder_of_slices_in_natural_order(tmp_path: Path, ramp: np.ndarray, end: str) -> None:
    from PIL import Image

    for k in range(12):
        Image.fromarray(np.full((4, 5), k, np.uint8)).save(tmp_path / f"slice{k}.{end}")
    np.testing.assert_array_equal(load(tmp_path).data[:, 0, 0], np.arange(12))
    Image.fromarray(np.zeros((3, 3), np.uint8)).save(tmp_path / f"slice12.{end}")
    with pytest.raises(LoadError, match=r"slice12\.\w+ has another size"):
        load(tmp_path)


# -- Zarr ------------------------------------------------------------------------------------------
def write_ome(path: Path, version: str, data: np.ndarray) -> None:
    """Write a pyramid of two levels with axes (c, x, z, y) in micrometres."""
    root = zarr.open_group(path, mode="w", zarr_format=2 if version == "0.4" else 3)
    datasets = []
    for level, factor in enumerate((1, 2)):
        voxels = np.stack([np.transpose(data, (2, 0, 1))] * 2)[:, ::factor, ::factor, ::factor]
        array = root.create_array(f"s{level}", shape=voxels.shape, dtype=voxels.dtype, chunks=(1, 4, 3, 4))
        array[...] = voxels
        scale = [1, *(SPACING[[0, 2, 1]] * 1000 * factor)]
        steps = [
            {"type": "scale", "scale": scale},
            {"type": "translation", "translation": [0, 10000, 30000, -20000]},
        ]
        datasets.append({"path": f"s{level}", "coordinateTransformations": steps})
    axes = [
        {"name": "c", "type": "channel"},
        *({"name": n, "type": "space", "unit": "micrometer"} for n in "xzy"),
    ]
    image = {"version": version, "axes": axes, "datasets": datasets}
    root.attrs.update(
        {"multiscales": [image]}
        if version == "0.4"
        else {"ome": {"version": version, "multiscales": [image]}}
    )


@pytest.mark.parametrize("version", ["0.4", "0.5"])
def test_ome_zarr(tmp_path: Path, version: str) -> None:
    data = np.arange(8 * 6 * 10, dtype=np.uint16).reshape(8, 6, 10)
    write_ome(tmp_path / "a.zarr", version, data)
    volume = load(tmp_path / "a.zarr")
    check(volume, data, np.eye(3))
    coarse = load(tmp_path / "a.zarr", budget_bytes=data.nbytes // 2)
    np.testing.assert_array_equal(coarse.data, data[::2, ::2, ::2])
    np.testing.assert_allclose(coarse.spacing, SPACING * 2)
    assert "Level 1 of 2" in " ".join(coarse.info.notices)
    assert load(tmp_path / "a.zarr", level=1).key == coarse.key
    with pytest.raises(LoadError, match="no level 2"):
        load(tmp_path / "a.zarr", level=2)


# -- NumPy and RAW ---------------------------------------------------------------------------------
def test_npy_and_npz(tmp_path: Path, ramp: np.ndarray) -> None:
    np.save(tmp_path / "a.npy", ramp)
    np.testing.assert_array_equal(load(tmp_path / "a.npy").data, ramp)
    np.savez(tmp_path / "a.npz", volume=ramp, spacing=SPACING, origin=ORIGIN, direction=TURN, other=ramp[0])
    volume = load(tmp_path / "a.npz")
    check(volume, ramp)
    assert "other" in volume.info.notices[0]
    np.save(tmp_path / "b.npy", np.stack([ramp, ramp + 9]))
    assert load(tmp_path / "b.npy", frame=1).value_range[0] == 9


@pytest.mark.parametrize("name", ["a.npy", "a.npz"])
def test_pickles_are_refused(tmp_path: Path, name: str) -> None:
    evil = np.array([[[{"a": 1}]]], dtype=object)
    (np.save if name.endswith("npy") else np.savez)(tmp_path / name, evil)
    with pytest.raises(LoadError, match="never loaded"):
        load(tmp_path / name)


def test_raw_by_name_json_and_hand(tmp_path: Path, ramp: np.ndarray) -> None:
    named = tmp_path / "ramp_7x6x5_int16.raw"
    named.write_bytes(ramp.astype("<i2").tobytes())
    np.testing.assert_array_equal(load(named).data, ramp)
    assert guess_raw(named)[0].dims == (7, 6, 5)
    bare = tmp_path / "bare.raw"
    bare.write_bytes(b"0123456789" + ramp.astype(">i2").tobytes())
    with pytest.raises(LoadError, match="without a description"):
        load(bare)
    volume = load_raw(bare, (7, 6, 5), ">i2", tuple(SPACING), offset=10)
    check(volume, ramp, np.eye(3), SPACING / 2)
    with pytest.raises(LoadError, match="truncated"):
        load_raw(bare, (70, 60, 50), "u1")
    about = {"dims": [7, 6, 5], "dtype": "int16", "spacing": list(SPACING)}
    (tmp_path / "side.raw").write_bytes(ramp.astype("<i2").tobytes())
    (tmp_path / "side.json").write_text(json.dumps(about))
    check(load(tmp_path / "side.raw"), ramp, np.eye(3), SPACING / 2)


def test_raw_guesses_from_size(tmp_path: Path) -> None:
    path = tmp_path / "x.raw"
    path.write_bytes(bytes(64 * 64 * 40 * 2))
    guesses = guess_raw(path)
    assert ((64, 64, 40), "uint16") in {(g.dims, g.dtype) for g in guesses}
    assert not any(g.sure for g in guesses)
    assert all(
        np.prod(g.dims) * np.dtype(g.dtype).itemsize + g.offset == path.stat().st_size for g in guesses
    )
