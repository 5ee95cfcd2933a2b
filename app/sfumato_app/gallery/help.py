"""The window's small pictures of less and more: what each parameter does, seen on a sample.

A parameter whose ends cannot be told apart in so small a picture gets none: words have to do.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from sfumato import Camera, Light, Scene, SceneError, render
from sfumato.scene import Field, fields_of
from sfumato.techniques import Technique, techniques
from sfumato_samples import scene as sample_scene
from sfumato_ui.generated import slider_range
from sfumato_ui.help_pictures import FOLDER, INDEX, SIZE, kept_index

from .figures.combined import tubes_in_a_pipe

#: Pictures are drawn so many times larger than they are shown, for dense screens.
DENSE = 2
FRAMES = 6
#: Mean difference of the two pictures in 8-bit steps below which there is nothing to see.
LEAST = 0.8
#: Shares of a slider's range that are shown.
LESS, MORE = 0.08, 0.85
#: Ends that tell more than those shares.
ENDS: dict[str, tuple[Any, Any]] = {
    "Light.tilt": (10.0, 65.0), "Light.rotation": (135.0, 45.0), "Light.aperture": (4.0, 40.0),
    "Light.intensity": (0.4, 1.4), "Scene.exposure": (-1.0, 1.0), "Camera.view_angle": (8.0, 70.0),
    "Scene.white_balance": (4000.0, 9000.0), "Scene.shadow_floor": (0.0, 0.6), "radius": (4.0, 40.0),
    "cone_angle": (3.0, 35.0), "shininess": (4.0, 80.0), "brightness": (0.7, 1.6), "strength": (0.3, 1.6),
    "shell_strength": (0.3, 1.6), "surface_shininess": (4.0, 120.0), "vicinity_distance": (1.0, 12.0),
}  # fmt: skip
#: What has to be there for a parameter to show.
WITH: dict[str, dict[str, Any]] = {
    "shininess": {"technique.specular": 0.6}, "surface_shininess": {"technique.surface_specular": 0.6},
    "bleeding": {"technique.shell_strength": 1.5}, "share": {"technique.mode": "mix", "technique.lamps": "diffuse"},
    "mode": {"technique.lamps": "diffuse"}, "Scene.shadow_floor": {"lights.0.tilt": 65.0},
    "Scene.tone_curve": {"exposure": 1.2},
    "Scene.solid_cuts": {"crop.low": (0.0, 0.45, 0.0), "technique": "raycast-phong"},
}  # fmt: skip
#: Effort and accuracy, which a small picture cannot show.
SILENT = {"resolution", "step", "frames", "samples", "directions", "light_step", "coarsest", "reduction", "ends",
          "joined", "adaptive", "vicinity_samples", "cones", "growth", "offset", "kind"}  # fmt: skip


@dataclass(frozen=True)
class Subject:
    """A parameter, and the scene on which it is shown."""

    key: str
    field: Field
    path: str
    scene: Scene


@cache
def _hand() -> Scene:
    scene = sample_scene("hand")
    assert scene.camera is not None
    return scene.with_(frames=FRAMES, background=(0.078, 0.078, 0.078, 1.0))


def subjects() -> Iterator[Subject]:
    """Yield all parameters that may have pictures."""
    plain = _hand().with_(technique="cone")
    for name, field in fields_of(Light).items():
        yield Subject(f"Light.{name}", field, f"lights.0.{name}", plain)
    for name, field in fields_of(Scene).items():
        yield Subject(f"Scene.{name}", field, name, plain)
    yield Subject("Camera.view_angle", fields_of(Camera)["view_angle"], "", plain)
    for technique in techniques().values():
        for name, field in fields_of(technique.params).items():
            yield Subject(f"{technique.id}.{name}", field, f"technique.{name}", _shown_by(technique))


def _shown_by(technique: Technique) -> Scene:
    if technique.id == "combined":
        return tubes_in_a_pipe().with_(frames=FRAMES, background=_hand().background, technique="combined")
    return _hand().with_(technique=technique.id)


def ends_of(subject: Subject) -> tuple[Any, Any] | None:
    """Return the two values that are shown; None for what is no number, switch or choice."""
    field, name = subject.field, subject.key.split(".")[1]
    param = field.param
    if param is None or name in SILENT:
        return None
    known = ENDS.get(subject.key, ENDS.get(name))
    if known is not None:
        return known
    if field.type is bool:
        return False, True
    if param.choices:
        return param.choices[0], param.choices[1]
    if field.kind not in (int, float) or (param.soft is None and param.ge is None and param.gt is None):
        return None
    low, high = slider_range(param)
    values = [low + share * (high - low) for share in (LESS, MORE)]
    return tuple(round(v) if field.kind is int else round(v, 2) for v in values)  # type: ignore[return-value]


def words(field: Field, value: Any) -> str:
    """Return a value as it is written below its picture."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, str):
        return value.replace("-", " ")
    unit = field.param.unit if field.param else ""
    return f"{value:g}{'°' if unit == 'deg' else f' {unit}' if unit else ''}"


def draw_pair(subject: Subject, ends: tuple[Any, Any]) -> list[np.ndarray] | None:
    """Draw less and more; None if a value cannot be drawn or nothing is to be seen of the difference."""
    name = subject.key.split(".")[1]
    base = subject.scene.with_(WITH.get(subject.key, WITH.get(name, {})))
    size = (SIZE[0] * DENSE, SIZE[1] * DENSE)
    try:
        pair = [render(_with(base, subject, end), size)[..., :3] for end in ends]
    except SceneError:
        return None
    return pair if np.abs(np.diff(np.array(pair, float), axis=0)).mean() >= LEAST else None


def _with(scene: Scene, subject: Subject, value: Any) -> Scene:
    if subject.path:
        return scene.with_({subject.path: value})
    from sfumato_ui.camera_moves import with_lens

    assert scene.camera is not None
    return scene.with_(camera=with_lens(scene.camera, value))


def draw_help(folder: Path = FOLDER, only: str = "") -> Iterator[str]:
    """Draw the pictures of less and more whose key holds a word, and write what stands below them.

    Yields the keys as they are done; what was drawn before and is not asked for stays.
    """
    folder.mkdir(parents=True, exist_ok=True)
    index = {key: text for key, text in kept_index(folder).items() if only not in key}
    for subject in subjects():
        ends = ends_of(subject) if only in subject.key else None
        pair = draw_pair(subject, ends) if ends is not None else None
        if ends is None or pair is None:
            continue
        for number, pixels in enumerate(pair):
            Image.fromarray(pixels).save(folder / f"{subject.key}-{number}.jpg", quality=82)
        index[subject.key] = [words(subject.field, end) for end in ends]
        yield subject.key
        text = json.dumps(dict(sorted(index.items())), indent=1, ensure_ascii=False)
        (folder / INDEX).write_text(text + "\n", encoding="utf-8")


__all__ = ["Subject", "draw_help", "ends_of", "subjects", "words"]
