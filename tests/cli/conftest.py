"""A small volume on disk, and the command line in this process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from sfumato_app.__main__ import main


@dataclass(frozen=True)
class Outcome:
    status: int
    out: str
    err: str

    def failed_with(self, status: int) -> str:
        """Check that it failed as promised, in one line on stderr, and return that line."""
        assert self.status == status, self.err
        lines = self.err.splitlines()
        assert len(lines) == 1, self.err
        assert lines[0].startswith("sfumato: error: ")
        assert "Traceback" not in self.err
        return lines[0]


@pytest.fixture
def ball(tmp_path: Path) -> Path:
    """A solid ball of radius 9 voxels, uint8, 24 x 24 x 24, as .npy."""
    z, y, x = np.mgrid[:24, :24, :24] - 11.5
    path = tmp_path / "ball.npy"
    np.save(path, np.clip(200 * (9.5 - np.sqrt(x * x + y * y + z * z)), 0, 200).astype(np.uint8))
    return path


@pytest.fixture
def run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Outcome]:
    """Run a command line in the test's own folder."""
    monkeypatch.chdir(tmp_path)

    def run_line(*arguments: object) -> Outcome:
        capsys.readouterr()
        status = main([str(a) for a in arguments])
        out, err = capsys.readouterr()
        return Outcome(status, out, err)

    return run_line
