"""The window where there is a screen, and the picture it would show where there is none."""

from __future__ import annotations

import os
import sys
from pathlib import Path

SAMPLE_PICTURE = "sfumato-sample.png"


def has_screen() -> bool:
    """Tell whether Qt can open a window here."""
    if not sys.platform.startswith("linux"):
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"))


def show(path: str | None) -> int:
    """Show the window on a path until it is closed, and return the exit status.

    Raises
    ------
    SfumatoError
        If there is no screen and the picture cannot be drawn.
    """
    if not has_screen():
        return _draw_instead(path)
    from sfumato_ui.app import run

    return run(path)


def _draw_instead(path: str | None) -> int:
    from .drawing import draw
    from .opening import DEFAULT_SAMPLE, open_scene
    from .printing import PrintFlags

    print(
        f"sfumato: no screen here (DISPLAY is not set); drawing to {SAMPLE_PICTURE} instead", file=sys.stderr
    )
    print(draw(open_scene(path or DEFAULT_SAMPLE), PrintFlags().spec(), Path(SAMPLE_PICTURE)))
    return 0
