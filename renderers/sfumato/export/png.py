"""PNG pictures that carry the scene they show, so that every picture can be opened and changed again.

The scene is JSON in an ``iTXt`` chunk with the keyword ``sfumato-scene``:
``{"program": "sfumato 0.1.0", "scene": {…}}``. The scene names its volume by content hash and file name;
folders, which can tell more than a picture should, are left out. So are the names of DICOM files and of
folders, which are often a patient's: such slices are looked for beside the picture by their content alone.
A TIFF of ours carries the same text as its description.
"""

from __future__ import annotations

import contextlib
import json
import os
import struct
import zlib
from collections.abc import Sequence
from itertools import islice
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, BinaryIO

import numpy as np

from ..errors import LoadError, SceneError
from ..scene import Scene, Volume
from ..scene.geometry import with_paths
from .atomic import replacing
from .streams import KEYWORD, PngStream
from .tiff_text import MAGIC, MAX_TEXT, is_tiff_of_ours, read_tiff_text

SAMPLE = "sample:"
#: Folders beside a picture in which a volume without a name is looked for.
MAX_FOLDERS = 32
#: File name endings of pictures that may carry a scene.
TIFF_SUFFIXES = (".tif", ".tiff")


def write_png(
    path: str | os.PathLike[str], picture: np.ndarray, scene: Scene | None = None, dpi: float | None = None
) -> None:
    """Write a picture, atomically, with its scene.

    Parameters
    ----------
    picture : ndarray, shape (height, width, 4), uint8 or uint16
        sRGB, straight alpha, the top row first; as from `sfumato.render`.
    scene : Scene, optional
        What the picture shows.
    dpi : float, optional
        Pixels per inch, which the file tells the printer.

    Raises
    ------
    SceneError
        If the array is not such a picture.
    SfumatoError
        If the file cannot be written.
    """
    bits = {np.dtype(np.uint8): 8, np.dtype(np.uint16): 16}.get(picture.dtype)
    if bits is None or picture.ndim != 3 or picture.shape[2] != 4 or picture.size == 0:
        raise SceneError(
            "picture",
            f"array of shape {picture.shape} and type {picture.dtype}",
            "uint8 or uint16 of shape (height, width, 4)",
        )
    height, width = picture.shape[:2]
    with replacing(path) as part, open(part, "wb") as file:
        stream = PngStream(file, (width, height), bits, scene_text(scene) if scene is not None else "", dpi)
        stream.write(picture)
        stream.close()


def scene_text(scene: Scene) -> str:
    """Return the JSON that goes into a picture: the scene, without what may name a person or a place."""
    from .. import __version__

    data = scene.to_json()
    volume = data["volume"]
    if isinstance(volume, dict) and volume.get("path"):
        volume["path"] = "" if _may_name_a_patient(volume["path"]) else _file_name(volume["path"])
    data["geometry"] = [with_paths(part, _file_name) for part in data["geometry"]]
    return json.dumps({"program": f"sfumato {__version__}", "scene": data})


def read_scene_data(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the JSON data of the scene that a picture carries.

    Raises
    ------
    LoadError
        If the file is not a PNG (or TIFF) of ours.
    """
    try:
        with open(path, "rb") as stream:
            tiff = stream.read(4) == MAGIC
            stream.seek(0)
            text = read_tiff_text(stream) if tiff else _find_text(stream)
    except OSError as error:
        raise LoadError(path, error.strerror or str(error), "check the path") from None
    except struct.error:
        raise LoadError(path, "this picture ends too soon", "open a picture that Sfumato wrote") from None
    except (ValueError, zlib.error) as error:
        raise LoadError(path, f"not a readable PNG ({error})", "open a picture that Sfumato wrote") from None
    if text is None:
        raise LoadError(
            path, "this picture carries no scene", "open a picture that Sfumato wrote, or a volume"
        )
    try:
        data = json.loads(text)["scene"]
    except (ValueError, KeyError, TypeError, RecursionError):
        data = None
    if not isinstance(data, dict):
        raise LoadError(path, "the scene in this picture is damaged", "open the volume instead")
    return data


def _find_text(stream: BinaryIO) -> str | None:
    """Return our text from the chunks before the pixels, which are left alone: they may be many."""
    if stream.read(8) != b"\x89PNG\r\n\x1a\n":
        raise ValueError("it does not begin as one")
    while True:
        length, kind = struct.unpack(">I4s", stream.read(8))
        if kind in (b"IDAT", b"IEND"):
            return None
        if kind != b"iTXt" or length > MAX_TEXT:
            stream.seek(length + 4, os.SEEK_CUR)
            continue
        payload = stream.read(length)
        if struct.unpack(">I", stream.read(4))[0] != zlib.crc32(kind + payload):
            raise ValueError("a checksum is wrong")
        keyword, _, rest = payload.partition(b"\0")
        if keyword == KEYWORD.encode():
            return _itxt_text(rest)


def _itxt_text(rest: bytes) -> str:
    """Return the text of an iTXt chunk from what follows its keyword (PNG specification, 11.3.4.5)."""
    packed, (_, _, text) = rest[:1] == b"\1", rest[2:].split(b"\0", 2)
    if packed:
        inflate = zlib.decompressobj()
        text = inflate.decompress(text, MAX_TEXT)
        if inflate.unconsumed_tail:
            raise ValueError("its text is too long")
    return text.decode("utf-8")


def carries_scene(path: str | os.PathLike[str]) -> bool:
    """Tell whether a file is to be opened as a picture with its scene: a PNG, or a TIFF that we wrote."""
    suffix = Path(path).suffix.lower()
    if Path(path).is_dir():
        return False
    return suffix == ".png" or (suffix in TIFF_SUFFIXES and is_tiff_of_ours(path))


def open_png(
    path: str | os.PathLike[str],
    volume: Volume | None = None,
    places: Sequence[str | os.PathLike[str]] = (),
) -> Scene:
    """Return the scene that a picture carries, with its volume, which is looked for beside the picture.

    Parameters
    ----------
    volume : Volume, optional
        Use this volume instead of the one that the scene names.
    places : sequence of path
        Folders in which a volume that is not beside the picture is looked for, by its content.

    Raises
    ------
    LoadError
        If the picture carries no scene, or its volume is not there or another one.
    SceneError
        If the scene holds something that a scene may not hold.
    """
    data = read_scene_data(path)
    if volume is None and data.get("volume"):
        volume = _volume_beside(Path(path), data["volume"], places)
    if isinstance(data.get("geometry"), list):
        # As with the volume: only ever names beside the picture.
        folder = Path(path).parent
        data["geometry"] = [
            with_paths(g, lambda p: p if p.startswith(SAMPLE) else str(folder / _file_name(p)))
            for g in data["geometry"]
        ]
    return Scene.from_json(data, volume)


def _volume_beside(picture: Path, reference: Any, places: Sequence[str | os.PathLike[str]] = ()) -> Volume:
    from ..io import MissingVolume, find_moved, load_known

    named, key = (reference.get(k) for k in ("path", "hash")) if isinstance(reference, dict) else (None, None)
    key = key if isinstance(key, str) else None
    if not isinstance(named, str) or not (named or key):
        raise LoadError(
            picture, "the scene in this picture does not say where its volume is", "name the volume too"
        )
    if not named:
        return _unnamed_beside(picture, str(key))
    # Only ever a name beside the picture: what a stranger's picture says is no path to follow.
    name = _file_name(named)
    place: str | Path = name if name.startswith(SAMPLE) else picture.parent / name
    if isinstance(place, Path) and not place.exists():
        if key:
            with contextlib.suppress(MissingVolume):
                return find_moved(place, key, [picture.parent, *places])
        raise MissingVolume(
            picture, f"its volume {name!r} is not beside it", "put it there, or name the volume too"
        )
    return load_known(place, key)


def _unnamed_beside(picture: Path, key: str) -> Volume:
    """Return the DICOM volume or stack of slices with a key from the picture's folder or a folder beside it."""
    from ..io import MissingVolume, load_known

    here = picture.parent
    folders = sorted(p for p in here.iterdir() if p.is_dir())
    for place in [here, *folders][:MAX_FOLDERS]:
        if _holds_slices(place):
            try:
                return load_known(place, key)
            except LoadError:
                continue
    raise MissingVolume(
        picture, "its slices are not beside it", "put the picture beside their folder, or name it too"
    )


def _holds_slices(place: Path) -> bool:
    """Tell whether a folder holds DICOM files, or two pictures of one kind; others are not worth a try."""
    from ..io.tiff import SLICE_SUFFIXES

    try:
        files = [p for p in islice(place.iterdir(), 64) if p.is_file()]
    except OSError:
        return False
    kinds = [p.suffix.lower() for p in files]
    return any(kinds.count(kind) > 1 for kind in SLICE_SUFFIXES) or any(map(_is_dicom, files[:8]))


def _is_dicom(path: Path) -> bool:
    from ..io.dicom_header import is_dicom

    try:
        return is_dicom(path)
    except OSError:
        return False


def _may_name_a_patient(path: str) -> bool:
    """Tell whether a volume was read from DICOM files, or from a folder that is no store of arrays."""
    if path.startswith(SAMPLE):
        return False
    place = Path(path)
    if place.is_dir():
        return place.suffix.lower() != ".zarr"
    return place.suffix.lower() in ("", ".dcm", ".dicom", ".ima") or (place.is_file() and _is_dicom(place))


def _file_name(path: str) -> str:
    if path.startswith(SAMPLE):
        return path
    return PureWindowsPath(PurePosixPath(path).name).name
