"""A volume that is no longer where its scene says: looked for under its name, then under any, known by its content."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from ..errors import LoadError
from ..scene import Volume
from .known import OTHER, load_known

#: Most files that are read in search of one, and most folders in which they are looked for.
MOST_READ, MOST_FOLDERS = 12, 200


class MissingVolume(LoadError):  # noqa: N818  (it says what is missing)
    """The volume of a scene is not where the scene says, nor anywhere else that was looked at."""


def find_moved(named: str | os.PathLike[str], key: str, folders: Iterable[str | os.PathLike[str]]) -> Volume:
    """Return the volume with a key from a place other than it had.

    Parameters
    ----------
    named : path
        Where it was.
    key : str
        Key of its content (`Volume.key`).
    folders : iterable of path
        Where to look, the likeliest first: there and one folder deeper for its name, there alone for any name with the
        same ending.

    Raises
    ------
    MissingVolume
        If it is not found.
    """
    named, looked = Path(named), 0
    for place in _places(named, [Path(folder) for folder in folders]):
        if looked == MOST_READ:
            break
        looked += 1
        try:
            volume = load_known(place, key)
        except LoadError:
            continue
        notice = f"The volume has moved: it was found as {place}."
        return replace(volume, info=replace(volume.info, notices=(*volume.info.notices, notice)))
    what = OTHER if named.exists() else "the scene's volume is not there"
    also = f", nor is it {looked} other{'s' * (looked > 1)} that may have been it" if looked else ""
    raise MissingVolume(named, what + also, "put it beside the scene, or open the volume by itself")


def _places(named: Path, folders: list[Path]) -> Iterator[Path]:
    """Yield where it may be: what has its name first."""
    seen = {_resolved(named)}
    # Scenes come from Windows, too.
    named = named.with_name(named.name.rsplit("\\", 1)[-1])
    for again in (False, True):
        for folder in folders[:MOST_FOLDERS]:
            found = _alike(named, folder) if again else [folder / named.name, *_deeper(named, folder)]
            for place in found:
                if place.exists() and (one := _resolved(place)) not in seen:
                    seen.add(one)
                    yield place


def _deeper(named: Path, folder: Path) -> list[Path]:
    return [inner / named.name for inner in _entries(folder) if inner.is_dir()][:MOST_FOLDERS]


def _alike(named: Path, folder: Path) -> list[Path]:
    """Return the files of a folder that end as it did; for a folder of slices, the folders."""
    if not named.suffix:
        return [inner for inner in _entries(folder) if inner.is_dir()]
    ending = "".join(named.suffixes[-2:]) if named.suffix == ".gz" else named.suffix
    return [one for one in _entries(folder) if one.name.endswith(ending) and one.is_file()]


def _entries(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []


def _resolved(path: Path) -> str:
    return os.path.realpath(path)
