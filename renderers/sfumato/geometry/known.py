"""The geometry that a scene names: by file and content hash, by how it was traced, or written out in it."""

from __future__ import annotations

from typing import Any

from ..errors import LoadError, SceneError
from ..scene.geometry import Geometry
from ..scene.params import from_json
from ..scene.tracing import Tracing
from .load import load_geometry
from .streamlines import trace


def load_known(data: Any, where: str = "geometry") -> Geometry:
    """Build a geometry from a scene's JSON data: read its file, or trace it anew, unless the data holds it.

    Raises
    ------
    LoadError
        If a file cannot be read, or its content is another than it was.
    SceneError
        If the data holds what a geometry may not hold.
    """
    if not isinstance(data, dict):
        raise SceneError(where, data, "an object is needed here")
    try:
        made = _remade(data)
        return Geometry.from_json(data, made.shape if made else None, made.notices if made else ())
    except SceneError as error:
        raise SceneError(f"{where}.{error.path}", error.value, error.allowed) from None


def _remade(data: dict[str, Any]) -> Geometry | None:
    path, wanted = data.get("path"), data.get("hash")
    if isinstance(path, str) and path:
        space = data.get("space", "")
        made = load_geometry(path, space=space if isinstance(space, str) else "?")
        if isinstance(wanted, str) and made.shape.key != wanted:
            raise LoadError(
                path,
                "this is not the geometry that the scene was made with (its content differs)",
                "open the file by itself",
            )
        return made
    if data.get("tracing") is not None and "shape" not in data:
        return trace(from_json(Tracing, data["tracing"], "tracing"))
    return None
