"""The command line: what each command is called and takes; the work is done in the modules beside it."""

from __future__ import annotations

import importlib
import json
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

import sfumato

from .errors import UsageError
from .flags import SceneFlags, TechniqueFlags, changed, widened
from .opening import ReadFlags
from .printing import PrintFlags

HELP = "Light for volumes: the window on PATH, or on the embedded sample."
EPILOGUE = (
    "--debug with any command shows tracebacks. Exit status: 0 done, 1 bad input or device, 2 wrong usage."
)
#: Size in pixels of the picture that `info --gpu` draws.
GPU_SIZE = (960, 720)

app = App(
    name="sfumato",
    help=HELP,
    help_epilogue=EPILOGUE,
    version=sfumato.__version__,
    help_format="plaintext",
    suppress_keyboard_interrupt=False,
    result_action="return_value",
)


@app.default
def window(
    path: Annotated[
        str | None,
        Parameter(help="A volume, a DICOM folder, tracts, a mesh, a scene file, or a picture of ours."),
    ] = None,
    /,
) -> int:
    """Show the window; without a screen, draw the same picture to sfumato-sample.png."""
    from .window import show

    return show(path)


@app.command
def render(
    path: Annotated[
        str, Parameter(help="A volume, a DICOM folder, tracts, a mesh, a scene file, or a picture of ours.")
    ],
    /,
    *,
    output: Annotated[
        Path | None,
        Parameter(
            name=["--output", "-o"], help="The picture: .png or .tif (default: PATH's name with .png, here)."
        ),
    ] = None,
    linear: Annotated[
        bool, Parameter(negative="", help="Linear light, before exposure, to .exr or .npy.")
    ] = False,
    volume: Annotated[
        str | None, Parameter(help="The volume to use instead of the one that a scene or picture names.")
    ] = None,
    geometry: Annotated[
        list[str] | None,
        Parameter(
            negative="",
            consume_multiple=False,
            help="Tracts or a mesh to add: TRK, TCK, TRX, VTP, VTK, STL, PLY, OBJ (repeatable).",
        ),
    ] = None,
    auto_exposure: Annotated[
        bool,
        Parameter(negative="", help="Expose so that bright parts have the brightness of their own colour."),
    ] = False,
    file: PrintFlags = PrintFlags(),  # noqa: B008
    read: ReadFlags = ReadFlags(),  # noqa: B008
    flags: SceneFlags = SceneFlags(),  # noqa: B008
    own: TechniqueFlags = TechniqueFlags(),  # type: ignore[valid-type]  # noqa: B008
) -> None:
    """Draw a picture without a window."""
    from .drawing import draw, target_of
    from .opening import geometry_notices, is_scene, open_scene, with_geometry

    spec = file.spec()
    target, linear = target_of(path, output, linear)
    if linear and file.only_for_print:
        raise UsageError(f"{', '.join(file.only_for_print)}: not for linear pictures")
    aspect = spec.size[0] / spec.size[1]
    scene = with_geometry(open_scene(path, volume, read), geometry or [])
    for notice in geometry_notices(scene):
        print(notice, file=sys.stderr)
    if not is_scene(path) and scene.camera is not None:
        scene = scene.with_(camera=widened(scene.camera, aspect))
    scene = changed(scene, flags, own, aspect)
    if auto_exposure:
        from sfumato.exposure import automatic_exposure

        scene = scene.with_(exposure=automatic_exposure(scene))
    print(draw(scene, spec, target, linear))


@app.command
def info(
    path: Annotated[
        str, Parameter(help="A volume, a DICOM folder, tracts, a mesh, a scene file, or a picture of ours.")
    ],
    /,
    *,
    gpu: Annotated[
        bool,
        Parameter(
            negative="", help="Draw it, and list what is on the GPU then (budget: SFUMATO_GPU_BUDGET_MB)."
        ),
    ] = False,
    read: ReadFlags = ReadFlags(),  # noqa: B008
) -> None:
    """Tell what a volume, tracts or a mesh are; of a scene file or a picture of ours, its scene."""
    from sfumato.geometry import is_geometry

    from .opening import is_scene, open_scene, open_volume
    from .tables import print_geometry, print_series, print_volume, scene_data

    if gpu:
        from .gpu_listing import print_gpu

        print_gpu(open_scene(path, None, read), GPU_SIZE)
    elif is_scene(path):
        print(json.dumps(scene_data(path), indent=1))
    elif is_geometry(path):
        print_geometry(path, sfumato.load_geometry(path))
    else:
        print_volume(path, open_volume(path, read))
        if read.series is None and Path(path).is_dir():
            print_series(path)


@app.command(name="techniques")
def list_techniques(
    *, json_: Annotated[bool, Parameter(name="--json", negative="", help="As JSON.")] = False
) -> None:
    """List the techniques and their parameters: units, ranges, defaults, sources."""
    from .tables import print_techniques, techniques_data

    if json_:
        print(json.dumps(techniques_data(), indent=1))
    else:
        print_techniques()


#: Commands with a command line of their own: name, module with ``main(arguments) -> int``, what they do.
PROGRAMS = (
    ("bench", "bench", "Measure the techniques on this machine."),
    ("contact-sheet", "contact_sheet", "Draw every volume in a folder of data sets to one labelled sheet."),
    ("first-minute", "first_minute", "Measure when a volume dropped on the window is seen."),
    ("gallery", "gallery", "Draw the gallery: the figures of Soltesova2010 with our samples."),
    ("quality", "quality", "Measure how near shadows are to the ray-traced cone."),
    ("walkthrough", "walkthrough", "Use the window by real events, with a screenshot of each step."),
)


def _add_program(name: str, module: str, meaning: str) -> None:
    def program(*arguments: Annotated[str, Parameter(allow_leading_hyphen=True)]) -> int:
        return int(importlib.import_module(f"{__package__}.{module}").main(list(arguments)) or 0)

    program.__doc__ = meaning
    # Their help is their own: --help goes through.
    app.command(program, name=name, help_flags=[], version_flags=[])


for _name, _module, _meaning in PROGRAMS:
    if find_spec(f"{__package__}.{_module}") is not None:
        _add_program(_name, _module, _meaning)
