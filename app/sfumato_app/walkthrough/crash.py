"""A window that is used and then killed, as a crash would: its unsaved work is offered at the next start."""

from __future__ import annotations

import subprocess
import sys

from sfumato import SfumatoError

#: Longest wait in seconds for the autosave.
SECONDS = 120.0

_PROGRAM = """
import os, sys
from qtpy.QtCore import QTimer
from sfumato_ui import autosave
from sfumato_ui.app import make_application
from sfumato_ui.settings import data_dir
from sfumato_ui.window import MainWindow

autosave.AUTOSAVE_MS = 50
app = make_application()
window = MainWindow()
window.show()
window.files.opened.connect(lambda: window.editor.change_light("Move the light", tilt=55.0, rotation=200.0))
window.open(sys.argv[1])

def look():
    if list((data_dir() / "autosave").glob("*.sfumato")):
        os._exit(0)

timer = QTimer()
timer.timeout.connect(look)
timer.start(100)
app.exec()
"""


def leave_unsaved_work(path: str) -> None:
    """Open a path in another process, move its light, and end the process before anything is saved.

    Raises
    ------
    SfumatoError
        If nothing was autosaved.
    """
    try:
        done = subprocess.run(
            [sys.executable, "-c", _PROGRAM, path],
            timeout=SECONDS,
            check=False,
            capture_output=True,
            text=True,
        )
    except subprocess.TimeoutExpired:
        raise SfumatoError(f"the window that was to crash: no autosave in {SECONDS:.0f} s") from None
    if done.returncode:
        raise SfumatoError(f"the window that was to crash: {done.stderr.strip()[-300:]}")
