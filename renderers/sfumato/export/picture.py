"""A scene as a picture file for print, of any size, in bounded memory, with progress and cancel."""

from __future__ import annotations

import dataclasses
import math
import os
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import SceneError, SfumatoError
from ..scene import Camera, Scene
from .atomic import replacing
from .color_bars import BarsInk
from .encode import encode16
from .ink import Ink
from .orientation_cube import CubeInk
from .png import scene_text
from .scale_bar import ScaleBar
from .streams import PictureStream, PngStream, TiffStream
from .tiles import TILE_PIXELS, TILE_SIDE, Guest, Tile, accumulate, bands_of

if TYPE_CHECKING:
    from ..renderer import Renderer

#: File name endings and how their files are written.
STREAMS: dict[str, type[PngStream | TiffStream]] = {
    ".png": PngStream,
    ".tif": TiffStream,
    ".tiff": TiffStream,
}
MAX_SIDE = 32768
MAX_PIXELS = 400_000_000
MM_PER_INCH = 25.4


@dataclass(frozen=True)
class PictureSpec:
    """What a picture file shall be.

    Parameters
    ----------
    size : (int, int)
        Width and height in pixels.
    bits : int
        8 or 16 for each channel.
    dpi : float, optional
        Pixels per inch, which the file tells the printer.
    frames : int, optional
        Jittered frames to accumulate; the scene's if not given.
    scale_bar : bool
        Draw a scale bar; needs an orthographic view.
    color_bars : bool
        Draw the colour bars of geometry that is coloured by a scalar, if there is any.
    orientation_cube : bool
        Draw a cube that tells the patient's sides, if there is room.

    Raises
    ------
    SceneError
        If a value is not possible.
    """

    size: tuple[int, int]
    bits: int = 8
    dpi: float | None = None
    frames: int | None = None
    scale_bar: bool = False
    color_bars: bool = False
    orientation_cube: bool = False

    def __post_init__(self) -> None:
        width, height = self.size
        if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE and width * height <= MAX_PIXELS):
            allowed = f"1 to {MAX_SIDE} pixels on a side, at most {MAX_PIXELS // 10**6} megapixels"
            raise SceneError("size", self.size, allowed)
        if self.bits not in (8, 16):
            raise SceneError("bits", self.bits, "8 or 16")
        if self.dpi is not None and not 1 <= self.dpi <= 10_000:
            raise SceneError("dpi", self.dpi, "1 to 10000 pixels per inch")

    @staticmethod
    def printed(millimetres: tuple[float, float], dpi: float = 300, **more: object) -> PictureSpec:
        """Return the picture of a size in mm on paper."""
        width, height = (pixels_of(length, dpi) for length in millimetres)
        return PictureSpec((width, height), dpi=dpi, **more)  # type: ignore[arg-type]

    @property
    def memory(self) -> int:
        """Bytes that drawing it takes, without the volume: one band of it, and a tile's float pictures."""
        tile = bands_of(self.size)[0][0]
        band = self.size[0] * tile.height * self.bits // 2
        return band + tile.width * tile.height * 16 * (5 if self.bits == 8 else 8)


def pixels_of(millimetres: float, dpi: float) -> int:
    """Return a length on paper in whole pixels, at least one.

    Raises
    ------
    SceneError
        If it is not a finite length.
    """
    if not (math.isfinite(millimetres) and millimetres > 0 and math.isfinite(dpi) and dpi > 0):
        raise SceneError(
            "size", (millimetres, dpi), "a positive length in mm and a positive resolution in dpi"
        )
    return max(1, round(millimetres / MM_PER_INCH * dpi))


def framed(camera: Camera, seen: float, wanted: float) -> Camera:
    """Return the camera for a picture of another shape that still shows all that was seen.

    Parameters
    ----------
    seen, wanted : float
        Width over height of the picture in which the camera was set up, and of the new one.
    """
    factor = seen / wanted
    if factor <= 1:
        return camera
    center = camera.window_center[0], camera.window_center[1] / factor
    if camera.parallel_projection:
        return dataclasses.replace(
            camera, parallel_scale=camera.parallel_scale * factor, window_center=center
        )
    tangent = math.tan(math.radians(camera.view_angle) / 2) * factor
    angle = min(math.degrees(2 * math.atan(tangent)), 169.0)
    return dataclasses.replace(camera, view_angle=angle, window_center=center)


def write_picture(
    path: str | os.PathLike[str],
    scene: Scene,
    spec: PictureSpec,
    *,
    carried: Scene | None = None,
    renderer: Renderer | None = None,
    guest: Guest | None = None,
    tile_side: int = TILE_SIDE,
    tile_pixels: int = TILE_PIXELS,
) -> Generator[float, None, None]:
    """Draw a scene to a PNG or TIFF file, yielding progress (0 to 1); stop iterating to cancel it.

    The file takes its place only when it is whole; until then nothing is there, and nothing is left.

    Parameters
    ----------
    path : path
        Ends in ``.png``, ``.tif`` or ``.tiff``.
    carried : Scene, optional
        The scene that goes into the file; `scene` if not given.
    renderer : Renderer, optional
        The calling thread's own, if not given.
    guest : Guest, optional
        Who else may use the renderer in between.
    tile_side, tile_pixels : int
        Longest side and largest area of a tile.

    Raises
    ------
    SceneError
        If the scene has no volume, or a scale bar does not go with it.
    SfumatoError
        If the ending is another, or the file cannot be written.
    GpuError
        If the device cannot do it.
    """
    from ..renderer import renderer_of_this_thread

    stream_of = STREAMS.get(Path(path).suffix.lower())
    if stream_of is None:
        raise SfumatoError(f"{path}: pictures end in {', '.join(STREAMS)}")
    if scene.camera is None:
        raise SceneError("volume", None, "a scene needs a volume or geometry to be drawn")
    inks = _inks(scene, scene.camera, spec)
    text = scene_text(carried or scene)
    bands = bands_of(spec.size, tile_side, tile_pixels)
    with replacing(path) as part, open(part, "wb") as file:
        stream: PictureStream = stream_of(file, spec.size, spec.bits, text, spec.dpi)
        yield from _draw(renderer or renderer_of_this_thread(), scene, spec, bands, stream, inks, guest)
        stream.close()
        file.flush()
        os.fsync(file.fileno())


def _inks(scene: Scene, camera: Camera, spec: PictureSpec) -> list[Ink]:
    """Return what is drawn over the picture."""
    inks: list[Ink] = []
    if spec.scale_bar:
        inks.append(ScaleBar.for_picture(camera, spec.size, spec.dpi))
    if spec.color_bars and (bars := BarsInk.for_picture(scene, spec.size, spec.dpi)) is not None:
        inks.append(bars)
    if spec.orientation_cube:
        known = scene.volume is None or scene.volume.info.orientation_known
        if (cube := CubeInk.for_picture(camera, spec.size, spec.dpi, known)) is not None:
            inks.append(cube)
    return inks


def _draw(
    renderer: Renderer,
    scene: Scene,
    spec: PictureSpec,
    bands: tuple[tuple[Tile, ...], ...],
    stream: PictureStream,
    inks: Sequence[Ink],
    guest: Guest | None,
) -> Generator[float, None, None]:
    """Draw band after band into a stream."""
    total, done = spec.size[0] * spec.size[1], 0
    for band in bands:
        top, height = band[0].y, band[0].height
        rows = np.empty((height, spec.size[0], 4), dtype=np.uint8 if spec.bits == 8 else np.uint16)
        for tile in band:
            area = tile.width * tile.height
            pixels = yield from _tile(renderer, scene, spec, tile, (done / total, area / total), guest)
            rows[:, tile.x : tile.x + tile.width] = pixels
            done += area
        for ink in inks:
            ink.draw_on(rows, top)
        stream.write(rows)


def _tile(
    renderer: Renderer,
    scene: Scene,
    spec: PictureSpec,
    tile: Tile,
    share: tuple[float, float],
    guest: Guest | None,
) -> Generator[float, None, np.ndarray]:
    """Draw a tile, whose share of the progress is given by its start and length; returns its final pixels."""
    accumulation = renderer.begin(scene, spec.size, part=(tile.x, tile.y, tile.width, tile.height))
    try:
        for done in accumulate(accumulation, spec.frames or scene.frames, guest):
            yield share[0] + share[1] * done
        if spec.bits == 8:
            return accumulation.picture()
        return encode16(accumulation.linear(), scene.exposure, scene.white_balance, scene.tone_curve)
    finally:
        accumulation.release()
        renderer.device.collect()
