"""Exporting the picture: from the wish, over dialog and progress, to the file or its message."""

from __future__ import annotations

from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

from qtpy.QtCore import QObject, Signal
from qtpy.QtGui import QColor, QImage, QPainter
from qtpy.QtWidgets import QApplication, QFileDialog, QWidget

from sfumato import Scene, SceneError
from sfumato.export.picture import PictureSpec, framed, write_picture
from sfumato.export.tiles import Guest, bands_of
from sfumato.geometry import color_bars

from .color_button import to_linear
from .editing import Editor
from .export_dialog import ExportDialog, ExportWish
from .jobs import Picture, SaveRequest
from .messages import MessageBar
from .settings import settings
from .subject import is_open
from .theme import PICTURE_GREY
from .viewport import Viewport
from .worker import RenderWorker

#: What a tile costs more than its share of pixels, because the light is swept for each.
_TILE_SHARE = 0.15
_FOLDER = "export/folder"


class Exporter(QObject):
    """Exports and copies the picture of one window.

    Parameters
    ----------
    name : callable
        Returns the name of what is open.
    """

    #: It is known anew how long a picture takes.
    time_known = Signal()

    def __init__(
        self,
        window: QWidget,
        editor: Editor,
        viewport: Viewport,
        worker: RenderWorker,
        bar: MessageBar,
        name: Callable[[], str],
    ) -> None:
        super().__init__(window)
        self._window, self._editor, self._viewport = window, editor, viewport
        self._worker, self._bar, self._name = worker, bar, name
        self._seconds_a_pixel: float | None = None
        self._copy_wanted = False
        self._path = ""
        worker.picture.connect(self._on_picture)
        worker.save_progress.connect(self._show_progress)
        worker.saved.connect(lambda path: bar.show_notice(f"Saved {path}"))
        worker.save_cancelled.connect(lambda: bar.clear("progress"))
        worker.save_failed.connect(self._on_failed)
        bar.cancelled.connect(worker.cancel_save)

    # -- asking -----------------------------------------------------------------------------------
    def ask(self) -> None:
        """Let the user choose how, then where."""
        camera = self._editor.scene.camera
        if not is_open(self._editor.scene) or camera is None:
            return
        dialog = ExportDialog(
            self._viewport.pixel_size, camera.parallel_projection, self.seconds_for, self._window,
            colored=bool(color_bars(self._editor.scene)),
        )  # fmt: skip
        dialog.accepted.connect(lambda: self._ask_for_file(dialog.wish))
        self.time_known.connect(dialog.show_summary)
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _ask_for_file(self, wish: ExportWish) -> None:
        folder = Path(str(settings().value(_FOLDER, str(Path.home()))))
        start = (folder if folder.is_dir() else Path.home()) / f"{self._name() or 'picture'}{wish.suffix}"
        kind = "PNG (*.png)" if wish.suffix == ".png" else "TIFF (*.tif *.tiff)"
        dialog = QFileDialog(self._window, "Export the picture", str(start), kind)
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(wish.suffix[1:])
        dialog.fileSelected.connect(lambda path: self.export(path, wish.spec, wish.transparent))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def seconds_for(self, size: tuple[int, int], frames: int) -> float | None:
        """Return about how long a picture takes, judged by the last full one in the window."""
        if self._seconds_a_pixel is None:
            return None
        tiles = sum(len(band) for band in bands_of(size))
        return self._seconds_a_pixel * size[0] * size[1] * frames * (1 + _TILE_SHARE * (tiles > 1))

    # -- exporting --------------------------------------------------------------------------------
    def export(self, path: str, spec: PictureSpec, transparent: bool = False) -> None:
        """Draw the scene and write it, on the worker's thread; the bar tells how far it is."""
        settings().setValue(_FOLDER, str(Path(path).parent))
        try:
            carried = self._scene_for(spec.size)
        except SceneError as error:
            self._bar.show_error(str(error))
            return
        drawn = _on_ground(carried, transparent)

        def work(renderer: Any, guest: Guest) -> Generator[float, None, None]:
            return write_picture(path, drawn, spec, carried=carried, renderer=renderer, guest=guest)

        self._path = path
        self._show_progress(0.0)
        self._worker.save(SaveRequest(work, path))

    def _scene_for(self, size: tuple[int, int]) -> Scene:
        """Return the scene; in a narrower picture than the window's, all that the window shows stays in it."""
        scene, (width, height) = self._editor.scene, self._viewport.pixel_size
        assert scene.camera is not None
        camera = framed(scene.camera, width / height, size[0] / size[1])
        return scene if camera is scene.camera else scene.with_(camera=camera)

    def _show_progress(self, done: float) -> None:
        self._bar.show_progress(f"Exporting {Path(self._path).name}…", done)

    def _on_failed(self, message: str) -> None:
        self._bar.show_error(
            f"{message}. Nothing was left behind; choose another place, or a smaller picture."
        )

    # -- copying ----------------------------------------------------------------------------------
    def copy(self) -> None:
        """Copy the picture as the window shows it, once it is no longer coarse."""
        picture = self._viewport.picture
        if picture is None:
            return
        self._copy_wanted = picture.interactive
        if not picture.interactive:
            self._copy(picture)

    def _copy(self, picture: Picture) -> None:
        image = picture.image
        # A ground of its own: not every program that pastes knows what transparent means.
        whole = QImage(image.size(), QImage.Format.Format_RGB32)
        whole.fill(QColor(PICTURE_GREY))
        painter = QPainter(whole)
        painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_SourceOver)
        painter.drawImage(whole.rect(), image)
        painter.end()
        QApplication.clipboard().setImage(whole)
        self._bar.show_notice(f"Copied the picture, {whole.width()} × {whole.height()} pixels")

    def _on_picture(self, picture: Picture) -> None:
        if picture.interactive:
            return
        self._seconds_a_pixel = picture.seconds / max(1, picture.size[0] * picture.size[1])
        self.time_known.emit()
        if self._copy_wanted:
            self._copy_wanted = False
            self._copy(picture)


def _on_ground(scene: Scene, transparent: bool) -> Scene:
    """Return the scene before what it shall stand on in the file."""
    if transparent:
        return scene.with_(background=(0.0, 0.0, 0.0, 0.0))
    if scene.background[3] == 0:
        # What is exported is what is seen: without a background, the picture stands on the window's grey.
        return scene.with_(background=(*to_linear(QColor(PICTURE_GREY)), 1.0))
    return scene
