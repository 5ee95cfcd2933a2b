"""How the selected streamlines are traced: how many, which way, how long, in what steps, when they end."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from qtpy.QtCore import QSignalBlocker, QTimer, Signal
from qtpy.QtWidgets import QVBoxLayout, QWidget

from sfumato import Geometry, Tracing
from sfumato.scene import Seeds, fields_of

from .generated import ChoiceBox, labelled, slider_for
from .sliders import LabelledSlider

#: An edit is traced after so many milliseconds without another.
WAIT_MS = 250
DIRECTIONS = {"both": "Both ways", "forward": "Downstream", "backward": "Upstream"}
_FIELDS = {"count": Seeds, "length": Tracing, "step": Tracing, "min_speed": Tracing}


class TracingControls(QWidget):
    """Edits a `Tracing`; whoever listens traces it."""

    #: Streamlines are to be traced (`Tracing`).
    wanted = Signal(object)
    #: The controls are others.
    rebuilt = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._tracing: Tracing | None = None
        self._longest = 0.0
        self.direction = ChoiceBox()
        self.direction.setAccessibleName("Direction")
        self.direction.setToolTip("Which way streamlines run from their seeds")
        for name, text in DIRECTIONS.items():
            self.direction.addItem(text, name)
        self.sliders: dict[str, LabelledSlider] = {}
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        self._column.addWidget(labelled("Direction", self.direction))
        self.direction.activated.connect(lambda i: self._edit(direction=self.direction.itemData(i)))
        self._wait = QTimer(self)
        self._wait.setSingleShot(True)
        self._wait.setInterval(WAIT_MS)
        self._wait.timeout.connect(self._tell)

    def show_tracing(self, geometry: Geometry | None) -> None:
        """Show how a geometry was traced; nothing if it was not."""
        tracing = geometry.tracing if geometry is not None else None
        self.setVisible(tracing is not None)
        if tracing is None or geometry is None:
            self._wait.stop()
            self._tracing = None
            return
        if self._wait.isActive():  # what the user is changing at this moment stays
            return
        self._tracing = tracing
        size = float(np.linalg.norm(geometry.bounds[1] - geometry.bounds[0]))
        if not self.sliders or not 0.2 < size / self._longest < 5:
            self._rebuild(size)
        with QSignalBlocker(self.direction):
            self.direction.setCurrentIndex(self.direction.findData(tracing.direction))
        for name, slider in self.sliders.items():
            slider.set_number(getattr(tracing.seeds if name == "count" else tracing, name))
        self.sliders["count"].setVisible(tracing.seeds.kind != "points")

    def _rebuild(self, size: float) -> None:
        for slider in self.sliders.values():
            slider.hide()
            slider.deleteLater()
        self._longest = size
        self.sliders = {name: _slider(name, size) for name in _FIELDS}
        for name, slider in self.sliders.items():
            slider.edited.connect(lambda value, name=name: self._on_edited(name, value))
            self._column.addWidget(slider)
        self.rebuilt.emit()

    def _on_edited(self, name: str, value: float) -> None:
        self.sliders[name].set_number(value)
        if name == "count" and self._tracing is not None:
            self._edit(seeds=replace(self._tracing.seeds, count=max(1, round(value))))
        else:
            self._edit(**{name: value})

    def _edit(self, **fields: Any) -> None:
        if self._tracing is not None:
            self._tracing = replace(self._tracing, **fields)
            self._wait.start()

    def _tell(self) -> None:
        if self._tracing is not None:
            self.wanted.emit(self._tracing)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        for slider in self.sliders.values():
            slider.refresh_theme()


def _slider(name: str, size: float) -> LabelledSlider:
    """Return the slider of a field; a length's range suits the size of what is shown."""
    field = fields_of(_FIELDS[name])[name]
    if name != "length":
        return slider_for(field)
    assert field.param is not None
    decimals = 1 if size < 50 else 0
    return LabelledSlider(
        field.param.label, ((0.0, 3 * size),), 0.0, unit="mm", tip=field.param.meaning, decimals=decimals,
        step=size / 100, limits=(0.0, 1e6),
    )  # fmt: skip
