"""How a slice view looks: the slice on neutral grey, the cross-hair, what cuts the picture, names and letters."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QImage, QPainter, QPen

from sfumato import Scene, Volume
from sfumato.scene import ClipPlane, CropBox
from sfumato.slicing import Cut, Frame

from .. import overlay
from ..clip_planes import unit, vec
from ..lamp_places import LETTERS
from ..theme import DARK
from ..tools.handles import draw_line
from ..tools.planes import outline
from ..tools.view import PictureView
from .lighter import LightImages
from .slicer import SliceImage

#: Half the gap in pixels that the cross-hair leaves open, so that what lies there is seen.
GAP = 9.0
#: Length in pixels of the marker's arms in the 3D picture.
MARKER = 15.0
#: Sine of the angle between two planes below which their common line is not drawn.
PARALLEL = 0.02
_INK, _SHADE = QColor(DARK.accent), QColor(0, 0, 0, 150)


def small(font: QFont) -> QFont:
    """Return the font of names and letters in a view."""
    made = QFont(font)
    made.setPointSizeF(max(7.0, 0.9 * font.pointSizeF()))
    return made


def draw_on_slice(painter: QPainter, view: PictureView, frame: Frame, image: QImage) -> None:
    """Draw a picture of a slice where it lies in the view: while one zooms or pans, the last one follows."""
    middle = view.place(np.asarray(frame.middle))
    if middle is None:
        return
    scale = frame.mm_per_pixel / view.mm_per_pixel(np.asarray(frame.middle))
    wide, high = frame.width * scale, frame.height * scale
    painter.drawImage(QRectF(middle[0] - wide / 2, middle[1] - high / 2, wide, high), image)


def lit_image(made: SliceImage, light: LightImages) -> QImage:
    """Return a slice's picture with light on it: darkened where little arrives, glowing where much does."""
    frame, coarse = made.request.frame, light.request.frame
    away = np.asarray(coarse.middle) - np.asarray(frame.middle)
    scale = coarse.mm_per_pixel / frame.mm_per_pixel
    wide, high = coarse.width * scale, coarse.height * scale
    x = frame.width / 2 + float(away @ np.asarray(frame.cut.right)) / frame.mm_per_pixel
    y = frame.height / 2 - float(away @ np.asarray(frame.cut.up)) / frame.mm_per_pixel
    box = QRectF(x - wide / 2, y - high / 2, wide, high)
    image = made.image.copy()
    mode = QPainter.CompositionMode
    with QPainter(image) as painter:
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setCompositionMode(mode.CompositionMode_Multiply)
        painter.drawImage(box, light.times)
        painter.setCompositionMode(mode.CompositionMode_Plus)
        painter.drawImage(box, light.plus)
        # The light's coarse pixels reach beyond the volume, its picture does not.
        painter.setCompositionMode(mode.CompositionMode_DestinationIn)
        painter.drawImage(0, 0, made.image)
    return image


def draw_cross(painter: QPainter, view: PictureView, cross: np.ndarray) -> None:
    """Draw the cross-hair, open in the middle."""
    at = view.place(cross)
    if at is None:
        return
    x, y = at
    # The gap stays where the cross-hair is out of sight, too: each line begins at the edge.
    for a, b in (
        ((0.0, y), (x - GAP, y)), ((x + GAP, y), (view.width, y)),
        ((x, 0.0), (x, y - GAP)), ((x, y + GAP), (x, view.height)),
    ):  # fmt: skip
        if a[0] <= b[0] and a[1] <= b[1]:
            _thin_line(painter, QPointF(*a), QPointF(*b))


def draw_marker(painter: QPainter, view: PictureView, cross: np.ndarray) -> None:
    """Draw the cross-hair's place in the 3D picture: a small cross, open in the middle."""
    at = view.place(cross)
    if at is None:
        return
    for x, y in ((MARKER, 0.0), (-MARKER, 0.0), (0.0, MARKER), (0.0, -MARKER)):
        inner, outer = QPointF(at[0] + 0.35 * x, at[1] + 0.35 * y), QPointF(at[0] + x, at[1] + y)
        _thin_line(painter, inner, outer, 1.8)


def _thin_line(painter: QPainter, a: QPointF, b: QPointF, width: float = 1.1) -> None:
    for colour, wide in ((_SHADE, width + 1.8), (_INK, width)):
        painter.setPen(QPen(colour, wide))
        painter.drawLine(a, b)


def draw_cuts(painter: QPainter, view: PictureView, scene: Scene, cut: Cut, cross: np.ndarray) -> None:
    """Draw where clip planes and the crop box cut the slice."""
    if scene.crop != CropBox():
        corners = outline(scene, ClipPlane(vec(cross), vec(cut.back)))
        around = np.stack([np.arange(len(corners)) - 1, np.arange(len(corners))], axis=-1)
        for a, b in view.segments(corners, around) if len(corners) else []:
            draw_line(painter, a, b)
    for plane in scene.clip:
        ends = common_line(plane, cut, cross) if plane.enabled and scene.volume is not None else None
        within = _in_box(scene.volume, *ends) if ends is not None and scene.volume is not None else None
        segment = view.segment(*within) if within is not None else None
        if segment is not None:
            draw_line(painter, *segment, dashed=True)


def common_line(plane: ClipPlane, cut: Cut, cross: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Return a point (world mm) and the unit direction of the line in which a clip plane meets the slice.

    None if they are parallel.
    """
    normal = unit(plane.normal)
    within = normal - cut.back * float(normal @ cut.back)
    sine = float(np.linalg.norm(within))
    if sine < PARALLEL:
        return None
    nearest = cross + within * (float(normal @ (np.asarray(plane.point) - cross)) / sine**2)
    return nearest, np.cross(cut.back, within / sine)


def _in_box(volume: Volume, point: np.ndarray, along: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the ends of the part of a line that lies in the volume's box; None if it misses it."""
    matrix = volume.texture_from_world
    start, way = matrix[:3, :3] @ point + matrix[:3, 3], matrix[:3, :3] @ along
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = np.sort(np.stack([-start / way, (1 - start) / way]), axis=0)
    # Along an axis on which the line does not move, it is inside all the way, or nowhere (NaN: on the face itself).
    low, high = float(np.nanmax(near)), float(np.nanmin(far))
    return (point + low * along, point + high * along) if low < high else None


def draw_names(painter: QPainter, area: QRect, cut: Cut, place: str) -> None:
    """Draw the view's name, where its slice lies, and what is at its edges."""
    metrics = painter.fontMetrics()
    tall = metrics.height() + 4
    for text, top in ((cut.title, area.top() + 8), (place, area.bottom() - tall - 7)):
        overlay.draw_text(
            painter, QRectF(area.left() + 8, top, metrics.horizontalAdvance(text) + 14, tall), text
        )
    overlay.draw_letters(painter, area, cut.letters)


def draw_focus(painter: QPainter, area: QRect) -> None:
    """Draw the frame of the view that has the keys, as the picture has it."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(_INK, 2))
    painter.drawRect(area.adjusted(1, 1, -1, -1))


def slice_place(volume: Volume, cut: Cut, cross: np.ndarray) -> str:
    """Return in words where a slice lies: ``40.0 S mm``, as `place_words` tells places."""
    axis = {"sagittal": 0, "coronal": 1, "axial": 2}[cut.id]
    if volume.info.orientation_known:
        value = float(cross[axis])
        return f"{abs(value):.1f} {LETTERS[axis][value < 0]} mm"
    value = float(np.asarray(volume.direction)[:, axis] @ cross)
    return f"{'xyz'[axis]} {value:.1f} mm".replace("-", "\N{MINUS SIGN}")


__all__ = [
    "common_line",
    "draw_cross",
    "draw_cuts",
    "draw_focus",
    "draw_marker",
    "draw_names",
    "draw_on_slice",
    "lit_image",
    "slice_place",
    "small",
]  # fmt: skip
