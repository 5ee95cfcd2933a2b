"""A camera's rays, and which part of a segment is inside the crop box and the clip planes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..scene import Camera, Scene

#: Nothing nearer to the eye than this fraction of its distance to the focal point is seen (perspective).
NEAR = 1e-3


@dataclass(frozen=True)
class Frame:
    """A camera's axes as arrays: eye in mm, and unit vectors; coordinates are (X right, Y up, z depth)."""

    eye: np.ndarray
    right: np.ndarray
    up: np.ndarray
    forward: np.ndarray

    @staticmethod
    def of(camera: Camera) -> Frame:
        """Return the axes of a camera."""
        basis = camera.basis()
        axes = (camera.position, basis.right, basis.up, basis.forward)
        return Frame(*(np.asarray(a, dtype=np.float64) for a in axes))

    def to_world(self, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return world points (..., 3) in mm."""
        x, y, z = np.broadcast_arrays(x, y, z)
        return np.asarray(
            self.eye + x[..., None] * self.right + y[..., None] * self.up + z[..., None] * self.forward
        )

    def to_camera(self, p_world: np.ndarray) -> np.ndarray:
        """Return (X, Y, z) of world points; shape (..., 3)."""
        away = p_world - self.eye
        return np.stack([away @ self.right, away @ self.up, away @ self.forward], axis=-1)


@dataclass(frozen=True)
class Rays:
    """View rays p(z) = start + slope z, z being the depth along the viewing axis in mm; shapes (n, 3)."""

    start: np.ndarray
    slope: np.ndarray

    @property
    def secant(self) -> np.ndarray:
        """Length of the ray per unit of depth; shape (n,)."""
        return np.asarray(np.linalg.norm(self.slope, axis=-1))

    def at(self, z: np.ndarray) -> np.ndarray:
        """Return the points at depths z (n,)."""
        return np.asarray(self.start + self.slope * z[:, None])


def view_rays(camera: Camera, size: tuple[int, int], pixel_jitter: tuple[float, float] = (0.0, 0.0)) -> Rays:
    """Return the rays of a picture's pixels, row by row from the top.

    Parameters
    ----------
    size : (int, int)
        Width and height in pixels.
    pixel_jitter : (float, float)
        Offset in pixels to the right and up.
    """
    width, height = size
    frame = Frame.of(camera)
    half_x, half_y = camera.half_extent(width / height)
    x = 2 * (np.arange(width) + 0.5 + pixel_jitter[0]) / width - 1 + camera.window_center[0]
    y = 1 - 2 * (np.arange(height) + 0.5 - pixel_jitter[1]) / height + camera.window_center[1]
    x, y = (a.ravel() for a in np.meshgrid(x * half_x, y * half_y))
    lateral = x[:, None] * frame.right + y[:, None] * frame.up
    if camera.parallel_projection:
        return Rays(frame.eye + lateral, np.broadcast_to(frame.forward, lateral.shape))
    return Rays(np.broadcast_to(frame.eye, lateral.shape), frame.forward + lateral)


#: Optical depth to which matter on a solid cut face is held: nothing more can be seen.
SOLID_DEPTH = 12.0


class Region:
    """What is left of the volume: the crop box and the enabled clip planes, as half spaces n . p >= c.

    Where cut faces are solid (`Scene.solid_cuts`), matter on them stops light as if it went on for the volume's
    diagonal, up to `SOLID_DEPTH`.
    """

    def __init__(self, scene: Scene) -> None:
        if scene.volume is None:
            raise SceneError("volume", None, "a volume is needed")
        matrix = scene.volume.texture_from_world
        rows, cuts = [], []
        for axis in range(3):
            n, c = matrix[axis, :3], matrix[axis, 3]
            rows.append((*n, scene.crop.low[axis] - c))
            rows.append((*-n, c - scene.crop.high[axis]))
            cuts += [scene.crop.low[axis] > 0, scene.crop.high[axis] < 1]
        for plane in scene.clip:
            if plane.enabled:
                n = np.asarray(plane.normal, dtype=np.float64) / np.linalg.norm(plane.normal)
                rows.append((*n, float(n @ np.asarray(plane.point))))
                cuts.append(True)
        #: Shape (n, 4): normal and offset.
        self.half_spaces = np.array(rows)
        #: Which of them have solid faces, shape (n,).
        self.solid = np.array(cuts) & scene.solid_cuts
        #: How far matter on a solid face goes on, mm.
        self.diagonal = scene.volume.diagonal

    def on_solid_face(self, points: np.ndarray, along: np.ndarray, inwards: bool) -> np.ndarray:
        """Tell of points (n, 3) whether they lie on a solid face that a direction enters (or leaves) through."""
        found = np.zeros(len(points), dtype=bool)
        for *normal, offset in self.half_spaces[self.solid]:
            n = np.array(normal)
            rate = np.broadcast_to(along @ n, found.shape)
            near = np.abs(points @ n - offset) < 1e-7 * self.diagonal * np.linalg.norm(n)
            found |= near & ((rate > 0) if inwards else (rate < 0))
        return found

    def solid_depth(self, extinction: np.ndarray) -> np.ndarray:
        """Return the optical depth of matter on a solid face, given its extinction per mm."""
        return np.minimum(extinction * self.diagonal, SOLID_DEPTH)

    def interval(self, start: np.ndarray, along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return (t_in, t_out) between which ``start + along t`` is inside; empty if t_in >= t_out."""
        shape = np.broadcast_shapes(start.shape, along.shape)[:-1]
        t_in, t_out = np.full(shape, -np.inf), np.full(shape, np.inf)
        for *normal, offset in self.half_spaces:
            rate, room = along @ np.array(normal), start @ np.array(normal) - offset
            rate, room = np.broadcast_arrays(rate, room)
            parallel = np.abs(rate) < 1e-14
            t = -room / np.where(parallel, 1.0, rate)
            t_in = np.where((rate > 0) & ~parallel, np.maximum(t_in, t), t_in)
            t_out = np.where((rate < 0) & ~parallel, np.minimum(t_out, t), t_out)
            t_out = np.where(parallel & (room < 0), -np.inf, t_out)
        return t_in, t_out


def visible_interval(scene: Scene, rays: Rays, region: Region) -> tuple[np.ndarray, np.ndarray]:
    """Return the depths between which each ray is inside what is left of the volume and before the eye."""
    assert scene.camera is not None
    z_in, z_out = region.interval(rays.start, rays.slope)
    if not scene.camera.parallel_projection:
        z_in = np.maximum(z_in, NEAR * scene.camera.distance)
    return z_in, z_out
