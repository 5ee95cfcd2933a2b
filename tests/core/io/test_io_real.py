"""Every real data set loads with the dimensions, spacing and values that its META.json verified."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sfumato.io import find_series, load

pytestmark = pytest.mark.real_data

#: Data set: what to open in it. DICOM sets are opened as folders.
SETS = {
    "aneurism": "aneurism.vti",
    "carotid_flow": "carotid.vtk",
    "ch2": "ch2.nii.gz",
    "cranium_invesalius": "cranium.mhd",
    "ct_bone_tiff": "bone_128x128x128.tif",
    "ct_torso_totalseg": "example_ct.nii.gz",
    "dicom_ct_body_j2k": "",
    "dicom_ct_head_tiny": "",
    "dicom_mr_t1_pddl": "",
    "dicom_multiframe_and_syntaxes": "emri_small.dcm",
    "dti_fa_v1": "FA.nii.gz",
    "embryo_slc": "embryo.slc",
    "engine": "engine.vti",
    "lobster": "lobster.mhd",
    "mni152_omezarr": "mni152.ome.zarr",
    "mr_head_electrodes": "MR.nii.gz",
    "stent": "stent.nrrd",
    "stroke_multimodal": "T1.nii.gz",
    "tooth": "tooth.mhd",
    "tracts_stanford_hardi": "sub-01_ses-01_dwi_desc-b0_dwi.nii.gz",
    "us_phantom_kretz": "us_scanconverted_0.3mm.nrrd",
}
MODALITIES = {
    "cranium_invesalius": "CT",
    "ct_torso_totalseg": "CT",
    "dicom_ct_body_j2k": "CT",
    "dicom_mr_t1_pddl": "MR",
    "dicom_multiframe_and_syntaxes": "MR",
}


def verified(data_dir: Path, name: str) -> dict[str, Any]:
    meta = json.loads((data_dir / name / "META.json").read_text(encoding="utf-8"))
    return {"spacing": meta["spacing"], **meta["verified"]}


@pytest.mark.parametrize("name", SETS)
def test_set(data_dir: Path, name: str) -> None:
    known, volume = verified(data_dir, name), load(data_dir / name / SETS[name])
    assert list(volume.dims) == known.get("shape_xyz", known.get("dims"))
    assert volume.spacing == pytest.approx(known["spacing"], abs=1e-3)
    if "min" in known:
        assert volume.value_range == pytest.approx((known["min"], known["max"]), rel=1e-6)
        assert float(volume.data.mean(dtype=np.float64)) == pytest.approx(known["mean"], rel=1e-5)
    assert volume.info.modality == MODALITIES.get(name, "")
    if "orient" in known:
        from nibabel.orientations import aff2axcodes

        ras = np.diag([-1, -1, 1]) @ np.asarray(volume.direction)
        affine = np.eye(4)
        affine[:3, :3] = ras
        codes = "".join(aff2axcodes(affine))
        assert codes == known["orient"]
        assert volume.info.orientation_known


def test_bounds_of_vtk(data_dir: Path) -> None:
    for name, file in (("carotid_flow", "carotid.vtk"), ("wind_rectgrid", "RectGrid2.vtk")):
        known, volume = verified(data_dir, name), load(data_dir / name / file)
        low = np.array(volume.origin)
        high = low + np.array(volume.spacing) * (np.array(volume.dims) - 1)
        np.testing.assert_allclose(np.stack([low, high], axis=1).ravel(), known["bounds"], atol=1e-4)
        assert "vectors" in volume.info.notices[0]


def test_tilted_phantom_is_straightened(data_dir: Path) -> None:
    known, volume = (
        verified(data_dir, "dicom_ct_phantom_tilt_philips"),
        load(data_dir / "dicom_ct_phantom_tilt_philips"),
    )
    x, y, z = volume.dims
    assert (x, z) == (512, 27)
    assert y == 512 + 86  # 26 steps of 4.742 mm, each moved by tan(18.5 degrees)
    assert volume.spacing == pytest.approx(known["spacing"], abs=1e-6)
    assert volume.value_range == pytest.approx((known["min"], known["max"]), abs=2)
    assert "18.5 degrees" in volume.info.notices[0]


@pytest.mark.parametrize("file", ["FLAIR.nii.gz", "T2.nii.gz", "T1.nii.gz"])
def test_nifti_agrees_with_nibabel(data_dir: Path, file: str) -> None:
    import nibabel

    path = data_dir / "stroke_multimodal" / file
    theirs, volume = nibabel.load(path), load(path)
    np.testing.assert_allclose(volume.data, np.asarray(theirs.dataobj).T, rtol=1e-6)
    affine = np.diag([-1, -1, 1, 1]) @ theirs.affine
    np.testing.assert_allclose(np.asarray(volume.direction) * volume.spacing, affine[:3, :3], atol=1e-4)
    np.testing.assert_allclose(volume.origin, affine[:3, 3], atol=1e-3)


@pytest.mark.parametrize("syntax", ["RLE", "big_endian", "jpeg_2k_lossless", "jpeg_ls_lossless"])
def test_syntaxes_hold_the_same_voxels(data_dir: Path, syntax: str) -> None:
    folder = data_dir / "dicom_multiframe_and_syntaxes"
    assert load(folder / f"emri_small_{syntax}.dcm").key == load(folder / "emri_small.dcm").key


def test_enhanced_ct(data_dir: Path) -> None:
    volume = load(data_dir / "dicom_multiframe_and_syntaxes" / "eCT_Supplemental.dcm")
    assert volume.dims == (512, 512, 2)
    assert volume.spacing == pytest.approx((0.388672, 0.388672, 10.0))
    np.testing.assert_allclose(volume.origin, (99.5, -301.5, -149.0))
    np.testing.assert_allclose(np.asarray(volume.direction)[:, 2], (0, 0, -1), atol=1e-6)
    assert volume.info.modality == "CT"


def test_many_series_in_a_folder(data_dir: Path) -> None:
    found = find_series(data_dir / "dicom_multiframe_and_syntaxes")
    assert [s.count for s in found] == [10, 2, 1, 1, 1, 1]
    assert load(data_dir / "dicom_multiframe_and_syntaxes", series=1).info.modality == "CT"


def test_dicom_agrees_with_simpleitk(data_dir: Path) -> None:
    import SimpleITK as sitk  # noqa: N813  (its own documentation does so)

    folder = str(data_dir / "dicom_mr_t1_pddl")
    reader = sitk.ImageSeriesReader()
    reader.SetFileNames(reader.GetGDCMSeriesFileNames(folder))
    theirs, volume = reader.Execute(), load(folder)
    np.testing.assert_array_equal(sitk.GetArrayViewFromImage(theirs), volume.data)
    np.testing.assert_allclose(volume.spacing, theirs.GetSpacing(), rtol=1e-5)
    np.testing.assert_allclose(volume.origin, theirs.GetOrigin(), atol=1e-3)
    np.testing.assert_allclose(np.ravel(volume.direction), theirs.GetDirection(), atol=1e-5)


def test_slc_agrees_with_vtk(data_dir: Path) -> None:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkSLCReader

    path = data_dir / "embryo_slc" / "embryo.slc"
    reader = vtkSLCReader()
    reader.SetFileName(str(path))
    reader.Update()
    theirs = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(256, -1)
    ours = load(path).data.reshape(256, -1)
    np.testing.assert_array_equal(ours[:, :-1], theirs[:, :-1])  # a slice's last voxel is not stored


def test_raw_by_sidecar_and_npz(data_dir: Path) -> None:
    raw = data_dir / "lobster" / "lobster_301x324x56_uint8.raw"
    assert load(raw).key == load(data_dir / "lobster" / "lobster.mhd").key
    assert (
        load(data_dir / "tooth" / "tooth.nrrd").data.mean()
        == load(data_dir / "tooth" / "tooth.mhd").data.mean()
    )
    np.testing.assert_array_equal(
        load(data_dir / "stent" / "stent.npz").data, load(data_dir / "stent" / "stent.nrrd").data
    )
