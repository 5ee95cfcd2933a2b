"""The multidirectional scheme in float64: the twin that GPU pictures are compared with.

Planes that face the viewer cut the volume into slabs. For each light, transmittance (or occlusion) is
carried from slab to slab, filtered by the footprint of the light's cone (Soltesova2010), on a grid parallel
to the planes whose columns follow the footprint's centroid; the filter then has zero mean. The grid covers
the crop box in world space, whatever the camera, so that neither zoom nor perspective changes a shadow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..scene import Scene, nearest_possible_tilt
from .footprint import characteristic_function, ellipse, moments
from .medium import Medium
from .rays import Frame, Region, view_rays, visible_interval
from .slab import SecantRule, secant_rule

#: Texels around the box's projection.
PAD = 2
#: Shears are rounded to this fraction of a texel, so that their multiples are exact.
SHEAR_UNIT = 32768
#: Most slabs before a sample in which occluders are looked for on the sample's own way to the light.
MAX_NEAR = 4
LIT = ("multidirectional", "directional")
UNLIT = ("slices", "raycast")


def jitter(frame_index: int) -> float:
    """Offset of the planes in units of their distance: golden ratio sequence from 1/2."""
    return (0.5 + frame_index * (math.sqrt(5) - 1) / 2) % 1.0


def pixel_jitter(frame_index: int) -> tuple[float, float]:
    """Offset of the rays in pixels: the R2 sequence, (0, 0) first."""
    g = 1.324717957244746  # g^3 = g + 1
    return (0.5 + frame_index / g) % 1.0 - 0.5, (0.5 + frame_index / g**2) % 1.0 - 0.5


@dataclass(frozen=True)
class Stack:
    """Planes z_i = z0 + i d, i = 0..n, and the extent of the crop box across them, in mm."""

    z0: float
    d: float
    n: int
    low: tuple[float, float]
    high: tuple[float, float]

    @staticmethod
    def of(scene: Scene, offset: float) -> Stack:
        """Cut a scene's crop box into slabs, the planes moved by ``offset`` slab thicknesses."""
        assert scene.volume is not None
        assert scene.camera is not None
        corners = Frame.of(scene.camera).to_camera(scene.volume.corners(scene.crop.low, scene.crop.high))
        low, high = corners.min(axis=0), corners.max(axis=0)
        d = scene.step * scene.volume.min_spacing
        z0 = float(low[2]) + (offset - 1) * d
        n = max(1, math.ceil((float(high[2]) - z0) / d))
        return Stack(z0, d, n, (float(low[0]), float(low[1])), (float(high[0]), float(high[1])))

    def plane(self, i: int) -> float:
        """Depth of a plane in mm."""
        return self.z0 + i * self.d


class LightGrid:
    """A light's transmittance or occlusion, carried through the slabs.

    Attributes
    ----------
    layers : ndarray, shape (n, ny, nx)
        What of the light reaches slab i (lambda), at its front plane, or back plane for a rear light;
        row 0 is the lowest.
    """

    def __init__(
        self,
        stack: Stack,
        frame: Frame,
        medium: Medium,
        region: Region,
        light: tuple[float, float, float],
        form: str,
        falloff: str,
        texel: float,
    ) -> None:
        tilt, self.aperture, self.rotation = light
        self.rear = tilt > 90
        self.tilt = 180 - tilt if self.rear else tilt
        self.sign = -1 if self.rear else 1
        self.stack, self.frame, self.medium, self.region = stack, frame, medium, region
        self.form, self.falloff, self.h = form, falloff, texel
        self.rule: SecantRule = secant_rule(self.tilt, self.aperture)
        mean = moments(self.tilt, self.aperture, falloff)[0]
        phi = math.radians(self.rotation)
        shear = mean * stack.d / texel * np.array([math.cos(phi), math.sin(phi)])
        #: Whole units of 1 / SHEAR_UNIT texel a plane.
        self.shear = np.round(shear * SHEAR_UNIT).astype(np.int64)
        self.nx, self.ny = (
            math.ceil((b - a) / texel) + 2 * PAD for a, b in zip(stack.low, stack.high, strict=True)
        )
        # Empty space (T = 1) around the grid, so that the periodic FFT does not carry shadows around.
        shape = ellipse(self.tilt, self.aperture)
        self.margin = 2 + math.ceil(2 * max(shape.A, shape.B) * stack.d / texel)
        self.transfer = self._transfer_function()
        self.layers = self._sweep()

    # -- the lattice ----------------------------------------------------------------------------------
    def _first_column(self, plane: int) -> np.ndarray:
        """Column of texel 0 at a plane (two integers)."""
        return np.asarray((self.sign * plane * self.shear) // SHEAR_UNIT)

    def _origin(self, plane: int) -> np.ndarray:
        """(X, Y) of texel 0's centre at a plane, in mm."""
        drift = self._first_column(plane) - self.sign * plane * self.shear / SHEAR_UNIT
        return np.asarray(np.array(self.stack.low) + (0.5 - PAD + drift) * self.h)

    # -- the sweep ------------------------------------------------------------------------------------
    def _sweep(self) -> np.ndarray:
        n, empty = self.stack.n, 0.0 if self.form == "additive" else 1.0
        layers = np.empty((n, self.ny, self.nx))
        state = np.full((self.ny, self.nx), empty)
        held = None
        for slab in range(n - 1, -1, -1) if self.rear else range(n):
            entry, leave = (slab + 1, slab) if self.rear else (slab, slab + 1)
            if held is not None:
                moved = self._first_column(entry) - self._first_column(held)
                state = self._filtered(_shifted(state, moved, empty), empty)
            held = entry
            depth = self._extinction(entry, leave) * self.stack.d
            layers[slab] = 1 / (1 + state) if self.form == "additive" else state
            state = self._after(state, depth)
        return layers

    def _after(self, state: np.ndarray, depth: np.ndarray) -> np.ndarray:
        if self.form == "extinction":
            return np.asarray(state * np.exp(-depth * self.rule.effective))
        if self.form == "multiplicative":
            return np.asarray(state * np.exp(-depth))  # V (1 - a), Schott2009
        return np.asarray(state - np.expm1(-depth))  # G * O + a, Soltesova2010 (14)

    def _extinction(self, entry: int, leave: int) -> np.ndarray:
        """Mean extinction along each column within the slab between two planes; shape (ny, nx)."""
        x0, y0 = self._origin(entry)
        x, y = np.meshgrid(x0 + np.arange(self.nx) * self.h, y0 + np.arange(self.ny) * self.h)
        step = -self.sign * (leave - entry) * self.shear / SHEAR_UNIT * self.h
        z0, z1 = self.stack.plane(entry), self.stack.plane(leave)
        start = self.frame.to_world(x, y, np.asarray(z0))
        end = self.frame.to_world(x + step[0], y + step[1], np.asarray(z1))
        t_in, t_out = self.region.interval(start, end - start)
        inside = np.maximum(np.minimum(t_out, 1) - np.maximum(t_in, 0), 0)
        mean = self.medium.extinction_between(self.medium.value(start), self.medium.value(end))
        return np.asarray(mean * inside)

    # -- the filter -----------------------------------------------------------------------------------
    def _transfer_function(self) -> np.ndarray:
        ky = 2 * np.pi * np.fft.fftfreq(self.ny + 2 * self.margin)[:, None]
        kx = 2 * np.pi * np.fft.rfftfreq(self.nx + 2 * self.margin)[None, :]
        return characteristic_function(
            kx, ky, self.tilt, self.aperture, self.rotation, self.falloff, self.stack.d / self.h
        )

    def _filtered(self, state: np.ndarray, empty: float) -> np.ndarray:
        """Convolve with the centred footprint; outside the grid is empty space."""
        m = self.margin
        wide = np.pad(state - empty, m)
        blurred = np.fft.irfft2(np.fft.rfft2(wide) * self.transfer, wide.shape)
        return np.asarray(blurred[m:-m, m:-m] + empty)

    # -- what the eye asks ----------------------------------------------------------------------------
    def reaching(self, slab: int, p_world: np.ndarray) -> np.ndarray:
        """Return lambda of a slab at points (n, 3) of its entry plane.

        The extinction form looks for what is close on each point's own way to the light, over as many slabs
        as a texel spans, and asks the grid there; the published forms ask it at the slab itself.
        """
        if self.form != "extinction":
            return self._on_grid(slab, p_world)
        near = max(1, min(MAX_NEAR, math.ceil(self.h / self.stack.d - 1e-6)))
        at = min(slab + near, self.stack.n - 1) if self.rear else max(slab - near, 0)
        lateral = self.shear / SHEAR_UNIT * self.h
        to_light = np.array([lateral[0], lateral[1], -self.sign * self.stack.d])
        along = self.frame.to_world(*to_light) - self.frame.to_world(*np.zeros(3))
        depth = np.zeros(len(p_world))
        for k in range(near):
            start = p_world + k * along
            t_in, t_out = self.region.interval(start, np.broadcast_to(along, start.shape))
            inside = np.maximum(np.minimum(t_out, 1) - np.maximum(t_in, 0), 0)
            mean = self.medium.extinction_between(self.medium.value(start), self.medium.value(start + along))
            depth += mean * inside * self.stack.d
        return self._on_grid(at, p_world + abs(at - slab) * along) * np.exp(-depth * self.rule.effective)

    def _on_grid(self, slab: int, p_world: np.ndarray) -> np.ndarray:
        """Return lambda of a slab at points (n, 3) of its entry plane: bilinear, clamped at the edge."""
        at = self.frame.to_camera(p_world)[:, :2]
        texel = (at - self._origin(slab + 1 if self.rear else slab)) / self.h
        texel = np.clip(texel, 0, [self.nx - 1, self.ny - 1])
        base = np.minimum(texel.astype(np.int64), [max(self.nx - 2, 0), max(self.ny - 2, 0)])
        fx, fy = (texel - base).T
        x, y = base.T
        layer = self.layers[slab]
        low = layer[y, x] * (1 - fx) + layer[y, x + 1] * fx
        high = layer[y + 1, x] * (1 - fx) + layer[y + 1, x + 1] * fx
        return np.asarray(low * (1 - fy) + high * fy)


def _shifted(state: np.ndarray, by: np.ndarray, empty: float) -> np.ndarray:
    """Return the array whose texel t is the old texel t + by; empty where there was none."""
    result = np.full_like(state, empty)
    ny, nx = state.shape
    x, y = int(by[0]), int(by[1])
    if abs(x) < nx and abs(y) < ny:
        result[max(0, -y) : ny - max(0, y), max(0, -x) : nx - max(0, x)] = state[
            max(0, y) : ny - max(0, -y), max(0, x) : nx - max(0, -x)
        ]
    return result


def light_grids(scene: Scene, stack: Stack, medium: Medium, region: Region) -> list[LightGrid]:
    """Sweep each of a scene's lights through the slabs."""
    assert scene.volume is not None
    assert scene.camera is not None
    params, grids = scene.technique, []
    for light, (tilt, rotation) in zip(scene.active_lights, scene.light_angles(), strict=True):
        # Within a degree of grazing the cone's section grows without bound: light stays that far away.
        tilt = 0.0 if scene.technique_id == "directional" else nearest_possible_tilt(tilt, light.aperture)
        angles = (tilt, light.aperture, rotation)
        texel = scene.volume.min_spacing / params.resolution
        frame = Frame.of(scene.camera)
        grids.append(LightGrid(stack, frame, medium, region, angles, params.occlusion, params.falloff, texel))
    return grids


def render(scene: Scene, size: tuple[int, int], frame_index: int = 0) -> np.ndarray:
    """Draw one frame of `multidirectional`, `directional`, or unlit slices.

    Parameters
    ----------
    scene : Scene
        Its background and exposure play no part.
    size : (int, int)
        Width and height in pixels.
    frame_index : int
        Which jitter; 0 has the planes half a step off and the rays in the pixels' centres.

    Returns
    -------
    ndarray, float64, shape (height, width, 4)
        Linear, premultiplied; row 0 on top.

    Raises
    ------
    SceneError
        If the technique is another, or asks for highlights.
    """
    lit = scene.technique_id in LIT
    if not lit and scene.technique_id not in UNLIT:
        raise SceneError("technique", scene.technique_id, "one of " + ", ".join(LIT + UNLIT))
    if scene.has_solid_cuts:
        raise SceneError("solid_cuts", True, "this twin has open cut faces; `reference.cone` has solid ones")
    if getattr(scene.technique, "specular", 0.0) > 0:
        raise SceneError("technique.specular", scene.technique.specular, "the reference has no highlights")
    medium, region, stack = Medium(scene), Region(scene), Stack.of(scene, jitter(frame_index))
    grids = light_grids(scene, stack, medium, region) if lit else []
    picture = np.zeros((size[0] * size[1], 4))
    assert scene.camera is not None
    rays = view_rays(scene.camera, size, pixel_jitter(frame_index))
    z_in, z_out = visible_interval(scene, rays, region)
    for i in range(stack.n):
        za, zb = np.maximum(stack.plane(i), z_in), np.minimum(stack.plane(i + 1), z_out)
        hit = np.flatnonzero((zb > za) & (picture[:, 3] < 1))
        if len(hit) == 0:
            continue
        s_a = medium.value(rays.start[hit] + rays.slope[hit] * za[hit, None])
        s_b = medium.value(rays.start[hit] + rays.slope[hit] * zb[hit, None])
        tau, color, emission = medium.between(s_a, s_b)
        x, v = tau * (zb - za)[hit], rays.secant[hit]
        alpha = -np.expm1(-x * v)
        if lit:
            points = [rays.start[hit] + rays.slope[hit] * stack.plane(j) for j in (i, i + 1)]
            shade = _lit(scene, grids, i, points, x, v, alpha)
        else:
            shade = alpha[:, None]
        share = 1 - picture[hit, 3]
        picture[hit, :3] += share[:, None] * (color * shade + emission * alpha[:, None])
        picture[hit, 3] += share * alpha
    return picture.reshape(size[1], size[0], 4)


def _lit(
    scene: Scene,
    grids: list[LightGrid],
    slab: int,
    points: list[np.ndarray],
    x: np.ndarray,
    v: np.ndarray,
    alpha: np.ndarray,
) -> np.ndarray:
    """Return S: the light that a slab sends to the eye if it is white; shape (n, 3)."""
    total = np.zeros((len(x), 3))
    for light, grid in zip(scene.active_lights, grids, strict=True):
        reaching = grid.reaching(slab, points[1] if grid.rear else points[0])
        term = grid.rule.term(x, v, grid.rear) if grid.form == "extinction" else alpha
        share = scene.technique.ambient  # what no shadow takes away, not even a sample's own
        returned = (1 - share) * reaching * term + share * alpha
        total += returned[:, None] * np.asarray(light.color) * light.intensity
    return total
