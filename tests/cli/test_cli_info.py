"""`sfumato info`."""

from __future__ import annotations

import json

import numpy as np
import pytest

from sfumato import Scene, Volume, VolumeInfo
from sfumato.export.png import write_png
from sfumato_app.tables import orientation_of


def rows(text):
    return {line.split()[0]: " ".join(line.split()[1:]) for line in text.splitlines() if line.strip()}


def test_volume(run, ball):
    told = rows(run("info", ball).out)
    assert told["dims"] == "24 x 24 x 24"
    assert told["spacing"] == "1 x 1 x 1 mm"
    assert told["type"] == "uint8"
    assert told["range"] == "0 to 200"
    assert told["memory"] == "0.0 MiB"
    assert told["orientation"] == "not known"


def test_sample(run):
    told = rows(run("info", "sample:hand").out)
    assert told["modality"] == "CT"
    assert told["range"].endswith("HU")
    assert told["orientation"] == "LPS"


def test_notices_are_told(run, tmp_path):
    data = np.zeros((4, 4, 4), np.float32)
    data[1, 1, 1] = np.nan
    data[2, 2, 2] = 1
    np.save(tmp_path / "holes.npy", data)
    assert "NaN" in run("info", "holes.npy").out


@pytest.mark.parametrize(
    ("direction", "letters"),
    [
        (((1, 0, 0), (0, 1, 0), (0, 0, 1)), "LPS"),
        (((-1, 0, 0), (0, -1, 0), (0, 0, 1)), "RAS"),
        (((0, 0, 1), (1, 0, 0), (0, -1, 0)), "PIL"),
    ],
)
def test_orientation(direction, letters):
    volume = Volume(
        np.zeros((2, 2, 2), np.uint8), direction=direction, info=VolumeInfo(orientation_known=True)
    )
    assert orientation_of(volume) == letters


def test_scene_of_a_picture_and_of_a_file(run, tmp_path):
    scene = Scene(technique="directional")
    write_png(tmp_path / "picture.png", np.zeros((2, 3, 4), np.uint8), scene)
    scene.save(tmp_path / "scene.sfumato")
    for name in ("picture.png", "scene.sfumato"):
        assert Scene.from_json(json.loads(run("info", name).out)) == scene


@pytest.mark.real_data
def test_dicom_folder(run, data_dir):
    told = rows(run("info", data_dir / "dicom_mr_t1_pddl").out)
    assert told["modality"] == "MR"
    assert told["dims"] == "274 x 384 x 128"
    assert told["orientation"] == "LPS"


@pytest.mark.real_data
def test_several_series_are_listed_and_chosen(run, data_dir):
    folder = data_dir / "dicom_multiframe_and_syntaxes"
    listed = rows(run("info", folder).out)
    assert listed["1"].startswith("CT series 3")
    told = rows(run("info", folder, "--series", 1).out)
    assert told["modality"] == "CT"
    assert told["dims"].startswith("512 x 512")
    assert "series" in run("info", folder, "--series", 99).failed_with(1)


@pytest.mark.gpu
def test_gpu_objects_are_listed_within_the_budget(run, ball, monkeypatch):
    monkeypatch.setenv("SFUMATO_GPU_BUDGET_MB", "64")
    text = run("info", "--gpu", ball).out
    assert "24 x 24 x 24, 1 x 8 bit" in text
    told = rows(text)
    assert float(told["total"]) > 4 * 960 * 720 * 16 / 2**20
    assert told["budget"].endswith("64.000")
    monkeypatch.setenv("SFUMATO_GPU_BUDGET_MB", "lots")
    assert "SFUMATO_GPU_BUDGET_MB" in run("info", "--gpu", ball).failed_with(1)
