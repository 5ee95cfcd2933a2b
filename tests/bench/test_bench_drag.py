"""The step of a drag is measured in a real window, and only where one can be shown."""

from __future__ import annotations

import json

import pytest

from sfumato_app.bench import main
from sfumato_app.bench.drag import has_display, measure_drag
from sfumato_app.bench.setting import Setting


@pytest.mark.gpu
@pytest.mark.skipif(not has_display(), reason="no display")
def test_every_step_of_a_drag_is_timed():
    pytest.importorskip("qtpy")
    drag = measure_drag(Setting(size=24), "multidirectional", steps=3, first=1)
    assert len(drag.steps) == len(drag.render) == 3
    assert all(0 < render < step for step, render in zip(drag.steps, drag.render, strict=True))
    assert drag.drawn < drag.picture
    assert "slider event to shown picture" in drag.text()
    assert json.loads(json.dumps(drag.to_json()))["median_ms"] > 0


def test_a_drag_needs_a_display(monkeypatch, capsys):
    monkeypatch.setattr("sfumato_app.bench.drag.has_display", lambda: False)
    assert main(["--drag"]) == 1
    assert "display" in capsys.readouterr().err
