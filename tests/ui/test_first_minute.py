"""The first minute: a volume is dropped on the window, and seen. Times are printed, never asserted."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from qtpy.QtWidgets import QApplication

from sfumato_app.first_minute import HEAD, Minute, find_drops, first_minute, main, row
from sfumato_ui.jobs import STILL_FRAMES, STILL_SECONDS, affordable_frames

DATA = Path(os.environ.get("SFUMATO_DATA", Path(__file__).resolve().parents[3] / "shared" / "data"))


def in_order(minute: Minute) -> bool:
    """Progress is seen before the volume is read, and a coarse picture long before the settled one."""
    return minute.progress < minute.loaded < minute.first < minute.settled


@pytest.mark.normal_quality
def test_a_dropped_volume_is_seen(
    qapp: QApplication, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    z, y, x = np.mgrid[:32, :32, :32] - 15.5
    np.save(
        tmp_path / "ball.npy", np.clip(300 - 25 * np.sqrt(x * x + y * y + z * z), 0, 200).astype(np.uint8)
    )
    shots = tmp_path / "shots"
    assert main([str(tmp_path), "--screenshots", str(shots)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "1280 × 720" in lines[0]
    assert lines[2:4] == HEAD.splitlines()
    assert lines[4].startswith("| ball.npy | 32 × 32 × 32 | ")
    assert [p.name for p in shots.iterdir()] == ["ball.npy.png"]


def test_what_cannot_be_opened_says_why(qapp: QApplication, tmp_path: Path) -> None:
    broken = tmp_path / "broken.nrrd"
    broken.write_bytes(b"NRRD0004\ntype: uchar\n")
    minute = first_minute(broken)
    assert not minute.opened
    assert "broken.nrrd" in minute.message
    assert minute.message in row(minute)


def test_goals_are_judged_one_by_one() -> None:
    good = Minute("a", (1, 2, 3), 0.1, 0.5, 2.0, 20.0, 1.0, "")
    late = Minute("a", (1, 2, 3), 0.6, 0.7, 2.0, 31.0, 1.0, "")
    assert (good.verdict, late.verdict) == ("yes", "progress, settled")


def test_a_slow_device_settles_on_fewer_frames() -> None:
    assert affordable_frames(STILL_FRAMES, 1, 0.1) == STILL_FRAMES
    assert affordable_frames(STILL_FRAMES, 1, STILL_SECONDS / 4) == 4
    assert affordable_frames(STILL_FRAMES, 1, STILL_SECONDS / 1.6) == 2
    assert affordable_frames(STILL_FRAMES, 1, 10 * STILL_SECONDS) == 1
    assert affordable_frames(32, 1, 10 * STILL_SECONDS) == 32, "many were asked for"
    assert affordable_frames(1, 1, 0.1) == 1


@pytest.mark.real_data
@pytest.mark.slow
@pytest.mark.measured
@pytest.mark.gpu
@pytest.mark.timeout(400)
@pytest.mark.parametrize(
    "path",
    find_drops(DATA) if DATA.is_dir() else [],
    ids=lambda path: str(path.relative_to(DATA)),
)
def test_the_first_minute(path: Path, qapp: QApplication, capsys: pytest.CaptureFixture[str]) -> None:
    minute = first_minute(path, path.name)
    with capsys.disabled():
        print(f"\n{row(minute)}")
    if minute.opened:
        assert in_order(minute), minute
    else:
        assert path.name in minute.message
        assert path.suffix == ".dcm", "only the single images among the DICOM files are no volumes"
