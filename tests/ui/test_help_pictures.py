"""Pictures of less and more in the tooltips: there for what can be seen, and named as the parameters are."""

from __future__ import annotations

from typing import Any

from qtpy.QtGui import QImage

from sfumato.scene import fields_of
from sfumato_app.gallery.help import ends_of, subjects, words
from sfumato_ui.help_pictures import FOLDER, INDEX, SIZE, kept_index, pictures_of
from sfumato_ui.window import MainWindow

#: What a person moves most must have pictures.
MUST = {
    "Light.tilt", "Light.rotation", "Light.aperture", "Light.intensity", "Scene.exposure", "Scene.shadow_floor",
    "Camera.view_angle", "cone.ambient", "extinction.ambient", "local-occlusion.radius",
}  # fmt: skip


def test_each_picture_belongs_to_a_parameter_as_it_is_declared() -> None:
    known = {subject.key: subject for subject in subjects()}
    assert kept_index().keys() >= MUST
    assert kept_index().keys() <= known.keys()
    for key, below in kept_index().items():
        ends = ends_of(known[key])
        assert ends is not None, key
        assert below == [words(known[key].field, end) for end in ends], key
        for k in (0, 1):
            image = QImage(str(FOLDER / f"{key}-{k}.jpg"))
            assert (image.width(), image.height()) == (2 * SIZE[0], 2 * SIZE[1]), key
    drawn = {f"{key}-{k}.jpg" for key in kept_index() for k in (0, 1)} | {INDEX}
    assert {file.name for file in FOLDER.iterdir()} == drawn, "none that is not shown"


def test_tooltips_show_them(window: MainWindow, ball_scene: Any) -> None:
    tip = window.light_page.tilt.slider.toolTip()
    declared = fields_of(type(ball_scene.lights[0]))["tilt"].param
    assert declared is not None
    assert declared.meaning in tip
    assert tip.count("<img") == 2
    assert "65°" in tip
    assert window.view_page.exposure.number.toolTip().count("<img") == 2
    assert pictures_of("cone.resolution") == "", "words have to do"
