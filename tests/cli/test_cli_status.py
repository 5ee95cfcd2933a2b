"""Exit statuses, and one line for what went wrong."""

from __future__ import annotations

import subprocess
import sys

import pytest

from sfumato.techniques import techniques


@pytest.mark.parametrize(
    "line",
    [
        "--nonsense",
        "render",
        "render ball.npy --nonsense",
        "render ball.npy --nonsense 3",
        "render ball.npy extra",
        "render ball.npy --technique ray-tracing",
        "render ball.npy --camera above",
        "render ball.npy --tilt much",
        "render ball.npy --frames 1.5",
        "render ball.npy --size 640",
        "render ball.npy --size 640x-1",
        "render ball.npy --size 0x10",
        "render ball.npy --technique reference --directions 2.5",
        "render ball.npy --set lights.0.tilt",
        "render ball.npy --set =3",
        "render ball.npy -o picture.jpg",
        "render ball.npy -o picture.png --linear",
        "render ball.npy --technique raycast --occlusion additive",
        "info",
        "techniques --csv",
    ],
)
def test_wrong_usage_is_2(run, ball, line):
    run(*line.split()).failed_with(2)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("info missing.nrrd", "missing.nrrd"),
        ("render missing.nrrd", "missing.nrrd"),
        ("render missing.sfumato", "missing.sfumato"),
        ("info missing.png", "missing.png"),
        ("render ball.npy --tilt 80", "lights.0.tilt"),
        ("render ball.npy --tilt nan", "tilt"),
        ("render ball.npy --aperture 0", "aperture"),
        ("render ball.npy --frames 0", "frames"),
        ("render ball.npy --set lights.7.tilt=3", "lights.7"),
        ("render ball.npy --set volume=3", "volume"),
        ("render ball.npy --set camera.zoom=3", "camera.zoom"),
        ("render ball.npy --set step=lots", "step"),
        ("render ball.npy --set technique=ray-tracing", "technique"),
        ("render ball.npy --set technique.ambient=2", "ambient"),
        ("render ball.npy --ambient 2", "ambient"),
        ("render ball.npy --transfer no-such-preset", "transfer"),
        ("render ball.npy --transfer missing.json", "missing.json"),
        ("render ball.npy -o no/such/folder/ball.png", "no/such/folder"),
        ("render ball.npy --volume missing.nrrd", "missing.nrrd"),
    ],
)
def test_bad_input_is_1_and_named(run, ball, line, said):
    assert said in run(*line.split()).failed_with(1)


def test_unreadable_files_are_1(run, tmp_path):
    for name in ("text.nrrd", "text.sfumato", "text.png", "text.npy", "text.dcm", "noise"):
        (tmp_path / name).write_bytes(b"this is no volume\n" * 9)
        assert name in run("info", name).failed_with(1)
        assert name in run("render", name).failed_with(1)


def test_debug_shows_the_traceback(run):
    outcome = run("info", "missing.nrrd", "--debug")
    assert outcome.status == 1
    assert "Traceback" in outcome.err


def test_ctrl_c_is_130_and_silent(run, ball, monkeypatch):
    def interrupted(*_args, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr("sfumato_app.drawing.draw", interrupted)
    outcome = run("render", "ball.npy")
    assert (outcome.status, outcome.out, outcome.err) == (130, "", "")


def test_a_fault_of_ours_is_one_line_too(run, ball, monkeypatch):
    def broken(*_args, **_options):
        raise RuntimeError("two\nlines")

    monkeypatch.setattr("sfumato_app.drawing.draw", broken)
    assert "two lines" in run("render", "ball.npy").failed_with(1)


@pytest.mark.parametrize("line", ["--help", "--version", "render --help", "info --help", "techniques --help"])
def test_help_is_0(run, line):
    outcome = run(*line.split())
    assert outcome.status == 0
    assert outcome.out
    assert not outcome.err


def test_as_a_program():
    done = subprocess.run(
        [sys.executable, "-m", "sfumato_app", "info", "missing.nrrd"],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 1
    assert done.stderr.startswith("sfumato: error: missing.nrrd")
    assert done.stdout == ""


def test_a_reader_that_goes_away_is_no_error():
    line = f"{sys.executable} -m sfumato_app techniques | head -n 1; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    assert len(techniques()) > 1
