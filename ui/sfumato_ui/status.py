"""The line below the picture: what is shown, how fast, by what, and how far the refinement is."""

from __future__ import annotations

import time

from qtpy.QtCore import QSize, Qt
from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QProgressBar, QSizePolicy, QToolButton

from sfumato import Volume

from .jobs import Picture

#: Least time between two steps of the bar, in seconds.
PROGRESS_SECONDS = 0.1


def set_quietly(bar: QProgressBar, value: int) -> None:
    """Set a bar's value and let it be painted with all else: by itself Qt paints, and composes the window, at once."""
    bar.setUpdatesEnabled(False)
    bar.setValue(value)
    bar.setUpdatesEnabled(True)


class StatusLine(QFrame):
    """One line of small facts."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("StatusLine")
        self.data = QLabel()
        self.state = QLabel()
        self.renderer = QLabel()
        self.renderer.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.renderer.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.bar = QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setTextVisible(False)
        self.bar.setFixedWidth(90)
        self.bar.setAccessibleName("Refinement of the picture")
        keep = self.bar.sizePolicy()
        keep.setRetainSizeWhenHidden(True)
        self.bar.setSizePolicy(keep)
        self._row = row = QHBoxLayout(self)
        row.setContentsMargins(8, 1, 14, 1)
        row.setSpacing(18)
        row.addWidget(self.data)
        row.addWidget(self.state)
        row.addWidget(self.bar)
        row.addWidget(self.renderer, 1)
        self.bar.hide()
        self._buttons = 0
        self._told = 0.0

    def add_button(self, button: QToolButton) -> None:
        """Put a button at the line's beginning, behind those that are there."""
        button.setIconSize(QSize(16, 16))
        self._row.insertWidget(self._buttons, button)
        self._buttons += 1

    def show_volume(self, volume: Volume | None) -> None:
        """Say what is open."""
        if volume is None:
            self.data.setText("Nothing open")
            return
        x, y, z = volume.dims
        spacing = " × ".join(f"{s:.3g}" for s in volume.spacing)
        self.data.setText(f"{x} × {y} × {z}")
        self.data.setToolTip(f"{volume.data.dtype}, spacing {spacing} mm")

    def show_picture(self, picture: Picture) -> None:
        """Say how the newest picture came about."""
        width, height = picture.image.width(), picture.image.height()
        kind = "moving" if picture.interactive else f"frame {picture.frames} of {picture.wanted}"
        if picture.light < 1:
            kind = f"light {100 * picture.light:.0f} %"
        self.state.setText(f"{_duration(picture.seconds)}   {width} × {height}   {kind}")
        self._row.activate()  # at once: the next paint would cut the longer text off
        if picture.settled:
            self.bar.hide()

    def show_progress(self, fraction: float) -> None:
        """Show how far the refinement is (0 to 1)."""
        now = time.monotonic()
        if fraction < 1 and self.bar.isVisible() and now - self._told < PROGRESS_SECONDS:
            return
        self._told = now
        set_quietly(self.bar, round(1000 * fraction))
        self.bar.setVisible(fraction < 1)

    def show_renderer(self, name: str) -> None:
        """Name the graphics device; the whole name in the tooltip."""
        self.renderer.setText(name.split(" (")[0])
        self.renderer.setToolTip(name)


def _duration(seconds: float) -> str:
    return f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"
