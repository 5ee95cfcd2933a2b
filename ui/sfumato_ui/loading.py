"""Opening files away from the window's thread, with progress and cancel."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from qtpy.QtCore import QObject, Signal

import sfumato_samples
from sfumato import Geometry, Scene, SfumatoError, Tracing, Volume
from sfumato.export.png import carries_scene, open_png, read_scene_data
from sfumato.geometry import is_geometry
from sfumato.geometry.directions import LEAST_ANISOTROPY
from sfumato.scene.peaks import peaks_of
from sfumato.scene.presets import presets_for, suggest_view

from .camera_moves import whole_view
from .subject import technique_drawing_geometry
from .wording import one_line

#: Shown when nothing was asked for.
DEFAULT_SAMPLE = "sample:hand"
SCENE_SUFFIX = ".sfumato"
SAMPLE = "sample:"

#: Work on the thread (progress, stop); what it returns is called to tell of the result.
Task = Callable[[Any, threading.Event], Callable[[], object]]


@dataclass(frozen=True)
class Wish:
    """What is to be opened, and what the user said about it.

    Parameters
    ----------
    path : str
        A file, a folder, or ``sample:name``.
    series : str, optional
        Key of the DICOM series.
    raw : RawGuess, optional
        How to read bare voxels.
    slot : Slot, optional
        The autosaved scene that `path` is.
    places : tuple of str
        Folders in which a scene's volume is looked for if it has moved.
    volume : str
        Path of a scene's volume, if the user named it; else empty.
    """

    path: str
    series: str | None = None
    raw: Any = None
    slot: Any = None
    places: tuple[str, ...] = ()
    volume: str = ""

    @property
    def name(self) -> str:
        """What it is called in messages."""
        if self.slot:
            return "the recovered scene"
        return self.path.removeprefix(SAMPLE) if self.is_sample else Path(self.path).name

    @property
    def is_sample(self) -> bool:
        """Whether it is one of the embedded samples."""
        return self.path.startswith(SAMPLE)

    @property
    def scene_path(self) -> str:
        """The scene file that it is, or nothing."""
        return self.path if self.path.endswith(SCENE_SUFFIX) else ""


class Loader(QObject):
    """Opens one thing at a time; asking for another gives up the first."""

    progress = Signal(float, str)
    #: A scene is ready (the scene, the wish).
    loaded = Signal(object, object)
    #: The scene with its volume at half the resolution.
    reduced = Signal(object)
    #: Tracts and meshes are ready (tuple of them, tuple of notices).
    geometry_loaded = Signal(object, object)
    #: Streamlines are ready.
    traced = Signal(object)
    #: A folder holds several DICOM series (path, list of series).
    several = Signal(str, object)
    #: Bare voxels that nothing describes (path, list of guesses).
    raw_found = Signal(str, object)
    #: A scene's volume is nowhere to be found (the wish, the message).
    volume_missing = Signal(object, str)
    failed = Signal(str)
    cancelled = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def open(self, wish: Wish, aspect: float = 1.0) -> None:
        """Begin to open a volume, a folder, a scene file or a sample, for a picture of an aspect."""
        self._start(lambda progress, stop: self._open(wish, aspect, progress, stop))

    def open_geometry(self, paths: list[str], scene: Scene) -> None:
        """Begin to open tracts and meshes that are to join a scene."""
        self._start(lambda progress, stop: self._open_geometry(paths, scene, progress, stop))

    def trace(self, tracing: Tracing) -> None:
        """Begin to trace streamlines."""
        self._start(lambda progress, stop: self._trace(tracing, progress, stop))

    def reduce(self, scene: Scene) -> None:
        """Begin to halve the resolution of a scene's volume."""
        self._start(lambda progress, stop: self._reduce(scene, progress, stop))

    def _start(self, task: Task) -> None:
        self.cancel()
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=self._run, args=(task, self._stop), name="sfumato-load", daemon=True
        )
        self._thread.start()

    def cancel(self) -> None:
        """Give up what is being opened; the thread ends by itself."""
        self._stop.set()

    @property
    def alive(self) -> bool:
        """Whether something is being opened."""
        return self._thread is not None and self._thread.is_alive()

    # -- the thread -------------------------------------------------------------------------------
    def _run(self, task: Task, stop: threading.Event) -> None:
        def progress(fraction: float, text: str = "") -> None:
            if not stop.is_set():
                self.progress.emit(fraction, text)

        try:
            tell = task(progress, stop)
        except Exception as error:
            # A reader that was stopped ends with an error of its own; what counts is who asked for it.
            tell = partial(self.failed.emit, one_line(error))
        if not stop.is_set():
            tell()
        elif stop is self._stop:  # given up by the user, not for something else
            self.cancelled.emit()

    def _open(self, wish: Wish, aspect: float, progress: Any, stop: threading.Event) -> Callable[[], object]:
        from sfumato.io import MissingVolume, NeedsDescription, guess_raw

        found = _several_series(wish.path) if wish.series is None else []
        if len(found) > 1:
            return partial(self.several.emit, wish.path, found)
        try:
            scene = read_scene(wish, progress, stop.is_set, aspect)
        except NeedsDescription as error:
            return partial(self.raw_found.emit, error.path, guess_raw(error.path))
        except MissingVolume as error:
            return partial(self.volume_missing.emit, wish, one_line(error))
        if not (wish.scene_path or wish.slot):
            scene = with_streamlines(scene, progress, stop.is_set)
        return partial(self.loaded.emit, scene, wish)

    def _open_geometry(
        self, paths: list[str], scene: Scene, progress: Any, stop: threading.Event
    ) -> Callable[[], object]:
        made: list[Geometry] = []
        notices: list[str] = []
        for i, path in enumerate(paths):

            def step(done: float, text: str, i: int = i) -> None:
                progress((i + done) / len(paths), text)

            made.append(read_geometry(path, step, stop.is_set))
            notices += geometry_notices(made[-1], scene.volume)
        return partial(self.geometry_loaded.emit, tuple(made), tuple(notices))

    def _trace(self, tracing: Tracing, progress: Any, stop: threading.Event) -> Callable[[], object]:
        from sfumato.geometry import mesh_of, trace

        made = trace(tracing, progress=progress, cancel=stop.is_set)
        mesh_of(made)
        return partial(self.traced.emit, made)

    def _reduce(self, scene: Scene, progress: Any, stop: threading.Event) -> Callable[[], object]:
        from sfumato.io import reduce_volume

        assert scene.volume is not None
        smaller = scene.with_(volume=reduce_volume(scene.volume, progress=progress, cancel=stop.is_set))
        _prepare(smaller)
        return partial(self.reduced.emit, smaller)


def read_scene(wish: Wish, progress: Any = None, cancel: Any = None, aspect: float = 1.0) -> Scene:
    """Read a scene file, a picture that carries its scene, or a volume as a new scene that fits the picture."""
    if wish.scene_path or carries_scene(wish.path):
        scene = _read_scene_file(wish, progress, cancel)
    elif wish.is_sample:
        scene = sfumato_samples.scene(wish.path.removeprefix(SAMPLE))
    elif is_geometry(wish.path):
        return _of_geometry(read_geometry(wish.path, progress, cancel), aspect)
    else:
        scene = _fitting(_read_volume(wish, progress, cancel), aspect)
    _prepare(scene)
    return scene


def _read_scene_file(wish: Wish, progress: Any, cancel: Any) -> Scene:
    """Read a scene, with the volume that it names or the user did."""
    opened = Scene.open if wish.scene_path else open_png
    if not wish.volume:
        return opened(wish.path, places=wish.places)
    volume = _read_volume(Wish(wish.volume), progress, cancel)
    scene = opened(wish.path, volume)
    if volume.key != _named_key(wish):
        volume = _noted(volume, "This is not the volume that the scene was made with.")
        scene = scene.with_(volume=volume)
    return scene


def _named_key(wish: Wish) -> object:
    """Return the key of the volume that a scene names."""
    if wish.scene_path:
        data = json.loads(Path(wish.path).read_text(encoding="utf-8"))
    else:
        data = read_scene_data(wish.path)
    return data["volume"].get("hash")


def with_streamlines(scene: Scene, progress: Any = None, cancel: Any = None) -> Scene:
    """Return a new scene with streamlines of its volume's vectors, if it has any: seen without a single click."""
    from sfumato.geometry import has_vectors, load_field, mesh_of, suggest_seeds, trace
    from sfumato.io import LoadCancelled

    volume = scene.volume
    if volume is None or scene.geometry or not has_vectors(volume.info.path):
        return scene
    try:
        field = load_field(volume.info.path)
        tracing = Tracing(path=volume.info.path, seeds=suggest_seeds(field))
        if field.axial:
            tracing = replace(tracing, min_speed=LEAST_ANISOTROPY)
        made = trace(tracing, field, progress=progress, cancel=cancel)
        mesh_of(made)
    except LoadCancelled:
        raise
    except SfumatoError as error:
        return scene.with_(volume=_noted(volume, f"No streamlines: {one_line(error)}."))
    return scene.with_(geometry=(made,), technique=technique_drawing_geometry(scene))


def _noted(volume: Volume, notice: str) -> Volume:
    """Return a volume with one more notice."""
    return replace(volume, info=replace(volume.info, notices=(*volume.info.notices, notice)))


def read_geometry(path: str, progress: Any = None, cancel: Any = None) -> Geometry:
    """Read tracts or a mesh, and build what is drawn, so that the first picture need not."""
    from sfumato.geometry import load_geometry, mesh_of
    from sfumato.io import LoadCancelled

    def step(first: float, done: float, text: str) -> None:
        if cancel is not None and cancel():
            raise LoadCancelled(path)
        if progress is not None:
            progress(first + 0.5 * done, text)

    geometry = load_geometry(path, progress=partial(step, 0.0), cancel=cancel)
    mesh_of(geometry, partial(step, 0.5))
    return geometry


def geometry_notices(geometry: Geometry, volume: Volume | None) -> list[str]:
    """Return what was left out of a geometry, and what of it lies outside the volume."""
    from sfumato.geometry import outside_notice

    outside = outside_notice(geometry, volume.texture_from_world) if volume is not None else ""
    return [*geometry.notices, *([outside] if outside else [])]


def _of_geometry(geometry: Geometry, aspect: float) -> Scene:
    """Return a new scene of geometry alone, seen as a whole in a picture of an aspect."""
    scene = Scene(geometry=(geometry,))
    camera = whole_view(scene, aspect, "front")
    return scene.with_(camera=camera, technique=technique_drawing_geometry(scene))


def _fitting(volume: Volume, aspect: float) -> Scene:
    """Return a new scene whose camera sees the whole subject in a picture of an aspect."""
    scene = Scene(volume=volume)
    return scene.with_(camera=suggest_view(volume, scene.transfer, aspect=aspect))


def _read_volume(wish: Wish, progress: Any, cancel: Any) -> Volume:
    from sfumato import load
    from sfumato.io import load_raw

    if wish.raw is not None:
        how = wish.raw
        return load_raw(
            wish.path, how.dims, how.dtype, how.spacing,
            offset=how.offset, progress=progress, cancel=cancel,
        )  # fmt: skip
    return load(wish.path, series=wish.series, progress=progress, cancel=cancel)


def _prepare(scene: Scene) -> None:
    """Compute here, off the window's thread, what is slow to compute once: content hash, histogram, presets."""
    if scene.volume is not None:
        _ = scene.volume.key, scene.volume.histogram, presets_for(scene.volume), peaks_of(scene.volume)


def _several_series(path: str) -> list[Any]:
    """Return the DICOM series in a folder, the largest first; nothing for anything else."""
    if path.startswith(SAMPLE) or not Path(path).is_dir():
        return []
    from sfumato.io import find_series

    return list(find_series(path))
