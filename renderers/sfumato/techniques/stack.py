"""The stack of view-aligned slabs, and the sheared lattice on which a light's occlusion is carried through it.

The occlusion buffer is a grid in millimetres, parallel to the slices and as large as the volume's
projection, whatever the camera shows of it. So light is parallel in perspective pictures too, occluders
outside the picture count, and a crop of a picture equals the picture of that crop (``methods.md``, open
points 1 and 2). Its columns follow the kernel's centroid from plane to plane: a shear by whole fractions
of a texel (1/32768), carried exactly in integers, so that moving the light's way along costs no
interpolation and adds no blur.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..scene import Camera, ClipPlane, Scene, Volume

#: Fractions of a texel in which columns are sheared.
SHEAR_UNIT = 32768
#: Texels of the lattice beyond the volume's projection on each side.
PAD = 2


@dataclass(frozen=True)
class View:
    """A camera's axes and what they make of a volume's visible box."""

    eye: np.ndarray
    axes: np.ndarray  # rows: right, up, forward

    @staticmethod
    def of(camera: Camera) -> View:
        """Return the view of a camera."""
        basis = camera.basis()
        return View(np.asarray(camera.position, dtype=float), np.array([basis.right, basis.up, basis.forward]))

    def coordinates(self, points: np.ndarray) -> np.ndarray:
        """Return lateral position and depth of world points in mm; shape (n, 3)."""
        return np.asarray((points - self.eye) @ self.axes.T)


@dataclass(frozen=True)
class Stack:
    """Planes at depth ``z0 + i * step``; slab i lies between planes i and i + 1.

    Attributes
    ----------
    low, high : ndarray, shape (2,)
        Lateral bounds of the visible box in mm.
    """

    view: View
    z0: float
    step: float
    count: int
    low: np.ndarray
    high: np.ndarray

    @staticmethod
    def through(view: View, corners: np.ndarray, step: float, jitter: float) -> Stack:
        """Return the stack through a box given by its corners in world space."""
        at = view.coordinates(corners)
        near, far = float(at[:, 2].min()), float(at[:, 2].max())
        z0 = near - (1 - jitter) * step
        return Stack(view, z0, step, max(1, math.ceil((far - z0) / step)), at[:, :2].min(axis=0), at[:, :2].max(axis=0))

    def depth(self, plane: int) -> float:
        """Return a plane's depth in mm."""
        return self.z0 + plane * self.step

    def slabs_of(self, near: float, far: float) -> tuple[int, int]:
        """Return the first slab that a range of depths touches, and the one after the last."""
        first = max(0, math.floor((near - self.z0) / self.step))
        return first, max(first, min(self.count, math.ceil((far - self.z0) / self.step)))


@dataclass(frozen=True)
class Lattice:
    """The grid of one light's occlusion buffer.

    Attributes
    ----------
    texel : float
        mm.
    size : (int, int)
        Texels.
    shear : (int, int)
        Shift of a column per plane in 1/32768 texel; signed: light from behind goes the other way.
    rear : bool
        Whether light enters slabs at their back.
    """

    stack: Stack
    texel: float
    size: tuple[int, int]
    shear: tuple[int, int]
    rear: bool

    @staticmethod
    def over(stack: Stack, texel: float, mean: float, rotation: float, rear: bool) -> Lattice:
        """Return the lattice of a light whose kernel's centroid lies `mean` slice distances along its rotation (degrees)."""
        extent = np.ceil((stack.high - stack.low) / texel - 1e-9).astype(int) + 2 * PAD
        phi, sign = math.radians(rotation), -1 if rear else 1
        per_plane = mean * stack.step / texel
        shear = tuple(sign * round(per_plane * c * SHEAR_UNIT) for c in (math.cos(phi), math.sin(phi)))
        return Lattice(stack, texel, (int(extent[0]), int(extent[1])), (shear[0], shear[1]), rear)

    @property
    def origin(self) -> np.ndarray:
        """Lateral position in mm of texel coordinate 0 at plane 0, shape (2,)."""
        return np.asarray(self.stack.low - PAD * self.texel)

    def base(self, plane: int) -> np.ndarray:
        """Return the columns that lie at texel (0, 0) of a plane, shape (2,)."""
        return np.array([(plane * s) // SHEAR_UNIT for s in self.shear])

    def carried(self, plane: int) -> np.ndarray:
        """Return the fraction of a texel by which a plane's grid is shifted, in [0, 1), shape (2,)."""
        return np.array([(plane * s) % SHEAR_UNIT for s in self.shear]) / SHEAR_UNIT

    def positions(self, plane: int, base: np.ndarray) -> np.ndarray:
        """Return the 3 x 3 affine from texel coordinates to (lateral x, lateral y, depth) on a plane.

        Texels are counted as on the plane whose base is given, so that both ends of a column have one texel.
        """
        offset = self.origin + self.texel * (base - self.base(plane) - self.carried(plane))
        return np.array([[self.texel, 0, offset[0]], [0, self.texel, offset[1]], [0, 0, self.stack.depth(plane)]])

    def rects(self, corners: np.ndarray, margin: int) -> np.ndarray:
        """Return, for each slab, the texels that a convex box touches; int, shape (count, 4): x0, y0, x1, y1.

        Texels are those of the plane where light enters; an empty rectangle has x0 >= x1.
        """
        at = self.stack.view.coordinates(corners)
        planes = self.stack.z0 + np.arange(self.stack.count + 1) * self.stack.step
        low, high = _sections(at, planes)
        # A slab holds what both its planes cut and the corners between them.
        low, high = np.minimum(low[:-1], low[1:]), np.maximum(high[:-1], high[1:])
        for corner in at:
            slab = int(np.clip(math.floor((corner[2] - planes[0]) / self.stack.step), 0, self.stack.count - 1))
            low[slab] = np.minimum(low[slab], corner[:2])
            high[slab] = np.maximum(high[slab], corner[:2])
        enter = np.arange(self.stack.count)[:, None] + (1 if self.rear else 0)
        carried = (enter * np.array(self.shear)) % SHEAR_UNIT / SHEAR_UNIT
        with np.errstate(invalid="ignore"):
            first = np.floor((low - self.origin) / self.texel + carried) - margin
            last = np.ceil((high - self.origin) / self.texel + carried) + margin
        size = np.array(self.size)
        empty = ~np.isfinite(low).all(axis=1)
        rect = np.concatenate([np.clip(np.nan_to_num(first, posinf=0), 0, size), np.clip(np.nan_to_num(last, neginf=0), 0, size)], axis=1)
        rect[empty] = 0
        return rect.astype(int)


#: Edges of a box whose corners are numbered as in `Volume.corners`: bit 2 is x, bit 1 is y, bit 0 is z.
_EDGES = [(a, a | bit) for a in range(8) for bit in (1, 2, 4) if not a & bit]


def _sections(at: np.ndarray, planes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return lateral bounds of a box's section with each plane; (inf, -inf) where there is none."""
    low = np.full((len(planes), 2), np.inf)
    high = np.full((len(planes), 2), -np.inf)
    for a, b in _EDGES:
        span = at[b, 2] - at[a, 2]
        if abs(span) < 1e-12:
            continue
        s = (planes - at[a, 2]) / span
        hit = (s >= 0) & (s <= 1)
        point = at[a, :2] + s[hit, None] * (at[b, :2] - at[a, :2])
        low[hit] = np.minimum(low[hit], point)
        high[hit] = np.maximum(high[hit], point)
    return low, high


def clip_uniforms(scene: Scene, volume: Volume) -> dict[str, object]:
    """Return the clip planes and the crop box in texture coordinates, as the shaders take them."""
    planes = np.zeros((6, 4), dtype=np.float32)
    enabled = [p for p in scene.clip if p.enabled]
    for k, plane in enumerate(enabled):
        planes[k] = plane_in_texture(volume, plane)
    return {"u_clip": planes, "u_clips": len(enabled), "u_low": scene.crop.low, "u_high": scene.crop.high}


def plane_in_texture(volume: Volume, plane: ClipPlane) -> np.ndarray:
    """Return (a, b, c, d) with a x + b y + c z + d >= 0 in texture coordinates on the kept side."""
    normal = np.asarray(plane.normal) / np.linalg.norm(plane.normal)
    equation = np.append(normal, -normal @ np.asarray(plane.point))
    in_texture = equation @ volume.world_from_texture
    return np.asarray(in_texture / max(float(np.abs(in_texture[:3]).max()), 1e-30))


__all__ = ["PAD", "SHEAR_UNIT", "Lattice", "Stack", "View", "clip_uniforms", "plane_in_texture"]
