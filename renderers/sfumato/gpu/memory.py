"""What is on the GPU, object by object, found by following the attributes of whoever owns it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import moderngl

_TEXTURES = (moderngl.Texture, moderngl.Texture3D, moderngl.TextureArray, moderngl.TextureCube)
#: Attributes that lead away from an owner, to what everybody shares.
_SHARED = ("device", "ctx", "renderer", "scene", "store")


@dataclass(frozen=True)
class GpuObject:
    """A texture or buffer.

    Parameters
    ----------
    name : str
        Its owner, and the way from there by the names of attributes.
    shape : str
        Texels and their type.
    size : int
        Bytes.
    """

    name: str
    shape: str
    size: int


def gpu_objects(owners: Mapping[str, Any]) -> list[GpuObject]:
    """Return all textures and buffers that named owners hold, each once, the largest first."""
    seen: set[int] = set()
    found = [item for name, owner in owners.items() for item in _within(owner, name, seen)]
    return sorted(found, key=lambda item: -item.size)


def _within(thing: Any, name: str, seen: set[int]) -> Iterator[GpuObject]:
    if id(thing) in seen:
        return
    if isinstance(thing, (*_TEXTURES, moderngl.Buffer)):
        seen.add(id(thing))
        if not isinstance(thing.mglo, moderngl.InvalidObject):
            yield _described(thing, name)
        return
    for part, value in _parts(thing):
        seen.add(id(thing))
        yield from _within(value, f"{name} {part}".strip(), seen)


def _parts(thing: Any) -> Iterator[tuple[str, Any]]:
    """Return the parts of one of our objects, or of a collection, with what they are called."""
    if isinstance(thing, dict):
        yield from (("", value) for value in thing.values())
    elif isinstance(thing, list | tuple):
        yield from (("", value) for value in thing)
    elif type(thing).__module__.startswith("sfumato.") and hasattr(thing, "__dict__"):
        for key, value in vars(thing).items():
            # A program only refers to textures, and those who made them list them.
            if key not in _SHARED and key != "_textures":
                yield key.strip("_").replace("_", " "), value


def _described(thing: Any, name: str) -> GpuObject:
    if isinstance(thing, moderngl.Buffer):
        return GpuObject(name, "buffer", thing.size)
    texels, bytes_each = " x ".join(map(str, thing.size)), int(thing.dtype[-1])
    count = thing.components * bytes_each
    for length in thing.size:
        count *= length
    return GpuObject(name, f"{texels}, {thing.components} x {8 * bytes_each} bit", count)
