"""``sfumato first-minute``: how long a volume that is dropped on the window takes to show, by real events.

For each volume a fresh window, with a device and shaders of its own, gets the events of a drag that brings
the path; Enter answers a question about DICOM series. What counts is what was painted: the message of
progress, the first lit picture (coarse allowed), the settled one.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, Parameter
from qtpy.QtCore import QCoreApplication, QEvent, QMimeData, QObject, QPoint, QPointF, Qt, QTimer, QUrl
from qtpy.QtGui import QDragEnterEvent, QDropEvent, QKeyEvent
from qtpy.QtWidgets import QApplication, QWidget

from sfumato import LoadError
from sfumato_ui.app import make_application
from sfumato_ui.series_dialog import SeriesDialog
from sfumato_ui.window import MainWindow

from .bench.machine import describe
from .contact_sheet import find_volumes

#: The window's size in pixels.
SIZE = (1280, 720)
#: What is hoped for, in seconds: progress, first lit picture, settled picture.
GOALS = (0.5, 10.0, 30.0)
#: A volume that has not settled after this many seconds is given up.
LIMIT = 240.0
_PROBE = 0.05


@dataclass(frozen=True)
class Minute:
    """What happened after a drop, in seconds since it.

    Attributes
    ----------
    name : str
        The data set.
    dims : tuple of int
        Columns, rows, slices; zeros if nothing was opened.
    progress, loaded, first, settled : float
        When a message of progress was painted, the volume was read, its first and its settled picture
        painted; NaN for what never happened.
    load : float
        Wall over processor time of a short calculation just before: 1 on an idle machine.
    message : str
        What the window said in the end.
    """

    name: str
    dims: tuple[int, int, int]
    progress: float
    loaded: float
    first: float
    settled: float
    load: float
    message: str

    @property
    def opened(self) -> bool:
        """Whether there was a picture in the end."""
        return self.settled == self.settled

    @property
    def verdict(self) -> str:
        """``yes`` if all goals were met, else which were not."""
        if not self.opened:
            return "not opened" if self.message else "given up"
        times = {"progress": self.progress, "first": self.first, "settled": self.settled}
        late = [name for (name, taken), goal in zip(times.items(), GOALS, strict=True) if not taken <= goal]
        return ", ".join(late) or "yes"


class _Clock(QObject):
    """Notes when parts of a window were painted."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._start = time.perf_counter()
        self.times: dict[str, float] = {}
        window.messages.installEventFilter(self)
        window.viewport.installEventFilter(self)
        window.files.loader.loaded.connect(lambda scene, wish: self.note("loaded"))

    def start(self) -> None:
        """Count from now."""
        self._start = time.perf_counter()

    def note(self, what: str) -> None:
        """Keep when something happened first."""
        self.times.setdefault(what, time.perf_counter() - self._start)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's own name)
        """See paintings; they are done when the event loop goes on."""
        if event.type() == QEvent.Type.Paint:
            for what in self._shown(watched):
                QTimer.singleShot(0, lambda what=what: self.note(what))
        return False

    def _shown(self, watched: QObject) -> Iterator[str]:
        picture = self._window.viewport.picture
        if watched is self._window.messages and self._window.messages.kind == "progress":
            yield "progress"
        elif watched is self._window.viewport and picture is not None:
            yield "first"
            if picture.settled and picture.size == self._window.viewport.pixel_size:
                yield "settled"


def drop(window: QWidget, path: Path) -> None:
    """Bring a file or folder over a window and let it go there."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    at, copy = window.rect().center(), Qt.DropAction.CopyAction
    button, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(window, QDragEnterEvent(QPoint(at), copy, data, button, keys))
    QApplication.sendEvent(window, QDropEvent(QPointF(at), copy, data, button, keys))


def _run_until(done: Callable[[], object], seconds: float) -> bool:
    until = time.perf_counter() + seconds
    while not done():
        if time.perf_counter() > until:
            return False
        QApplication.processEvents()
        time.sleep(0.002)
    return True


def _press_enter(widget: QWidget) -> None:
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
        event = QKeyEvent(kind, Qt.Key.Key_Return, Qt.KeyboardModifier.NoModifier)
        QApplication.sendEvent(QApplication.focusWidget() or widget, event)


def _load_now() -> float:
    """Return wall over processor time of a calculation: how much others take of this processor."""
    wall, cpu = time.perf_counter(), time.thread_time()
    while time.thread_time() - cpu < _PROBE:
        pass
    return (time.perf_counter() - wall) / (time.thread_time() - cpu)


@contextmanager
def own_settings() -> Iterator[None]:
    """Neither use nor change what the user's window remembers."""
    kept = os.environ.get("SFUMATO_SETTINGS")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["SFUMATO_SETTINGS"] = folder
        try:
            yield
        finally:
            if kept is None:
                del os.environ["SFUMATO_SETTINGS"]
            else:
                os.environ["SFUMATO_SETTINGS"] = kept


def first_minute(path: Path, name: str = "", screenshot: Path | None = None) -> Minute:
    """Drop a volume on a fresh window, wait until its picture has settled, and tell when what was seen.

    Parameters
    ----------
    path : Path
        A file or folder.
    name : str
        What the set is called; its path if not given.
    screenshot : Path, optional
        PNG to write of the settled window.
    """
    make_application()
    with own_settings():
        window = MainWindow()
        try:
            return _measure(window, path, name or str(path), screenshot)
        finally:
            window.editor.document.mark_saved()
            window.close()
            window.deleteLater()
            QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def _measure(window: MainWindow, path: Path, name: str, screenshot: Path | None) -> Minute:
    window.resize(*SIZE)
    window.show()
    window.activateWindow()
    _run_until(lambda: window.windowHandle().isExposed() and window.isActiveWindow(), 5)
    clock, load = _Clock(window), _load_now()
    asked: list[QWidget] = []

    def done() -> bool:
        dialog = QApplication.activeModalWidget()
        if isinstance(dialog, SeriesDialog) and dialog not in asked:
            asked.append(dialog)
            _press_enter(dialog)
        return "settled" in clock.times or window.messages.kind == "error"

    clock.start()
    drop(window, path)
    _run_until(done, LIMIT)
    if screenshot is not None:
        window.grab().save(str(screenshot))
    volume = window.editor.scene.volume
    progress, loaded, first, settled = (
        clock.times.get(what, float("nan")) for what in ("progress", "loaded", "first", "settled")
    )
    dims = volume.dims if volume is not None else (0, 0, 0)
    return Minute(name, dims, progress, loaded, first, settled, load, window.messages.text)


# -- the table ----------------------------------------------------------------------------------------
HEAD = (
    "| data set | voxels | progress (s) | read (s) | first lit (s) | settled (s) | load | within goals |\n"
    "|---|---|--:|--:|--:|--:|--:|---|"
)


def row(minute: Minute) -> str:
    """Return the table's row, in Markdown."""
    if not minute.opened:
        said = minute.message or minute.verdict
        return f"| {minute.name} | | {minute.progress:.2f} | | | | {minute.load:.1f} | {said} |"
    times = (minute.progress, minute.loaded, minute.first, minute.settled)
    voxels = " × ".join(map(str, minute.dims))
    figures = " | ".join(f"{t:.2f}" for t in times)
    return f"| {minute.name} | {voxels} | {figures} | {minute.load:.1f} | {minute.verdict} |"


def _machine() -> str:
    from sfumato import Renderer

    renderer = Renderer()
    try:
        told = describe(renderer.name, renderer.version)
    finally:
        renderer.close()
    load = " ".join(map(str, told["load_average"] or []))
    return (
        f"{told['cpu']}, {told['cores']} cores, load average {load}; {told['gl_renderer']}; "
        f"window {SIZE[0]} × {SIZE[1]}"
    )


def find_drops(folder: Path) -> list[Path]:
    """Return what a user may drop of a folder of data sets: its volumes, and folders of several DICOM files."""
    volumes = find_volumes(folder)
    several = {p.parent for p in volumes if p.suffix == ".dcm" and p.is_file()}
    return volumes + sorted(several)


_program = App(
    name="sfumato first-minute",
    help="Measure when a volume that is dropped on the window is seen, for each in a folder of data sets.",
    help_format="plaintext",
    result_action="return_value",
)


@_program.default
def _command(
    folder: Annotated[Path, Parameter(help="Folder of data sets.")],
    /,
    *,
    only: Annotated[str, Parameter(help="Only sets whose path holds this.")] = "",
    screenshots: Annotated[Path | None, Parameter(help="Folder for a PNG of each settled window.")] = None,
) -> int:
    drops = [p for p in find_drops(folder) if only in str(p.relative_to(folder))]
    if not drops:
        raise LoadError(folder, "there are no such volumes in this folder", "name a folder of data sets")
    if screenshots is not None:
        screenshots.mkdir(parents=True, exist_ok=True)
    print(f"{_machine()}\n\n{HEAD}", flush=True)
    for path in drops:
        name = str(path.relative_to(folder))
        shot = screenshots / f"{name.replace('/', '_')}.png" if screenshots is not None else None
        print(row(first_minute(path, name, shot)), flush=True)
    return 0


def main(arguments: Sequence[str]) -> int:
    """Run the command and return its exit status."""
    status: Any = _program(list(arguments), exit_on_error=False, print_error=False)
    return status if isinstance(status, int) else 0
