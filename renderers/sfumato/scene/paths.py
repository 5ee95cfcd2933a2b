"""Paths into the scene: ``lights.0.tilt`` names a field; changes are made and texts read by them."""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import SceneError
from .params import coerce, fields_of
from .shapes import Lines, Surface
from .tracing import Tracing
from .volume import Volume

if TYPE_CHECKING:
    from .scene import Scene


#: What is replaced as a whole: arrays, and what they were made by.
_LEAVES = (Volume, Lines, Surface, Tracing)


def plant(tree: dict[str, Any], path: list[str], value: Any) -> None:
    """Hang a value into a tree of changes at a path."""
    for name in path[:-1]:
        branch = tree.setdefault(name, {})
        if not isinstance(branch, _Branch):
            branch = tree[name] = _Branch()
        tree = branch
    tree[path[-1]] = value


class _Branch(dict[str, Any]):
    """Changes below a path, as opposed to a value that is a dict."""


def changed(node: Any, changes: dict[str, Any], path: str) -> Any:
    """Return a copy of a dataclass or tuple in which the named children are changed."""

    def child(old: Any, change: Any, where: str) -> Any:
        return changed(old, change, where) if isinstance(change, _Branch) else change

    prefix = f"{path}." if path else ""
    if isinstance(node, tuple):
        items = list(node)
        for name, change in changes.items():
            if not name.isdigit() or int(name) >= len(items):
                raise SceneError(
                    prefix + name,
                    change if not isinstance(change, dict) else "",
                    f"an index from 0 to {len(items) - 1} is needed" if items else "the list is empty",
                )
            items[int(name)] = child(items[int(name)], change, prefix + name)
        return tuple(items)
    if not dataclasses.is_dataclass(node) or isinstance(node, _LEAVES):
        raise SceneError(path, next(iter(changes.values())), "nothing can be set below this")
    known = fields_of(type(node))
    values = {}
    for name, change in changes.items():
        if name not in known:
            raise SceneError(
                prefix + name,
                change if not isinstance(change, dict) else "",
                "unknown field; known: " + ", ".join(known),
            )
        values[name] = child(getattr(node, name), change, prefix + name)
    try:
        return dataclasses.replace(node, **values)  # type: ignore[type-var]
    except SceneError as error:
        if error.path.startswith(prefix) and prefix:
            raise
        raise SceneError(prefix + error.path, error.value, error.allowed) from None


def parse_setting(scene: Scene, path: str, text: str) -> Any:
    """Turn a command line's text for a path of the scene into a value of the type that lives there.

    Raises
    ------
    SceneError
        If the path does not exist or the text does not fit.
    """
    try:
        value = json.loads(text)
    except ValueError:
        value = text
    node: Any = scene
    optional = False
    for i, name in enumerate(path.split(".")):
        where = ".".join(path.split(".")[: i + 1])
        if isinstance(node, tuple) and name.isdigit() and int(name) < len(node):
            node, hint, param, optional = node[int(name)], Any, None, False
        elif (
            dataclasses.is_dataclass(node) and not isinstance(node, _LEAVES) and name in fields_of(type(node))
        ):
            f = fields_of(type(node))[name]
            node, hint, param, optional = getattr(node, name), f.type, f.param, f.optional
        else:
            raise SceneError(where, text, "there is no such field in the scene")
    if path == "technique":
        return value
    if optional and isinstance(value, str) and value.lower() == "none":
        return None
    if isinstance(node, (np.ndarray, *_LEAVES)):
        raise SceneError(path, text, "this cannot be set")
    return coerce(tuple(value) if isinstance(value, list) else value, hint, path, param)
