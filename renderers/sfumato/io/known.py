"""The volume that a scene names: by its path, and by the key of its content where a path holds several."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ..errors import LoadError
from ..scene import Volume

#: How often a volume may have been halved for a device with little room.
MAX_HALVINGS = 3


#: What is said of a volume whose key is another.
OTHER = "this is not the volume that the scene was made with (its content differs)"


class OtherContent(LoadError):  # noqa: N818  (it says what was found)
    """What lies at a path is not the volume that is looked for."""

    def __init__(self, path: object) -> None:
        super().__init__(path, OTHER, "open the volume by itself")


def load_known(path: str | os.PathLike[str], key: str | None = None) -> Volume:
    """Read the volume of a path: of several series, or at a lower resolution, that which has the key.

    Raises
    ------
    LoadError
        If it cannot be read.
    OtherContent
        If none of these has the key.
    """
    from . import load

    volume = load(path)
    if key is None or volume.key == key:
        return volume
    for other in _other_readings(path, volume):
        if other.key == key:
            return other
    raise OtherContent(path)


def _other_readings(path: str | os.PathLike[str], volume: Volume) -> Iterator[Volume]:
    from . import find_series, load, reduce_volume

    for series in find_series(path)[1:] if Path(path).is_dir() else ():
        if series.count > 1:
            yield load(path, series=series.key)
    for _ in range(MAX_HALVINGS):
        if min(volume.dims) < 4:
            return
        volume = reduce_volume(volume)
        yield volume
