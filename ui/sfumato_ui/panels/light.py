"""The Light tab: lamps, dial, tilt, rotation, softness, rigs, technique and what belongs to it."""

from __future__ import annotations

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from sfumato import Light, Scene
from sfumato.scene import fields_of, nearest_possible_tilt
from sfumato.scene.light import shining
from sfumato.techniques import techniques

from .. import light_moves
from ..auto_exposure import AutoExposure
from ..dial import MOVE, SOFTEN, LightDial
from ..editing import Editor
from ..generated import ChoiceBox, ParamControl, bind_slider, controls_for, labelled, slider_for, tooltip_of
from ..help_pictures import pictures_of
from ..lamp_place import LampForm, LampMore, LampPlace, radius_slider, show_radius
from ..lamp_temperature import LampTemperature
from ..lamp_tools import LampTools
from ..lamps import LampRow
from ..own_rigs_row import OwnRigsRow
from ..rigs_row import RigButton, RigsRow
from ..section import Section
from ..shadow_audit import ShadowAudit
from ..shadow_floor import no_floor
from ..sliders import LabelledSlider
from ..thumbnails import Thumbnails
from .page import Page


class LightPage(Page):
    """Everything that lights the picture."""

    #: The technique's controls were made anew.
    rebuilt = Signal()

    def __init__(self, editor: Editor, thumbnails: Thumbnails, auto: AutoExposure) -> None:
        super().__init__()
        self._editor = editor
        self.lamps = LampRow(editor)
        self.dial = LightDial(editor)
        self.tools = LampTools(editor)
        self.tilt = self._slider("tilt", "Tilt", ((0, 69), (111, 180)))
        self.rotation = self._slider("rotation", "Rotation", ((0, 360),))
        self.aperture = self._slider(
            "aperture", "Softness (aperture)", ((light_moves.MIN_APERTURE, light_moves.MAX_APERTURE),)
        )
        self.place, self.form, self.lamp_more = LampPlace(editor), LampForm(editor), LampMore(editor)
        self.radius = radius_slider(editor)
        self.rigs = RigsRow(editor, thumbnails, auto)
        self.more_rigs = RigsRow(editor, thumbnails, auto, "more rigs")
        self.own_rigs = OwnRigsRow(editor, thumbnails, auto)
        self.temperature = LampTemperature(editor)
        self.technique = self._technique_menu()
        self.own = Section("", "technique")
        self.more = Section("More", "light_more")
        self.note = QLabel()
        self.note.setProperty("muted", True)
        self.note.setWordWrap(True)
        self.attached = self._attached_menu()
        self.floor = slider_for(fields_of(Scene)["shadow_floor"], "Scene.shadow_floor")
        bind_slider(self.floor, editor, "shadow_floor", "the shadow floor")
        self.audit = ShadowAudit()
        # All that a first look needs fits into a window of 1280 x 720.
        self.column.setSpacing(4)
        self.controls: list[ParamControl] = []
        self._technique_type: object = None
        for widget in (
            self.lamps,
            self._dial_and_tools(),
            # A lamp with a place has that instead of angles: the dial turns it about the subject.
            _either(self.tilt, self.place),
            _either(self.rotation, self.form),
            _either(self.aperture, self.radius),
            self.rigs,
            self._technique_row(),
            self.note,
        ):
            self.add(widget)
        self.add(self.own)
        self.add(self.more)
        self.finish()
        self._connect()
        self.refresh()

    @property
    def rig_buttons(self) -> dict[str, RigButton]:
        """The buttons of all rigs by their ids."""
        return {**self.rigs.buttons, **self.more_rigs.buttons}

    # -- building ---------------------------------------------------------------------------------
    def _dial_and_tools(self) -> QWidget:
        row = QWidget()
        layout = QHBoxLayout(row)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        layout.addWidget(self.dial, 1)
        layout.addWidget(self.tools)
        return row

    def _slider(self, field: str, label: str, pieces: tuple[tuple[float, float], ...]) -> LabelledSlider:
        declared = fields_of(Light)[field]
        assert declared.param is not None
        return LabelledSlider(
            label, pieces, float(declared.default), unit=declared.param.unit, tip=tooltip_of(declared.param),
            decimals=1, step=1.0, pictures=pictures_of(f"Light.{field}"),
        )  # fmt: skip

    def _technique_menu(self) -> ChoiceBox:
        box = ChoiceBox()
        box.setAccessibleName("Technique")
        for i, technique in enumerate(techniques().values()):
            box.addItem(technique.title, technique.id)
            box.setItemData(i, technique.summary, Qt.ItemDataRole.ToolTipRole)
        return box

    def _technique_row(self) -> QWidget:
        """Return the menu below its label: the longest title needs the panel's width."""
        row = QWidget()
        column = QVBoxLayout(row)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addWidget(QLabel("Technique"))
        column.addWidget(self.technique)
        return row

    def _attached_menu(self) -> ChoiceBox:
        param = fields_of(Light)["attached"].param
        assert param is not None
        box = ChoiceBox()
        box.setAccessibleName("What the lamp moves with")
        box.setToolTip(
            "<p>Viewer: the lamp turns with the camera.</p><p>Patient: it stays where it is when the camera "
            "moves; tilt and rotation refer to the front view.</p><p>A lamp with a place always stays there.</p>"
        )
        for word in param.choices:
            box.addItem(word.capitalize(), word)
        return box

    def _connect(self) -> None:
        editor = self._editor
        self.tilt.edited.connect(self._set_tilt)
        self.rotation.edited.connect(lambda v: self._set(self.rotation, MOVE, "rotation", v))
        self.aperture.edited.connect(self._set_aperture)
        for slider, label in (
            (self.tilt, MOVE),
            (self.rotation, MOVE),
            (self.aperture, SOFTEN),
        ):
            slider.drag_started.connect(lambda label=label: editor.begin(label))
            slider.drag_finished.connect(editor.end)
        self.technique.activated.connect(self._choose_technique)
        self.attached.activated.connect(
            lambda i: editor.change_light("Attach the lamp", attached=self.attached.itemData(i))
        )
        editor.changed.connect(self._on_changed)
        editor.light_selected.connect(self._show_light)

    # -- edits ------------------------------------------------------------------------------------
    def _set(self, slider: LabelledSlider, label: str, field: str, value: float) -> None:
        self._editor.change_light(label, not slider.slider.isSliderDown(), **{field: value})
        self._show_light()

    def _set_tilt(self, value: float) -> None:
        light = self._editor.light
        if light is not None:
            self._set(self.tilt, MOVE, "tilt", nearest_possible_tilt(value, light.aperture))

    def _set_aperture(self, value: float) -> None:
        light = self._editor.light
        if light is not None:
            self._set(self.aperture, SOFTEN, "aperture", min(value, light_moves.largest_aperture(light.tilt)))

    def _choose_technique(self, index: int) -> None:
        wanted = self.technique.itemData(index)
        if wanted != self._editor.scene.technique_id:
            self._editor.change("Choose the technique", technique=wanted)
            self.own.set_open(self.own.isVisibleTo(self))

    # -- showing ----------------------------------------------------------------------------------
    def refresh(self) -> None:
        """Show everything anew."""
        self._show_light()
        self._show_technique(self._editor.scene)

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.lights != new.lights:
            self._show_light()
            self._show_note(new)
        if old.technique != new.technique:
            self._show_technique(new)
        elif (old.volume is None) != (new.volume is None):
            self._show_note(new)
        if old.shadow_floor != new.shadow_floor:
            self._show_floor(new)

    def _show_light(self) -> None:
        light = self._editor.light
        for widget in (self.tilt, self.rotation, self.aperture, self.attached, self.temperature):
            widget.setEnabled(light is not None)
        if light is None:
            return
        self._show_place(light)
        self.temperature.show_light(light)
        self.tilt.slider.set_pieces(light_moves.tilt_ranges(light.aperture))
        self.tilt.set_number(light.tilt)
        self.rotation.set_number(light.rotation if light.rotation == 360 else light.rotation % 360)
        self.aperture.set_number(light.aperture)
        self.attached.setCurrentIndex(self.attached.findData("patient" if light.placed else light.attached))

    def _show_place(self, light: Light) -> None:
        """Show what a lamp that stands somewhere has instead of angles."""
        scene = self._editor.scene
        known = light.kind in techniques()[scene.technique_id].kinds
        flat = light.kind == "area" and light.shape == "rectangle"
        for widget, shown in (
            (self.tilt, not light.placed),
            (self.rotation, not light.placed),
            # Where it is taken for parallel light, its shadows are as soft as its aperture says.
            (self.aperture, not light.placed or not known),
            (self.place, light.placed),
            (self.radius, light.placed and known and not flat),
        ):
            widget.setVisible(shown)
        self.place.show_light(light)
        self.form.show_light(light)
        show_radius(self.radius, scene, light)
        self.lamp_more.show_light(light, light.placed)
        self.attached.setEnabled(not light.placed)

    def _show_technique(self, scene: Scene) -> None:
        technique = techniques()[scene.technique_id]
        self.technique.setCurrentIndex(self.technique.findData(technique.id))
        self.technique.setToolTip(technique.summary)
        if self._technique_type is not type(scene.technique):
            self._technique_type = type(scene.technique)
            self._rebuild(technique.title)
            self._show_light()
        for control in self.controls:
            control.show_value()
        self._show_floor(scene)
        self._show_note(scene)

    def _show_floor(self, scene: Scene) -> None:
        """Show the least light that shadows leave, or why the technique has no such thing."""
        reason = no_floor(scene)
        param = fields_of(Scene)["shadow_floor"].param
        assert param is not None
        self.floor.setEnabled(not reason)
        self.floor.setToolTip(reason or tooltip_of(param))
        self.floor.set_number(scene.shadow_floor)

    def _show_note(self, scene: Scene) -> None:
        """Say what the technique leaves out of the lamps."""
        technique = techniques()[scene.technique_id]
        lamps = shining(scene.lights)
        text = ""
        if not technique.lit:
            text = "This technique draws without light."
        elif len(lamps) > technique.max_lights:
            first = "the first that shines" if technique.max_lights == 1 else "the first that shine"
            text = f"This technique uses {technique.max_lights} of {len(lamps)} lamps: {first}."
        elif any(lamp.kind not in technique.kinds for lamp in lamps):
            text = "This technique takes lamps with a place for parallel light from there."
        self.note.setText(text)
        self.note.setVisible(bool(text))
        for row in (self.rigs, self.more_rigs, self.own_rigs):
            if scene.volume is None:
                row.set_reason("Open a volume to see the rigs on it.")
            else:
                row.set_reason("" if technique.lit else text)

    def _rebuild(self, title: str) -> None:
        """Make the technique's own controls: its essentials in its section, the rest under More."""
        fields = fields_of(type(self._editor.scene.technique))
        essential = controls_for(fields, "essential", self._editor, "technique.")
        rest = controls_for(fields, "more", self._editor, "technique.")
        self.attached.setParent(self)
        self.lamp_more.setParent(self)
        self.temperature.setParent(self)
        self.floor.setParent(self)
        self.audit.setParent(self)
        self.more_rigs.setParent(self)
        self.own_rigs.setParent(self)
        self.own.clear()
        self.more.clear()
        self.own.set_title(title)
        self.own.setVisible(bool(essential))
        for control in essential:
            self.own.add(control)
        self.more.add(self.more_rigs)
        self.more.add(self.own_rigs)
        self.more.add(self.temperature)
        self.more.add(self.lamp_more)
        self.more.add(labelled("Lamp fixed to", self.attached))
        for control in rest:
            self.more.add(control)
        self.more.add(self.floor)
        self.more.add(self.audit)
        self.controls = essential + rest
        self.rebuilt.emit()


def _either(*widgets: QWidget) -> QWidget:
    """Return one place of the column for widgets of which some are shown."""
    place = QWidget()
    column = QVBoxLayout(place)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(4)
    for widget in widgets:
        column.addWidget(widget)
    return place
