"""Comparing pictures with accepted ones, and the picture of a failure."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import sfumato

HERE = Path(__file__).resolve().parent
REFERENCE, FAILURES = HERE / "reference", HERE / "failures"
#: Factor on differences in the picture of a failure.
MAGNIFIED = 16

#: Takes a name, a picture and two limits in 8-bit counts: on the mean and on the worst pixel.
Check = Callable[[str, np.ndarray, float, float], None]


@pytest.fixture(scope="session")
def renderer_name(software_renderer: bool) -> str:
    """Name of the graphics device; skips where the accepted pictures were not drawn by its like."""
    renderer = sfumato.Renderer()
    name = renderer.name
    renderer.close()
    if "llvmpipe" not in name:
        if os.environ.get("CI"):
            pytest.fail(f"CI compares pictures on llvmpipe, but this is {name}")
        pytest.skip(f"the accepted pictures were drawn by llvmpipe; this is {name}")
    assert software_renderer, "llvmpipe although a GPU was asked for"
    return name


def premultiplied(picture: np.ndarray) -> np.ndarray:
    """Return what can be seen of a picture: colour that nothing carries does not count."""
    counts = picture.astype(float)
    counts[..., :3] *= counts[..., 3:] / 255
    return counts


def over_chequers(picture: np.ndarray) -> np.ndarray:
    """Return a picture over a chequered ground, so that its alpha can be seen."""
    y, x = np.indices(picture.shape[:2]) // 8
    ground = np.where((x + y) % 2, 96, 160)[..., None]
    counts = premultiplied(picture)
    return (counts[..., :3] + ground * (1 - counts[..., 3:] / 255)).round().astype(np.uint8)


def show_failure(name: str, got: np.ndarray, expected: np.ndarray) -> Path:
    """Write got | expected | magnified difference side by side."""
    difference = np.abs(premultiplied(got) - premultiplied(expected))
    worst = np.maximum(difference[..., :3], difference[..., 3:]) * MAGNIFIED
    parts = [over_chequers(got), over_chequers(expected), np.minimum(worst, 255).astype(np.uint8)]
    FAILURES.mkdir(exist_ok=True)
    path = FAILURES / f"{name}.png"
    sheet = np.hstack(parts)
    Image.fromarray(np.repeat(np.repeat(sheet, 3, axis=0), 3, axis=1)).save(path)
    return path


@pytest.fixture(scope="session")
def check_picture(request: pytest.FixtureRequest, renderer_name: str) -> Check:
    """Compare a picture with the accepted one of that name; ``--accept-images`` takes it instead."""
    accept = bool(request.config.getoption("--accept-images"))

    def check(name: str, picture: np.ndarray, mean: float, worst: float) -> None:
        path = REFERENCE / f"{name}.png"
        if accept:
            REFERENCE.mkdir(exist_ok=True)
            Image.fromarray(picture).save(path, optimize=True)
            return
        assert path.exists(), f"no accepted picture {path.name}; look at it, then pytest --accept-images"
        with Image.open(path) as image:
            expected = np.asarray(image.convert("RGBA"))
        assert picture.shape == expected.shape
        difference = np.abs(premultiplied(picture) - premultiplied(expected))
        if difference.mean() > mean or difference.max() > worst:
            shown = show_failure(name, picture, expected)
            pytest.fail(
                f"{name}: mean difference {difference.mean():.2f} (limit {mean}), "
                f"worst {difference.max():.0f} (limit {worst}) of 255; see {shown}"
            )

    return check
