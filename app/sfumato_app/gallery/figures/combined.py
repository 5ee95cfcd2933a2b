"""Figures of Schott2012: streamlines and fibre tracts that share the volume's light."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import Any

from sfumato import (
    Camera,
    ClipPlane,
    Geometry,
    Light,
    Scene,
    Seeds,
    Tracing,
    TransferFunction,
    load,
    load_geometry,
)
from sfumato.geometry import load_field, suggest_seeds, trace
from sfumato_samples import load as sample_volume

from ..figure import Figure, panels
from ..setting import look, still
from .extinction_places import beside

PAPER = "Schott2012"
#: Real tracts and a real flow, where they lie beside the project; else our own pipe takes their place.
DATA = Path(os.environ.get("SFUMATO_DATA", Path(__file__).resolve().parents[5] / "shared" / "data"))
TRACTS = DATA / "tracts_stanford_hardi" / "hardi-lr-superiorfrontal.trk"
SCAN = DATA / "tracts_stanford_hardi" / "sub-01_ses-01_dwi_desc-b0_dwi.nii.gz"
CAROTID = DATA / "carotid_flow" / "carotid.vtk"
FRAMES = 12
LAMP = Light(tilt=37, aperture=22, rotation=135)
#: Intensity of the lamp in pictures without shadows.
WEAKER = 0.5
#: All that casts shadows on what, and contact shadows.
SWITCHES = ("volume_on_volume", "geometry_on_geometry", "geometry_on_volume", "volume_on_geometry")


def _combined(scene: Scene, *, frames: int = FRAMES, **params: Any) -> Scene:
    changes = {f"technique.{name}": value for name, value in {"ambient": 0.1, **params}.items()}
    return still(scene.with_(technique="combined").with_(changes)).with_(frames=frames)


def _without_shadows(scene: Scene) -> Scene:
    """Return a scene shaded by its surfaces alone, as under local lighting.

    What no shadow dims is brighter as a whole: its lamp is weaker, so that nothing burns out.
    """
    unshadowed = _combined(scene, vicinity=0.0, specular=0.3, **dict.fromkeys(SWITCHES, False))
    return unshadowed.with_({f"lights.{k}.intensity": WEAKER for k in range(len(scene.lights))})


# -- the mixing pipe -------------------------------------------------------------------------------
@cache
def _pipe() -> Scene:
    """Return the pipe, cut open, and streamlines through it, coloured by the fluid's temperature."""
    volume, path = sample_volume("pipe"), "sample:pipe"
    field = load_field(path)
    seeds = Seeds(kind="sphere", center=beside((-60.0, 0.0, 0.0), volume.center), radius=19, count=70)
    tracing = Tracing(path=path, seeds=seeds)
    lines = trace(tracing, field)
    lines = Geometry(
        lines.shape, tracing=lines.tracing, kind="streamlines", name=lines.name, radius=0.5, smoothing=2,
        color_by="scalar", scalar="value", colormap="matplotlib:coolwarm", scalar_range=(90, 250),
    )  # fmt: skip
    wall = (0.66, 0.65, 0.62)
    transfer = TransferFunction.from_points(
        [(0, wall, 0.95), (22, wall, 0.9), (34, wall, 0.0), (150, (0.9, 0.55, 0.2), 0.0), (168, (0.95, 0.6, 0.2), 0.05),
         (186, (0.9, 0.55, 0.2), 0.0)], 1.0,
    )  # fmt: skip
    camera = look(volume.center, 66, turn=-12, lift=16)
    return Scene(volume=volume, transfer=transfer, camera=camera, lights=(LAMP,), geometry=(lines,))


def tubes_in_a_pipe() -> Scene:
    """Return the lines in the pipe from near."""
    return _combined(_pipe().with_(camera=_near()))


def figure_1() -> Figure:
    """Streamlines in the mixing pipe."""
    return Figure(
        1,
        "Streamlines in a mixing pipe",
        "Without shadows the lines are a tangle; under one light with the volume one sees which runs before which, how "
        "deep they lie in the pipe, and where the two streams mix (the orange veil).",
        panels(
            (_without_shadows(_pipe()), "no shadows"),
            (_combined(_pipe()), "geometry and volume under one light"),
        ),
        (720, 340),
        PAPER,
    )


def figure_2() -> Figure:
    """Show what casts shadows on what, one more from picture to picture."""
    off = dict.fromkeys(SWITCHES, False)
    steps: list[tuple[dict[str, Any], str]] = [
        ({**off, "volume_on_volume": True, "vicinity": 0.0}, "volume on volume"),
        ({**off, "volume_on_volume": True, "geometry_on_geometry": True}, "... and geometry on geometry"),
        ({"volume_on_geometry": False}, "... and geometry on volume"),
        ({}, "... and volume on geometry"),
    ]
    parts = [(_combined(_pipe().with_(camera=_near()), **changes), note) for changes, note in steps]
    return Figure(
        2,
        "Who casts shadows on whom",
        "Each picture adds one interaction: the baffles' shadows on the wall, the lines' on each other, the lines' on "
        "the wall, and at last the pipe's own on the lines.",
        panels(*parts),
        (380, 340),
        PAPER,
    )


def _near() -> Camera:
    return look(beside((-6.0, 0.0, -2.0), sample_volume("pipe").center), 44, turn=-14, lift=18)


# -- fibre tracts ----------------------------------------------------------------------------------
def _tracts() -> Geometry:
    if TRACTS.is_file():
        tracts = load_geometry(TRACTS)
        return Geometry(
            tracts.shape, str(TRACTS), name=tracts.name, radius=0.45, color_by="direction", fraction=0.5
        )
    return _pipe().geometry[0]


def _tracts_alone() -> Scene:
    scene = Scene(geometry=(_tracts(),), lights=(Light(tilt=30, aperture=45, rotation=135),))
    low, high = _tracts().bounds
    middle = tuple(((low + high) / 2).tolist())
    size = float((high - low)[1:].max())
    return scene.with_(camera=look(middle, 0.85 * size, turn=68, lift=16))


def figure_5() -> Figure:
    """How far contact shadows look: the virtual slice distance."""
    parts = [
        (_combined(_tracts_alone(), show="vicinity", vicinity_distance=mm), f"{mm:g} mm")
        for mm in (1.0, 3.0, 9.0)
    ]
    return Figure(
        5,
        "How far contact shadows look",
        "The paper draws the set-up: within a virtual slice distance, and a disc as wide as the cone is there, what "
        "lies nearer counts. Here is what that does: the term alone, for three distances.",
        panels(*parts),
        (380, 340),
        PAPER,
    )


def figure_6() -> Figure:
    """Show the terms, and the combined term for three cones."""
    scene = _tracts_alone()
    parts: list[tuple[Scene, str]] = []
    terms = (("partial", "the swept term"), ("vicinity", "the vicinity term"), ("occlusion", "both"))
    for (show, note), aperture in zip(terms, (15.0, 30.0, 45.0), strict=True):
        lamp = {"lights.0.aperture": aperture}
        parts += [
            (_combined(scene, show=show, vicinity_distance=4.0), note),
            (_combined(scene.with_(lamp), show="occlusion", vicinity_distance=4.0), "both"),
        ]
    return Figure(
        6,
        "The terms of the light on tracts",
        "On the left of each pair a term by itself: what is swept knows large and far things, the vicinity term fine "
        "and near ones; together they tell the bundle's shape and its fibres. On the right both, for wider cones.",
        panels(*parts),
        (250, 250),
        PAPER,
    )


def figure_7() -> Figure:
    """Fibre tracts in the scan that they were traced in."""
    scene = _tracts_in_scan()
    return Figure(
        7,
        "Fibre tracts in the brain",
        "Tracts of the superior frontal cortex over the b0 scan that they were traced in, cut open. With shadows one "
        "sees how far before the cut the fibres run, and which bundle passes over which.",
        panels(
            (_without_shadows(scene), "no shadows"), (_combined(scene), "geometry and volume under one light")
        ),
        (520, 480),
        PAPER,
    )


def _tracts_in_scan() -> Scene:
    if not (TRACTS.is_file() and SCAN.is_file()):
        return _pipe()
    volume, tracts = load(SCAN), _tracts()
    low, high = tracts.bounds
    x, y, z = ((low + high) / 2).tolist()
    plane = ClipPlane((x, y, z), (-1.0, 0.0, 0.0))
    flesh = (0.64, 0.56, 0.51)
    transfer = TransferFunction.from_points(
        [(220, flesh, 0.0), (420, flesh, 0.7), (1600, (0.9, 0.84, 0.8), 0.9)], 2.0
    )
    shown = Geometry(
        tracts.shape,
        tracts.path,
        name=tracts.name,
        radius=0.45,
        color_by="direction",
        fraction=0.5,
        clipped=False,
    )
    camera = look((x, volume.center[1], volume.center[2] + 8), 165, turn=68, lift=14)
    return Scene(
        volume=volume, transfer=transfer, camera=camera, lights=(LAMP,), geometry=(shown,), clip=(plane,)
    )


# -- a field and its lines -------------------------------------------------------------------------
def figure_8() -> Figure:
    """Lines of a field in the field's strength."""
    scene = _flow()
    return Figure(
        8,
        "Blood flow in the carotid artery",
        "The paper shows the magnetic field of a star; here are streamlines of blood, coloured by its speed, in the "
        "vessels that carry it. Shadows lift the lines off the walls, and tell the branches' order in depth.",
        panels(
            (_without_shadows(scene), "no shadows"), (_combined(scene), "geometry and volume under one light")
        ),
        (520, 420),
        PAPER,
    )


def _flow() -> Scene:
    if not CAROTID.is_file():
        return _pipe()
    volume, field = load(CAROTID), load_field(CAROTID)
    seeds = suggest_seeds(field, 220)
    lines = trace(Tracing(path=str(CAROTID), seeds=seeds, min_speed=0.03), field)
    lines = Geometry(
        lines.shape, tracing=lines.tracing, kind="streamlines", name=lines.name, radius=0.28, color_by="scalar",
        scalar="speed", colormap="magma",
    )  # fmt: skip
    tissue = (0.75, 0.35, 0.28)
    transfer = TransferFunction.from_points(
        [(150, tissue, 0.0), (260, tissue, 0.10), (580, (0.9, 0.6, 0.5), 0.16)], 1.0
    )
    camera = look(volume.center, 56, turn=150, lift=24)
    return Scene(volume=volume, transfer=transfer, camera=camera, lights=(LAMP,), geometry=(lines,))
