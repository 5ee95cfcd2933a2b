"""Rows of geometry, and a large tractogram's way to its first picture."""

from __future__ import annotations

import json

import pytest

from sfumato.geometry import mesh_of
from sfumato_app.bench import main
from sfumato_app.bench.drag import has_display
from sfumato_app.bench.ratios import RATIOS
from sfumato_app.bench.rows import tube_rows
from sfumato_app.bench.setting import Setting
from sfumato_app.bench.tracts import measure_tracts
from sfumato_app.bench.tubes import TRIANGLES, tubes


def test_tubes_have_the_triangles_they_are_named_after():
    assert len(mesh_of(tubes(TRIANGLES["130k"])).triangles) == pytest.approx(130_000, rel=0.03)
    ids = {row.id for row in tube_rows(Setting())}
    assert {r.above for r in RATIOS if r.above.startswith("combined")} <= ids


@pytest.mark.gpu
def test_geometry_is_measured_beside_the_volume_alone(tmp_path):
    options = ["--tubes", "--only", "cone,combined-130k", "--size", "32", "--viewport", "32", "--rounds", "1"]
    assert main([*options, "--json", str(tmp_path / "b.json")]) == 0
    report = json.loads((tmp_path / "b.json").read_text())
    assert [r["id"] for r in report["ratios"]] == ["combined-130k / cone"]


@pytest.mark.gpu
@pytest.mark.skipif(not has_display(), reason="no display")
def test_a_tractogram_is_timed_to_its_first_picture():
    pytest.importorskip("qtpy")
    tracts = measure_tracts(lines=200)
    assert 0 < tracts.loaded < tracts.first_picture <= tracts.full_picture
    assert tracts.drawn == 200
    assert tracts.steps > 3
    assert "first picture" in tracts.text()
