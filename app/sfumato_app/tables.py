"""What `info` and `techniques` print."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from sfumato import Geometry, Lines, Scene, Volume
from sfumato.scene import Field, fields_of
from sfumato.scene.geometry import value_range
from sfumato.techniques import Technique, techniques

from .opening import SCENE_SUFFIX

#: World axes in LPS: the letter where a coordinate grows, and where it falls.
LETTERS = (("L", "R"), ("P", "A"), ("S", "I"))


def _console() -> Console:
    """Return a console that does not squeeze what goes to a file or a pipe."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=160)


def orientation_of(volume: Volume) -> str:
    """Return towards which side of the patient the array's axes x, y, z run, as in ``LPS``."""
    if not volume.info.orientation_known:
        return "not known"
    letters = ""
    for axis in range(3):
        column = [volume.direction[row][axis] for row in range(3)]  # type: ignore[index]
        main = max(range(3), key=lambda row: abs(column[row]))
        letters += LETTERS[main][column[main] < 0]
    return letters


def _numbers(values: Any) -> str:
    return " x ".join(f"{v:g}" for v in values)


def volume_rows(volume: Volume) -> list[tuple[str, str]]:
    """Return what there is to say about a volume, as names and values."""
    low, high = volume.value_range
    extent = [n * s for n, s in zip(volume.dims, volume.spacing, strict=True)]
    rows = [
        ("dims", _numbers(volume.dims)),
        ("spacing", _numbers(volume.spacing) + " mm"),
        ("extent", _numbers(round(e, 2) for e in extent) + " mm"),
        ("type", str(volume.data.dtype)),
        ("range", f"{low:g} to {high:g}" + (" HU" if volume.info.modality == "CT" else "")),
        ("modality", volume.info.modality or "not known"),
        ("orientation", orientation_of(volume)),
        ("memory", f"{volume.data.nbytes / 2**20:.1f} MiB"),
    ]
    return rows + [("notice", text) for text in volume.info.notices]


def print_volume(path: str, volume: Volume) -> None:
    """Print what there is to say about a volume."""
    table = Table(show_header=False, box=None, title=volume.info.name or path, title_justify="left")
    for name, value in volume_rows(volume):
        table.add_row(name, value)
    _console().print(table)


def geometry_rows(geometry: Geometry) -> list[tuple[str, str]]:
    """Return what there is to say about tracts or a mesh, as names and values."""
    shape = geometry.shape
    rows = [("kind", geometry.kind)]
    if isinstance(shape, Lines):
        low, mean, high = shape.lengths.min(), shape.lengths.mean(), shape.lengths.max()
        rows += [("lines", str(shape.count)), ("lengths", f"{low:.4g} to {high:.4g} mm, mean {mean:.4g} mm")]
    else:
        rows.append(("triangles", str(shape.count)))
    rows += [
        ("points", str(len(shape.points))),
        ("from", "{:.5g}, {:.5g}, {:.5g} mm (LPS)".format(*shape.bounds[0])),
        ("to", "{:.5g}, {:.5g}, {:.5g} mm".format(*shape.bounds[1])),
        ("memory", f"{shape.nbytes / 2**20:.1f} MiB"),
    ]
    for name in geometry.scalar_names:
        rows.append(("scalar", "{}: {:g} to {:g}".format(name, *value_range(geometry.scalar_values(name)))))
    return rows + [("notice", text) for text in geometry.notices]


def print_geometry(path: str, geometry: Geometry) -> None:
    """Print what there is to say about tracts or a mesh."""
    table = Table(show_header=False, box=None, title=geometry.name or path, title_justify="left")
    for name, value in geometry_rows(geometry):
        table.add_row(name, value)
    _console().print(table)


def print_series(folder: str) -> None:
    """Print the DICOM series in a folder, where there are several to choose from."""
    from sfumato.io import find_series

    found = find_series(folder)
    if len(found) < 2:
        return
    table = Table(box=None, pad_edge=False)
    for heading in ("--series", "what", "dims"):
        table.add_column(heading)
    for place, series in enumerate(found):
        table.add_row(str(place), series.label, _numbers(series.dims))
    console = _console()
    console.print()
    console.print(table)


def scene_data(path: str) -> dict[str, Any]:
    """Return the scene in a scene file or in a picture of ours, checked, as JSON data.

    Raises
    ------
    LoadError, SceneError
        If it cannot be read, or holds what a scene may not hold.
    """
    from sfumato import LoadError
    from sfumato.export.png import read_scene_data

    if Path(path).suffix.lower() != SCENE_SUFFIX:
        data = read_scene_data(path)
    else:
        try:
            data = json.loads(Path(path).read_text(encoding="utf-8"))
        except OSError as error:
            raise LoadError(path, error.strerror or str(error), "check the path") from None
        except (ValueError, RecursionError) as error:
            raise LoadError(path, f"not a scene file ({error})", "open a .sfumato file") from None
    # What its geometry shows lies in other files: that is not what is asked here.
    Scene.from_json({**data, "geometry": []} if isinstance(data, dict) else data)
    return data


def _parameter_data(field: Field) -> dict[str, Any]:
    param = field.param
    assert param is not None
    return {
        "name": field.name,
        "meaning": param.meaning,
        "unit": param.unit,
        "allowed": param.allowed().removeprefix("allowed: ") + (", or none" if field.optional else ""),
        "default": field.default,
        "none": param.none_label,
        "source": param.source,
    }


def _technique_data(technique: Technique) -> dict[str, Any]:
    declared = [f for f in fields_of(technique.params).values() if f.param is not None]
    return {
        "id": technique.id,
        "title": technique.title,
        "summary": technique.summary,
        "source": technique.source,
        "parameters": [_parameter_data(f) for f in declared],
    }


def techniques_data() -> list[dict[str, Any]]:
    """Return all techniques with their parameters as JSON data."""
    return [_technique_data(t) for t in techniques().values()]


def print_techniques() -> None:
    """Print the table of techniques and their parameters."""
    table = Table(box=None, pad_edge=False)
    for heading in ("technique, parameter", "meaning", "unit", "allowed", "default", "source"):
        table.add_column(heading, overflow="fold")
    for technique in techniques_data():
        table.add_row(technique["id"], technique["summary"], "", "", "", technique["source"], style="bold")
        for p in technique["parameters"]:
            allowed = str(p["allowed"]).removeprefix("one of ")
            default = f"none ({p['none']})" if p["default"] is None and p["none"] else str(p["default"])
            table.add_row(f"  {p['name']}", p["meaning"], p["unit"], allowed, default, p["source"])
        table.add_section()
    _console().print(table)
