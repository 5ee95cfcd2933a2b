"""What all tests share: options, the real data sets, and an environment that is the same everywhere."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest

import sfumato

#: The real data sets lie beside the repository, or where SFUMATO_DATA says.
DATA = Path(os.environ.get("SFUMATO_DATA", Path(__file__).resolve().parents[2] / "shared" / "data"))
#: Folders in the order in which they run: what fails fast comes first.
ORDER = ("core", "techniques", "cli", "ui", "images", "bench")
_HOME = "SFUMATO_TEST_HOME"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--all", action="store_true", help="run the slow tests too (as SFUMATO_ALL=1)")
    parser.addoption(
        "--measured",
        choices=("also", "not", "only"),
        default="also",
        help="tests that measure how long the window stalls: with the others, not, or they alone",
    )
    parser.addoption("--accept-images", action="store_true", help="expect the pictures drawn now")


def pytest_configure(config: pytest.Config) -> None:
    # The pictures that tests compare with were drawn by Mesa's software renderer; SFUMATO_TEST_GPU=1 draws
    # on the machine's own device instead, and the image tests are skipped.
    if not os.environ.get("SFUMATO_TEST_GPU"):
        os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
        os.environ.setdefault("GALLIUM_DRIVER", "llvmpipe")
    # Settings and caches of tests are not the user's. The processes of xdist share the first one's folder.
    if _HOME not in os.environ:
        home = tempfile.mkdtemp(prefix="sfumato-test-home-")
        os.environ[_HOME] = home
        for name in ("CONFIG", "CACHE", "DATA", "STATE"):
            os.environ[f"XDG_{name}_HOME"] = str(Path(home) / name.lower())
        config.add_cleanup(lambda: _forget(home))


def _forget(home: str) -> None:
    os.environ.pop(_HOME, None)
    shutil.rmtree(home, ignore_errors=True)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    everything = config.getoption("--all") or os.environ.get("SFUMATO_ALL")
    for item in items:
        if item.get_closest_marker("slow") and not everything:
            item.add_marker(pytest.mark.skip(reason="slow: ./run test --all"))
        if item.get_closest_marker("real_data") and not DATA.is_dir():
            item.add_marker(pytest.mark.skip(reason=f"the real data sets are not at {DATA}"))
    _choose_measured(config, items)
    items.sort(key=_rank)


def _choose_measured(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave the tests that measure time for a process of their own, or the others."""
    choice = config.getoption("--measured")
    if choice == "also":
        return
    chosen: list[pytest.Item] = []
    others: list[pytest.Item] = []
    for item in items:
        measured = item.get_closest_marker("measured") is not None
        (chosen if measured == (choice == "only") else others).append(item)
    config.hook.pytest_deselected(items=others)
    items[:] = chosen


def _rank(item: pytest.Item) -> tuple[bool, int]:
    folder = item.path.relative_to(Path(__file__).parent).parts[0]
    place = ORDER.index(folder) if folder in ORDER else len(ORDER)
    return item.get_closest_marker("slow") is not None, place


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of the real data sets; for tests marked ``real_data``."""
    return DATA


@pytest.fixture(scope="session")
def still_life() -> sfumato.Volume:
    """Return a ball and two rods before a wall, 48^3 voxels of 1 mm."""
    z, y, x = (np.mgrid[:48, :48, :48] + 0.5) / 48
    ball = np.sqrt((x - 0.38) ** 2 + (y - 0.35) ** 2 + (z - 0.58) ** 2) - 0.17
    upright = np.hypot(x - 0.72, y - 0.4) - 0.05
    lying = np.hypot(y - 0.52, z - 0.24) - 0.05
    wall = np.maximum(0.74 - y, y - 0.86)
    parts = [(ball, 220), (upright, 160), (lying, 160), (wall, 100)]
    voxels = np.max([value * np.clip(0.5 - 48 * distance, 0, 1) for distance, value in parts], axis=0)
    return sfumato.Volume(voxels.astype(np.uint8))


@pytest.fixture(scope="session")
def still_life_colors() -> sfumato.TransferFunction:
    """Return a transfer function for `still_life`: a pale wall, blue rods, a red ball that shows its skin."""
    return sfumato.TransferFunction.from_points(
        [(40, (0.9, 0.85, 0.75), 0.0), (90, (0.9, 0.85, 0.75), 0.7), (110, (0.9, 0.85, 0.75), 0.7),
         (150, (0.3, 0.5, 0.9), 0.6), (170, (0.3, 0.5, 0.9), 0.6), (210, (0.9, 0.3, 0.2), 0.5)]
    )  # fmt: skip


@pytest.fixture(scope="session")
def software_renderer() -> bool:
    """Whether drawing is done by llvmpipe, with which the reference pictures were made."""
    return not os.environ.get("SFUMATO_TEST_GPU")
