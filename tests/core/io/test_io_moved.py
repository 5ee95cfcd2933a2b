"""Volumes that are no longer where their scene says: found by name and content, beside the scene or elsewhere."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sfumato import LoadError, Scene, load
from sfumato.export.png import open_png, write_png
from sfumato.io import MissingVolume
from sfumato.io.moved import MOST_READ


def volume_file(path: Path, first: int = 0) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    np.save(path, np.arange(first, first + 6 * 5 * 4, dtype=np.uint16).reshape(6, 5, 4))
    return path


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """A scene, and its volume in a folder of its own."""
    Scene(volume=load(volume_file(tmp_path / "scans" / "a.npy"))).save(tmp_path / "work" / "kept.sfumato")
    return tmp_path / "work" / "kept.sfumato"


@pytest.fixture(autouse=True)
def work(tmp_path: Path) -> None:
    (tmp_path / "work").mkdir(exist_ok=True)


@pytest.mark.parametrize(
    "now", ["work/a.npy", "work/deeper/a.npy", "work/b.npy", "other/a.npy", "other/b.npy"]
)
def test_it_is_found_where_it_is_now(kept: Path, tmp_path: Path, now: str) -> None:
    for k in range(3):  # others of its kind, and another of its name
        volume_file(tmp_path / "work" / f"{k}.npy", 7 + k)
    volume_file(tmp_path / "elsewhere" / "a.npy", 99)
    there = tmp_path / now
    there.parent.mkdir(exist_ok=True)
    (tmp_path / "scans" / "a.npy").rename(there)
    scene = Scene.open(kept, places=[tmp_path / "elsewhere", tmp_path / "other"])
    assert scene.volume is not None
    assert scene.volume.info.path == str(there)
    assert any(f"found as {there}" in notice for notice in scene.volume.info.notices)
    if now.startswith("work"):
        assert Scene.open(kept).volume == scene.volume, "beside the scene it needs no hint"


def test_what_lies_in_its_place_is_not_taken_for_it(kept: Path, tmp_path: Path) -> None:
    (tmp_path / "scans" / "a.npy").rename(tmp_path / "scans" / "older.npy")
    volume_file(tmp_path / "scans" / "a.npy", 5)
    with pytest.raises(MissingVolume, match="its content differs"):
        Scene.open(kept)
    assert Scene.open(kept, places=[tmp_path / "scans"]).volume == load(tmp_path / "scans" / "older.npy")


def test_the_search_is_bounded_and_says_what_it_looked_at(kept: Path, tmp_path: Path) -> None:
    (tmp_path / "scans" / "a.npy").unlink()
    for k in range(MOST_READ + 5):
        volume_file(tmp_path / "work" / f"{k}.npy", 7 + k)
    with pytest.raises(MissingVolume, match=rf"not there, nor is it {MOST_READ} others") as caught:
        Scene.open(kept, places=[tmp_path / "nowhere"])
    assert "a.npy" in str(caught.value)
    assert isinstance(caught.value, LoadError)
    assert "\n" not in str(caught.value)


def test_a_path_of_windows_is_looked_for_by_its_name(kept: Path, tmp_path: Path) -> None:
    text = kept.read_text().replace(str(tmp_path / "scans" / "a.npy"), r"C:\\scans\\a.npy")
    assert "C:" in text
    kept.write_text(text)
    (tmp_path / "scans" / "a.npy").rename(tmp_path / "work" / "a.npy")
    volume = Scene.open(kept).volume
    assert volume is not None
    assert volume.info.path == str(tmp_path / "work" / "a.npy")


def test_a_pictures_volume_may_be_in_another_folder(tmp_path: Path) -> None:
    scene = Scene(volume=load(volume_file(tmp_path / "scans" / "a.npy")))
    write_png(tmp_path / "work" / "a.png", np.zeros((4, 4, 4), np.uint8), scene)
    with pytest.raises(MissingVolume, match="not beside it"):
        open_png(tmp_path / "work" / "a.png")
    assert open_png(tmp_path / "work" / "a.png", places=[tmp_path / "scans"]).volume == scene.volume
