"""The Geometry section: the tracts and meshes of the scene, and how the selected one is shown."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QSignalBlocker, Qt, Signal
from qtpy.QtWidgets import QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from sfumato import Geometry, Lines, Scene
from sfumato.geometry import kept_lines, known_mesh
from sfumato.scene import fields_of

from .color_button import ColorButton
from .editing import Editor
from .generated import ChoiceBox, bind_slider, labelled, slider_for
from .icons import icon
from .section import Section
from .sliders import LabelledSlider
from .theme import current_theme
from .tracing_controls import TracingControls

#: Colour maps that are even to the eye, and one with a middle for values with a sign.
COLORMAPS = ("viridis", "magma", "plasma", "cividis", "coolwarm", "gray")
COLORINGS = {"color": "One colour", "file": "As in the file", "direction": "Direction", "scalar": "Values"}
#: Sliders of lines: field, and what an edit is called.
LINE_SLIDERS = {"radius": "radius", "min_length": "shortest line", "fraction": "part shown"}


class GeometryControls(Section):
    """One at a time is shown: chosen by its name, it can be hidden, removed, coloured, thinned out."""

    #: Controls came or went.
    rebuilt = Signal()
    #: Streamlines are to be traced in another way (`Tracing`).
    trace_wanted = Signal(object)

    def __init__(self, editor: Editor) -> None:
        super().__init__("Geometry", "geometry")
        self._editor = editor
        self._shown: Geometry | None = None
        self._path = ""
        self.choice, self.coloring, self.scalar, self.colormap = (ChoiceBox() for _ in range(4))
        self.visible = _button("Hide", checkable=True)
        self.remove = _button("Remove")
        self.color = ColorButton("Colour of the geometry")
        self.count = QLabel()
        self.count.setProperty("muted", True)
        self.count.setWordWrap(True)
        self.rows: dict[str, QWidget] = {}
        self.sliders: dict[str, LabelledSlider] = {}
        self.tracing = TracingControls()
        self._lay_out()
        self._connect()
        self.refresh()

    # -- building ---------------------------------------------------------------------------------
    def _lay_out(self) -> None:
        head = QWidget()
        row = QHBoxLayout(head)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(2)
        row.addWidget(self.choice, 1)
        row.addWidget(self.visible)
        row.addWidget(self.remove)
        self.add(head)
        self.add(self.count)
        for name, control, label in (
            ("color_by", self.coloring, "Colour by"),
            ("color", self.color, "Colour"),
            ("scalar", self.scalar, "Values"),
            ("colormap", self.colormap, "Colour map"),
        ):
            control.setAccessibleName(label)
            self.rows[name] = labelled(label, control)
            self.add(self.rows[name])
        self._sliders = QWidget()
        self._column = QVBoxLayout(self._sliders)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        self.add(self._sliders)
        self.add(self.tracing)
        self.choice.setAccessibleName("Geometry")
        self.choice.setToolTip("Tracts and meshes of the scene; drop a file on the picture to add one")
        for name in COLORMAPS:
            self.colormap.addItem(name.capitalize(), name)
        self.refresh_theme()

    def _connect(self) -> None:
        editor = self._editor
        self.choice.activated.connect(lambda index: self.refresh())
        self.visible.clicked.connect(
            lambda: self._set("Show or hide geometry", visible=not self.visible.isChecked())
        )
        self.remove.clicked.connect(self._remove)
        self.coloring.activated.connect(
            lambda i: self._set("Colour geometry", color_by=self.coloring.itemData(i))
        )
        self.scalar.activated.connect(
            lambda i: self._set("Colour geometry", scalar=self.scalar.itemData(i), scalar_range=None)
        )
        self.colormap.activated.connect(
            lambda i: self._set("Change the colour map", colormap=self.colormap.itemData(i))
        )
        self.color.picked.connect(lambda color: self._set("Colour geometry", color=color))
        self.color.opened.connect(lambda: editor.begin("Colour geometry"))
        self.color.closed.connect(editor.end)
        self.tracing.wanted.connect(self.trace_wanted)
        self.tracing.rebuilt.connect(self.rebuilt)
        editor.changed.connect(self._on_changed)

    def _on_changed(self, old: Scene, new: Scene) -> None:
        if old.geometry is not new.geometry:
            if len(new.geometry) > len(old.geometry):
                self._list(new)
                self.choice.setCurrentIndex(len(new.geometry) - 1)
                self.set_open(True)
            self.refresh()

    # -- edits ------------------------------------------------------------------------------------
    @property
    def selected(self) -> int:
        """Index of the geometry whose controls are shown."""
        return max(0, min(self.choice.currentIndex(), len(self._editor.scene.geometry) - 1))

    @property
    def geometry_shown(self) -> Geometry | None:
        """The geometry whose controls are shown."""
        geometry = self._editor.scene.geometry
        return geometry[self.selected] if geometry else None

    def _set(self, label: str, **fields: Any) -> None:
        self._editor.change(
            label, **{f"geometry.{self.selected}.{name}": value for name, value in fields.items()}
        )
        self.refresh()

    def _remove(self) -> None:
        geometry, index = self._editor.scene.geometry, self.selected
        self._editor.change("Remove geometry", geometry=geometry[:index] + geometry[index + 1 :])
        self.refresh()

    # -- showing ----------------------------------------------------------------------------------
    def refresh(self) -> None:
        """Show the scene's geometry; the section is there only if there is any."""
        scene = self._editor.scene
        self._list(scene)
        self.setVisible(bool(scene.geometry))
        geometry = self.geometry_shown
        self.tracing.show_tracing(geometry)
        if geometry is None:
            self._shown = None
            return
        if self._shown is None or self._shown.shape is not geometry.shape or self._path != self._prefix:
            self._rebuild(geometry)
        self._shown = geometry
        self._show_colors(geometry)
        for name, slider in self.sliders.items():
            slider.set_number(getattr(geometry, name))
        self.visible.setChecked(not geometry.visible)
        self.visible.setAccessibleName("Hide" if geometry.visible else "Show")
        self.visible.setToolTip("Hide it; it casts no shadow then" if geometry.visible else "Show it again")
        self.remove.setToolTip(f"Remove {geometry.name or geometry.kind} from the scene")
        self.show_count()
        self.refresh_theme()

    def show_count(self) -> None:
        """Say how much of the selected geometry is shown."""
        if self.geometry_shown is not None:
            self.count.setText(_count_text(self.geometry_shown))

    @property
    def _prefix(self) -> str:
        return f"geometry.{self.selected}."

    def _list(self, scene: Scene) -> None:
        names = [g.name or g.kind.capitalize() for g in scene.geometry]
        if names == [self.choice.itemText(i) for i in range(self.choice.count())]:
            return
        with QSignalBlocker(self.choice):
            index = self.selected
            self.choice.clear()
            self.choice.addItems(names)
            self.choice.setCurrentIndex(min(index, len(names) - 1))

    def _rebuild(self, geometry: Geometry) -> None:
        """Fill the menus with what this geometry offers, and make the sliders that suit its size."""
        self._path = self._prefix
        known = [c for c in COLORINGS if _offers(geometry, c)]
        for box, items in (
            (self.coloring, {COLORINGS[c]: c for c in known}),
            (self.scalar, {name: name for name in geometry.scalar_names}),
        ):
            with QSignalBlocker(box):
                box.clear()
                for text, data in items.items():
                    box.addItem(text, data)
        for slider in self.sliders.values():
            self._column.removeWidget(slider)
            slider.hide()
            slider.deleteLater()
        self.sliders = {
            name: self._slider(name, geometry) for name in LINE_SLIDERS if isinstance(geometry.shape, Lines)
        }
        self._sliders.setVisible(bool(self.sliders))
        self.rebuilt.emit()

    def _slider(self, name: str, geometry: Geometry) -> LabelledSlider:
        slider = _sized_slider(name, geometry)
        bind_slider(slider, self._editor, self._prefix + name, LINE_SLIDERS[name])
        self._column.addWidget(slider)
        return slider

    def _show_colors(self, geometry: Geometry) -> None:
        for box, value in (
            (self.coloring, geometry.color_by),
            (self.scalar, geometry.scalar or (geometry.scalar_names or ("",))[0]),
            (self.colormap, geometry.colormap),
        ):
            with QSignalBlocker(box):
                box.setCurrentIndex(box.findData(value))
        self.color.set_color(geometry.color)
        self.rows["color_by"].setVisible(self.coloring.count() > 1)
        self.rows["color"].setVisible(geometry.color_by == "color")
        for name in ("scalar", "colormap"):
            self.rows[name].setVisible(geometry.color_by == "scalar")

    def refresh_theme(self) -> None:
        """Take the theme's icon colours."""
        theme = current_theme()
        self.tracing.refresh_theme()
        self.visible.setIcon(icon("mute" if self.visible.isChecked() else "shown", theme))
        self.remove.setIcon(icon("remove", theme))


def _offers(geometry: Geometry, coloring: str) -> bool:
    if coloring == "scalar":
        return bool(geometry.scalar_names)
    if coloring == "file":
        return getattr(geometry.shape, "colors", None) is not None
    return True


def _sized_slider(name: str, geometry: Geometry) -> LabelledSlider:
    """Return the slider of a field of lines, with a range that suits how large they are."""
    field = fields_of(Geometry)[name]
    param = field.param
    assert param is not None
    assert isinstance(geometry.shape, Lines)
    if name == "fraction":
        return slider_for(field)
    if name == "radius":
        from sfumato.scene.geometry import suggest_radius

        usual = suggest_radius(geometry.shape)
        pieces, limits, default, log = ((usual / 8, usual * 8),), (usual / 1000, 1000.0), usual, True
        decimals = 3 if usual < 0.5 else 2
        step = 0.1
    else:
        longest = float(geometry.shape.lengths.max())
        pieces, limits, default, log = ((0.0, longest),), (0.0, 1e6), 0.0, False
        decimals = 1 if longest < 50 else 0
        step = longest / 100
    return LabelledSlider(
        param.label, pieces, default, unit=param.unit, tip=param.meaning, decimals=decimals, step=step,
        limits=limits, log=log,
    )  # fmt: skip


def _count_text(geometry: Geometry) -> str:
    """Say how much of it is shown."""
    if not isinstance(geometry.shape, Lines):
        return f"{_spaced(geometry.shape.count)} triangles"
    shown, count = int(kept_lines(geometry).sum()), geometry.shape.count
    text = f"{_spaced(count)} lines" if shown == count else f"{_spaced(shown)} of {_spaced(count)} lines"
    mesh = known_mesh(geometry)
    return text if mesh is None or mesh.shown >= shown else f"{text}; {_spaced(mesh.shown)} drawn"


def _spaced(number: int) -> str:
    return f"{number:,}".replace(",", " ")


def _button(name: str, checkable: bool = False) -> QToolButton:
    button = QToolButton()
    button.setCheckable(checkable)
    button.setAccessibleName(name)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button
