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
#: Texels of the lattice beyond the volume's projection on each side, besides what the footprint reaches.
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
        return View(
            np.asarray(camera.position, dtype=float), np.array([basis.right, basis.up, basis.forward])
        )

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
        return Stack(
            view, z0, step, max(1, math.ceil((far - z0) / step)), at[:, :2].min(axis=0), at[:, :2].max(axis=0)
        )

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
    offset : (float, float)
        Shift of the whole grid in texels, each in [-0.5, 0.5]; changes from frame to frame, so that the
        grid's pattern on surfaces that light grazes averages out.
    border : int
        Texels on each side beyond the volume's projection.
    pad : int
        How many of them, next to the projection, are swept; those farther out are always clear.
    """

    stack: Stack
    texel: float
    size: tuple[int, int]
    shear: tuple[int, int]
    rear: bool
    offset: tuple[float, float]
    border: int
    pad: int = PAD

    @staticmethod
    def over(
        stack: Stack,
        texel: float,
        mean: float,
        rotation: float,
        rear: bool,
        offset: tuple[float, float],
        reach: int,
        ahead: int = 0,
    ) -> Lattice:
        """Return the lattice of a light whose kernel's centroid lies `mean` slice distances along its rotation (deg).

        ``reach`` is how many texels the footprint reaches to each side, ``ahead`` how many slabs nearer to the
        light than a sample the ray caster reads: there the sample's column may lie beyond the projection.
        """
        per_plane = mean * stack.step / texel
        pad = PAD + math.ceil(ahead * abs(per_plane))
        border = pad + reach + 1
        extent = np.ceil((stack.high - stack.low) / texel - 1e-9).astype(int) + 2 * border
        phi, sign = math.radians(rotation), -1 if rear else 1
        shear = tuple(sign * round(per_plane * c * SHEAR_UNIT) for c in (math.cos(phi), math.sin(phi)))
        return Lattice(
            stack, texel, (int(extent[0]), int(extent[1])), (shear[0], shear[1]), rear, offset, border, pad
        )

    @property
    def origin(self) -> np.ndarray:
        """Lateral position in mm of texel coordinate 0 at plane 0, shape (2,)."""
        return np.asarray(self.stack.low + self.texel * (np.asarray(self.offset) - self.border))

    def base(self, plane: int) -> np.ndarray:
        """Return the columns that lie at texel (0, 0) of a plane, shape (2,)."""
        return np.array([(plane * s) // SHEAR_UNIT for s in self.shear])

    def carried(self, plane: int) -> np.ndarray:
        """Return the fraction of a texel by which a plane's grid is shifted, in [0, 1), shape (2,)."""
        return np.array([(plane * s) % SHEAR_UNIT for s in self.shear]) / SHEAR_UNIT

    def to_light(self) -> np.ndarray:
        """Return the way along a column from a plane to the next towards the light: lateral x, y and depth in mm."""
        sign = 1 if self.rear else -1
        # A column moves by -shear texels per plane.
        lateral = -np.asarray(self.shear) / SHEAR_UNIT * self.texel * sign
        return np.array([lateral[0], lateral[1], sign * self.stack.step])

    def positions(self, plane: int, base: np.ndarray) -> np.ndarray:
        """Return the 3 x 3 affine from texel coordinates to (lateral x, lateral y, depth) on a plane.

        Texels are counted as on the plane whose base is given, so that both ends of a column have one texel.
        """
        offset = self.origin + self.texel * (base - self.base(plane) - self.carried(plane))
        return np.array(
            [[self.texel, 0, offset[0]], [0, self.texel, offset[1]], [0, 0, self.stack.depth(plane)]]
        )


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
