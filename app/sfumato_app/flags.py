"""The command line's words about a scene: flags made from the declared parameters, and their application."""

from __future__ import annotations

import dataclasses
import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import numpy as np
from cyclopts import Group, Parameter

from sfumato import Camera, LoadError, Scene, SceneError, TransferFunction
from sfumato.scene import STANDARD_VIEWS, Field, Light, fields_of, parse_setting
from sfumato.scene.params import from_json
from sfumato.scene.rig_files import fitted, load_rig
from sfumato.scene.rigs import rig_named, rigs
from sfumato.techniques import techniques

from .errors import UsageError
from .numbers import whole
from .opening import SCENE_SUFFIX

if TYPE_CHECKING:
    TechniqueId: TypeAlias = str
    View: TypeAlias = str
    RigId: TypeAlias = str
else:
    TechniqueId = Literal[tuple(techniques())]
    View = Literal[tuple(STANDARD_VIEWS)]
    RigId = Literal[tuple(rigs())]

LIGHT = Group("The first light")
OWN = Group("The technique's own parameters", help="Each for the techniques named with it.")


def _help(field: Field) -> str:
    param = field.param
    assert param is not None
    # Choices and on/off are shown by the parser.
    told = bool(param.choices) or field.type is bool
    if told:
        return param.meaning
    unset = f"; unless set: {param.none_label}" if field.optional and param.none_label else ""
    return f"{param.meaning} ({param.allowed().removeprefix('allowed: ')}{unset})"


def _light_flag(name: str) -> Any:
    field = fields_of(Light)[name]
    return Annotated[float | None, Parameter(name=f"--{name}", help=_help(field), group=LIGHT)]


@Parameter(name="*")
@dataclass(frozen=True)
class SceneFlags:
    """What the command line changes in a scene; what is not given stays as it is."""

    technique: Annotated[
        TechniqueId | None, Parameter(help="How the volume is lit (see: sfumato techniques).")
    ] = None
    rig: Annotated[
        RigId | None, Parameter(help="A set of lamps, instead of the scene's; the first is the key.")
    ] = None
    rig_file: Annotated[
        Path | None,
        Parameter(help="A rig of one's own, as the window exports it, instead of the scene's lamps."),
    ] = None
    transfer: Annotated[
        str | None,
        Parameter(help="Preset of the transfer function, or a file: its JSON, or a scene that has one."),
    ] = None
    camera: Annotated[View | None, Parameter(help="A standard view.")] = None
    transparent: Annotated[bool, Parameter(negative="", help="Leave the background out.")] = False
    frames: Annotated[
        int | None,
        Parameter(converter=whole, help="Jittered frames to accumulate: more are smoother, and take longer."),
    ] = None
    set: Annotated[
        list[str] | None,
        Parameter(
            name="--set",
            negative="",
            consume_multiple=False,
            help="Set any field of the scene: PATH=VALUE, as in lights.0.tilt=37 (repeatable).",
        ),
    ] = None
    tilt: _light_flag("tilt") = None  # type: ignore[valid-type]
    aperture: _light_flag("aperture") = None  # type: ignore[valid-type]
    rotation: _light_flag("rotation") = None  # type: ignore[valid-type]


@dataclass(frozen=True)
class _Declared:
    """One parameter name, and the techniques that declare it alike."""

    field: Field
    owners: tuple[str, ...]


def declared_parameters() -> dict[str, _Declared]:
    """Return the parameters that may be flags: those that mean one thing, and no other flag's name.

    A name that techniques declare with different types is left to ``--set technique.NAME=…``.
    """
    taken = {f.name for f in dataclasses.fields(SceneFlags)} | {
        "size",
        "mm",
        "dpi",
        "bits",
        "scale_bar",
        "color_bar",
        "orientation_cube",
        "output",
        "linear",
        "auto_exposure",
        "volume",
        "geometry",
        "path",
        "debug",
    }
    found: dict[str, _Declared] = {}
    ambiguous: set[str] = set(taken)
    for technique in techniques().values():
        for name, field in fields_of(technique.params).items():
            if field.param is None or field.kind not in (int, float, bool, str):
                continue
            known = found.get(name)
            if known and (known.field.kind, known.field.param.choices) != (field.kind, field.param.choices):  # type: ignore[union-attr]
                ambiguous.add(name)
            found[name] = _Declared(field, (*(known.owners if known else ()), technique.id))
    return {name: declared for name, declared in found.items() if name not in ambiguous}


def _flag_type(declared: _Declared) -> Any:
    assert declared.field.param is not None
    choices = declared.field.param.choices
    kind = Literal[tuple(choices)] if choices else declared.field.kind
    words = f"{_help(declared.field)}; {', '.join(declared.owners)}"
    name = "--" + declared_flag(declared.field.name)
    converter = whole if kind is int else None
    return Annotated[kind | None, Parameter(name=name, help=words, group=OWN, converter=converter)]


def declared_flag(name: str) -> str:
    """Return a parameter's name as a flag is spelled."""
    return name.replace("_", "-")


#: One optional field for each declared parameter, made from the declarations.
TechniqueFlags = Parameter(name="*")(
    dataclasses.make_dataclass(
        "TechniqueFlags",
        [(name, _flag_type(d), dataclasses.field(default=None)) for name, d in declared_parameters().items()],
        # cyclopts takes a class of the standard library (this one would pass as `types`) as one value.
        namespace={"__module__": __name__},
        frozen=True,
    )
)


def parse_size(text: str) -> tuple[int, int]:
    """Return (width, height) from a text like ``1920x1080``.

    Raises
    ------
    UsageError
        If it is none.
    """
    match = re.fullmatch(r"(\d{1,6})[xX×](\d{1,6})", text)
    if match is None:
        raise UsageError(f"--size {text}: WIDTHxHEIGHT is needed, as in 1920x1080")
    width, height = int(match[1]), int(match[2])
    if not (width and height):
        raise UsageError(f"--size {text}: at least 1x1 is needed")
    return width, height


def changed(scene: Scene, flags: SceneFlags, own: Any, aspect: float) -> Scene:
    """Return the scene as the flags want it; values are checked together, not one by one.

    Raises
    ------
    UsageError
        If a setting is not of the form PATH=VALUE.
    SceneError
        If a path does not exist or a value is not allowed.
    """
    settings = dict(_split(text) for text in flags.set or ())
    technique = flags.technique or settings.pop("technique", None)
    settings.pop("technique", None)
    if technique and technique != scene.technique_id:
        scene = scene.with_(technique=technique)
    if flags.rig:
        scene = scene.with_(lights=rig_named(flags.rig).lights)
    if flags.rig_file:
        if flags.rig:
            raise UsageError("--rig and --rig-file: give one of them")
        kept = load_rig(flags.rig_file).lights
        scene = scene.with_(lights=kept if scene.volume is None else fitted(kept, scene.volume))
    if flags.transfer:
        scene = scene.with_(transfer=transfer_of(scene, flags.transfer))
    if flags.camera:
        scene = scene.with_(camera=view_of(scene, flags.camera, aspect))
    wanted = {path: parse_setting(scene, path, text) for path, text in settings.items()}
    wanted.update(_light_changes(flags))
    wanted.update(_own_changes(scene, own))
    if flags.frames is not None:
        wanted["frames"] = flags.frames
    if flags.transparent:
        wanted["background"] = (*scene.background[:3], 0.0)
    return scene.with_(wanted) if wanted else scene


def _split(setting: str) -> tuple[str, str]:
    path, equals, value = setting.partition("=")
    if not (path and equals):
        raise UsageError(f"--set {setting}: PATH=VALUE is needed, as in lights.0.tilt=37")
    return path.strip(), value.strip()


def _light_changes(flags: SceneFlags) -> dict[str, Any]:
    angles = {name: getattr(flags, name) for name in ("tilt", "aperture", "rotation")}
    return {f"lights.0.{name}": value for name, value in angles.items() if value is not None}


def _own_changes(scene: Scene, own: Any) -> dict[str, Any]:
    given = {name: value for name, value in vars(own).items() if value is not None}
    known = fields_of(type(scene.technique))
    for name in given:
        if name not in known:
            owners = ", ".join(declared_parameters()[name].owners)
            raise UsageError(
                f"--{declared_flag(name)}: {scene.technique_id} has no such parameter; it belongs to {owners}"
            )
    return {f"technique.{name}": value for name, value in given.items()}


def transfer_of(scene: Scene, wanted: str) -> TransferFunction:
    """Return a transfer function by the name of a preset, or from a JSON or scene file.

    Raises
    ------
    LoadError, SceneError
        If there is no such preset or file, or the file holds something else.
    """
    from sfumato.scene.presets import preset

    if Path(wanted).suffix:
        return _transfer_from_file(Path(wanted))
    if scene.volume is None:
        raise SceneError("transfer", wanted, "a file; presets need a volume")
    return preset(wanted, scene.volume).transfer


def _transfer_from_file(path: Path) -> TransferFunction:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise LoadError(path, error.strerror or str(error), "check the path") from None
    except (ValueError, RecursionError) as error:
        raise LoadError(
            path, f"not a transfer function ({error})", "give its JSON, or a scene file"
        ) from None
    if path.suffix.lower() == SCENE_SUFFIX and isinstance(data, dict):
        data = data.get("transfer")
    return from_json(TransferFunction, data, "transfer")


def view_of(scene: Scene, view: str, aspect: float) -> Camera:
    """Return a standard view of what a scene shows, with the lens and projection it has.

    Parameters
    ----------
    aspect : float
        Width of the picture divided by its height.
    """
    from sfumato.scene.presets.visible import outline, seen_cells

    volume, transfer, camera = scene.volume, scene.transfer, scene.camera
    if camera is not None and volume is None and scene.geometry:
        points = np.concatenate([g.bounds for g in scene.geometry])
        box = np.array([points.min(axis=0), points.max(axis=0)])
        return Camera.fit(
            box, view, aspect=aspect,
            view_angle=camera.view_angle, parallel_projection=camera.parallel_projection,
        )  # fmt: skip
    if volume is None or transfer is None or camera is None:
        raise SceneError("camera", view, "a standard view needs a volume")
    cells = seen_cells(volume, transfer)
    points = outline(volume, cells) if cells.any() else volume.corners()
    for plane in scene.clip:
        kept = points @ plane.normal >= np.dot(plane.point, plane.normal)
        points = points[kept] if plane.enabled and kept.any() else points
    return Camera.fit(
        points,
        view,
        aspect=aspect,
        view_angle=camera.view_angle,
        parallel_projection=camera.parallel_projection,
    )


def widened(camera: Camera, aspect: float) -> Camera:
    """Return a camera made for a square picture from which a portrait one (aspect < 1) cuts nothing off."""
    factor = max(1.0, 1.0 / aspect)
    away = np.subtract(camera.position, camera.focal_point) * factor
    x, y, z = np.add(camera.focal_point, away).tolist()
    return dataclasses.replace(camera, position=(x, y, z), parallel_scale=camera.parallel_scale * factor)
