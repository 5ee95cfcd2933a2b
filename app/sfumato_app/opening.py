"""Anything that can be opened, as a scene: a volume, a DICOM folder, a scene file, a picture of ours."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Group, Parameter

import sfumato
from sfumato import LoadError, Scene, Volume
from sfumato.export.png import carries_scene

from .numbers import whole

#: The embedded sample that is shown when nothing was asked for.
DEFAULT_SAMPLE = "sample:hand"
SCENE_SUFFIX = ".sfumato"
SAMPLE = "sample:"
#: What is behind a new scene, linear: the neutral grey on which the window shows it (sRGB 78).
BACKGROUND = (0.0762, 0.0762, 0.0762, 1.0)
#: Jittered frames of a new scene's picture: edges are smooth, and no grain is left.
FRAMES = 4


def is_scene(path: str) -> bool:
    """Tell whether a path names a scene file or a picture, as opposed to a volume."""
    if Path(path).suffix.lower() == SCENE_SUFFIX:
        return not Path(path).is_dir()
    return carries_scene(path)


READING = Group("Reading")


@Parameter(name="*")
@dataclass(frozen=True)
class ReadFlags:
    """Which part of a file or folder is read."""

    series: Annotated[
        str | None, Parameter(help="Series of a DICOM folder: its place (0, 1, …) or key.", group=READING)
    ] = None
    frame: Annotated[
        int | None,
        Parameter(converter=whole, help="Frame (time, echo) of a file with several.", group=READING),
    ] = None
    level: Annotated[
        int | None,
        Parameter(help="Level of a pyramid; else how often to halve.", group=READING),
    ] = None

    def options(self) -> dict[str, Any]:
        """Return what was given as options of `sfumato.load`."""
        series = (
            int(self.series)
            if self.series and self.series.isdigit() and len(self.series) < 5
            else self.series
        )
        given = {"series": series, "frame": self.frame, "level": self.level}
        return {name: value for name, value in given.items() if value is not None}


def open_volume(path: str, read: ReadFlags | None = None) -> Volume:
    """Read a volume.

    Raises
    ------
    LoadError
        If there is no such file, or it cannot be read.
    """
    if not path.startswith(SAMPLE) and not Path(path).exists():
        raise LoadError(path, "there is no such file or folder", "check the path")
    return sfumato.load(path, **(read.options() if read else {}))


def open_scene(path: str, volume_path: str | None = None, read: ReadFlags | None = None) -> Scene:
    """Read a scene with its volume, or a volume as a new scene with a fitting transfer function and view.

    Parameters
    ----------
    volume_path : str, optional
        The volume to use instead of the one that a scene file or a picture names.
    read : ReadFlags, optional
        Which part of the volume.

    Raises
    ------
    LoadError, SceneError
        If something cannot be read, or holds what a scene may not hold.
    """
    if not is_scene(path):
        return Scene(volume=open_volume(volume_path or path, read), background=BACKGROUND, frames=FRAMES)
    volume = open_volume(volume_path, read) if volume_path else None
    if Path(path).suffix.lower() == SCENE_SUFFIX:
        return Scene.open(path, volume)
    from sfumato.export.png import open_png

    return open_png(path, volume)
