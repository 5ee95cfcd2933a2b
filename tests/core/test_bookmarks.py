"""Kept views: part of the scene, saved with it, each name once."""

from __future__ import annotations

from pathlib import Path

import pytest

import sfumato
from sfumato import Bookmark, Camera, Scene, SceneError


def test_kept_views_are_saved_with_the_scene(tmp_path: Path) -> None:
    marks = (
        Bookmark("Face", Camera(position=(0.0, -300.0, 0.0))),
        Bookmark("Crown", Camera(position=(0.0, -1.0, 400.0))),
    )
    scene = Scene(volume=sfumato.load("sample:hand"), bookmarks=marks)
    scene.save(tmp_path / "a.sfumato")
    assert Scene.open(tmp_path / "a.sfumato").bookmarks == marks
    data = scene.to_json()
    del data["bookmarks"]
    assert Scene.from_json(data, scene.volume).bookmarks == (), "scenes of before have none"


@pytest.mark.parametrize(
    ("marks", "told"),
    [
        (lambda: (Bookmark("A"), Bookmark("A")), "each name once"),
        (lambda: tuple(Bookmark(str(k)) for k in range(65)), "at most 64"),
        (lambda: (Bookmark(" "),), "1 to 60 characters"),
        (lambda: (Bookmark("x" * 61),), "1 to 60 characters"),
        (lambda: ("A",), "a Bookmark is needed"),
    ],
)
def test_what_cannot_be_kept_is_told(marks: object, told: str) -> None:
    with pytest.raises(SceneError, match=told):
        Scene(bookmarks=marks())  # type: ignore[operator]


def test_a_files_bad_bookmark_is_named() -> None:
    data = Scene().to_json()
    data["bookmarks"] = [{"name": "A", "camera": {"view_angle": 900}}]
    with pytest.raises(SceneError, match=r"bookmarks\.0\.camera\.view_angle"):
        Scene.from_json(data)
