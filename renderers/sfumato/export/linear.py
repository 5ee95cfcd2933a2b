"""Linear pictures (before exposure and tone mapping) for compositing: OpenEXR, or a NumPy array."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from ..errors import SfumatoError
from ..scene import Scene
from .atomic import replacing
from .png import scene_text
from .streams import KEYWORD

#: File name endings of linear pictures.
LINEAR_SUFFIXES = (".exr", ".npy")


def write_linear(path: str | os.PathLike[str], picture: np.ndarray, scene: Scene | None = None) -> None:
    """Write a linear picture, atomically, as OpenEXR or ``.npy``, by the file's ending.

    Parameters
    ----------
    picture : ndarray, shape (height, width, 4), float32
        Linear light, Rec. 709 primaries, premultiplied alpha, the top row first.
    scene : Scene, optional
        What it shows; kept in the OpenEXR header as in our PNG.

    Raises
    ------
    SfumatoError
        If the ending is another, the file cannot be written, or OpenEXR is not installed.
    """
    suffix = Path(path).suffix.lower()
    # OpenEXR writes non-contiguous arrays wrong without a word.
    pixels = np.ascontiguousarray(picture, dtype=np.float32)
    if suffix == ".npy":
        with replacing(path) as part:
            np.save(part, pixels)
    elif suffix == ".exr":
        with replacing(path) as part:
            _write_exr(part, pixels, scene)
    else:
        raise SfumatoError(f"{path}: linear pictures end in {' or '.join(LINEAR_SUFFIXES)}")


def _write_exr(path: Path, pixels: np.ndarray, scene: Scene | None) -> None:
    try:
        import OpenEXR
    except ImportError:
        raise SfumatoError("OpenEXR is not installed; install sfumato[io], or write .npy") from None
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    if scene is not None:
        header[KEYWORD] = scene_text(scene)
    try:
        OpenEXR.File(header, {"RGBA": pixels}).write(str(path))
    except RuntimeError as error:
        raise OSError(str(error)) from None
