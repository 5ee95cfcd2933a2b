"""The shadow audit's switch and threshold, and what the picture says while it is on."""

from __future__ import annotations

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QCheckBox, QVBoxLayout, QWidget

from sfumato import Scene
from sfumato.audit import THRESHOLD, Audit
from sfumato.techniques import technique_for

from .bindings import explain
from .settings import settings
from .sliders import LabelledSlider

KEPT = "audit/threshold"
TIP = (
    "What has less than this share of the brightness that it would have if nothing were in the way of any lamp is "
    "shown in false colours"
)


class ShadowAudit(QWidget):
    """A switch, and a threshold in percent that is remembered."""

    #: Show the audit with this threshold (0 to 1), or end it (0).
    wanted = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.on = QCheckBox("Shadow audit")
        explain(self.on, "Mark what shadows darken so much that it may escape notice", "audit")
        self.threshold = LabelledSlider(
            "Audit threshold", ((5, 75),), 100 * THRESHOLD, unit="%", tip=TIP, step=1.0, limits=(1, 99)
        )
        self.threshold.set_number(float(str(settings().value(KEPT, 100 * THRESHOLD))))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addWidget(self.on)
        column.addWidget(self.threshold)
        self.on.toggled.connect(lambda _: self._tell())
        self.threshold.edited.connect(self._set_threshold)
        self.threshold.setEnabled(False)

    def _set_threshold(self, percent: float) -> None:
        settings().setValue(KEPT, percent)
        self.threshold.set_number(percent)
        self._tell()

    def _tell(self) -> None:
        self.threshold.setEnabled(self.on.isChecked())
        self.wanted.emit(self.threshold.number.value() / 100 if self.on.isChecked() else 0.0)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        self.threshold.refresh_theme()


def words_of(audit: Audit, scene: Scene) -> str:
    """Return what the picture says of an audit."""
    if not technique_for(scene.technique).shadows:
        return "Shadow audit: this technique casts no shadows"
    share = 100 * audit.share
    told = "nothing" if not share else "less than 0.1 %" if share < 0.1 else f"{share:.1f} %"
    return f"Shadow audit: {told} has less than {100 * audit.threshold:.0f} % of its light"


__all__ = ["ShadowAudit", "words_of"]
