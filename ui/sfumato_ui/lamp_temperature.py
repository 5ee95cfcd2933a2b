"""The colour of the selected lamp as a temperature."""

from __future__ import annotations

from sfumato import Light
from sfumato.scene.white import WHITE, lamp_color, lamp_temperature

from .editing import Editor
from .sliders import LabelledSlider

LABEL = "Colour the lamp"
#: Range of the slider in K, of the typed number, and what the number's arrows change it by.
RANGE, LIMITS, STEP = (1700.0, 15000.0), (1667.0, 25000.0), 100.0
TIP = (
    "Colour of the lamp as the temperature of a black body: a candle has 1900 K, a bulb 2700 K, daylight 6500 K, blue "
    "sky 10000 K and more"
)


class LampTemperature(LabelledSlider):
    """From warm to cold; a colour that no temperature has is the lamp's own."""

    def __init__(self, editor: Editor) -> None:
        super().__init__(
            "Lamp temperature", (RANGE,), WHITE, unit="K", tip=TIP, step=0.05, limits=LIMITS, log=True,
            none_label="own colour",
        )  # fmt: skip
        self.number.setSingleStep(STEP)
        self._editor = editor
        self.edited.connect(self._set)
        self.drag_started.connect(lambda: editor.begin(LABEL))
        self.drag_finished.connect(editor.end)

    def _set(self, kelvin: float) -> None:
        color = (1.0, 1.0, 1.0) if round(kelvin) == WHITE else lamp_color(kelvin)
        self._editor.change_light(LABEL, not self.slider.isSliderDown(), color=color)
        if not self.slider.isSliderDown() and self._editor.light is not None:
            self.show_light(self._editor.light)

    def show_light(self, light: Light) -> None:
        """Show a lamp's temperature; a hand on the slider is not disturbed."""
        if self.slider.isSliderDown():
            return
        white = light.color[0] == light.color[1] == light.color[2]
        self.set_number(WHITE if white else lamp_temperature(light.color))


__all__ = ["LampTemperature"]
