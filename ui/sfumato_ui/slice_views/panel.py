"""The three slice views with their bar above and what lies at the cross-hair below."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QEvent, QPoint, Qt, Signal
from qtpy.QtGui import QHideEvent, QResizeEvent, QShowEvent
from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QToolTip, QVBoxLayout

from sfumato import Scene
from sfumato.scene.vectors import vec3
from sfumato.slicing import fitting_scale, value_at

from ..editing import Editor
from ..icons import icon
from ..lamp_places import place_words
from ..settings import settings
from ..theme import current_theme
from .lighter import Lighter
from .pane import KEYS, SlicePane
from .slicer import Slicer
from .state import SliceState
from .values import value_words
from .window_row import WindowRow

LIGHT, LAMPS, ENLARGED = "slices/light", "slices/lamps", "slices/enlarged"
#: Least width in pixels, and with larger letters in lines' heights.
NARROWEST, NARROWEST_LINES = 270, 17
#: Least height of a pane in parts of the highest.
LOWEST = 0.65


class SlicePanel(QFrame):
    """Bar, panes and status; it listens to the editor as long as it lives, and slices while it is seen."""

    close_wanted = Signal()
    #: It came to be seen.
    seen = Signal()

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self.setObjectName("SlicePanel")
        self.setAccessibleName("Slice views")
        self._editor = editor
        self.state, self.slicer, self.lighter = SliceState(self), Slicer(self), Lighter(self)
        self.panes = [SlicePane(editor, self.state, self.slicer, self.lighter, i) for i in range(3)]
        self.window_row = WindowRow(self.state)
        self.light, self.lamps, self.whole, self.shut, self.help = (QToolButton() for _ in range(5))
        self.place, self.value = QLabel(), QLabel()
        self.enlarged: SlicePane | None = None
        self._lay_out()
        self._connect()
        self._restore()
        self.refresh_theme()
        self.state.show(editor.scene)

    # -- building ---------------------------------------------------------------------------------
    def _lay_out(self) -> None:
        head = QHBoxLayout()
        head.setSpacing(4)
        head.addWidget(self.window_row.choice, 1)
        for button in (self.light, self.lamps, self.whole, self.shut):
            button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            head.addWidget(button)
        # Not on the slices themselves: there it would lie over what one looks at.
        _name(self.help, "What mouse and keys do in the slices", KEYS)
        self.help.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        for button in (self.light, self.lamps):
            button.setCheckable(True)
        _name(
            self.light,
            "Light in the slices",
            "Show how much light of the lamps reaches each place of the slices",
        )
        _name(self.lamps, "Lamps in the slices", "Show the lamps in the slices, and take hold of them there")
        _name(self.whole, "Show the whole slices", "Show the whole slices: no zoom, no pan (0)")
        _name(self.shut, "Close the slice views", "Close the slice views")
        self._column = column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        bar = QVBoxLayout()
        bar.setContentsMargins(8, 4, 8, 4)
        bar.setSpacing(4)
        bar.addLayout(head)
        bar.addWidget(self.window_row)
        column.addLayout(bar)
        for pane in self.panes:
            column.addWidget(pane, 1)
        below = QHBoxLayout()
        below.setContentsMargins(8, 3, 8, 4)
        below.addLayout(self._told(), 1)
        below.addWidget(self.help)
        column.addLayout(below)
        # What is told below has no least width of its own, so that it never pushes the picture.
        least = max(NARROWEST, NARROWEST_LINES * self.fontMetrics().height())
        self.setMinimumWidth(max(least, column.minimumSize().width()))

    def _told(self) -> QVBoxLayout:
        """Return the two lines below: where the cross-hair is, and what is there."""
        lines = QVBoxLayout()
        lines.setSpacing(0)
        for label, name in ((self.place, "Place of the cross-hair"), (self.value, "Value at the cross-hair")):
            label.setAccessibleName(name)
            label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            label.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            lines.addWidget(label)
        self.place.setProperty("muted", True)
        return lines

    def _connect(self) -> None:
        self._editor.changed.connect(self._on_changed)
        self.state.replaced.connect(self._share)
        self.state.moved.connect(self._tell)
        self.state.windowed.connect(self._tell)
        self.slicer.windows_found.connect(self.state.offer)
        self.slicer.failed.connect(lambda why: self.value.setText(f"No slice: {why}"))
        self.lighter.failed.connect(lambda why: self.value.setText(f"No light: {why}"))
        self.light.toggled.connect(self._show_light)
        self.lamps.toggled.connect(self._show_lamps)
        self.whole.clicked.connect(self.state.show_whole)
        self.shut.clicked.connect(self.close_wanted)
        self.help.clicked.connect(self._explain)
        for pane in self.panes:
            pane.enlarge_wanted.connect(lambda pane=pane: self.enlarge(None if self.enlarged else pane))

    def _restore(self) -> None:
        kept = settings()
        self.light.setChecked(bool(kept.value(LIGHT, False, type=bool)))
        self.lamps.setChecked(bool(kept.value(LAMPS, True, type=bool)))
        name = str(kept.value(ENLARGED, ""))
        self.enlarge(next((pane for pane in self.panes if pane.cut.id == name), None))

    # -- showing ----------------------------------------------------------------------------------
    def _on_changed(self, old: Scene, new: Scene) -> None:
        if new.volume is not self.state.volume:
            self.slicer.forget()
            self.lighter.forget()
            self.state.show(new)
            self._want_windows()
            self._fit()

    def _want_windows(self) -> None:
        """Ask for the volume's windows, once it is seen."""
        volume = self.state.volume
        if volume is not None and not self.state.windows and self.isVisible():
            self.slicer.want_windows(volume)

    def _fit(self) -> None:
        """Let the whole volume fit into each pane that is seen, at the same scale in all."""
        shown = [pane.room for pane in self.panes if not pane.isHidden()]
        if self.state.volume is not None and self.isVisible():
            self.state.set_fit(fitting_scale(self.state.volume, shown))

    def _share(self) -> None:
        """Give each pane a height that suits what it shows: at the same scale, all get larger by that."""
        volume = self.state.volume
        if volume is None:
            return
        heights = [float(np.ptp(volume.corners() @ np.asarray(pane.cut.up))) for pane in self.panes]
        for pane, height in zip(self.panes, heights, strict=True):
            self._column.setStretchFactor(pane, round(100 * max(LOWEST, height / max(heights))))

    def _tell(self) -> None:
        """Say where the cross-hair is and what lies there."""
        volume, cross = self.state.volume, self.state.cross
        self.whole.setEnabled(volume is not None and not self.state.is_whole)
        self.place.setText(place_words(self._editor.scene, vec3(cross)) if volume is not None else "")
        self.value.setText(
            value_words(volume, self.state.zero, value_at(volume, cross)) if volume is not None else ""
        )
        for label in (self.place, self.value):
            label.setToolTip(label.text())

    def enlarge(self, pane: SlicePane | None) -> None:
        """Give one pane the place of all three, or show all again, and remember it."""
        focused = next((p for p in self.panes if p.hasFocus() or p.enlarge.hasFocus()), None)
        self.enlarged = pane
        for other in self.panes:
            other.setVisible(pane is None or other is pane)
            other.show_enlarged(pane is not None)
            other.scale_bar = other is (pane or self.panes[-1])
        settings().setValue(ENLARGED, pane.cut.id if pane is not None else "")
        if focused is not None:
            focused.setFocus()

    def _show_lamps(self, on: bool) -> None:
        settings().setValue(LAMPS, on)
        for pane in self.panes:
            pane.lamps.shown = on
            pane.update()

    def _show_light(self, on: bool) -> None:
        settings().setValue(LIGHT, on)
        if not on:
            self.lighter.forget()
        for pane in self.panes:
            pane.set_lit(on)

    def _explain(self) -> None:
        """Say what mouse and keys do, for those who do not wait for a tooltip."""
        QToolTip.showText(self.help.mapToGlobal(QPoint(0, 0)), KEYS, self.help)

    def close_threads(self) -> None:
        """Make nothing any more: the window closes."""
        self.slicer.close()
        self.lighter.close()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the slices to another size."""
        super().resizeEvent(event)
        self._fit()

    def event(self, event: QEvent) -> bool:
        """Fit them after the panes have got their places, too."""
        handled = super().event(event)
        if event.type() == QEvent.Type.LayoutRequest:
            self._fit()
        return handled

    def showEvent(self, event: QShowEvent) -> None:
        """Begin to slice."""
        super().showEvent(event)
        self._want_windows()
        self._fit()
        if not event.spontaneous():
            self.seen.emit()

    def hideEvent(self, event: QHideEvent) -> None:
        """Slice nothing that nobody sees."""
        super().hideEvent(event)
        self.slicer.forget()
        self.lighter.forget()
        for pane in self.panes:
            pane.forget()

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        for button, name in (
            (self.light, "light"), (self.lamps, "lamp"), (self.whole, "fit"), (self.shut, "close"), (self.help, "info"),
        ):  # fmt: skip
            button.setIcon(icon(name, current_theme()))
        self.window_row.refresh_theme()


def _name(button: QToolButton, name: str, tip: str) -> None:
    button.setAccessibleName(name)
    button.setToolTip(tip)


__all__ = ["SlicePanel"]
