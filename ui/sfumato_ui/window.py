"""The main window: the picture, with strip, panel, bars and their wiring.

How it hangs together: every control edits the document through `Editor`; `Editor.changed` makes the panels
show the new scene and `ViewDriver` ask the worker for its picture; the worker's thread sends pictures back
as queued signals. `Files` opens and saves.
"""

from __future__ import annotations

import time

from qtpy.QtCore import QEvent, QEventLoop, Qt
from qtpy.QtGui import (
    QCloseEvent,
    QDragEnterEvent,
    QDropEvent,
    QKeyEvent,
    QResizeEvent,
)
from qtpy.QtWidgets import QApplication, QGridLayout, QMainWindow, QSplitter, QTabWidget, QWidget

from sfumato import Document, Scene
from sfumato.scene.picking import Found

from . import camera_moves
from .auto_exposure import AutoExposure
from .autosave import Autosave
from .bars import ToolStrip, TopBar
from .compare import ComparePage
from .drawer import Drawer
from .driver import ViewDriver
from .editing import Editor
from .exporting import Exporter
from .files import Files
from .history import HistoryRow
from .loading import Loader
from .messages import MessageBar
from .panels.light import LightPage
from .panels.material import MaterialPage
from .panels.view import ViewPage
from .recent_pictures import RecentPictures
from .recovery import Recovery
from .settings import settings
from .slice_views.layout import SliceLayout
from .status import StatusLine
from .tab_order import set_tab_order
from .theme import apply_theme
from .thumbnails import Thumbnails
from .trouble import Trouble
from .turntable import Turntable
from .viewport import Viewport
from .vtk_view.layout import VtkLayout
from .window_commands import window_commands
from .worker import RenderWorker

PANEL_WIDTH = 320
#: With larger letters the panel is so many lines' heights wide.
PANEL_LINES = 21
HINT = "Shift-drag moves the light"
#: Longest wait in seconds for the render thread when the window closes; events go on meanwhile.
CLOSE_SECONDS = 5.0


class MainWindow(QMainWindow):
    """One window on one document.

    Parameters
    ----------
    document : Document, optional
        What it shows; an empty one if not given.
    """

    def __init__(self, document: Document | None = None) -> None:
        super().__init__()
        self.setAcceptDrops(True)
        self.editor = Editor(document or Document(Scene()), self)
        self.viewport = Viewport(self.editor)
        self.messages = MessageBar(self.viewport)
        self.worker = RenderWorker()
        self.thumbnails = Thumbnails(self.worker, self)
        self.driver = ViewDriver(self.editor, self.viewport, self.worker)
        self.files = Files(self, self.editor, self.messages, lambda: self.viewport.aspect)
        self.exporter = Exporter(
            self, self.editor, self.viewport, self.worker, self.messages, lambda: self.files.name
        )
        self.top, self.strip, self.status = TopBar(self.editor), ToolStrip(), StatusLine()
        self.drawer = Drawer()
        self.history = HistoryRow(self.editor, self.thumbnails)
        self.exposure = AutoExposure(self.editor, self.thumbnails, self)
        self.compare = ComparePage(self.editor, self.viewport, self.thumbnails, self.history, self.exposure)
        self.light_page = LightPage(self.editor, self.thumbnails, self.exposure)
        self.material_page = MaterialPage(self.editor)
        self.material_page.use_thumbnails(self.thumbnails)
        self.view_page = ViewPage(self.editor, self.viewport.clips)
        self.turntable = Turntable(self.editor, self)
        self.views = QSplitter(Qt.Orientation.Horizontal)
        self.vtk = VtkLayout(self.views, self.editor, self.messages)
        self.slices = SliceLayout(self.views, self.editor, self.viewport)
        self.autosave = Autosave(self.editor, self.files.identify, self)
        self.recent_pictures = RecentPictures(self.viewport, self.files.path)
        self.recovery = Recovery(self.messages, self.files.recover)
        self.trouble = Trouble(self.editor, self.files, self.driver, self.worker, self.messages)
        self._closed = False
        self._lay_out()
        self._connect()
        self.commands = window_commands(self)
        self._restore()
        self._show_document()
        self.worker.start()
        self.recovery.offer()

    # -- building ---------------------------------------------------------------------------------
    def _lay_out(self) -> None:
        self.panel = QTabWidget()
        self.panel.setObjectName("Panel")
        self.panel.setDocumentMode(True)
        self.panel.setFixedWidth(max(PANEL_WIDTH, PANEL_LINES * self.fontMetrics().height()))
        self.panel.tabBar().setDrawBase(False)
        self.panel.tabBar().setAccessibleName("Panels")
        # Its bar alone takes the focus: the tab widget hands it on, and Tab would never get past it.
        self.panel.setFocusProxy(None)  # type: ignore[arg-type]
        self.panel.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        for page, name in (
            (self.light_page, "Light"),
            (self.material_page, "Material"),
            (self.view_page, "View"),
        ):
            self.panel.addTab(page, name)
        self.views.addWidget(self.viewport)
        self.views.setChildrenCollapsible(False)
        middle = QWidget()
        grid = QGridLayout(middle)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(0)
        grid.addWidget(self.top, 0, 0, 1, 3)
        grid.addWidget(self.strip, 1, 0)
        grid.addWidget(self.views, 1, 1)
        grid.addWidget(self.panel, 1, 2, 2, 1)
        self.status.add_button(
            self.drawer.add("history", "History", "Every step, to return to", self.history)
        )
        self.status.add_button(
            self.drawer.add(
                "compare", "Compare", "Against a technique or a step of the history", self.compare
            )
        )
        grid.addWidget(self.drawer, 2, 0, 1, 2)
        grid.addWidget(self.status, 3, 0, 1, 3)
        grid.setRowStretch(1, 1)
        grid.setColumnStretch(1, 1)
        self.setCentralWidget(middle)
        set_tab_order(middle)
        self.viewport.setFocus()

    def _connect(self) -> None:
        editor, worker = self.editor, self.worker
        self.top.file_wanted.connect(self.files.ask_to_open)
        self.top.folder_wanted.connect(self.files.ask_to_open_folder)
        self.top.sample_wanted.connect(self.files.open)
        self.top.recent.chosen.connect(self.files.open)
        self.top.save.clicked.connect(lambda: self.files.save_scene())
        self.top.picture.clicked.connect(self.exporter.ask)
        self.top.unlit.connect(self.driver.set_unlit)
        self.light_page.audit.wanted.connect(self.driver.set_audit)
        self.strip.chosen.connect(self._choose_tool)
        self.strip.fit.clicked.connect(lambda: self.look(""))
        self.strip.vtk.toggled.connect(self.vtk.set_open)
        self.vtk.changed.connect(self.strip.vtk.setChecked)
        self.vtk.rebuilt.connect(lambda: set_tab_order(self.centralWidget()))
        self.strip.slices.toggled.connect(self.slices.set_open)
        self.slices.changed.connect(self.strip.slices.setChecked)
        self.slices.rebuilt.connect(lambda: set_tab_order(self.centralWidget()))
        self.viewport.pick_tool.picked.changed.connect(lambda found: self.slices.go_to(found.point))
        self.vtk.trace_wanted.connect(self.files.trace)
        self.view_page.shapes.trace_wanted.connect(self.files.trace)
        self.view_page.view_chosen.connect(self.look)
        self.view_page.auto.clicked.connect(lambda: self.exposure.ask())
        self.view_page.automatic.setChecked(self.exposure.on)
        self.view_page.automatic.toggled.connect(self._set_automatic)
        self.view_page.theme_chosen.connect(self.set_theme)
        self.view_page.scale_bar_chosen.connect(self.viewport.set_scale_bar)
        self.view_page.turntable.clicked.connect(lambda: self._turn())
        self.turntable.playing_changed.connect(self.view_page.turntable.setChecked)
        self.viewport.shown.connect(lambda picture: self.turntable.step())
        self.view_page.cube_chosen.connect(self.viewport.set_cube)
        self.viewport.side_chosen.connect(self.turn_to)
        self.view_page.frames_chosen.connect(self.driver.set_frames)
        self.viewport.pick_tool.picked.changed.connect(self._show_material)
        self.viewport.pick_tool.words = self.material_page.transfer.plot.told
        self.viewport.clips.added.connect(lambda: self.strip.choose("clip"))
        self.light_page.rebuilt.connect(lambda: set_tab_order(self.centralWidget()))
        self.light_page.own_rigs.rebuilt.connect(lambda: set_tab_order(self.centralWidget()))
        self.view_page.shapes.rebuilt.connect(lambda: set_tab_order(self.centralWidget()))
        self.viewport.lamp_moved.connect(self._hint_done)
        self.viewport.resized.connect(self.messages.place)
        editor.changed.connect(lambda old, new: self._show_title())
        editor.history_changed.connect(self._show_title)
        editor.rejected.connect(self.messages.show_error)
        worker.picture.connect(self.status.show_picture)
        worker.picture.connect(self.history.see)
        self.viewport.shown.connect(self.compare.see)
        self.drawer.changed.connect(lambda page: self.compare.end() if page != "compare" else None)
        worker.progress.connect(self.status.show_progress)
        worker.ready.connect(self.status.show_renderer)
        builder = self.driver.builder
        builder.progress.connect(self._show_building)
        builder.built.connect(self.view_page.shapes.show_count)
        self.messages.cancelled.connect(builder.give_up)
        builder.given_up.connect(lambda shown: editor.change("Leave geometry as it was", geometry=shown))
        self.files.opened.connect(self._show_document)
        self.files.opened.connect(self.exposure.opened)
        self.files.scene_saved.connect(self._show_title)
        self.files.scene_saved.connect(self.autosave.watch)
        self.files.recovered.connect(self.autosave.adopt)
        self.autosave.failed.connect(
            lambda why: self.messages.show_notice(f"The scene could not be autosaved: {why}")
        )

    def _restore(self) -> None:
        kept = settings()
        geometry = kept.value("window/geometry")
        if geometry is None or not self.restoreGeometry(geometry):
            self.resize(1280, 720)
        self.panel.setCurrentIndex(int(str(kept.value("panel/tab", 0, type=int))))
        self.panel.currentChanged.connect(lambda tab: settings().setValue("panel/tab", tab))
        if not kept.value("hint/light_seen", False, type=bool):
            self.viewport.set_hint(HINT)
        self.slices.restore()

    # -- showing ----------------------------------------------------------------------------------
    def _show_document(self) -> None:
        """Show another document from scratch."""
        for page in (self.light_page, self.material_page, self.view_page):
            page.refresh()
        self.light_page.lamps.refresh()
        self.status.show_volume(self.editor.scene.volume)
        self.top.refresh()
        self._show_title()
        self.driver.ask()

    def _show_title(self) -> None:
        name, modified = self.files.name, self.editor.document.modified
        title = f"{name}[*] – Sfumato" if name else "Sfumato[*]"
        # Windows' titles are dear to set, and drags come here at each move.
        if (title, modified) != (self.windowTitle(), self.isWindowModified()):
            self.setWindowTitle(title)
            self.setWindowModified(modified)

    def set_theme(self, name: str) -> None:
        """Show the window in another theme, and remember it."""
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        settings().setValue("window/theme", apply_theme(app, name).name)
        for part in (
            self.top,
            self.strip,
            self.drawer,
            self.messages,
            self.viewport.shadow_bar,
            self.vtk,
            self.slices,
            self.light_page,
            self.material_page,
            self.view_page,
        ):
            part.refresh_theme()
        self.view_page.refresh()
        self.viewport.update()

    # -- acting -----------------------------------------------------------------------------------
    def open(self, path: str) -> None:
        """Open a file, a folder or a sample."""
        self.files.open(path)

    def look(self, view: str) -> None:
        """See the whole subject from a standard view, or from where the camera stands if none is named."""
        camera = camera_moves.whole_view(self.editor.scene, self.viewport.aspect, view)
        if camera is not None:
            self.editor.change(f"View from the {view}" if view else "See the whole", camera=camera)

    def turn_to(self, view: str) -> None:
        """See what is seen from a standard view, as near as it is."""
        camera = self.editor.scene.camera
        if camera is not None:
            self.editor.change(f"View from the {view}", camera=camera_moves.from_side(camera, view))

    def _turn(self) -> None:
        """Let the turntable play, or end it; its button tells which."""
        self.turntable.toggle()
        self.view_page.turntable.setChecked(self.turntable.playing)

    def _show_material(self, found: Found) -> None:
        """Show where a material that was picked lies in the function."""
        self.panel.setCurrentWidget(self.material_page)
        transfer = self.material_page.transfer
        transfer.pick(found)
        self.material_page.ensureWidgetVisible(
            transfer.shapes.plot if transfer.dimensions.two else transfer.plot
        )

    def _show_building(self, done: float, text: str) -> None:
        """Tell how far meshes are, unless the bar tells of an error or asks something."""
        if done < 1 and self.messages.kind in ("", "progress", "notice"):
            self.messages.show_progress(f"{text}…", done)
        elif done >= 1 and self.messages.text.startswith("Building"):
            self.messages.clear("progress")

    def _choose_tool(self, name: str) -> None:
        self.viewport.tool = name

    def _set_automatic(self, on: bool) -> None:
        self.exposure.set_on(on)
        self.light_page.rigs.refresh()
        self.light_page.more_rigs.refresh()
        self.light_page.own_rigs.row.refresh()

    def _hint_done(self) -> None:
        if self.viewport.hint:
            self.viewport.set_hint("")
            settings().setValue("hint/light_seen", True)

    # -- events -----------------------------------------------------------------------------------
    def keyPressEvent(self, event: QKeyEvent) -> None:
        """B shows the unlit picture while it is held."""
        if event.key() == Qt.Key.Key_B and not event.modifiers():
            if not event.isAutoRepeat():
                self._see_unlit(True)
            return
        super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """End the unlit picture."""
        if event.key() == Qt.Key.Key_B and not event.isAutoRepeat():
            self._see_unlit(False)
            return
        super().keyReleaseEvent(event)

    def _see_unlit(self, unlit: bool) -> None:
        self.driver.set_unlit(unlit)
        self.top.before.setDown(unlit)

    def changeEvent(self, event: QEvent) -> None:
        """End the unlit picture when another window takes the keys."""
        if event.type() == QEvent.Type.ActivationChange and not self.isActiveWindow():
            self._see_unlit(False)
        super().changeEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the message bar in its place."""
        super().resizeEvent(event)
        self.messages.place()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files and folders."""
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open the first file or folder that was dropped, and all tracts and meshes with it."""
        paths = [url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()]
        if paths:
            event.acceptProposedAction()
            self.files.open_all(paths)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Ask about unsaved work, then end the threads without freezing."""
        if self._closed:
            return
        if not self.files.may_leave():
            event.ignore()
            return
        self._closed = True
        settings().setValue("window/geometry", self.saveGeometry())
        self.hide()
        self.turntable.end()
        self.vtk.close()
        self.slices.close()
        self.driver.stop()
        self.recovery.close()
        self.autosave.close()
        self.editor.close()
        self.files.loader.cancel()
        self.worker.ask_to_stop()
        _wait_for(self.worker, self.files.loader)
        self.files.loader.blockSignals(True)
        self.worker.blockSignals(True)
        event.accept()


def _wait_for(worker: RenderWorker, loader: Loader) -> None:
    """Go on with events until both threads have ended, for a bounded time."""
    until = time.monotonic() + CLOSE_SECONDS
    while (worker.alive or loader.alive) and time.monotonic() < until:
        QApplication.processEvents(QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents, 20)
        time.sleep(0.005)
