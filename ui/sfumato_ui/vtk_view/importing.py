"""VTK is imported when its view is first wanted, away from the window's thread."""

from __future__ import annotations

import threading

from qtpy.QtCore import QObject, Signal

from ..threads import tell


class VtkImporter(QObject):
    """Imports VTK, which takes seconds the first time, away from the window's thread."""

    #: VTK is there, or why not.
    done = Signal(str)

    def start(self) -> None:
        """Begin; `done` follows."""
        threading.Thread(target=self._run, name="sfumato-import-vtk", daemon=True).start()

    def _run(self) -> None:
        problem = ""
        try:
            import pyvistaqt  # noqa: F401
        except Exception as error:  # a broken installation may raise anything
            problem = str(error) or type(error).__name__
        tell(self.done, problem)
