"""`sfumato render --rig`: a set of lamps by name; the first light's flags come after it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import sfumato
from sfumato import Light
from sfumato.export.png import open_png
from sfumato.scene.rig_files import save_rig
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


def test_a_rig_of_ones_own_is_a_file(run: Callable[..., Any], ball: Path, tmp_path: Path) -> None:
    lamps = (Light(name="low", tilt=55.0), Light(kind="point", position=(4.0, 5.0, 6.0), radius=0.5))
    save_rig(tmp_path / "mine.sfumato-rig", "mine", lamps, sfumato.load(ball))
    assert run("render", ball, "-o", "c.png", "--rig-file", tmp_path / "mine.sfumato-rig", *QUICK).status == 0
    lights = open_png("c.png").lights
    assert lights[0] == lamps[0]
    assert lights[1].position == pytest.approx((4.0, 5.0, 6.0))
    assert "not a rig" in run("render", ball, "--rig-file", ball).failed_with(1)


def test_an_unknown_rig(run: Callable[..., Any], ball: Path) -> None:
    assert "three-point" in run("render", ball, "--rig", "disco").failed_with(2)
