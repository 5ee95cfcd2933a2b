"""A figure to one picture: panels side by side on white, each above its letter."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from sfumato import Scene, SfumatoError, Volume, render
from sfumato.colorimetry import cielab

from .explicit import draw_explicit
from .figure import Cuts, Difference, Explicit, Figure, Panel

#: Share of a panel's height for gaps and for the line of letters.
GAP, LINE = 0.025, 0.075
SHEET, INK = (255, 255, 255), (40, 40, 44)
#: Of the cuts: the screen, and the lines that show where the others lie, one colour an axis (x, y, z).
SCREEN = (18, 19, 21)
AXIS_COLORS = ((214, 92, 84), (104, 178, 96), (92, 140, 220))


def draw_figure(figure: Figure, scale: float = 1.0, frames: int | None = None) -> Image.Image:
    """Draw a figure.

    Parameters
    ----------
    scale : float
        Of the panels' sides.
    frames : int, optional
        Jittered frames of each panel; the scenes' own number if not given.
    """
    width, height = (max(8, round(side * scale)) for side in figure.size)
    gap, line = max(2, round(height * GAP)), max(9, round(height * LINE))
    across = figure.columns or len(figure.panels)
    rows = -(-len(figure.panels) // across)
    sheet = Image.new("RGB", (across * width + (across - 1) * gap, rows * (height + line)), SHEET)
    pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(line * 0.58)
    for number, panel in enumerate(figure.panels):
        left, top = number % across * (width + gap), number // across * (height + line)
        sheet.paste(draw_panel(panel, (width, height), frames), (left, top))
        middle = left + width / 2, top + height + line / 2
        pen.text(middle, f"({panel.label})", fill=INK, font=font, anchor="mm")
    return sheet


def draw_panel(panel: Panel, size: tuple[int, int], frames: int | None = None) -> Image.Image:
    """Draw a panel at a size in pixels."""
    if isinstance(panel.picture, Cuts):
        return draw_cuts(panel.picture, size)
    if isinstance(panel.picture, Difference):
        return draw_difference(panel.picture, size, frames)
    if isinstance(panel.picture, Explicit):
        return Image.fromarray(draw_explicit(_with_frames(panel.picture.scene, frames), size))
    return Image.fromarray(np.ascontiguousarray(render(_with_frames(panel.picture, frames), size)[..., :3]))


def _with_frames(scene: Scene, frames: int | None) -> Scene:
    return scene if frames is None else scene.with_(frames=frames)


def draw_difference(difference: Difference, size: tuple[int, int], frames: int | None = None) -> Image.Image:
    """Draw how far a scene's picture is from another's."""
    looks = []
    for scene in (difference.scene, difference.truth):
        looks.append(cielab(np.clip(render(_with_frames(scene, frames), size, linear=True)[..., :3], 0, 1)))
    away = np.linalg.norm(looks[0] - looks[1], axis=-1)
    return Image.fromarray(np.uint8(np.rint(255 * np.clip(away / difference.white, 0, 1)))).convert("RGB")


def save(picture: Image.Image, path: Path) -> int:
    """Write a picture as PNG, small; return its size in bytes.

    Raises
    ------
    SfumatoError
        If it cannot be written.
    """
    try:
        picture.save(path, optimize=True)
        return path.stat().st_size
    except OSError as error:
        raise SfumatoError(f"{path}: the picture could not be written: {error.strerror or error}") from None


def draw_cuts(cuts: Cuts, size: tuple[int, int]) -> Image.Image:
    """Draw the three cuts in quarters of a screen, with lines where the others lie."""
    screen = Image.new("RGB", size, SCREEN)
    edge = size[0] * 3 // 5
    # The cut across y fills the left; across x above and across z below stand on the right.
    rooms = ((1, 0, 2, (0, 0, edge, size[1])), (0, 1, 2, (edge, 0, size[0], size[1] // 2)),
             (2, 0, 1, (edge, size[1] // 2, size[0], size[1])))  # fmt: skip
    for across, right, down, (left, top, end, bottom) in rooms:
        tile = _cut(cuts, across, right, down, (end - left, bottom - top))
        screen.paste(tile, ((left + end - tile.width) // 2, (top + bottom - tile.height) // 2))
    return screen


def _cut(cuts: Cuts, across: int, right: int, down: int, room: tuple[int, int]) -> Image.Image:
    """Draw the cut across an axis; ``down`` 1 is the array's y, drawn downwards, 2 its z, upwards."""
    volume = cuts.volume
    index = min(int(cuts.at[across] * volume.dims[across]), volume.dims[across] - 1)
    values = np.take(volume.data, index, axis=2 - across).astype(float)
    values = values if down == 1 else values[::-1]
    low, high = cuts.window
    grey = np.uint8(255 * np.clip((values - low) / (high - low), 0, 1))
    wide, tall = _extent(volume, right), _extent(volume, down)
    zoom = 0.94 * min(room[0] / wide, room[1] / tall)
    side = max(1, round(wide * zoom)), max(1, round(tall * zoom))
    tile = Image.fromarray(grey).resize(side, Image.Resampling.BICUBIC).convert("RGB")
    pen = ImageDraw.Draw(tile)
    x = cuts.at[right] * side[0]
    y = (cuts.at[down] if down == 1 else 1 - cuts.at[down]) * side[1]
    pen.line([(x, 0), (x, side[1])], fill=AXIS_COLORS[right])
    pen.line([(0, y), (side[0], y)], fill=AXIS_COLORS[down])
    pen.rectangle([0, 0, side[0] - 1, side[1] - 1], outline=AXIS_COLORS[across])
    return tile


def _extent(volume: Volume, axis: int) -> float:
    return volume.dims[axis] * volume.spacing[axis]
