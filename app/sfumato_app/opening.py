"""Anything that can be opened, as a scene: a volume, a DICOM folder, a scene file, a picture of ours."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Group, Parameter

import sfumato
from sfumato import LoadError, Scene, Volume
from sfumato.export.png import carries_scene
from sfumato.techniques import technique_for, technique_with_geometry

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


def new_scene(path: str, volume_path: str | None = None, read: ReadFlags | None = None) -> Scene:
    """Return a new scene of a volume, or of tracts or a mesh (on a volume, if one is named)."""
    from sfumato.geometry import is_geometry

    if not is_geometry(path):
        return Scene(volume=open_volume(volume_path or path, read), background=BACKGROUND, frames=FRAMES)
    volume = open_volume(volume_path, read) if volume_path else None
    scene = Scene(
        volume=volume, geometry=(sfumato.load_geometry(path),), background=BACKGROUND, frames=FRAMES
    )
    return drawing_geometry(scene)


def with_geometry(scene: Scene, paths: list[str]) -> Scene:
    """Return the scene with tracts and meshes from files added, drawn by a technique that can.

    Raises
    ------
    LoadError
        If one cannot be read.
    """
    more = tuple(sfumato.load_geometry(path) for path in paths)
    return drawing_geometry(scene.with_(geometry=(*scene.geometry, *more))) if more else scene


def drawing_geometry(scene: Scene) -> Scene:
    """Return the scene with a technique that draws its geometry; its own, if that does."""
    if technique_for(scene.technique).geometry or not technique_with_geometry():
        return scene
    return scene.with_(technique=technique_with_geometry())


def geometry_notices(scene: Scene) -> list[str]:
    """Return what was left out of the scene's geometry, and what of it lies outside the volume."""
    from sfumato.geometry import outside_notice

    told = []
    for geometry in scene.geometry:
        outside = outside_notice(geometry, scene.volume.texture_from_world) if scene.volume else ""
        told += [f"{geometry.name or geometry.kind}: {text}" for text in (*geometry.notices, outside) if text]
    return told


def open_scene(path: str, volume_path: str | None = None, read: ReadFlags | None = None) -> Scene:
    """Read a scene, or a volume, tracts or a mesh as a new scene with a fitting transfer function and view.

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
        return new_scene(path, volume_path, read)
    volume = open_volume(volume_path, read) if volume_path else None
    if Path(path).suffix.lower() == SCENE_SUFFIX:
        return Scene.open(path, volume)
    from sfumato.export.png import open_png

    return open_png(path, volume)
