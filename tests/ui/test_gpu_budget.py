"""The preference ``gpu/budget_mb``."""

from __future__ import annotations

from typing import Any

import pytest
from pytestqt.qtbot import QtBot

from sfumato import Scene, Volume
from sfumato_ui.settings import gpu_budget, settings


@pytest.fixture(autouse=True)
def _own_settings(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SFUMATO_SETTINGS", str(tmp_path))


@pytest.mark.parametrize(("text", "budget"), [("256", 256 << 20), ("2", None), ("many", None), ("-5", None)])
def test_the_preference_is_a_number_of_mebibytes(text: str, budget: int | None) -> None:
    assert gpu_budget() is None
    settings().setValue("gpu/budget_mb", text)
    assert gpu_budget() == budget


def test_the_window_keeps_to_it(make_window: Any, qtbot: QtBot, still_life: Volume) -> None:
    settings().setValue("gpu/budget_mb", 128)
    window = make_window()
    window.editor.reset(Scene(volume=still_life))
    qtbot.waitUntil(lambda: window.worker._renderer is not None, timeout=60_000)
    assert window.worker._renderer.device.store.budget == 128 << 20
