"""The hand's skin as a smooth union of rods and pads, with creases, knuckles, tendons, veins and nails."""

from __future__ import annotations

import itertools

import numpy as np

from ..field import WORLD, Field
from ..grid import Grid
from ..sdf import Frame, bump, length, smooth_max, smooth_min
from .pose import FINGERS, Bone, long_bones

#: The middle finger's radius in mm: base joint, proximal phalanx, its head, the middle one's head, tip.
FINGER_RADII = (10.4, 9.5, 9.3, 8.0, 6.6)
THUMB_RADII = (12.8, 10.4, 10.6, 9.0, 7.4)
Line = tuple[tuple[float, float], ...]

#: Palm creases (x, z): the line around the thumb, the head line, the heart line.
CREASES: tuple[Line, ...] = (
    ((-25, 81), (-15, 78), (-6, 69), (-0.5, 57), (1.5, 43), (0.5, 28), (-1, 18)),
    ((-25, 81), (-10, 77), (6, 70), (19, 60), (27, 51)),
    ((44, 74), (30, 80), (15, 85), (2, 91), (-8, 102)),
)
#: Creases before the wrist.
WRIST: tuple[Line, ...] = (
    ((-24, 4), (-12, 1), (0, 0), (12, 1), (24, 5)),
    ((-22, -5), (-8, -8), (6, -8), (20, -5)),
)
#: Veins on the back of the hand (x, z).
VEINS: tuple[Line, ...] = (
    ((9, 94), (8, 78), (13, 62), (10, 46), (16, 28), (14, 4), (18, -34)),
    ((27, 82), (24, 68), (13, 60)),
    ((-12, 95), (-13, 80), (-8, 64), (-12, 44), (-17, 22), (-22, 0), (-20, -34)),
    ((-8, 64), (2, 56), (10, 46)),
)


def surface(grid: Grid) -> np.ndarray:
    """Return the distance to the smooth skin, without its fine relief."""
    hand = Field(grid)
    _palm(hand)
    fingers = [Field(grid) for _ in range(2)]
    # Neighbours are joined sharply, so alternate fingers are kept apart until they are whole.
    for number in range(1, 5):
        _finger(fingers[number % 2], [b for b in long_bones() if b.finger == number])
    fingers[0].join(fingers[1], 0.8)
    _forearm(hand)
    hand.join(fingers[0], 7.0)
    thumb = Field(grid)
    _thumb(thumb, [b for b in long_bones() if b.finger == 0])
    hand.join(thumb, 9.0)
    return hand.distance


def _palm(hand: Field) -> None:
    metacarpals = [b for b in long_bones() if b.kind == "metacarpal" and b.finger]
    for bone in metacarpals:
        start, end = bone.frame.world(0, -3.5, 0), bone.frame.world(0, -2.8, bone.length)
        hand.rod(start, end, 12.0, 10.6 * bone.size, 5.0)
    # Between the heads, up to the webs of the fingers; and the pads of the palm below the fingers.
    for left, right in itertools.pairwise(metacarpals):
        middle = (left.end + right.end) / 2
        hand.rod(np.add(middle, (0, -4, -10)), np.add(middle, (0, -5.5, 9.5)), 9.0, 6.6, 5.0)
    for bone in metacarpals:
        hand.pad(WORLD, np.add(bone.end, (0, -10.0, 3)), (8.5, 6.0, 8.0), 6.0)
    # Ball of the little finger, and that of the thumb.
    hand.pad(Frame.along((25, -10.5, 44), (0.32, 0.0, 1)), (0, 0, 0), (11.5, 11.0, 29), 9.0)
    hand.pad(Frame.along((-16, -13.0, 38), (-0.55, -0.40, 0.8)), (0, 0, 0), (14.5, 13.0, 25), 9.0)


def _forearm(hand: Field) -> None:
    x, y, z = hand.grid.axes()
    # Wider towards the elbow, and running out under the palm.
    waist = np.where(z < -4, np.float32(0.003), np.float32(-0.006)) * (z + 4) * (z + 4)
    q = length((x - np.float32(0.8)) / (28 + waist), (y + np.float32(1.2)) / (19 + waist))
    tube = (q - 1) * np.float32(20)
    hand.distance = smooth_min(hand.distance, smooth_max(tube, z - 24, 10), 14.0)


def _finger(hand: Field, bones: list[Bone]) -> None:
    metacarpal, proximal, middle, distal = bones
    s = metacarpal.size
    r0, r1, r2, r3, r4 = (r * s for r in FINGER_RADII)
    lift = -1.4 * s  # the bones lie nearer to the back of the finger
    half = proximal.frame.world(0, lift - 0.6, 0.5 * proximal.length)
    hand.rod(
        metacarpal.frame.world(0, -3, metacarpal.length - 8),
        np.add(proximal.start, (0, lift - 1, 0)),
        r0,
        r0,
        4.0,
    )
    hand.rod(proximal.frame.world(0, lift, 0), half, r0, r1, 5.0)
    hand.rod(half, middle.frame.world(0, lift, 0), r1, r2, 5.0)
    hand.rod(
        middle.frame.world(0, lift, 0),
        middle.frame.world(0, lift - 0.3, 0.5 * middle.length),
        r2,
        8.5 * s,
        3.0,
    )
    hand.rod(
        middle.frame.world(0, lift - 0.3, 0.5 * middle.length),
        distal.frame.world(0, lift, 0),
        8.5 * s,
        r3,
        3.0,
    )
    _tip(hand, distal, r3, r4, lift)
    # Pulps between the creases, and the skin folds over the joints at the back.
    hand.pad(proximal.frame, (0, lift - 4.6 * s, 0.62 * proximal.length), (7.4 * s, 6.0 * s, 9.5 * s), 3.0)
    hand.pad(middle.frame, (0, lift - 3.6 * s, 0.5 * middle.length), (6.9 * s, 5.6 * s, 8.0 * s), 3.0)
    hand.pad(middle.frame, (0, 3.4 * s, 0), (6.6 * s, 4.6 * s, 5.8 * s), 3.0)
    hand.pad(distal.frame, (0, 2.4 * s, -0.5), (5.4 * s, 3.9 * s, 4.2 * s), 2.5)
    hand.pad(proximal.frame, (0, 3.6 * s, -2.5), (7.0 * s, 6.2 * s, 7.5 * s), 5.0)


def _tip(hand: Field, distal: Bone, base: float, tip: float, lift: float) -> None:
    frame, s = distal.frame, distal.size
    end = frame.world(0, lift - 0.2, distal.length - 2.8)
    hand.rod(frame.world(0, lift, 0), end, base, tip, 3.0)
    hand.pad(frame, (0, lift - 1.9 * s, 0.58 * distal.length), (6.6 * s, 5.4 * s, 8.6 * s), 3.5)


def _thumb(hand: Field, bones: list[Bone]) -> None:
    metacarpal, proximal, distal = bones
    r0, r1, r2, r3, r4 = THUMB_RADII
    hand.rod(
        metacarpal.frame.world(0, -4, 0), metacarpal.frame.world(0, -3, metacarpal.length - 4), 14.5, r0, 5.0
    )
    half = proximal.frame.world(0, -1.5, 0.5 * proximal.length)
    hand.rod(metacarpal.frame.world(0, -3, metacarpal.length - 4), half, r0, r1, 5.0)
    hand.rod(half, distal.frame.world(0, -1.2, 0), r1, r2, 4.0)
    _tip(hand, distal, r3 + 0.8, r4, -1.4)
    hand.pad(proximal.frame, (0, -5.5, 0.5 * proximal.length), (7.8, 6.0, 10), 4.0)
    hand.pad(proximal.frame, (0, 4.5, -1), (7.6, 6.5, 8.0), 4.0)
    # The web between thumb and index finger.
    index = next(b for b in long_bones() if b.finger == 1)
    for share, radius in ((0.35, 9.0), (0.55, 6.0), (0.72, 4.5)):
        hand.rod(
            metacarpal.frame.world(0, -2, share * metacarpal.length + 5),
            index.frame.world(0, -5, share * index.length + 2),
            radius,
            radius,
            9.0,
        )


def add_relief(grid: Grid, skin: np.ndarray) -> None:
    """Carve creases and raise tendons and veins, in place, by fractions of a millimetre."""
    for bone in long_bones():
        if bone.kind != "metacarpal":
            _joint_creases(grid, skin, bone)
    for line in CREASES:
        _stroke(grid, skin, line, (-45, -2), 0.95, 2.3)
    for line in WRIST:
        _stroke(grid, skin, line, (-40, 0), 0.5, 1.8)
    for line in VEINS:
        _stroke(grid, skin, line, (2, 30), -0.75, 3.4)
    for ray in FINGERS:
        line = (
            (ray.base[0] * 0.8, ray.base[2] - 12),
            ((ray.base[0] + ray.head[0]) / 2, 64),
            (ray.head[0], ray.head[2] + 4),
        )
        _stroke(grid, skin, line, (2, 30), -0.7, 4.2)


def _stroke(
    grid: Grid, skin: np.ndarray, line: Line, depths: tuple[float, float], height: float, width: float
) -> None:
    """Move the skin in (positive) or out along a curve in the x, z plane, between two depths in y."""
    points = _curve(line)
    low, high = points.min(axis=0) - width, points.max(axis=0) + width
    window, (x, _, z) = grid.window((low[0], depths[0], low[1]), (high[0], depths[1], high[1]))
    profile = np.zeros(np.broadcast_shapes(x.shape, z.shape), dtype=np.float32)
    count = len(points) - 1
    for i in range(count):
        (x0, z0), (dx, dz) = points[i], points[i + 1] - points[i]
        t = np.clip(
            ((x - np.float32(x0)) * np.float32(dx) + (z - np.float32(z0)) * np.float32(dz))
            / np.float32(dx * dx + dz * dz),
            0,
            1,
        )
        away = length(x - np.float32(x0) - t * np.float32(dx), z - np.float32(z0) - t * np.float32(dz))
        # Fades out over a fifth of the curve at either end.
        fade = min(1.0, 5 * (i + 0.5) / count, 5 * (count - i - 0.5) / count)
        np.maximum(profile, np.float32(fade) * bump(away, width), out=profile)
    skin[window] += np.float32(height) * profile


def _curve(line: Line) -> np.ndarray:
    """Return points on the smooth curve through a line's corners (Catmull-Rom)."""
    p = np.asarray(line, dtype=float)
    p = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    t = np.linspace(0, 1, 6)[:-1, None]
    pieces = [
        p[i]
        + 0.5
        * t
        * (
            p[i + 1]
            - p[i - 1]
            + t
            * (
                2 * p[i - 1]
                - 5 * p[i]
                + 4 * p[i + 1]
                - p[i + 2]
                + t * (3 * (p[i] - p[i + 1]) + p[i + 2] - p[i - 1])
            )
        )
        for i in range(1, len(p) - 2)
    ]
    return np.concatenate([*pieces, p[-2:-1]])


def _joint_creases(grid: Grid, skin: np.ndarray, bone: Bone) -> None:
    """Carve the creases of a finger's joint; the one at its base lies halfway up the first phalanx."""
    s = bone.size
    if bone.kind == "proximal" and bone.finger:
        _rings(grid, skin, bone, ((0.47 * bone.length, 2.2, 0.75),), dorsal=False)
        return
    double = bone.kind == "middle" or bone.finger == 0
    _rings(grid, skin, bone, ((0.8, 1.9, 0.8), (-2.6, 1.7, 0.4))[: 2 if double else 1], dorsal=False)
    _rings(
        grid, skin, bone, ((-3.6 * s, 1.5, 0.32), (-0.8 * s, 1.5, 0.36), (2.0 * s, 1.5, 0.28)), dorsal=True
    )
    if bone.kind == "distal":
        _nail(grid, skin, bone)


def _rings(
    grid: Grid, skin: np.ndarray, bone: Bone, rings: tuple[tuple[float, float, float], ...], *, dorsal: bool
) -> None:
    """Carve grooves (place along the bone, width, depth) across a finger, fading at its sides."""
    reach = 14.5 * bone.size
    middle = bone.frame.world(0, 0, sum(r[0] for r in rings) / len(rings))
    window, axes = grid.window(middle - reach, middle + reach)
    u, v, w = bone.frame.local(axes)
    across = bump(u, (9.0 if dorsal else 12.0) * bone.size)
    side = (
        np.clip(v * np.float32(0.25) - np.float32(0.5), 0, 1)
        if dorsal
        else np.clip(np.float32(-0.25) * v, 0, 1)
    )
    # A little bent, as creases are.
    bent = w + u * u * np.float32(0.012)
    grooves = sum(
        (np.float32(depth) * bump(bent - np.float32(at), width) for at, width, depth in rings), np.float32(0)
    )
    skin[window] += across * side * grooves


def nail_coordinates(bone: Bone, u: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return how far a point is from the middle of the nail; 1 on the nail's rim."""
    s = bone.size
    a, b, middle = 5.6 * s, 6.6 * s, bone.length - 4.2 * s
    p, q = u / np.float32(a), (w - np.float32(middle)) / np.float32(b)
    return np.asarray(np.sqrt(np.sqrt(p * p * p * p + q * q * q * q)))


def _nail(grid: Grid, skin: np.ndarray, bone: Bone) -> None:
    middle = bone.frame.world(0, 3, bone.length - 4)
    window, axes = grid.window(middle - 14, middle + 14)
    u, v, w = bone.frame.local(axes)
    rho = nail_coordinates(bone, u, w)
    dorsal = np.clip(v * np.float32(0.5) + np.float32(0.2), 0, 1)
    groove = bump(rho - np.float32(1.08), 0.22) * np.float32(0.75)
    plate = np.clip((np.float32(1.0) - rho) * np.float32(8), 0, 1) * np.float32(0.35)
    skin[window] += dorsal * (groove - plate)
