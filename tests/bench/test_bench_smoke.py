"""The benchmark runs and tells everything; nothing here depends on how fast the machine is."""

from __future__ import annotations

import gc
import json
import math
from pathlib import Path

import numpy as np
import pytest

import sfumato
from sfumato.gpu import is_software
from sfumato.renderer import Renderer
from sfumato_app.bench import main
from sfumato_app.bench.measure import Result, Spread
from sfumato_app.bench.phantom import phantom
from sfumato_app.bench.ratios import RATIOS, Goal, outcomes
from sfumato_app.bench.rows import rows, tube_rows
from sfumato_app.bench.setting import Setting

TINY = ["--size", "32", "--viewport", "64", "--rounds", "1"]


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """Run everything once; return the JSON report and the folder with all that was written."""
    folder = tmp_path_factory.mktemp("bench")
    names = {"--json": "b.json", "--plot": "b.png", "--pictures": "pictures"}
    files = [text for option, name in names.items() for text in (option, str(folder / name))]
    assert main([*TINY, *files]) == 0
    return json.loads((folder / "b.json").read_text()), folder


@pytest.mark.gpu
def test_vtk_takes_no_context_of_ours_with_it(still_life, told):
    scene = sfumato.Scene(volume=still_life)
    job = Renderer().begin(scene, (32, 32))
    frame = job.add_frame()
    next(frame)
    gc.collect()  # where VTK's windows would go, with the EGL display that we share
    list(frame)
    assert job.picture()[..., :3].max() > 60
    job.renderer.close()


@pytest.mark.gpu
def test_report_has_all_fields(told):
    report, folder = told
    machine = report["machine"]
    assert {"date", "cpu", "cores", "load_average", "gl_renderer", "gl_version", "packages"} <= set(machine)
    assert machine["gl_renderer"]
    assert report["setting"]["size"] == 32
    assert report["rounds"] == 1
    assert [row["id"] for row in report["rows"]] == [row.id for row in rows(Setting())]
    for row in report["rows"]:
        if not row["missing"]:
            assert row["cpu_ms"]["q1"] <= row["cpu_ms"]["median"] <= row["cpu_ms"]["q3"]
            assert len(row["wall_ms"]["all"]) == 1
            assert min(row["wall_ms"]["all"]) > 0
            assert (folder / "pictures" / f"{row['id']}.png").stat().st_size > 0


@pytest.mark.gpu
def test_our_rows_take_part_and_ratios_are_finite(told):
    report, _ = told
    missing = {row["id"]: row["missing"] for row in report["rows"] if row["missing"]}
    assert not {"raycast", "slices-phong", "directional", "multidirectional"} & set(missing), missing
    ids = {ratio["id"] for ratio in report["ratios"]}
    assert "multidirectional / directional" in ids
    for ratio in report["ratios"]:
        numbers = [*ratio["cpu"].values(), *ratio["wall"].values()]
        assert len(numbers) == 6
        assert all(map(math.isfinite, numbers))
        assert ratio["verdict"] in ("pass", "short", "-")


@pytest.mark.gpu
def test_vtk_shows_the_same(told):
    pytest.importorskip("vtkmodules")
    report, _ = told
    agreement = {row["id"]: row.get("psnr_to_raycast_db") for row in report["rows"]}
    # 32 voxels: VTK's volume ends at the outer voxels' centres and its samples are not pre-integrated.
    assert agreement["vtk-gpu"] > 30
    assert agreement["slices"] > 40


@pytest.mark.gpu
def test_plot_is_drawn(told):
    pytest.importorskip("matplotlib")
    assert (told[1] / "b.png").stat().st_size > 1000


@pytest.mark.gpu
def test_table_names_machine_and_verdicts(capsys):
    assert main([*TINY, "--only", "raycast,directional,multidirectional"]) == 0
    text = capsys.readouterr().out
    assert "cores" in text
    assert "OpenGL" in text
    assert "multidirectional / directional" in text
    assert "<= 1.05" in text


@pytest.mark.parametrize("wrong", [["--rounds", "0"], ["--size", "x"], ["--only", "warp"], ["--nothing"]])
def test_wrong_usage(wrong, capsys):
    assert main(wrong) == 2
    assert capsys.readouterr().err


@pytest.mark.gpu
def test_file_that_cannot_be_written(tmp_path: Path, capsys):
    assert main([*TINY, "--only", "raycast", "--json", str(tmp_path / "none" / "b.json")]) == 1
    assert "sfumato bench:" in capsys.readouterr().err


def test_spread_is_median_and_quartiles():
    assert Spread.of([4.0, 1.0, 3.0, 2.0, 5.0]) == Spread(3.0, 2.0, 4.0)


def test_goals_are_judged_by_the_clock_that_counts():
    table = {row.id: Result(row, 1) for row in rows(Setting())}
    for name, cpu in (("multidirectional", 139.0), ("directional", 100.0), ("slices-phong", 100.0)):
        table[name].cpu, table[name].wall = [cpu, cpu], [100.0, 100.0]
    measured = [result for result in table.values() if result.cpu]

    def verdicts(clock: str, on_gpu: bool) -> list[str]:
        return [outcome.verdict for outcome in outcomes(measured, clock, on_gpu)]

    assert verdicts("cpu", False) == ["short", "-"]
    assert verdicts("wall", False) == ["pass", "-"]
    assert verdicts("cpu", True) == ["short", "pass"]


def test_ratios_refer_to_rows():
    ids = [row.id for row in rows(Setting())]
    assert len(set(ids)) == len(ids)
    ids += [row.id for row in tube_rows(Setting())]
    assert all(ratio.above in ids and ratio.below in ids for ratio in RATIOS)
    assert not Goal(4.0, at_least=True).met(3.9)


def test_phantom_shows_the_same_at_all_sizes():
    small, large = phantom(32), phantom(64)
    halved = large.data.reshape(32, 2, 32, 2, 32, 2).mean(axis=(1, 3, 5))
    assert small.data.dtype == np.uint8
    assert np.abs(halved - small.data).mean() < 3
    assert 0.85 < (large.data < 45).mean() < 0.95


def test_software_renderers_are_known():
    assert is_software("llvmpipe (LLVM 15.0.6, 256 bits)")
    assert not is_software("NVIDIA H100/PCIe/SSE2")
