"""The quality harness: its measures mean what they say, and the command tells everything."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sfumato.errors import SfumatoError
from sfumato_app.errors import UsageError
from sfumato_app.quality.contestants import contestants, quality_of
from sfumato_app.quality.measure import enlarged, error
from sfumato_app.quality.staging import AIR
from sfumato_app.quality.trials import TRIALS
from sfumato_app.quality.truth import Truth, receiver

TINY = ["--scenes", "shapes", "--side", "32", "--directions", "8", "--cache", "truth"]


def penumbra(copies: int = 0) -> Truth:
    """A shadow's edge on a white wall, softly from 0 to 1; or in as many steps."""
    ramp = np.clip((np.arange(96) - 24) / 48, 0, 1)
    if copies:
        ramp = np.round(ramp * copies) / copies
    light = np.broadcast_to(ramp[None, :, None], (96, 96, 4)).copy()
    return Truth(light, np.ones((96, 96)), np.ones((96, 96), dtype=bool), 0.0)


def test_truth_has_no_error() -> None:
    found = error(penumbra().picture, penumbra())
    assert found.rmse == pytest.approx(0)
    assert found.copies == pytest.approx(0)


def test_error_is_in_units_of_the_unshadowed_wall() -> None:
    true = penumbra()
    half = Truth(true.picture, np.full((96, 96), 0.5), true.mask, 0.0)
    found = error(true.picture - 0.05, half)
    assert found.rmse == pytest.approx(0.1)
    assert found.bias == pytest.approx(-0.1)


def test_copies_are_told_from_softness_and_darkness() -> None:
    true = penumbra()
    few, many = (error(penumbra(copies=n).picture, true).copies for n in (4, 256))
    darker = error(true.picture * 0.8, true).copies
    assert few > 1
    assert many < 0.1
    assert darker < 0.25


def test_only_the_mask_counts() -> None:
    true = penumbra()
    mask = true.mask.copy()
    mask[:10] = False
    wrong = true.picture.copy()
    wrong[:10] += 5
    assert error(wrong, Truth(true.picture, true.bare, mask, 0.0)).rmse == pytest.approx(0)


def test_small_pictures_are_shown_large() -> None:
    ramp = np.broadcast_to(np.linspace(0, 1, 8)[None, :, None], (8, 8, 4))
    shown = enlarged(ramp, 16)
    assert shown.shape == (16, 16, 4)
    assert shown.mean() == pytest.approx(0.5, abs=1e-6)


def test_receiver_is_bare_wall() -> None:
    trial = TRIALS["shapes"]
    stage, scene = trial.stage(), trial.scene()
    mask = receiver(scene, stage, 46)
    assert 0.3 < mask.mean() < 0.9
    # What stands before the wall, seen from the front: a pixel is two voxels, the picture almost the wall.
    stands = (stage.volume.data[:, : int(stage.center[1]) - 1] > AIR + 60).any(axis=1)[::-1]
    there = np.asarray(Image.fromarray(stands).resize((46, 46)))
    assert not (mask & there).any()
    assert stage.bare.data.max() == AIR


@pytest.mark.parametrize("trial", TRIALS.values(), ids=TRIALS)
def test_lamps_stay_before_the_subject(trial: object) -> None:
    assert all(lamp.tilt + lamp.aperture <= 80 for lamp in TRIALS[trial.id].lights)  # type: ignore[attr-defined]


def test_contestants_by_name() -> None:
    first, second = contestants("multidirectional:falloff=gaussian:ambient=0.5,directional", "full")
    assert first.changes == {"falloff": "gaussian", "ambient": 0.5}
    assert first.id == "multidirectional:falloff=gaussian:ambient=0.5"
    assert second.takes_part(TRIALS["shapes"])
    assert not second.takes_part(TRIALS["hand"])
    assert quality_of("drag").scale < 1
    assert quality_of("step=2:light=3").light == 3
    for names, qualities in (("warp", "full"), ("directional", "warp=2"), ("directional:x", "full")):
        with pytest.raises((UsageError, SfumatoError)):
            contestants(names, qualities)


@pytest.mark.gpu
@pytest.mark.slow
def test_command_tells_everything(run: Callable[..., object], tmp_path: Path) -> None:
    pytest.importorskip("numba")
    pytest.importorskip("matplotlib")
    line = ["quality", *TINY, "--techniques", "multidirectional"]
    outcome = run(*line, "--frames", "1,2", "-o", "docs/accuracy")
    assert outcome.status == 0, outcome.err  # type: ignore[attr-defined]
    report = json.loads((tmp_path / "docs" / "accuracy" / "numbers.json").read_text(encoding="utf-8"))
    (result,) = report["results"]
    assert 0 < result["errors"]["1"]["rmse"] < 0.3
    assert set(result["errors"]) == {"1", "2"}
    assert result["cpu_ms_a_frame"] > 0
    text = (tmp_path / "docs" / "accuracy.md").read_text(encoding="utf-8")
    assert "| `multidirectional` | full | 1 |" in text
    assert (tmp_path / "docs" / "accuracy" / "cost.png").stat().st_size > 1000
    with Image.open(tmp_path / "docs" / "accuracy" / "sheet.png") as sheet:
        assert np.asarray(sheet).std() > 10
    (kept,) = (tmp_path / "truth").iterdir()
    before = kept.stat().st_mtime_ns
    assert run(*line, "--frames", "1").status == 0  # type: ignore[attr-defined]
    assert kept.stat().st_mtime_ns == before


@pytest.mark.parametrize(
    "wrong", [["--scenes", "warp"], ["--frames", "0"], ["--techniques", "warp"], ["--side", "4"]]
)
def test_wrong_usage(run: Callable[..., object], wrong: list[str]) -> None:
    assert run("quality", *wrong).failed_with(2)  # type: ignore[attr-defined]
