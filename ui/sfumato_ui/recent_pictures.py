"""What the recent files looked like when they were last seen: small pictures beside the settings."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Callable
from pathlib import Path

from qtpy.QtCore import QObject, QRect, Qt, QTimer
from qtpy.QtGui import QColor, QIcon, QImage, QPainter, QPixmap

from .jobs import Picture
from .recent import recent_files
from .settings import data_dir
from .theme import PICTURE_GREY
from .viewport import Viewport

#: Side of a picture in the menu in widget pixels, and of that which is kept, for dense screens.
SIDE, KEPT_SIDE = 44, 88
#: Milliseconds after a still picture until it is kept: the hand may go on.
WAIT_MS = 1500
_PART = "-part.png"


def folder() -> Path:
    """Return the folder of the pictures."""
    return data_dir() / "recent"


def file_of(path: str) -> Path:
    """Return the file of a path's picture."""
    return folder() / f"{hashlib.blake2b(path.encode(), digest_size=16).hexdigest()}.png"


def icon_of(path: str) -> QIcon:
    """Return the picture of a path; empty ground if there is none."""
    pixmap = QPixmap(str(file_of(path)))
    if pixmap.isNull():
        pixmap = QPixmap(KEPT_SIDE, KEPT_SIDE)
        pixmap.fill(QColor(PICTURE_GREY))
    return QIcon(pixmap)


def small(image: QImage) -> QImage:
    """Return the middle of a picture, as a small square on the window's grey."""
    side = min(image.width(), image.height())
    middle = QRect((image.width() - side) // 2, (image.height() - side) // 2, side, side)
    scaled = image.copy(middle).scaled(
        KEPT_SIDE, KEPT_SIDE, Qt.AspectRatioMode.IgnoreAspectRatio, Qt.TransformationMode.SmoothTransformation
    )
    whole = QImage(KEPT_SIDE, KEPT_SIDE, QImage.Format.Format_RGB32)
    whole.fill(QColor(PICTURE_GREY))
    painter = QPainter(whole)
    painter.drawImage(0, 0, scaled)
    painter.end()
    return whole


class RecentPictures(QObject):
    """Keeps the picture of what is open, once it has come to rest.

    Parameters
    ----------
    path : callable
        Returns the path of what is open, or nothing.
    """

    def __init__(self, viewport: Viewport, path: Callable[[], str]) -> None:
        super().__init__(viewport)
        self._path = path
        self._seen: tuple[str, QImage] | None = None
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(WAIT_MS)
        self._timer.timeout.connect(self.keep)
        viewport.shown.connect(self._see)

    def _see(self, picture: Picture) -> None:
        path = self._path()
        if self._seen is not None and self._seen[0] != path:
            self.keep()  # something else was opened meanwhile
        if picture.interactive or picture.audit is not None:
            self._timer.stop()
            return
        self._seen = path, picture.image
        if not self._timer.isActive():
            self._timer.start()

    def keep(self) -> None:
        """Write the picture that was last seen, away from the window's thread."""
        seen, self._seen = self._seen, None
        if seen is None or seen[0] not in recent_files():
            return
        path, image = seen[0], small(seen[1])
        kept = {file_of(one) for one in recent_files()}
        threading.Thread(
            target=_write, args=(image, file_of(path), kept), name="sfumato-recent-picture", daemon=True
        ).start()


def _write(image: QImage, target: Path, kept: set[Path]) -> None:
    """Write a picture, and remove those of files that are no longer listed; what cannot be written is no loss."""
    try:
        target.parent.mkdir(exist_ok=True)
        part = target.with_name(f"{target.stem}{_PART}")
        if image.save(str(part)):
            part.replace(target)
        for other in target.parent.glob("*.png"):
            if other not in kept and not other.name.endswith(_PART):
                other.unlink(missing_ok=True)
    except OSError:
        return
