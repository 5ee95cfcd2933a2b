"""Lamps that stand somewhere, in the picture: their handles, what a hand does to them, how they look.

A lamp follows the pointer over the surface that lies under it, lifted off towards the viewer; one that is
deeper stays as deep below. Where nothing lies under it, it moves in the plane that faces the viewer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from qtpy.QtCore import QPointF, Qt
from qtpy.QtGui import QColor, QPainter, QPen, QPolygonF

from sfumato import Light, Scene
from sfumato.scene.picking import surface_under

from ..lamp_places import diagonal_of, middle_of, place_words, within_reach
from ..theme import DARK
from .handles import Handle, draw_line
from .view import MARGIN, PictureView, Place

#: How far a lamp floats off a surface beside its radius, and how far a notch of the wheel moves it along the
#: view, in parts of the visible box's diagonal.
LIFT, NOTCH = 0.012, 0.02
#: Distance in pixels from a lamp's handle to the one that moves it along the view.
ASIDE = 34.0
#: Shortest and longest arm in pixels at whose end a lamp is aimed.
ARM = (46.0, 170.0)
#: Smallest circle in pixels that is worth drawing around a handle.
SEEN_RADIUS = 13.0
_POINTS = 48


# -- where its handles are ----------------------------------------------------------------------------
def place_of(view: PictureView, light: Light) -> Place:
    """Return where a lamp's handle is: where the lamp is seen, or the nearest place at the picture's edge."""
    position = np.asarray(light.position, dtype=float)
    seen = view.place(position)
    if seen is None:
        # Behind the eye: on the side to which it lies.
        right, up, _ = view.camera_axes @ (position - np.asarray(view.camera.position))
        length = max(math.hypot(right, up), 1e-9)
        seen = view.width / 2 + 1e4 * right / length, view.height / 2 - 1e4 * up / length
    return (
        min(max(seen[0], MARGIN), max(view.width - MARGIN, MARGIN)),
        min(max(seen[1], MARGIN), max(view.height - MARGIN, MARGIN)),
    )


def is_seen(view: PictureView, light: Light) -> bool:
    """Tell whether a lamp's place lies in the picture."""
    return bool(view.shows(np.asarray(light.position, dtype=float)[None])[0])


def aimed_at(scene: Scene, view: PictureView, light: Light) -> np.ndarray:
    """Return the point, world mm, by which a lamp is aimed: as far away as the subject's middle, within sight."""
    position = np.asarray(light.position, dtype=float)
    far = float(np.linalg.norm(middle_of(scene) - position))
    mm = view.mm_per_pixel(position)
    far = min(max(far, ARM[0] * mm), ARM[1] * mm)
    return position + far * shines(light)


def shines(light: Light) -> np.ndarray:
    """Return the unit vector in which a lamp shines."""
    return np.asarray(light.direction) / math.hypot(*light.direction)


def aim_place(scene: Scene, view: PictureView, light: Light) -> Place | None:
    """Return where the end of a lamp's arm is drawn: never so near that it hides the lamp."""
    at, tip = view.place(np.asarray(light.position)), view.place(aimed_at(scene, view, light))
    if at is None or tip is None:
        return None
    length = math.dist(at, tip)
    if length < 1e-6:
        return at[0], at[1] + ARM[0]
    grown = max(length, ARM[0]) / length
    return at[0] + grown * (tip[0] - at[0]), at[1] + grown * (tip[1] - at[1])


def handles(
    scene: Scene, view: PictureView, light: Light, index: int, selected: bool, name: str
) -> list[Handle]:
    """Return a lamp's handles: itself; if it is selected, one along the view and one that aims it."""
    at = place_of(view, light)
    made = [Handle(f"lamp.{index}", f"{name}: {place_words(scene, light.position)}", at, None, "round")]
    if selected and is_seen(view, light):
        side = -1 if at[0] > view.width - ASIDE - MARGIN else 1
        aside = at[0] + side * ASIDE, at[1]
        made.append(Handle(f"depth.{index}", "Up: farther away, down: nearer", aside, (0.0, 1.0), "diamond"))
        tip = aim_place(scene, view, light) if light.needs_direction else None
        if tip is not None:
            made.append(Handle(f"aim.{index}", "Aim the lamp", tip, None, "square"))
    return made


# -- what a hand does ---------------------------------------------------------------------------------
class PlaceGrip:
    """A lamp in the hand.

    Parameters
    ----------
    at : (float, float)
        Where the pointer took it; from beside the lamp it moves as far as the pointer does.
    """

    def __init__(self, scene: Scene, view: PictureView, light: Light, at: Place) -> None:
        self._spot = place_of(view, light) if is_seen(view, light) else at
        self._slip = self._spot[0] - at[0], self._spot[1] - at[1]
        position = np.asarray(light.position, dtype=float)
        self._depth = view.depth(position)
        if not view.camera.parallel_projection and self._depth <= 0:
            self._depth = view.camera.distance
        #: How much deeper than the surface it is kept, mm along the sight.
        self._deeper = 0.0
        surface = lifted(scene, view, light, self._spot) if is_seen(view, light) else None
        if surface is not None:
            along = view.ray(self._spot)[1]
            self._deeper = max(0.0, float((position - surface) @ along))

    def moved(self, scene: Scene, view: PictureView, light: Light, at: Place) -> dict[str, Any]:
        """Return the lamp's fields for a place of the pointer."""
        self._spot = at[0] + self._slip[0], at[1] + self._slip[1]
        return self._fields(scene, view, light)

    def deeper(self, scene: Scene, view: PictureView, light: Light, mm: float) -> dict[str, Any]:
        """Return the lamp's fields, moved away from the viewer by some mm under a resting pointer."""
        self._deeper += mm
        return self._fields(scene, view, light)

    def _fields(self, scene: Scene, view: PictureView, light: Light) -> dict[str, Any]:
        start, along = view.ray(self._spot)
        base = lifted(scene, view, light, self._spot)
        if base is None:
            base = _at_depth(view, start, along, self._depth)
        self._depth = view.depth(base)
        return {"position": within_reach(base + along * self._deeper)}


def lifted(scene: Scene, view: PictureView, light: Light, at: Place) -> np.ndarray | None:
    """Return the place for a lamp on the surface under a place of the picture, off it by its radius and a little."""
    surface = surface_under(scene, *view.fractions(at), view.width / view.height)
    if surface is None:
        return None
    off = LIFT * diagonal_of(scene) + (
        0.0 if light.kind == "area" and light.shape == "rectangle" else light.radius
    )
    return np.asarray(surface) - off * view.ray(at)[1]


def _at_depth(view: PictureView, start: np.ndarray, along: np.ndarray, depth: float) -> np.ndarray:
    """Return the point of a ray at a depth along the view."""
    forward = -view.camera_axes[2]
    rate = max(float(along @ forward), 1e-6)
    return np.asarray(start + along * ((depth - view.depth(start)) / rate))


class DepthGrip:
    """A lamp in the hand that moves it along the view."""

    def __init__(self, view: PictureView, light: Light, at: Place) -> None:
        self._start, self._position = at, np.asarray(light.position, dtype=float)
        self._sight, self._mm = view.sight(self._position), view.mm_per_pixel(self._position)

    def moved(self, scene: Scene, view: PictureView, light: Light, at: Place) -> dict[str, Any]:
        """Return the lamp's fields for a place of the pointer: upwards is away."""
        travel = (self._start[1] - at[1]) * self._mm
        if not view.camera.parallel_projection:
            # Never through the eye.
            travel = max(travel, 0.05 * view.camera.distance - view.depth(self._position))
        return {"position": within_reach(self._position + travel * self._sight)}


class AimGrip:
    """The end of a lamp's arm in the hand: the lamp shines to the surface under it, or to its plane."""

    def __init__(self, scene: Scene, view: PictureView, light: Light, at: Place) -> None:
        tip = aim_place(scene, view, light) or at
        self._slip = tip[0] - at[0], tip[1] - at[1]
        self._depth = view.depth(aimed_at(scene, view, light))

    def moved(self, scene: Scene, view: PictureView, light: Light, at: Place) -> dict[str, Any]:
        """Return the lamp's fields for a place of the pointer."""
        spot = at[0] + self._slip[0], at[1] + self._slip[1]
        surface = surface_under(scene, *view.fractions(spot), view.width / view.height)
        start, along = view.ray(spot)
        target = np.asarray(surface) if surface is not None else _at_depth(view, start, along, self._depth)
        way = target - np.asarray(light.position)
        length = float(np.linalg.norm(way))
        if length <= 1e-6 * diagonal_of(scene):
            return {}
        return {"direction": within_reach(way / length)}


def nudged(view: PictureView, light: Light, right: float, up: float) -> dict[str, Any]:
    """Return a lamp's fields, moved in the plane that faces the viewer by parts of the picture's height."""
    position = np.asarray(light.position, dtype=float)
    mm = view.mm_per_pixel(position) * view.height
    axes = view.camera_axes
    return {"position": within_reach(position + mm * (right * axes[0] + up * axes[1]))}


def farther(scene: Scene, view: PictureView, light: Light, notches: float) -> dict[str, Any]:
    """Return a lamp's fields, moved along the view away from the eye."""
    position = np.asarray(light.position, dtype=float)
    way = notches * NOTCH * diagonal_of(scene)
    return {"position": within_reach(position + way * view.sight(position))}


def aimed_by(view: PictureView, light: Light, right: float, up: float) -> dict[str, Any]:
    """Return a lamp's fields, its direction turned to the right and up, in degrees as the eye sees it."""
    x, y, z = view.camera_axes @ shines(light)
    a, b = math.radians(right), math.radians(up)
    # Towards the right means towards the right on the side that is shone to.
    sign = -1.0 if z <= 0 else 1.0
    x, z = x * math.cos(a) + sign * z * math.sin(a), z * math.cos(a) - sign * x * math.sin(a)
    y, z = y * math.cos(b) + sign * z * math.sin(b), z * math.cos(b) - sign * y * math.sin(b)
    return {"direction": within_reach(view.camera_axes.T @ np.array([x, y, z]))}


# -- how it looks -------------------------------------------------------------------------------------
def outlines(scene: Scene, view: PictureView, light: Light, selected: bool) -> Iterator[np.ndarray]:
    """Yield the lines, world mm, that show what a lamp is: its ball, its area; a selected spot's cone."""
    position = np.asarray(light.position, dtype=float)
    if light.kind == "area" and light.shape == "rectangle":
        across, up = (side * half for side, half in zip(light.sides, np.asarray(light.size) / 2, strict=True))
        yield position + np.array([across + up, across - up, -across - up, up - across, across + up])
    elif light.kind == "area" and light.shape == "tube":
        half = 0.5 * light.size[0] * np.asarray(light.axis) / math.hypot(*light.axis)
        side = np.cross(half, view.sight(position))
        side = light.radius * side / max(float(np.linalg.norm(side)), 1e-9)
        yield position + np.array([half + side, half - side, -half - side, side - half, half + side])
    else:
        mm = max(view.mm_per_pixel(position), 1e-12)
        if light.radius / mm >= SEEN_RADIUS:
            yield _circle(position, light.radius, view.camera_axes[0], view.camera_axes[1])
    if light.kind == "spot" and selected:
        yield from _cone(scene, view, light)


def _cone(scene: Scene, view: PictureView, light: Light) -> Iterator[np.ndarray]:
    """Yield a beam's end and its two sides as they are seen."""
    position, way = np.asarray(light.position, dtype=float), shines(light)
    tip = aimed_at(scene, view, light)
    far = float(np.linalg.norm(tip - position))
    wide = far * math.tan(math.radians(min(light.spread, 80.0)))
    across = np.cross(way, np.eye(3)[int(np.argmin(np.abs(way)))])
    across = across / np.linalg.norm(across)
    ring = _circle(tip, wide, across, np.cross(way, across))
    yield ring
    at, places = view.place(position), view.places(ring[:-1])
    if at is None or np.isnan(places).any():
        return
    arms = places - at
    angles = np.unwrap(np.arctan2(arms[:, 1], arms[:, 0]))
    if np.ptp(angles) < math.pi:
        for k in (int(angles.argmin()), int(angles.argmax())):
            yield np.array([position, ring[k]])


def _circle(middle: np.ndarray, radius: float, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    turn = np.linspace(0, 2 * math.pi, _POINTS + 1)[:, None]
    return np.asarray(middle + radius * (np.cos(turn) * a + np.sin(turn) * b))


def draw(painter: QPainter, scene: Scene, view: PictureView, light: Light, selected: bool) -> None:
    """Draw a lamp's outlines, and of a selected one its arms."""
    accent = QColor(DARK.accent) if selected else QColor(255, 255, 255, 190)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for line in outlines(scene, view, light, selected):
        places = view.places(line)
        if np.isnan(places).any():
            continue
        polygon = QPolygonF([QPointF(float(x), float(y)) for x, y in places])
        for colour, width in ((QColor(0, 0, 0, 130), 3.0), (accent, 1.3)):
            painter.setPen(QPen(colour, width))
            painter.drawPolyline(polygon)
    if selected and light.needs_direction and is_seen(view, light):
        tip = aim_place(scene, view, light)
        if tip is not None:
            draw_line(painter, place_of(view, light), tip, dashed=True)
