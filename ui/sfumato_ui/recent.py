"""What was opened last: the list of recent files, and the folder where dialogs start."""

from __future__ import annotations

import os
from pathlib import Path

from .settings import settings

MAX_RECENT = 10
_FILES, _FOLDER = "files/recent", "files/folder"


def recent_files() -> list[str]:
    """Return the paths that were opened or saved last, the newest first."""
    kept = settings().value(_FILES, [])
    # An INI file does not tell one text from a list of one.
    paths = kept if isinstance(kept, list) else [kept]
    return [path for path in paths if isinstance(path, str) and path][:MAX_RECENT]


def remember(path: str) -> None:
    """Put a file or folder in front of the list, and let dialogs start beside it."""
    absolute = os.path.abspath(path)
    others = [p for p in recent_files() if p != absolute]
    kept = settings()
    kept.setValue(_FILES, [absolute, *others][:MAX_RECENT])
    kept.setValue(_FOLDER, os.path.dirname(absolute))


def forget_all() -> None:
    """Empty the list."""
    settings().remove(_FILES)


def last_folder() -> str:
    """Return the folder where a dialog starts: that of the last file, or the user's own."""
    return str(settings().value(_FOLDER, "")) or str(Path.home())


def recent_folders() -> list[str]:
    """Return the folders of the recent files, each once: where a volume that has moved may be."""
    return list(dict.fromkeys(os.path.dirname(path) for path in recent_files()))
