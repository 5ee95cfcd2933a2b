"""The joint histogram is counted away from the window's thread; another volume's count replaces one that goes on."""

from __future__ import annotations

import threading

from qtpy.QtCore import QObject, Signal

from sfumato import Volume
from sfumato.scene.joint_histogram import joint_histogram

from ..threads import tell


class JointCount(QObject):
    """Counts one volume at a time."""

    #: A histogram is there: the volume and its `JointHistogram`.
    counted = Signal(object, object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._volume: Volume | None = None
        self._stop = threading.Event()

    def want(self, volume: Volume | None) -> None:
        """Count a volume's histogram, or none any more; `counted` tells it, once for each wish of another volume."""
        if volume is self._volume:
            return
        self._stop.set()
        self._volume, self._stop = volume, threading.Event()
        if volume is not None:
            # Also where it is known: to find it by its content takes a look at every voxel.
            arguments = volume, self._stop
            threading.Thread(target=self._count, args=arguments, name="sfumato-joint", daemon=True).start()

    def _count(self, volume: Volume, stop: threading.Event) -> None:
        histogram = joint_histogram(volume, stop.is_set)
        if histogram is not None and not stop.is_set():
            tell(self.counted, volume, histogram)
