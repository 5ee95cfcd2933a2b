"""Controls made from the declarations of parameters: what `Param` says once becomes slider, box or menu."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtGui import QWheelEvent
from qtpy.QtWidgets import QCheckBox, QComboBox, QHBoxLayout, QLabel, QToolButton, QWidget

from sfumato.scene import Field, Param, TechniqueParams

from .editing import Editor
from .help_pictures import illustrated, pictures_of
from .icons import icon
from .sliders import LabelledSlider, Range
from .theme import current_theme


class ChoiceBox(QComboBox):
    """A menu that the wheel changes only while it is focused."""

    def __init__(self) -> None:
        super().__init__()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Ignore the wheel unless focused."""
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()


def labelled(label: str, control: QWidget) -> QWidget:
    """Return a row of a label and a control; the controls of several rows stand below each other."""
    row = QWidget()
    layout = QHBoxLayout(row)
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(8)
    words = QLabel(label)
    words.setMinimumWidth(words.fontMetrics().horizontalAdvance("Lamp colour "))
    layout.addWidget(words)
    layout.addWidget(control, 1)
    return row


def tooltip_of(param: Param) -> str:
    """Return meaning, source and range of a parameter as they are shown beside its control."""
    words = param.meaning + (f" ({param.source})" if param.source else "")
    limits = range_of(param)
    return f"{words}. {limits}." if limits else words


def range_of(param: Param) -> str:
    """Return what a number may be, in words and with its unit; nothing for other parameters."""
    bounds = {"from": param.ge, "above": param.gt, "to": param.le, "below": param.lt}
    words = " ".join(f"{word} {bound:g}" for word, bound in bounds.items() if bound is not None)
    unit = {"deg": "°", "": ""}.get(param.unit, f" {param.unit}")
    return words.capitalize() + unit if words else ""


def label_of(field: Field) -> str:
    """Return the name of a field for people."""
    return (field.param.label if field.param else "") or field.name.replace("_", " ").capitalize()


def slider_range(param: Param) -> Range:
    """Return the range of a parameter's slider."""
    if param.soft is not None:
        return param.soft
    low = param.ge if param.ge is not None else param.gt if param.gt is not None else 0.0
    high = param.le if param.le is not None else param.lt if param.lt is not None else low + 1
    return low, high


def slider_for(field: Field, key: str = "") -> LabelledSlider:
    """Return the slider of a numeric field, with the pictures that help has of a key."""
    param = field.param
    assert param is not None
    low, high = slider_range(param)
    whole = field.kind is int
    # About a hundred key steps from end to end, rounded to a decimal power.
    step = (
        100.0
        if high - low >= 5000
        else 1.0
        if whole or high - low >= 50
        else 0.1
        if high - low > 4
        else 0.01
        if high - low <= 1
        else 0.05
    )
    decimals = 0 if whole or (step >= 1 and low == round(low)) else 1 if step >= 1 else 2
    limits = (param.ge if param.ge is not None else low, param.le if param.le is not None else high)
    return LabelledSlider(
        label_of(field), ((low, high),), None if field.default is None else float(field.default),
        unit=param.unit, tip=tooltip_of(param), decimals=decimals, step=step, limits=limits,
        none_label=param.none_label, pictures=pictures_of(key),
    )  # fmt: skip


def bind_slider(slider: LabelledSlider, editor: Editor, path: str, name: str, kind: type = float) -> None:
    """Let a slider edit a path of the scene: a drag is one step of the history, so are quick nudges."""

    def edit(value: float) -> None:
        editor.change(
            f"Change {name}",
            not slider.slider.isSliderDown(),
            **{path: round(value) if kind is int else value},
        )
        slider.set_number(value_at(editor.scene, path))

    slider.edited.connect(edit)
    slider.cleared.connect(lambda: editor.change(f"Change {name}", **{path: None}))
    slider.drag_started.connect(lambda: editor.begin(f"Change {name}"))
    slider.drag_finished.connect(editor.end)


def value_at(scene: Any, path: str) -> Any:
    """Return what lies at a dotted path of the scene."""
    node = scene
    for part in path.split("."):
        node = node[int(part)] if part.isdigit() else getattr(node, part)
    return node


class ParamControl(QWidget):
    """The control of one declared field, bound to a path of the scene."""

    def __init__(self, field: Field, editor: Editor, path: str) -> None:
        super().__init__()
        assert field.param is not None
        self._editor, self._path, self.field = editor, path, field
        self.name = label_of(field)
        owner = editor.scene.technique_id if path.startswith("technique.") else "Scene"
        key = f"{owner}.{field.name}"
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self.control: LabelledSlider | QCheckBox | ChoiceBox
        if field.type is bool:
            self.control = self._check_box()
        elif field.param.choices:
            self.control = self._choice(field.param)
        else:
            self.control = slider_for(field, key)
            bind_slider(self.control, editor, path, self.name.lower(), field.kind)
        self.control.setAccessibleName(self.name)
        if not isinstance(self.control, LabelledSlider):
            self.control.setToolTip(illustrated(tooltip_of(field.param), key))
        choice = isinstance(self.control, ChoiceBox)
        layout.addWidget(labelled(self.name, self.control) if choice else self.control, 1)
        self.reset: QToolButton | None = None
        if not isinstance(self.control, LabelledSlider):
            self.reset = self._reset_button()
            layout.addWidget(self.reset)
        self.show_value()

    def _check_box(self) -> QCheckBox:
        box = QCheckBox(self.name)
        box.toggled.connect(lambda on: self._set(on))
        return box

    def _choice(self, param: Param) -> ChoiceBox:
        box = ChoiceBox()
        for word in param.choices:
            box.addItem(word.replace("-", " ").capitalize(), word)
        box.activated.connect(lambda index: self._set(box.itemData(index)))
        return box

    def _reset_button(self) -> QToolButton:
        button = QToolButton()
        default = self.field.default
        shown = ("on" if default else "off") if self.field.type is bool else str(default).replace("-", " ")
        button.setAccessibleName(f"Reset {self.name}")
        button.setToolTip(f"Back to {shown}")
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        button.setIcon(icon("reset", current_theme()))
        button.clicked.connect(lambda: self._set(default))
        return button

    def _set(self, value: Any) -> None:
        self._editor.change(f"Change {self.name.lower()}", **{self._path: value})

    def show_value(self) -> None:
        """Show the scene's value."""
        value = value_at(self._editor.scene, self._path)
        if isinstance(self.control, LabelledSlider):
            self.control.set_number(value, self._in_effect() if value is None else None)
            return
        assert self.reset is not None
        self.reset.setVisible(value != self.field.default)
        self.control.blockSignals(True)
        if isinstance(self.control, QCheckBox):
            self.control.setChecked(value)
        else:
            self.control.setCurrentIndex(self.control.findData(value))
        self.control.blockSignals(False)

    def _in_effect(self) -> float | None:
        """Return what no value amounts to for the selected lamp."""
        owner = value_at(self._editor.scene, self._path.rpartition(".")[0])
        if not isinstance(owner, TechniqueParams):
            return None
        return owner.in_effect(self.field.name, self._editor.scene, self._editor.light)

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        if isinstance(self.control, LabelledSlider):
            self.control.refresh_theme()
        elif self.reset is not None:
            self.reset.setIcon(icon("reset", current_theme()))


def controls_for(fields: dict[str, Field], level: str, editor: Editor, prefix: str) -> list[ParamControl]:
    """Return the controls of all declared fields of a level that can be shown as one."""
    return [
        ParamControl(field, editor, prefix + name)
        for name, field in fields.items()
        if field.param is not None
        and field.param.level == level
        and (field.kind in (bool, int, float) or field.param.choices)
    ]
