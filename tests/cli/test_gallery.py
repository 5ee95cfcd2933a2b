"""The gallery: its figures can be drawn, and the command writes pictures and page."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sfumato import Light, Scene
from sfumato_app.gallery.figure import Cuts, Difference, Figure
from sfumato_app.gallery.figures import FIGURES, combined
from sfumato_app.gallery.hero import hero_panels
from sfumato_app.gallery.sheet import draw_difference

LOCAL = (1, 3, 4, 6, 7, 8, 9, 10)
PAPER_FIGURES = (1, 8, 9, 10, 11, 12, 13, 14)
COUNTS = {1: 4, 8: 3, 9: 2, 10: 4, 11: 4, 12: 4, 13: 4, 14: 2}
#: Of Schlegel2011: numbers, and how many panels we make of each.
EXTINCTION = {1: 4, 2: 2, 4: 2, 6: 2, 8: 2, 9: 2, 10: 4, 11: 4, 12: 2}
#: Of Schott2012.
COMBINED = {1: 2, 2: 4, 5: 3, 6: 6, 7: 2, 8: 2}


def scenes(figure: Figure) -> list[Scene]:
    return [panel.picture for panel in figure.panels if isinstance(panel.picture, Scene)]


def light(scene: Scene) -> Light:
    return scene.active_lights[0]


def pixels(path: Path) -> np.ndarray:
    with Image.open(path) as picture:
        return np.asarray(picture).astype(float)


@pytest.mark.parametrize("number", PAPER_FIGURES)
def test_figure_is_whole(number: int) -> None:
    figure = FIGURES[number]()
    assert figure.number == number
    assert [panel.label for panel in figure.panels] == list("abcd"[: COUNTS[number]])
    assert figure.title
    assert figure.caption.endswith(".")
    assert all(scene.volume is not None for scene in scenes(figure))
    assert all(Scene.from_json(scene.to_json(), scene.volume) == scene for scene in scenes(figure))


@pytest.mark.parametrize("number", EXTINCTION)
def test_figure_of_extinction_is_whole(number: int) -> None:
    figure = FIGURES[f"schlegel2011-{number}"]()
    assert (figure.paper, figure.number) == ("Schlegel2011", number)
    assert figure.id == f"schlegel2011-{number}"
    assert figure.file_name == f"schlegel2011-fig{number:02d}.png"
    assert len(scenes(figure)) == EXTINCTION[number]
    assert figure.caption.endswith(".")
    assert {scene.technique_id for scene in scenes(figure)} == {"extinction"}
    assert all(Scene.from_json(scene.to_json(), scene.volume) == scene for scene in scenes(figure))


@pytest.mark.parametrize("number", COMBINED)
def test_figure_of_combined_is_whole(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where there are no real data: the pipe takes their place."""
    for name in ("TRACTS", "SCAN", "CAROTID"):
        monkeypatch.setattr(combined, name, Path("nowhere"))
    figure = FIGURES[f"schott2012-{number}"]()
    assert (figure.paper, figure.number) == ("Schott2012", number)
    assert len(scenes(figure)) == COMBINED[number]
    assert figure.caption.endswith(".")
    assert {scene.technique_id for scene in scenes(figure)} == {"combined"}
    assert all(scene.geometry for scene in scenes(figure))


@pytest.mark.parametrize("number", LOCAL)
def test_figure_of_local_occlusion_is_whole(number: int) -> None:
    figure = FIGURES[f"hernell2007-{number}"]()
    assert (figure.paper, figure.number) == ("Hernell2007", number)
    assert figure.caption.endswith(".")
    assert {scene.technique_id for scene in scenes(figure)} <= {"local-occlusion", "raycast-phong"}
    assert all(Scene.from_json(scene.to_json(), scene.volume) == scene for scene in scenes(figure))


@pytest.mark.gpu
def test_a_difference_is_black_where_nothing_differs_and_white_where_all_does() -> None:
    scene = scenes(FIGURES["hernell2007-3"]())[0]
    same = draw_difference(Difference(scene, scene), (24, 24), 1)
    assert np.asarray(same).max() == 0
    dark = scene.with_({"technique.ambient": 0.0, "technique.diffuse": 0.0, "technique.specular": 0.0})
    other = np.asarray(draw_difference(Difference(dark, scene), (24, 24), 1))
    assert other.shape == (24, 24, 3)
    assert other.max() == 255
    assert other[0, 0].max() == 0  # the background


def test_numbers_are_the_papers() -> None:
    assert tuple(FIGURES) == (
        *PAPER_FIGURES,
        *(f"schlegel2011-{n}" for n in EXTINCTION),
        *(f"hernell2007-{n}" for n in LOCAL),
        *(f"schott2012-{n}" for n in COMBINED),
    )


@pytest.mark.parametrize("number", [1, 12])
def test_four_techniques(number: int) -> None:
    assert [scene.technique_id for scene in scenes(FIGURES[number]())] == [
        "raycast-phong",
        "slices-phong",
        "directional",
        "multidirectional",
    ]


def test_cones_are_the_papers() -> None:
    lamps = [light(scene) for scene in scenes(FIGURES[8]())]
    assert [(lamp.aperture, lamp.tilt, lamp.rotation) for lamp in lamps] == [
        (10, 37, 0),
        (40, 37, 0),
        (40, 5, 0),
    ]


def test_pairs_differ_in_light_alone() -> None:
    for number, first, second in ((9, 0, 1), (10, 0, 1), (10, 2, 3), (11, 0, 1), (11, 2, 3)):
        eye, side = (scenes(FIGURES[number]())[k] for k in (first, second))
        assert (eye.technique_id, side.technique_id) == ("directional", "multidirectional")
        assert light(side).rotation == 135
        assert eye.with_(technique="raycast", lights=()) == side.with_(technique="raycast", lights=())


def test_ultrasound_is_opened_by_a_plane() -> None:
    figure = FIGURES[13]()
    assert isinstance(figure.panels[0].picture, Cuts)
    assert all(scene.clip for scene in scenes(figure))
    assert [light(scene).rotation for scene in scenes(figure)[1:]] == [135, 225]


def test_half_angle_is_pressed_beyond_its_limit() -> None:
    view, half = scenes(FIGURES[14]())
    assert light(view) == light(half)
    assert light(half).tilt > 60
    assert half.technique_id == "half-angle"


def test_hero_is_one_view() -> None:
    cameras = {panel.picture.camera for panel in hero_panels() if isinstance(panel.picture, Scene)}
    assert len(cameras) == 1


def test_wrong_number_is_wrong_usage(run: Callable[..., object]) -> None:
    line = run("gallery", "--only", "2").failed_with(2)  # type: ignore[attr-defined]
    assert "2" in line
    assert "1, 8" in line


@pytest.mark.gpu
def test_one_figure(run: Callable[..., object], tmp_path: Path) -> None:
    outcome = run("gallery", "-o", "docs/pictures", "--only", "9", "--scale", "0.15", "--frames", "1")
    assert outcome.status == 0, outcome.err  # type: ignore[attr-defined]
    picture = pixels(tmp_path / "docs" / "pictures" / "fig09.png")
    assert picture[:50].std() > 5
    assert not (tmp_path / "docs" / "pictures.md").exists()


@pytest.mark.gpu
@pytest.mark.slow
@pytest.mark.timeout(900)
def test_whole_page(run: Callable[..., object], tmp_path: Path) -> None:
    outcome = run("gallery", "-o", "docs/gallery", "--scale", "0.12", "--frames", "1")
    assert outcome.status == 0, outcome.err  # type: ignore[attr-defined]
    page = (tmp_path / "docs" / "gallery.md").read_text(encoding="utf-8")
    shown = re.findall(r"!\[[^\]]+\]\((\S+)\)", page)
    assert len(shown) == len(FIGURES)
    assert all(pixels(tmp_path / "docs" / name).std() > 5 for name in shown)


@pytest.mark.gpu
@pytest.mark.slow
def test_hero_picture(run: Callable[..., object], tmp_path: Path) -> None:
    outcome = run("gallery", "-o", "docs/gallery", "--hero", "--scale", "0.1", "--frames", "1")
    assert outcome.status == 0, outcome.err  # type: ignore[attr-defined]
    height, width, _ = pixels(tmp_path / "docs" / "hero.png").shape
    assert width / height == pytest.approx(1200 / 675, rel=0.05)
