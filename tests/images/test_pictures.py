"""Pictures of every technique against accepted ones: the last net, for what the tests of truth do not see."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sfumato
from sfumato import Scene, TransferFunction, Volume
from sfumato.techniques import techniques

pytestmark = pytest.mark.gpu

SCENES = Path(__file__).resolve().parent / "scenes"
SIDE = 96
#: Sides of pictures of techniques that take long.
SIDES = {"reference": 24}
#: Limits in 8-bit counts. Mesa's releases differ in the last bit of a few functions; at a shadow's edge that
#: becomes a few counts in single pixels.
MEAN, WORST = 0.3, 8.0

Check = Callable[[str, np.ndarray, float, float], None]


def load_scene(name: str, volume: Volume, transfer: TransferFunction, **changes: Any) -> Scene:
    """Return a scene of `scenes`, in the still life's colours unless it brings its own."""
    data = json.loads((SCENES / f"{name}.json").read_text(encoding="utf-8"))
    scene = Scene.from_json(data, volume)
    changes = changes if data.get("transfer") else {"transfer": transfer, **changes}
    return scene.with_(changes) if changes else scene


@pytest.mark.parametrize("scene", ["front", "behind"])
@pytest.mark.parametrize("technique", list(techniques()))
def test_technique(
    technique: str,
    scene: str,
    check_picture: Check,
    still_life: Volume,
    still_life_colors: TransferFunction,
) -> None:
    side = SIDES.get(technique, SIDE)
    wanted = load_scene(scene, still_life, still_life_colors, technique=technique)
    check_picture(f"{technique}-{scene}", sfumato.render(wanted, (side, side)), MEAN, WORST)


@pytest.mark.parametrize("path", sorted(SCENES.glob("*.json")), ids=lambda p: p.stem)
def test_scene(
    path: Path, check_picture: Check, still_life: Volume, still_life_colors: TransferFunction
) -> None:
    scene = load_scene(path.stem, still_life, still_life_colors)
    check_picture(f"scene-{path.stem}", sfumato.render(scene, (SIDE, SIDE)), MEAN, WORST)


def test_every_accepted_picture_is_tested() -> None:
    expected = {f"{t}-{s}" for t in techniques() for s in ("front", "behind")}
    expected |= {f"scene-{path.stem}" for path in SCENES.glob("*.json")}
    assert {p.stem for p in (SCENES.parent / "reference").glob("*.png")} <= expected
