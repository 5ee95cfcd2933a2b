"""The scene: one frozen tree that says everything about a picture but its size."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from ..errors import LoadError, SceneError
from .camera import Bookmark, Camera
from .clip import MAX_CLIP_PLANES, ClipPlane, CropBox
from .geometry import Geometry, with_paths
from .light import Light, shining
from .params import Param, check, fields_of, from_json, to_json
from .paths import changed, plant
from .transfer import TransferFunction
from .volume import Volume
from .white import WHITE

#: Version of the JSON form; a reader refuses newer ones.
FORMAT_VERSION = 1
#: A technique may use fewer: the first of those that shine.
MAX_LIGHTS = 16
MAX_BOOKMARKS = 64


@dataclass(frozen=True)
class TechniqueParams:
    """Base of every technique's own parameters; a technique without any uses a bare subclass."""

    def __post_init__(self) -> None:
        check(self)

    def in_effect(self, name: str, scene: Scene, light: Light | None) -> float | None:
        """Return what a parameter without a value amounts to in a scene, for a lamp; None if that is not known."""
        return None


@dataclass(frozen=True)
class Scene:
    """Everything that a picture depends on, except its size.

    Parameters
    ----------
    volume : Volume, optional
        What is shown.
    transfer : TransferFunction, optional
        If not given, a preset is chosen from the modality and the values.
    camera : Camera, optional
        If not given, the front view of what the transfer function shows.
    lights : sequence of Light
        Up to sixteen; a technique uses as many as it can, the first that shine.
    technique : str or TechniqueParams
        An id (see ``sfumato techniques``) or a technique's parameter object.
    step : float
        Sampling distance in voxels (of the smallest spacing).
    background : (r, g, b, alpha)
        Linear, straight alpha.
    exposure : float
        In stops: linear values are multiplied by 2 ** exposure before the tone map.
    white_balance : float
        Temperature in K of the light that is shown as white; 6504 leaves colours as they are.
    tone_curve : str
        ``clip`` cuts off what is brighter than white; ``soft`` bends it below white, from 60 % on.
    shadow_floor : float
        f in [0, 1): a lamp's visibility V counts as max(V, f) wherever it falls; 0 leaves shadows as they are.
    frames : int
        Jittered frames that `render` accumulates.
    clip, crop
        Clip planes (up to six) and crop box.
    solid_cuts : bool
        Whether cut faces are solid: matter on them looks as if it went on behind the face through the whole
        subject, and is shaded as the plane is turned.
    geometry : sequence of Geometry
        Tracts, streamlines and surfaces (`sfumato.load_geometry`).
    bookmarks : sequence of Bookmark
        Cameras to come back to, up to sixty-four, each name once.

    Raises
    ------
    SceneError
        With the path of the field, the value and what is allowed.
    """

    volume: Volume | None = None
    transfer: TransferFunction | None = None
    camera: Camera | None = None
    lights: tuple[Light, ...] = (Light(),)
    technique: Any = "cone"
    step: Annotated[
        float,
        Param(
            "Sampling distance",
            label="Sampling",
            unit="voxel",
            ge=0.05,
            le=16,
            soft=(0.25, 4),
            tab="view",
            level="more",
        ),
    ] = 0.5
    background: Annotated[tuple[float, float, float, float], Param("Linear RGB and alpha", ge=0, le=1)] = (
        0.0,
        0.0,
        0.0,
        0.0,
    )
    exposure: Annotated[
        float,
        Param("Brightness in stops", label="Exposure", unit="stops", ge=-16, le=16, soft=(-3, 3), tab="view"),
    ] = 0.0
    white_balance: Annotated[
        float,
        Param(
            "Temperature of the light that is shown as white; lower makes the picture bluer",
            label="White balance",
            unit="K",
            ge=2000,
            le=20000,
            soft=(2500, 12000),
            source="CIE 159:2004, Bradford",
            tab="view",
            level="more",
        ),
    ] = WHITE
    tone_curve: Annotated[
        str,
        Param(
            "What is brighter than white: clip cuts it off, soft bends it below white from 60 % on",
            label="Tone curve",
            choices=("clip", "soft"),
            tab="view",
            level="more",
        ),
    ] = "clip"
    frames: Annotated[
        int, Param("Jittered frames accumulated in a still picture", label="Frames", ge=1, le=1024)
    ] = 1
    shadow_floor: Annotated[
        float,
        Param(
            "Least share of a lamp's light that its shadow leaves: no shadow hides what lies in it",
            label="Shadow floor",
            ge=0,
            lt=1,
            soft=(0, 0.6),
            tab="light",
            level="more",
        ),
    ] = 0.0
    clip: tuple[ClipPlane, ...] = ()
    crop: CropBox = field(default_factory=CropBox)
    solid_cuts: Annotated[
        bool,
        Param(
            "Matter on a cut face looks as if it went on behind it: what is translucent shows its section, "
            "shaded as a plane",
            label="Solid cut faces",
            tab="view",
        ),
    ] = False
    geometry: tuple[Geometry, ...] = ()
    bookmarks: tuple[Bookmark, ...] = ()

    def __post_init__(self) -> None:
        from ..techniques import params_of

        check(self)
        object.__setattr__(self, "technique", params_of(self.technique))
        if len(self.lights) > MAX_LIGHTS:
            raise SceneError("lights", f"{len(self.lights)} lights", f"at most {MAX_LIGHTS}")
        if len(self.clip) > MAX_CLIP_PLANES:
            raise SceneError("clip", f"{len(self.clip)} planes", f"at most {MAX_CLIP_PLANES}")
        if len(self.bookmarks) > MAX_BOOKMARKS:
            raise SceneError("bookmarks", f"{len(self.bookmarks)} bookmarks", f"at most {MAX_BOOKMARKS}")
        if len({b.name for b in self.bookmarks}) < len(self.bookmarks):
            raise SceneError("bookmarks", [b.name for b in self.bookmarks], "each name once")
        if self.volume is not None:
            self._fill_in_defaults(self.volume)
        elif self.geometry and self.camera is None:
            bounds = np.array([g.bounds for g in self.geometry])
            box = np.array([bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)])
            object.__setattr__(self, "camera", Camera.fit(box))

    def _fill_in_defaults(self, volume: Volume) -> None:
        from .presets import suggest_clip, suggest_transfer, suggest_view

        if self.transfer is None:
            supplied = volume.info.transfer
            object.__setattr__(self, "transfer", supplied or suggest_transfer(volume))
            if not self.clip and supplied is None:
                object.__setattr__(self, "clip", suggest_clip(volume))
        if self.camera is None:
            object.__setattr__(self, "camera", suggest_view(volume, self.transfer))

    # -- what a renderer asks -----------------------------------------------------------------------
    @property
    def technique_id(self) -> str:
        """Id of the technique."""
        from ..techniques import id_of

        return id_of(self.technique)

    @property
    def active_lights(self) -> tuple[Light, ...]:
        """The lights that shine (see `shining`), as many of them as the technique can use."""
        from ..techniques import technique_for

        return shining(self.lights)[: technique_for(self.technique).max_lights]

    @property
    def is_clipped(self) -> bool:
        """Whether a clip plane is on."""
        return any(plane.enabled for plane in self.clip)

    @property
    def is_cut(self) -> bool:
        """Whether clip planes or the crop box, which is the volume's, cut anything away."""
        cropped = max(self.crop.low) > 0 or min(self.crop.high) < 1
        return self.is_clipped or (cropped and self.volume is not None)

    @property
    def has_solid_cuts(self) -> bool:
        """Whether there are cut faces, and they are solid."""
        return self.solid_cuts and self.is_cut

    def light_angles(self) -> tuple[tuple[float, float], ...]:
        """Tilt and rotation in degrees of each active light, as the camera sees it."""
        assert self.camera is not None
        basis, target = self.camera.basis(), self.volume.center if self.volume else self.camera.focal_point
        return tuple(light.angles(basis, target) for light in self.active_lights)

    # -- changed copies -----------------------------------------------------------------------------
    def with_(self, changes: dict[str, Any] | None = None, /, **more: Any) -> Scene:
        """Return a changed copy; paths are dotted, as in ``with_(**{"lights.0.tilt": 50})``.

        Raises
        ------
        SceneError
            If a path does not exist or a value is not allowed.
        """
        wanted = {**(changes or {}), **more}
        # Parts changed together (tilt and aperture, both crop bounds) are checked together, not one by one.
        tree: dict[str, Any] = {}
        for path, value in wanted.items():
            plant(tree, path.split("."), value)
        try:
            return changed(self, tree, "")  # type: ignore[no-any-return]
        except RecursionError:
            raise SceneError("scene", wanted, "nested too deeply") from None

    # -- files --------------------------------------------------------------------------------------
    def to_json(self) -> dict[str, Any]:
        """Return the scene as JSON data; the volume by path and content hash."""
        data: dict[str, Any] = {"sfumato": FORMAT_VERSION}
        for f in dataclasses.fields(self):
            value = getattr(self, f.name)
            if f.name == "volume":
                data["volume"] = None if value is None else {"path": value.info.path, "hash": value.key}
            elif f.name == "technique":
                data["technique"] = {"id": self.technique_id, **to_json(value)}
            elif f.name == "geometry":
                data["geometry"] = [g.to_json() for g in value]
            else:
                data[f.name] = to_json(value)
        return data

    @staticmethod
    def from_json(
        data: Any, volume: Volume | None = None, geometry: tuple[Geometry, ...] | None = None
    ) -> Scene:
        """Build a scene from JSON data and a volume that was loaded already.

        Parameters
        ----------
        geometry : tuple of Geometry, optional
            As many as the data names, loaded already; otherwise what the data names is read or traced.

        Raises
        ------
        SceneError
            If a field is unknown or its value is not allowed.
        """
        from ..techniques import params_from_json

        if not isinstance(data, dict):
            raise SceneError("scene", data, "an object is needed here")
        version = data.get("sfumato")
        if not isinstance(version, int) or not 1 <= version <= FORMAT_VERSION:
            raise SceneError(
                "sfumato",
                version,
                f"this program reads scene format 1 to {FORMAT_VERSION}; a newer Sfumato may read it",
            )
        known = fields_of(Scene)
        values: dict[str, Any] = {"volume": volume}
        for name, value in data.items():
            if name in ("sfumato", "volume"):
                continue
            if name not in known:
                raise SceneError(name, value, "unknown field; known: " + ", ".join(known))
            if name == "technique":
                values[name] = params_from_json(value)
            elif name == "geometry":
                values[name] = _geometry(value) if geometry is None else geometry
            elif name in _NESTED:
                values[name] = _nested(name, value)
            else:
                values[name] = value
        return Scene(**values)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as a JSON file, atomically; the volume by path (relative where it can be) and hash.

        Raises
        ------
        SceneError
            If the file cannot be written.
        """
        target = Path(path)
        data = self.to_json()
        if data["volume"] and data["volume"]["path"]:
            data["volume"]["path"] = _portable(data["volume"]["path"], target)
        data["geometry"] = [with_paths(g, lambda p: _portable(p, target)) for g in data["geometry"]]
        temporary = target.with_name(target.name + ".part")
        try:
            temporary.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
            temporary.replace(target)
        except OSError as error:
            temporary.unlink(missing_ok=True)
            raise SceneError(
                "path", str(target), f"the scene could not be written: {error.strerror or error}"
            ) from None

    @staticmethod
    def open(
        path: str | os.PathLike[str],
        volume: Volume | None = None,
        places: Sequence[str | os.PathLike[str]] = (),
    ) -> Scene:
        """Read a scene file and the volume it names; one that has moved is known by its content.

        Parameters
        ----------
        volume : Volume, optional
            Use this volume instead of the one that the scene names.
        places : sequence of path
            Folders in which a volume that has moved is looked for, after the scene's own.

        Raises
        ------
        LoadError
            If the file or its volume cannot be read.
        SceneError
            If the file holds something that a scene may not hold.
        """
        source = Path(path)
        try:
            data = json.loads(source.read_text(encoding="utf-8"))
        except OSError as error:
            raise LoadError(source, error.strerror or str(error), "check the path") from None
        except (ValueError, RecursionError) as error:
            raise LoadError(
                source, f"not a scene file ({error})", "open a .sfumato file or a volume"
            ) from None
        if volume is None and isinstance(data, dict) and data.get("volume"):
            volume = _find_volume(data["volume"], source, places)
        return Scene.from_json(located(data, source.parent), volume)


_NESTED: dict[str, type] = {
    "transfer": TransferFunction,
    "camera": Camera,
    "crop": CropBox,
    "lights": Light,
    "clip": ClipPlane,
    "bookmarks": Bookmark,
}
_LISTS = ("lights", "clip", "bookmarks")


def _nested(name: str, value: Any) -> Any:
    if value is None:
        return None
    if name in _LISTS:
        if not isinstance(value, list):
            raise SceneError(name, value, "a list is needed here")
        return tuple(from_json(_NESTED[name], v, f"{name}.{i}") for i, v in enumerate(value))
    return from_json(_NESTED[name], value, name)


def _geometry(value: Any) -> tuple[Geometry, ...]:
    if not isinstance(value, list):
        raise SceneError("geometry", value, "a list is needed here")
    from ..geometry import load_known

    return tuple(load_known(v, f"geometry.{i}") for i, v in enumerate(value))


def located(data: Any, folder: Path) -> Any:
    """Return a scene's JSON data in which the paths of its geometry, as kept beside the scene, lead there."""
    if not isinstance(data, dict) or not isinstance(data.get("geometry"), list):
        return data
    there = [
        with_paths(g, lambda p: p if p.startswith("sample:") else str(folder / p)) for g in data["geometry"]
    ]
    return {**data, "geometry": there}


def _portable(volume_path: str, scene_path: Path) -> str:
    """Return the volume's path relative to the scene file where both lie below one folder."""
    if volume_path.startswith("sample:"):
        return volume_path
    try:
        return Path(volume_path).resolve().relative_to(scene_path.resolve().parent).as_posix()
    except ValueError:
        return str(Path(volume_path).resolve())


def _find_volume(reference: Any, scene_path: Path, places: Sequence[str | os.PathLike[str]] = ()) -> Volume:
    from ..io import OtherContent, find_moved, load_known

    if not isinstance(reference, dict) or not isinstance(reference.get("path"), str) or not reference["path"]:
        raise LoadError(
            scene_path, "the scene does not say where its volume is", "open the volume first, then the scene"
        )
    name = reference["path"]
    wanted = reference.get("hash") if isinstance(reference.get("hash"), str) else None
    if name.startswith("sample:"):
        return load_known(name, wanted)
    there = scene_path.parent / name
    if wanted is None or there.exists():
        try:
            return load_known(there, wanted)
        except OtherContent:
            pass
    return find_moved(there, str(wanted), [scene_path.parent, *places])
