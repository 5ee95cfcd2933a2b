"""What the window remembers between sessions; tests point it to a temporary folder."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs
from qtpy.QtCore import QSettings

from sfumato.gpu.store import LIMITS

_GPU_BUDGET = "gpu/budget_mb"


def settings() -> QSettings:
    """Return the settings: an INI file in the user's configuration folder, or in ``SFUMATO_SETTINGS``."""
    folder = os.environ.get("SFUMATO_SETTINGS")
    if folder:
        return QSettings(os.path.join(folder, "sfumato.ini"), QSettings.Format.IniFormat)
    return QSettings(QSettings.Format.IniFormat, QSettings.Scope.UserScope, "sfumato", "sfumato")


def gpu_budget() -> int | None:
    """Return the bytes that may be kept on the GPU, by the preference ``gpu/budget_mb`` (MiB); None if there is none.

    What is not a number of MiB that a store takes counts as none.
    """
    text = str(settings().value(_GPU_BUDGET, "")).strip()
    low, high = LIMITS
    return int(text) << 20 if text.isdecimal() and low <= int(text) <= high else None


def data_dir() -> Path:
    """Return the folder of what the user makes (presets, autosaves), which exists, or `SFUMATO_SETTINGS`.

    Raises
    ------
    OSError
        If the folder cannot be made.
    """
    folder = os.environ.get("SFUMATO_SETTINGS")
    path = Path(folder) if folder else platformdirs.user_data_path("sfumato", appauthor=False)
    path.mkdir(parents=True, exist_ok=True)
    return path
