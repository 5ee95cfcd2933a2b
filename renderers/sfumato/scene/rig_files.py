"""Rigs as files: lamps that fit a volume of any size, to be kept and shared.

Lamps with a place are kept in diagonals of the volume from its middle, along world axes; so are their sizes and reach.
Parallel lamps, which have no place, stay as they are. The file is JSON:
``{"sfumato-rig": 1, "name": …, "lights": […]}``.
"""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LoadError, SceneError
from ..export.atomic import replacing
from .light import FARTHEST, Light
from .params import from_json, to_json
from .rigs import Rig
from .scene import MAX_LIGHTS
from .vectors import vec3
from .volume import Volume

#: Version of the files; a reader refuses newer ones.
VERSION = 1
SUFFIX = ".sfumato-rig"
#: Sixteen lamps have some ten thousand bytes; what is larger than this is something else.
_MAX_BYTES = 1 << 20


def fitted(lights: tuple[Light, ...], volume: Volume) -> tuple[Light, ...]:
    """Return a rig's lamps, as they are kept, in the world of a volume."""
    center, size = _frame(volume)
    return tuple(_moved(light, size, center, np.zeros(3)) for light in lights)


def normalised(lights: tuple[Light, ...], volume: Volume) -> tuple[Light, ...]:
    """Return lamps in the world of a volume as they are kept: in its diagonals, from its middle."""
    center, size = _frame(volume)
    return tuple(_moved(light, 1 / size, np.zeros(3), center) for light in lights)


def _frame(volume: Volume) -> tuple[np.ndarray, float]:
    corners = volume.corners()
    return np.asarray(volume.center, dtype=float), float(np.linalg.norm(np.ptp(corners, axis=0)))


def _moved(light: Light, scale: float, to: np.ndarray, start: np.ndarray) -> Light:
    """Return a lamp scaled about one point, which goes to another; solo lamps are the window's affair."""
    if not light.placed:
        return replace(light, solo=False)
    place = np.clip(to + scale * (np.asarray(light.position) - start), -FARTHEST, FARTHEST)
    width, height = light.size
    return replace(
        light, solo=False, position=vec3(place), radius=light.radius * scale,
        size=(width * scale, height * scale), reach=None if light.reach is None else light.reach * scale,
    )  # fmt: skip


def rig_to_json(rig: Rig) -> dict[str, Any]:
    """Return a rig of one's own as JSON data."""
    return {"sfumato-rig": VERSION, "name": rig.title, "lights": [to_json(light) for light in rig.lights]}


def rig_from_json(data: Any) -> Rig:
    """Build a rig from JSON data.

    Raises
    ------
    SceneError
        If it is none, a field is unknown or a value is not allowed.
    """
    if not isinstance(data, dict) or not isinstance(data.get("sfumato-rig"), int):
        raise SceneError("sfumato-rig", type(data).__name__, "a rig's file begins with its version")
    if not 1 <= data["sfumato-rig"] <= VERSION:
        raise SceneError("sfumato-rig", data["sfumato-rig"], f"this program reads version 1 to {VERSION}")
    name, lights = data.get("name", ""), data.get("lights")
    if not isinstance(name, str):
        raise SceneError("name", name, "a text is needed here")
    if not isinstance(lights, list) or not 1 <= len(lights) <= MAX_LIGHTS:
        raise SceneError("lights", type(lights).__name__, f"a list of 1 to {MAX_LIGHTS} lamps is needed here")
    lamps = tuple(from_json(Light, light, f"lights.{i}") for i, light in enumerate(lights))
    return Rig(name, name, f"Own rig {name}", lamps)


def save_rig(path: str | os.PathLike[str], name: str, lights: tuple[Light, ...], volume: Volume) -> None:
    """Write lamps in the world of a volume as a rig's file, atomically.

    Raises
    ------
    SfumatoError
        If the file cannot be written.
    """
    write_rig(path, Rig(name, name, "", normalised(lights, volume)))


def write_rig(path: str | os.PathLike[str], rig: Rig) -> None:
    """Write a rig as it is kept to a file, atomically; errors as in `save_rig`."""
    with replacing(path) as part:
        part.write_text(json.dumps(rig_to_json(rig), indent=1) + "\n", encoding="utf-8")


def load_rig(path: str | os.PathLike[str]) -> Rig:
    """Read a rig's file; `fitted` puts its lamps into the world of a volume.

    Raises
    ------
    LoadError
        If the file cannot be read or is no rig.
    """
    source = Path(path)
    try:
        if source.stat().st_size > _MAX_BYTES:
            raise LoadError(source, "too large for a rig", "choose a rig's file")
        rig = rig_from_json(json.loads(source.read_text(encoding="utf-8")))
    except OSError as error:
        raise LoadError(source, error.strerror or str(error), "check the path") from None
    except (ValueError, RecursionError, SceneError) as error:
        raise LoadError(source, f"not a rig ({error})", "choose a rig's file") from None
    return rig if rig.title else replace(rig, id=source.stem, title=source.stem)


__all__ = [
    "SUFFIX",
    "fitted",
    "load_rig",
    "normalised",
    "rig_from_json",
    "rig_to_json",
    "save_rig",
    "write_rig",
]
