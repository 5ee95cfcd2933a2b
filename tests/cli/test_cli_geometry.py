"""Tracts and meshes on the command line."""

from __future__ import annotations

import json

import numpy as np
import pytest
from nibabel.streamlines import Tractogram, TrkFile

from sfumato.export.png import open_png, read_scene_data


@pytest.fixture
def tracts(tmp_path):
    # RAS: the ball's box is [0, 24] in LPS. The third line lies outside, the last has one point.
    lines = [np.float32([[-5, -5, z], [-18, -18, z]]) for z in (5, 12)]
    lines += [np.float32([[50, 0, 0], [60, 0, 0]]), np.float32([[0, 0, 0]])]
    tractogram = Tractogram(
        lines, data_per_streamline={"fa": [[0.1], [0.2], [0.3], [0]]}, affine_to_rasmm=np.eye(4)
    )
    TrkFile(tractogram).save(str(tmp_path / "a.trk"))
    return tmp_path / "a.trk"


def test_info(run, tracts):
    out = run("info", tracts).out
    rows = {line.split()[0]: " ".join(line.split()[1:]) for line in out.splitlines() if line.strip()}
    assert rows["kind"] == "tracts"
    assert rows["lines"] == "3"
    assert rows["points"] == "6"
    assert rows["scalar"] == "fa: 0.1 to 0.3"
    assert "1 line of one point left out" in rows["notice"]
    assert rows["from"].startswith("-60,"), "LPS"


def test_render_with_tracts_keeps_them_in_the_picture(run, ball, tracts):
    done = run(
        "render",
        ball,
        "--geometry",
        tracts,
        "--set",
        "geometry.0.radius=0.8",
        "--size",
        "64x64",
        "-o",
        "p.png",
    )
    assert done.status == 0
    assert "a: 1 line of one point left out." in done.err
    assert "1 line of 3 leave the volume, 1 of them lie outside it altogether" in done.err
    data = read_scene_data("p.png")["geometry"][0]
    assert (data["path"], data["radius"]) == ("a.trk", 0.8)
    scene = open_png("p.png")
    assert scene.geometry[0].shape.count == 3
    assert json.loads(run("info", "p.png").out)["geometry"][0]["hash"] == data["hash"]


def test_bad_files_are_one_line(run, ball, tmp_path):
    (tmp_path / "bad.trk").write_bytes(b"no")
    done = run("render", ball, "--geometry", tmp_path / "bad.trk")
    assert done.status == 1
    assert done.err.count("\n") == 1
    assert "bad.trk" in done.err
    assert run("info", tmp_path / "none.stl").status == 1
