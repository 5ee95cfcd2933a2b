"""The walkthrough's command line."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, Parameter

from sfumato import SfumatoError

from ..errors import UsageError
from ..opening import DEFAULT_SAMPLE
from ..window import has_screen

_program = App(
    name="sfumato walkthrough",
    help="Use the window by real mouse and key events, and save a screenshot of each step in both themes.",
    help_format="plaintext",
    result_action="return_value",
)


@_program.default
def _command(
    *,
    output: Annotated[Path, Parameter(name=["--output", "-o"], help="Folder of the screenshots.")],
    sample: Annotated[str, Parameter(help="What is opened: a sample, as in sample:hand.")] = DEFAULT_SAMPLE,
    size: Annotated[str, Parameter(help="Of the screenshots, in pixels.")] = "1280x720",
    scale: Annotated[float, Parameter(help="Pixels of the screen a pixel of the window.")] = 1.0,
    settle: Annotated[
        float, Parameter(help="Longest wait in s for a step's finished picture; then a coarse one.")
    ] = 240.0,
) -> int:
    if not has_screen():
        raise UsageError("walkthrough: no screen here (DISPLAY is not set); xvfb-run gives one")
    try:
        width, height = (round(int(side) / scale) for side in size.split("x"))
    except (ValueError, ZeroDivisionError):
        raise UsageError(f"--size {size} --scale {scale}: as in --size 3840x2160 --scale 2") from None
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SfumatoError(f"{output}: the folder could not be made: {error.strerror or error}") from None
    # Qt reads it when the application is made.
    os.environ["QT_SCALE_FACTOR"] = str(scale)
    kept = os.environ.get("SFUMATO_SETTINGS")
    with tempfile.TemporaryDirectory(prefix="sfumato-walk-") as folder:
        os.environ["SFUMATO_SETTINGS"] = folder
        try:
            _walk(sample, (width, height), output, settle)
        finally:
            if kept is None:
                del os.environ["SFUMATO_SETTINGS"]
            else:
                os.environ["SFUMATO_SETTINGS"] = kept
    return 0


def _walk(sample: str, size: tuple[int, int], output: Path, settle: float) -> None:
    from sfumato_ui.app import make_application
    from sfumato_ui.quality import QUALITIES, remember_quality
    from sfumato_ui.theme import apply_theme

    from .crash import leave_unsaved_work
    from .steps import AFTER_CRASH, WALK, numbered

    apply_theme(make_application(), "dark")
    # Most of the walk's time goes into pictures.
    remember_quality(QUALITIES[0])
    steps = list(numbered())
    _use_window(sample, size, output, settle, steps[: len(WALK)])
    leave_unsaved_work(sample)
    _use_window("", size, output, settle, steps[-len(AFTER_CRASH) :])


def _use_window(
    sample: str, size: tuple[int, int], output: Path, settle: float, steps: Iterable[tuple[str, Any]]
) -> None:
    """Go through steps in a new window."""
    from sfumato_ui.window import MainWindow

    from .hand import Hand

    window = MainWindow()
    hand = Hand(window, output, settle)
    try:
        window.resize(*size)
        window.show()
        window.activateWindow()
        if sample:
            window.open(sample)
            hand.rest()
        for name, (_, title, act) in steps:
            act(hand)
            hand.look(name, title)
    finally:
        window.editor.document.mark_saved()
        window.close()
        window.deleteLater()


def main(arguments: Sequence[str]) -> int:
    """Run the command and return its exit status."""
    status: Any = _program(list(arguments), exit_on_error=False, print_error=False)
    return status if isinstance(status, int) else 0
