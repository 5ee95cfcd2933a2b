"""What the Light tab shows of a lamp that stands somewhere: its place, its beam or size, its radius; then the rest."""

from __future__ import annotations

from typing import Any

from qtpy.QtWidgets import QLabel, QVBoxLayout, QWidget

from sfumato import Light, Scene
from sfumato.scene import fields_of
from sfumato.scene.light import FARTHEST

from .dial import MOVE, SOFTEN
from .editing import Editor
from .generated import tooltip_of
from .help_pictures import pictures_of
from .lamp_places import axis_names, diagonal_of
from .sliders import LabelledSlider
from .vector_row import VectorRow

AIM, SHAPE = "Aim the lamp", "Change the lamp's shape"
#: Ranges of the sliders in parts of the visible box's diagonal.
RADII, REACHES = (0.002, 0.5), (0.02, 5.0)
#: Largest length in mm that can be typed.
LONGEST = 99999.0


class LampPlace(QWidget):
    """Its place in mm along the patient's axes."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self.place = VectorRow(
            "Place of the lamp", 3, unit="mm", limits=(-FARTHEST, FARTHEST),
            tip="Where the lamp stands, in the patient's millimetres (LPS)",
        )  # fmt: skip
        _column(self, self.place)
        self.place.edited.connect(lambda place: _set(editor, MOVE, self.place, "position", place))

    def show_light(self, light: Light) -> None:
        """Show a lamp's place."""
        self.place.set_names(axis_names(self._editor.scene))
        self.place.set_values(light.position)


class LampForm(QWidget):
    """What it is beside a place: a spot's beam, a rectangle's sides, a tube's length."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self.beam = light_slider(editor, "spread", "Change the beam", decimals=1)
        self.sides = VectorRow(
            "Size of the lamp", 2, unit="mm", limits=(0.01, LONGEST), tip="Width and height of the lamp"
        )
        self.sides.set_names((("Width", "width"), ("Height", "height")))
        self.length = VectorRow(
            "Size of the tube", 1, unit="mm", limits=(0.01, LONGEST), tip="Length of the tube"
        )
        self.length.set_names((("Length", "length"),))
        _column(self, self.beam, self.sides, self.length)
        self.sides.edited.connect(lambda size: _set(editor, SHAPE, self.sides, "size", size))
        self.length.edited.connect(
            lambda size: (
                _set(editor, SHAPE, self.length, "size", (size[0], editor.light.size[1]))
                if editor.light is not None
                else None
            )
        )

    def show_light(self, light: Light) -> None:
        """Show what the lamp has of it; nothing of a ball."""
        rectangle, tube = (light.kind == "area" and light.shape == s for s in ("rectangle", "tube"))
        self.beam.setVisible(light.kind == "spot")
        self.sides.setVisible(rectangle)
        self.length.setVisible(tube)
        self.setVisible(light.kind == "spot" or rectangle or tube)
        self.beam.set_number(light.spread)
        self.sides.set_values(light.size)
        self.length.set_values(light.size[:1])


class LampMore(QWidget):
    """What is seldom needed: where it shines to, how it lies, how its beam and its light fade."""

    def __init__(self, editor: Editor) -> None:
        super().__init__()
        self._editor = editor
        self.aim = VectorRow("Direction of the lamp", 3, limits=(-1.0, 1.0), decimals=2, step=0.05,
                             tip="Which way the lamp shines; only the direction counts")  # fmt: skip
        self.axis = VectorRow("Axis of the lamp", 3, limits=(-1.0, 1.0), decimals=2, step=0.05,
                              tip="Which way the tube, or the rectangle's width, lies")  # fmt: skip
        self.aim_words, self.axis_words = QLabel("Shines towards"), QLabel("Lies along")
        self.edge = light_slider(editor, "edge", "Change the beam's edge", decimals=1)
        self.reach = light_slider(editor, "reach", "Change the reach", decimals=1, log=True)
        _column(self, self.aim_words, self.aim, self.axis_words, self.axis, self.edge, self.reach)
        self.aim.edited.connect(lambda way: _set(editor, AIM, self.aim, "direction", way))
        self.axis.edited.connect(lambda way: _set(editor, AIM, self.axis, "axis", way))

    def show_light(self, light: Light, shown: bool) -> None:
        """Show what the lamp has of it."""
        self.setVisible(shown)
        size = diagonal_of(self._editor.scene)
        lies = light.kind == "area" and light.shape != "sphere"
        for row, words, visible, way in (
            (self.aim, self.aim_words, light.needs_direction, light.direction),
            (self.axis, self.axis_words, lies, light.axis),
        ):
            row.setVisible(visible)
            words.setVisible(visible)
            row.set_names(axis_names(self._editor.scene))
            # Typed directions need not be of length 1, and stay as they are.
            longest = max(1.0, *(abs(v) for v in way))
            row.set_values(tuple(v / longest for v in way))
        self.edge.setVisible(light.kind == "spot")
        self.edge.set_number(light.edge)
        self.reach.slider.set_pieces((_scaled(REACHES, size),))
        self.reach.set_number(light.reach)


def radius_slider(editor: Editor) -> LabelledSlider:
    """Return the slider of a lamp's radius; its range goes with the subject."""
    return light_slider(editor, "radius", SOFTEN, decimals=2, log=True)


def show_radius(slider: LabelledSlider, scene: Scene, light: Light) -> None:
    """Show a lamp's radius."""
    slider.slider.set_pieces((_scaled(RADII, diagonal_of(scene)),))
    slider.set_number(light.radius)


def light_slider(
    editor: Editor, field: str, label: str, *, decimals: int, log: bool = False
) -> LabelledSlider:
    """Return a slider that edits a number of the selected lamp; a drag is one step of the history."""
    declared = fields_of(Light)[field]
    param = declared.param
    assert param is not None
    assert param.soft is not None
    low, high = (param.ge if param.ge is not None else 10.0**-decimals), param.le if param.le else param.lt
    assert high is not None
    slider = LabelledSlider(
        param.label, (param.soft,), declared.default, unit=param.unit, tip=tooltip_of(param), decimals=decimals,
        step=0.05 if log else 1.0, limits=(low, min(high, LONGEST)), log=log, none_label=param.none_label,
        pictures=pictures_of(f"Light.{field}"),
    )  # fmt: skip

    def edit(value: float | None) -> None:
        editor.change_light(label, not slider.slider.isSliderDown(), **{field: value})
        if editor.light is not None:
            slider.set_number(getattr(editor.light, field))

    slider.edited.connect(edit)
    slider.cleared.connect(lambda: edit(None))
    slider.drag_started.connect(lambda: editor.begin(label))
    slider.drag_finished.connect(editor.end)
    return slider


def _set(editor: Editor, label: str, row: VectorRow, field: str, value: Any) -> None:
    """Change a field of the selected lamp by typed numbers; if it is refused, show what it was."""
    light = editor.light
    if light is not None and not editor.change_light(label, True, **{field: value}):
        old = getattr(light, field)
        row.set_values(old[: len(row.numbers)])


def _scaled(parts: tuple[float, float], size: float) -> tuple[float, float]:
    return parts[0] * size, parts[1] * size


def _column(widget: QWidget, *rows: QWidget) -> None:
    column = QVBoxLayout(widget)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(4)
    for row in rows:
        column.addWidget(row)
