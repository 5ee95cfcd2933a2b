"""A grid over the picture: the same view by each technique, or under each rig, with the time of each."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass

from qtpy.QtCore import QRectF, QSize, Qt, QTimer, Signal
from qtpy.QtGui import QColor, QHideEvent, QImage, QPainter, QPaintEvent, QPen, QResizeEvent, QShowEvent
from qtpy.QtWidgets import QAbstractButton, QGridLayout, QSizePolicy, QWidget

from sfumato import Scene, SceneError
from sfumato.scene.rigs import rig_of, rigs
from sfumato.techniques import techniques
from sfumato.techniques.frame import FULL

from .auto_exposure import AutoExposure, exposure_of, unexposed
from .editing import Editor
from .overlay import draw_text
from .theme import DARK, PICTURE_GREY
from .thumbnails import Thumbnails
from .wording import duration

#: Jittered frames of each picture.
FRAMES = 2
QUIET_MS = 300
#: Takes minutes a frame.
LEFT_OUT = ("reference",)


@dataclass(frozen=True)
class Choice:
    """One cell: its name, the scene that it shows, and whether the present one is such."""

    title: str
    label: str
    scene_of: Callable[[Scene], Scene]
    is_present: Callable[[Scene], bool]


def technique_choices() -> dict[str, Choice]:
    """Return the techniques that are quick enough."""

    def choice(name: str, title: str) -> Choice:
        return Choice(
            title,
            "Choose the technique",
            lambda scene: scene if scene.technique_id == name else scene.with_(technique=name),
            lambda scene: scene.technique_id == name,
        )

    return {t.id: choice(t.id, t.title) for t in techniques().values() if t.id not in LEFT_OUT}


def rig_choices() -> dict[str, Choice]:
    """Return the rigs."""
    return {
        rig.id: Choice(
            rig.title,
            f"Light with rig {rig.title}",
            lambda scene, rig=rig: scene.with_(lights=rig.lights),  # type: ignore[misc]
            lambda scene, rig=rig: rig_of(scene.lights) == rig.id,  # type: ignore[misc]
        )
        for rig in rigs().values()
    }


class GridCell(QAbstractButton):
    """A picture with its name and time; a click takes it."""

    def __init__(self, choice: Choice) -> None:
        super().__init__()
        self.choice = choice
        self.image = QImage()
        self.present = False
        self.setText(choice.title)
        self.setAccessibleName(choice.title)
        self.setToolTip(f"{choice.title}: click to take it")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    @property
    def time_words(self) -> str:
        """How long a frame took, or nothing yet."""
        told = self.image.text("seconds") if not self.image.isNull() else ""
        return duration(float(told)) if told else ""

    def set_image(self, image: QImage) -> None:
        """Show a picture, or none."""
        self.image = image
        self.setAccessibleDescription(f"{self.time_words} a frame" if self.time_words else "being drawn")
        self.update()

    def sizeHint(self) -> QSize:
        """Take what is there."""
        return QSize(120, 90)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw picture, name, time, frame of the present one and focus."""
        painter = QPainter(self)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        painter.fillRect(self.rect(), QColor(PICTURE_GREY))
        if not self.image.isNull():
            painter.drawImage(QRectF(self.rect()), self.image)
        metrics = painter.fontMetrics()
        room = self.width() - 12
        name = metrics.elidedText(self.text(), Qt.TextElideMode.ElideRight, room - 16)
        for text, top in (
            (name, 6),
            (self.time_words or "being drawn…", self.height() - metrics.height() - 12),
        ):
            wide = min(room, metrics.horizontalAdvance(text) + 14)
            draw_text(painter, QRectF(6, top, wide, metrics.height() + 6), text)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if self.present:
            painter.setPen(QPen(QColor(DARK.accent), 3))
            painter.drawRect(self.rect().adjusted(1, 1, -2, -2))
        if self.hasFocus():
            # Dark beside light: seen on any picture.
            for color, width in ((QColor(20, 20, 20), 6), (QColor(255, 255, 255), 2)):
                painter.setPen(QPen(color, width))
                painter.drawRect(self.rect().adjusted(5, 5, -6, -6))


class CompareGrid(QWidget):
    """Cells over the whole picture, drawn one after the other while the render thread is idle."""

    #: Every picture is there.
    finished = Signal()

    def __init__(
        self,
        picture: QWidget,
        editor: Editor,
        thumbnails: Thumbnails,
        group: str,
        choices: Mapping[str, Choice],
        auto: AutoExposure | None = None,
    ) -> None:
        super().__init__(picture)
        self._auto = auto
        self._picture, self._editor, self._thumbnails, self._group = picture, editor, thumbnails, group
        self.cells = {name: GridCell(choice) for name, choice in choices.items()}
        columns = _columns(len(self.cells))
        grid = QGridLayout(self)
        grid.setContentsMargins(2, 2, 2, 2)
        grid.setSpacing(2)
        for i, cell in enumerate(self.cells.values()):
            grid.addWidget(cell, i // columns, i % columns)
            cell.clicked.connect(lambda _=False, cell=cell: self._take(cell))
        self._quiet = QTimer(self)
        self._quiet.setSingleShot(True)
        self._quiet.setInterval(QUIET_MS)
        self._quiet.timeout.connect(self._want)
        editor.changed.connect(lambda old, new: self._on_changed())
        thumbnails.ready.connect(self._on_ready)
        self.hide()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Fill what no cell covers."""
        QPainter(self).fillRect(self.rect(), QColor(PICTURE_GREY).darker(115))

    def place(self) -> None:
        """Cover the picture."""
        self.setGeometry(self._picture.rect())

    def _take(self, cell: GridCell) -> None:
        scene = cell.choice.scene_of(self._editor.scene)
        stops = exposure_of(cell.image) if self._exposed else None
        exposed = {} if stops is None else {"exposure": stops}
        self._editor.change(cell.choice.label, technique=scene.technique, lights=scene.lights, **exposed)

    @property
    def _exposed(self) -> bool:
        """Whether each cell has an exposure of its own."""
        return self._auto is not None and self._auto.on

    def _on_changed(self) -> None:
        if self.isVisible():
            self._mark()
            self._quiet.start()

    def _mark(self) -> None:
        for cell in self.cells.values():
            cell.present = cell.choice.is_present(self._editor.scene)
            cell.update()

    def _want(self) -> None:
        scene = self._editor.scene
        if scene.volume is None or not self.isVisible():
            return
        first = next(iter(self.cells.values()))
        ratio = self.devicePixelRatioF()
        size = max(1, round(first.width() * ratio)), max(1, round(first.height() * ratio))
        wanted: dict[Hashable, Scene] = {}
        for name, cell in self.cells.items():
            try:
                wanted[name] = cell.choice.scene_of(unexposed(scene) if self._exposed else scene)
            except SceneError as error:
                cell.setToolTip(str(error))
                cell.setEnabled(False)
            cell.set_image(QImage())
        self._thumbnails.want(
            self._group, wanted, size, quality=FULL, frames=FRAMES, first=True, timed=True,
            exposed=self._exposed,
        )  # fmt: skip

    def _on_ready(self, group: str, key: Hashable, image: QImage) -> None:
        if group == self._group and isinstance(key, str) and key in self.cells:
            self.cells[key].set_image(image)
            if all(not cell.image.isNull() for cell in self.cells.values()):
                self.finished.emit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Draw at the new size."""
        super().resizeEvent(event)
        if self.isVisible():
            self._quiet.start()

    def showEvent(self, event: QShowEvent) -> None:
        """Draw."""
        super().showEvent(event)
        self._mark()
        self._quiet.start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Draw nothing that nobody sees."""
        super().hideEvent(event)
        self._quiet.stop()
        self._thumbnails.forget(self._group)


def _columns(count: int) -> int:
    """Return the columns of a grid: two to four, as many as leave the fewest places empty."""
    return min((4, 3, 2), key=lambda columns: -count % columns)
