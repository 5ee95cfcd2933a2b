"""Comparing: the present picture against another technique or a step of the history, on the same view.

The other picture is drawn by the render thread when it has nothing better to do, in full quality and at the
window's size; as long as the view moves, the present picture alone is seen, and no drag is slowed.
"""

from __future__ import annotations

import threading
from typing import Any

from qtpy.QtCore import QObject, Qt, QTimer, Signal
from qtpy.QtGui import QImage
from qtpy.QtWidgets import QApplication, QHBoxLayout, QLabel, QPushButton, QSizePolicy, QWidget

from sfumato import Scene, SceneError
from sfumato.techniques import techniques
from sfumato.techniques.frame import FULL

from .auto_exposure import AutoExposure
from .camera_moves import edge_letters
from .compare_grid import CompareGrid, rig_choices, technique_choices
from .difference import difference_picture
from .editing import Editor
from .generated import ChoiceBox
from .history import HistoryRow
from .jobs import Picture
from .threads import tell
from .thumbnails import Thumbnails
from .viewport import Viewport
from .wipe import CompareLayer, FollowsSize, WipeHandle
from .wording import duration

GROUP = "compare"
#: Jittered frames of the other picture.
FRAMES = 2
#: Quiet time in milliseconds after which it is drawn.
QUIET_MS = 300
STEP = "step"


class _Differ(QObject):
    """Computes a map of differences on a thread of its own; a newer one replaces it."""

    #: Its number, and what `difference_picture` returns.
    done = Signal(int, object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.number = 0

    def start(self, one: QImage, other: QImage) -> None:
        """Begin."""
        self.number += 1
        threading.Thread(
            target=self._run, args=(self.number, one, other), name="sfumato-difference", daemon=True
        ).start()

    def _run(self, number: int, one: QImage, other: QImage) -> None:
        found = difference_picture(one, other)
        if number == self.number:
            tell(self.done, number, found)


class ComparePage(QWidget):
    """The drawer's page: against what, and how."""

    def __init__(
        self,
        editor: Editor,
        viewport: Viewport,
        thumbnails: Thumbnails,
        history: HistoryRow,
        auto: AutoExposure,
    ) -> None:
        super().__init__()
        self._editor, self._viewport, self._thumbnails = editor, viewport, thumbnails
        self._history = history
        self.mode = ""
        self._other: tuple[Scene, tuple[int, int], QImage] | None = None
        self._present: Picture | None = None
        self.layer, self.handle = CompareLayer(viewport), WipeHandle(viewport)
        self.grids = {
            "techniques": CompareGrid(
                viewport, editor, thumbnails, "compare-techniques", technique_choices()
            ),
            "rigs": CompareGrid(viewport, editor, thumbnails, "compare-rigs", rig_choices(), auto),
        }
        viewport.controls_over += [self.handle, *self.grids.values()]
        FollowsSize(viewport, (self.layer, self.handle, *self.grids.values()))
        self.against = ChoiceBox()
        self.wipe = _button("Wipe", "Both pictures side by side of a line that you drag")
        self.differ = _button("Difference", "Where and how much they differ, by a colour map with a legend")
        self.techniques = _button(
            "All techniques", "The same view by each technique, with the time of a frame"
        )
        self.rigs = _button("All rigs", "The same view under each rig, with the time of a frame")
        self.told = QLabel()
        self._differences = _Differ(self)
        self._quiet = QTimer(self)
        self._quiet.setSingleShot(True)
        self._quiet.setInterval(QUIET_MS)
        self._lay_out()
        self._connect()
        self._fill()

    def _lay_out(self) -> None:
        self.against.setAccessibleName("Compare the picture with")
        self.told.setProperty("muted", True)
        self.told.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        row = QHBoxLayout(self)
        row.setContentsMargins(4, 2, 4, 2)
        row.setSpacing(8)
        row.addWidget(QLabel("Compare with"))
        for widget in (self.against, *self._modes().values()):
            row.addWidget(widget)
        row.addWidget(self.told, 1)

    def _modes(self) -> dict[str, QPushButton]:
        return {
            "wipe": self.wipe,
            "difference": self.differ,
            "techniques": self.techniques,
            "rigs": self.rigs,
        }

    def _connect(self) -> None:
        self.against.activated.connect(lambda _: self._ask())
        for mode, button in self._modes().items():
            button.clicked.connect(lambda on, mode=mode: self.set_mode(mode if on else ""))
        self.handle.moved.connect(self.layer.set_begin)
        self._quiet.timeout.connect(self._want)
        self._editor.changed.connect(lambda old, new: self._ask())
        self._viewport.resized.connect(self._ask)
        self._thumbnails.ready.connect(self._on_ready)
        self._differences.done.connect(self._on_difference)
        self._history.currentRowChanged.connect(lambda _: self._fill())
        self._editor.history_changed.connect(self._fill)

    # -- against what -----------------------------------------------------------------------------
    def _fill(self) -> None:
        """Name the step that is marked in the history, and all techniques."""
        metrics = self.fontMetrics()
        longest = max(metrics.horizontalAdvance(t.title) for t in techniques().values())
        name = metrics.elidedText(f"History: {self._step_words()}", Qt.TextElideMode.ElideRight, longest)
        if not self.against.count():
            self.against.addItem(name, STEP)
            for technique in techniques().values():
                self.against.addItem(technique.title, technique.id)
            self.against.setCurrentIndex(self.against.findData("raycast"))
            self.against.setFixedWidth(longest + 60)
        elif self.against.itemText(0) != name:
            self.against.setItemText(0, name)
            if self.against.currentData() == STEP:
                self._ask()

    def _step(self) -> int:
        """Return the marked step; the beginning, if that is the present one."""
        row = self._history.currentRow()
        return 0 if row == self._history.position or row < 0 else row

    def _step_words(self) -> str:
        steps, step = self._history.steps, self._step()
        return self._history.words(steps[step]) if step < len(steps) else ""

    @property
    def other_scene(self) -> Scene | None:
        """The scene to compare with, seen as the present one is."""
        present = self._editor.scene
        if present.volume is None:
            return None
        name = self.against.currentData()
        try:
            if name != STEP:
                return present.with_(technique=name)
            step = self._history.steps[self._step()].scene
            return step.with_(camera=present.camera) if step.volume is present.volume else None
        except SceneError:
            return None

    # -- how --------------------------------------------------------------------------------------
    def set_mode(self, mode: str) -> None:
        """Compare by ``wipe``, ``difference``, ``techniques`` or ``rigs``, or end it by an empty name."""
        self.mode = mode if self._editor.scene.volume is not None else ""
        for name, button in self._modes().items():
            button.setChecked(name == self.mode)
        self.layer.begin = self.handle.fraction if self.mode == "wipe" else 0.0
        over: list[tuple[Any, bool]] = [(self.layer, self._paired), (self.handle, self.mode == "wipe")]
        for widget, on in (*over, *((grid, name == self.mode) for name, grid in self.grids.items())):
            widget.place()
            widget.setVisible(on)
            widget.raise_()
        # What lies below a grid cannot be reached.
        focus = Qt.FocusPolicy.NoFocus if self.mode in self.grids else Qt.FocusPolicy.StrongFocus
        self._viewport.setFocusPolicy(focus)
        self._tell("", "")
        if self._paired:
            self._show()
            self._ask()
        else:
            self._thumbnails.forget(GROUP)
            self._quiet.stop()

    @property
    def _paired(self) -> bool:
        """Whether two pictures are compared."""
        return self.mode in ("wipe", "difference")

    def end(self) -> bool:
        """End comparing; returns whether there was anything to end."""
        comparing = bool(self.mode)
        inside = self._viewport.isAncestorOf(QApplication.focusWidget() or self)
        self.set_mode("")
        if inside:
            self._viewport.setFocus()
        return comparing

    # -- drawing ----------------------------------------------------------------------------------
    def see(self, picture: Picture) -> None:
        """Take note of the present picture."""
        self._present = picture
        if self.mode == "difference" and not picture.interactive:
            self._show()

    def _ask(self) -> None:
        if self._paired:
            self._show()
            self._quiet.start()

    def _want(self) -> None:
        """Have the other picture drawn, once the hand rests."""
        other, size = self.other_scene, self._viewport.pixel_size
        if other is not None and self._image() is None:
            self._thumbnails.want(
                GROUP, {size: other}, size, quality=FULL, frames=FRAMES, first=True, timed=True
            )

    def _on_ready(self, group: str, key: Any, image: QImage) -> None:
        other = self.other_scene
        if group == GROUP and other is not None and key == self._viewport.pixel_size:
            self._other = other, key, image
            if self._paired:
                self._show()

    def _image(self) -> QImage | None:
        """Return the other picture, if it is of the present view."""
        if self._other is None:
            return None
        scene, size, image = self._other
        return image if size == self._viewport.pixel_size and scene == self.other_scene else None

    def _show(self) -> None:
        image, layer = self._image(), self.layer
        name = self.against.currentText()
        layer.names, layer.bars = ("Now", name), ()
        layer.told = "" if image is not None else f"{name}: being drawn…"
        layer.image = image
        scene = self._editor.scene
        known = scene.volume is not None and scene.volume.info.orientation_known
        layer.letters = edge_letters(scene.camera) if scene.camera is not None and known else None
        if self.mode == "difference":
            layer.names, layer.image = ("", f"Difference from: {name}"), None
            shown = self._present
            still = (
                shown is not None
                and not shown.interactive
                and shown.audit is None
                and shown.scene == self._editor.scene
            )
            if image is not None and shown is not None and still:
                self._differences.start(shown.image, image)
        elif image is not None:
            self._tell(_time_words(image), "A frame of the other picture, the light being there already")
        layer.update()

    def _tell(self, words: str, more: str) -> None:
        self.told.setText(words)
        self.told.setToolTip(more)

    def _on_difference(self, number: int, found: tuple[QImage, Any, float]) -> None:
        if self.mode != "difference" or number != self._differences.number or self._image() is None:
            return
        self.layer.image, bar, mean = found
        self.layer.bars = (bar,)
        self._tell(
            f"mean ΔE {mean:.1f}", "Mean CIE 1976 colour difference of the two pictures; 2 is just seen"
        )
        self.layer.update()


def _time_words(image: QImage) -> str:
    seconds = float(image.text("seconds") or 0)
    return f"{duration(seconds)} a frame" if seconds else ""


def _button(text: str, tip: str) -> QPushButton:
    button = QPushButton(text)
    button.setCheckable(True)
    button.setToolTip(tip)
    return button
