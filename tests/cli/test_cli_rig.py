"""`sfumato render --rig`: a set of lamps by name; the first light's flags come after it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sfumato.export.png import open_png
from sfumato.scene.rigs import rigs

pytestmark = pytest.mark.gpu

QUICK = ("--size", "24x24", "--technique", "raycast")


def test_a_rig_lights_the_picture(run: Callable[..., Any], ball: Path) -> None:
    assert run("render", ball, "-o", "out.png", "--rig", "three-point", *QUICK).status == 0
    assert open_png("out.png").lights == rigs()["three-point"].lights
    assert run("render", "out.png", "-o", "b.png", "--rig", "rim", "--rotation", 100, *QUICK).status == 0
    lights = open_png("b.png").lights
    assert lights[0].rotation == 100
    assert lights[1:] == rigs()["rim"].lights[1:]


def test_an_unknown_rig(run: Callable[..., Any], ball: Path) -> None:
    assert "three-point" in run("render", ball, "--rig", "disco").failed_with(2)
