"""The history as a row of pictures: a click, or arrow keys and Enter, return to a step.

A step's picture is what the window showed of it, so it costs nothing. Steps that went by too quickly to be
seen are drawn while the worker is idle, and only as long as the row is seen.
"""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QModelIndex, QPersistentModelIndex, QRectF, QSize, Qt, QTimer
from qtpy.QtGui import QColor, QHideEvent, QImage, QKeyEvent, QPainter, QPainterPath, QPen, QShowEvent
from qtpy.QtWidgets import QListView, QListWidget, QListWidgetItem, QStyle, QStyledItemDelegate

from sfumato import Scene
from sfumato.scene.document import Step

from .editing import Editor
from .jobs import Picture
from .theme import PICTURE_GREY, current_theme
from .thumbnails import Thumbnails

GROUP = "history"
#: Width and height of a picture, and the room around it.
PICTURE, GAP = (96, 64), 6
#: Pictures kept at most (20 MB on a screen of ratio 2), and drawn at most at a time.
MOST_PICTURES, MOST_WANTED = 200, 24
#: Quiet time in milliseconds after which missing pictures are drawn.
QUIET_MS = 500
BEGINNING = "Beginning"
_Index = QModelIndex | QPersistentModelIndex


class StepPictures:
    """Small pictures of states of the history, by the state itself; a bounded number."""

    def __init__(self) -> None:
        self._kept: dict[int, tuple[Scene, QImage]] = {}

    def __len__(self) -> int:
        return len(self._kept)

    def of(self, scene: Scene) -> QImage | None:
        """Return the picture of a state, if there is one."""
        kept = self._kept.get(id(scene))
        return kept[1] if kept is not None and kept[0] is scene else None

    def keep(self, scene: Scene, image: QImage) -> None:
        """Keep a picture of a state."""
        self._kept[id(scene)] = scene, image

    def tidy(self, steps: tuple[Step, ...], position: int) -> None:
        """Forget states that are gone, and if there are too many those farthest from the present."""
        nearest = sorted(range(len(steps)), key=lambda i: abs(i - position))
        near = [id(steps[i].scene) for i in nearest if id(steps[i].scene) in self._kept]
        self._kept = {name: self._kept[name] for name in near[:MOST_PICTURES]}


class HistoryRow(QListWidget):
    """All steps from left to right; the present one is framed, what was undone is paler."""

    def __init__(self, editor: Editor, thumbnails: Thumbnails) -> None:
        super().__init__()
        self._editor, self._thumbnails = editor, thumbnails
        self.pictures = StepPictures()
        self.steps: tuple[Step, ...] = ()
        self._shown: Picture | None = None
        self._ratio = 1.0
        self.setAccessibleName("History")
        self.setAccessibleDescription("Left and right choose a step, Enter returns to it")
        self.setFlow(QListView.Flow.LeftToRight)
        self.setWrapping(False)
        self.setUniformItemSizes(True)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setHorizontalScrollMode(QListView.ScrollMode.ScrollPerPixel)
        self.setItemDelegate(_StepPainter(self))
        self.itemClicked.connect(self._return_to)
        self._quiet = QTimer(self)
        self._quiet.setSingleShot(True)
        self._quiet.setInterval(QUIET_MS)
        self._quiet.timeout.connect(self._want_missing)
        editor.history_changed.connect(self.refresh)
        thumbnails.ready.connect(self._on_ready)
        self.refresh()

    @property
    def position(self) -> int:
        """Index of the present state."""
        return self._editor.document.position

    @property
    def chosen(self) -> Scene | None:
        """The state that is marked in the row, whether or not it is the present one."""
        row = self.currentRow()
        return self.steps[row].scene if 0 <= row < len(self.steps) else None

    @staticmethod
    def words(step: Step) -> str:
        """Name a step."""
        return step.label or BEGINNING

    # -- steps ------------------------------------------------------------------------------------
    def refresh(self) -> None:
        """Show the document's steps; what has not changed is left alone."""
        before, moved = self.steps, self.property("position") != self.position
        self.steps = self._editor.document.steps
        same = 0
        for old, new in zip(before, self.steps, strict=False):
            if old.label != new.label:
                break
            same += 1
        while self.count() > same:
            self.takeItem(self.count() - 1)
        for step in self.steps[same:]:
            self.addItem(self._item(step))
        if moved or same < max(len(before), len(self.steps)):
            self.setProperty("position", self.position)
            self.setCurrentRow(self.position)
            self._follow()
            self.viewport().update()
        if self._shown is not None:
            self._take(self._shown)
        self.pictures.tidy(self.steps, self.position)
        if self.isVisible():
            self._quiet.start()

    def _item(self, step: Step) -> QListWidgetItem:
        item = QListWidgetItem(self.words(step))
        item.setToolTip(self.words(step))
        return item

    def _follow(self) -> None:
        item = self.item(self.position)
        if item is not None:
            self.scrollToItem(item)

    def _return_to(self, item: QListWidgetItem) -> None:
        self._editor.go_to(self.row(item))

    # -- pictures ---------------------------------------------------------------------------------
    def see(self, picture: Picture) -> None:
        """Take a step's picture from what the window shows."""
        self._shown = picture
        if not picture.interactive and (picture.frames == 1 or picture.settled):
            self._take(picture)

    def _take(self, picture: Picture) -> None:
        """Keep a small copy, if the picture is the present state's and better than what is there."""
        scene = picture.scene
        if scene is not self._editor.scene or self._editor.document.dragging or picture.audit is not None:
            return
        if self.pictures.of(scene) is not None and not picture.settled:
            return
        size = QSize(*PICTURE) * self.devicePixelRatioF()
        filling = Qt.AspectRatioMode.KeepAspectRatioByExpanding
        wide = picture.image.scaled(size, filling, Qt.TransformationMode.SmoothTransformation)
        left, top = (wide.width() - size.width()) // 2, (wide.height() - size.height()) // 2
        self.pictures.keep(scene, wide.copy(left, top, size.width(), size.height()))
        self.viewport().update()

    def _want_missing(self) -> None:
        """Have the worker draw what was never seen, the nearest first."""
        volume = self._editor.scene.volume
        places = sorted(range(len(self.steps)), key=lambda place: abs(place - self.position))
        missing: dict[Any, Scene] = {
            id(step.scene): step.scene
            for step in (self.steps[place] for place in places)
            if step.scene.volume is volume is not None and self.pictures.of(step.scene) is None
        }
        if missing and self.isVisible():
            size = QSize(*PICTURE) * self.devicePixelRatioF()
            wanted = dict(list(missing.items())[:MOST_WANTED])
            self._thumbnails.want(GROUP, wanted, (size.width(), size.height()))

    def _on_ready(self, group: str, key: Any, image: QImage) -> None:
        if group == GROUP:
            for step in self.steps:
                if id(step.scene) == key:
                    self.pictures.keep(step.scene, image)
            self.viewport().update()

    # -- events -----------------------------------------------------------------------------------
    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrow keys choose, Enter or Space returns to the step; letters are the window's."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self._editor.go_to(max(0, self.currentRow()))
        elif event.text().strip():
            event.ignore()
        else:
            super().keyPressEvent(event)

    def showEvent(self, event: QShowEvent) -> None:
        """Show the present step, and draw what is missing."""
        super().showEvent(event)
        self._follow()
        self._quiet.start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Draw nothing that nobody sees."""
        super().hideEvent(event)
        self._quiet.stop()
        self._thumbnails.forget(GROUP)

    def sizeHint(self) -> QSize:
        """Be as tall as a step and the bar that scrolls."""
        bar = self.horizontalScrollBar().sizeHint().height()
        return QSize(400, step_size(self).height() + bar + 2 * self.frameWidth() + 2)


def step_size(row: HistoryRow) -> QSize:
    """Return the room of a step: its picture and two lines of words."""
    lines = 2 * row.fontMetrics().lineSpacing()
    return QSize(PICTURE[0] + 2 * GAP, PICTURE[1] + lines + 2 * GAP + 2)


class _StepPainter(QStyledItemDelegate):
    """Paints a step: picture, words, the present one's frame, the chosen one's ring."""

    def __init__(self, row: HistoryRow) -> None:
        super().__init__(row)
        self._row = row

    def sizeHint(self, option: Any, index: _Index) -> QSize:
        """All are as large."""
        return step_size(self._row)

    def paint(self, painter: QPainter, option: Any, index: _Index) -> None:
        """Paint one step."""
        if index.row() >= len(self._row.steps):
            return
        theme, step = current_theme(), self._row.steps[index.row()]
        present, undone = index.row() == self._row.position, index.row() > self._row.position
        painter.save()
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        box = QRectF(option.rect)
        if option.state & QStyle.StateFlag.State_MouseOver:
            painter.fillRect(box, QColor(theme.hover))
        frame = QRectF(box.left() + GAP, box.top() + GAP, *PICTURE)
        self._paint_picture(painter, frame, self._row.pictures.of(step.scene), undone)
        if present:
            painter.setPen(QPen(QColor(theme.accent), 3))
            painter.drawRoundedRect(frame.adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)
        if index.row() == self._row.currentRow() and self._row.hasFocus():
            painter.setPen(QPen(QColor(theme.text), 2))
            painter.drawRoundedRect(frame.adjusted(-3, -3, 3, 3), 6, 6)
        font = painter.font()
        font.setBold(present)
        painter.setFont(font)
        painter.setPen(QColor(theme.muted if undone else theme.text))
        _draw_words(
            painter,
            QRectF(
                frame.left() - 4, frame.bottom() + 4, frame.width() + 8, box.bottom() - frame.bottom() - 4
            ),
            self._row.words(step),
        )
        painter.restore()

    @staticmethod
    def _paint_picture(painter: QPainter, frame: QRectF, image: QImage | None, pale: bool) -> None:
        rounded = QPainterPath()
        rounded.addRoundedRect(frame, 4, 4)
        painter.save()
        painter.setClipPath(rounded)
        painter.fillRect(frame, QColor(PICTURE_GREY))
        painter.setOpacity(0.45 if pale else 1.0)
        if image is not None:
            painter.drawImage(frame, image)
        painter.restore()


def _draw_words(painter: QPainter, box: QRectF, text: str) -> None:
    """Draw words on two lines at most, shortened where they need more."""
    metrics = painter.fontMetrics()
    flags = Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
    while text and metrics.boundingRect(box.toRect(), flags, text).height() > 2 * metrics.lineSpacing():
        text = text.rstrip("…")[:-1].rstrip() + "…"
    painter.drawText(box, flags, text)
