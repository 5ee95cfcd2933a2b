"""Gathering of light: one direction after the other is added to a map over the packed texels.

The map holds sums, and beside them the sum of the weights: shaders divide, so what is shown is the exact mean at
each step. A pass over all texels may be interrupted between slabs of bricks and go on in another frame, or another
picture.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Hashable, Iterator

import moderngl
import numpy as np

from ...gpu import Device, LayerTarget, Program, Variants
from ..frame import Frame
from ..marcher import Material, bind_material, material_defines
from .blocks import Blocks, blocks_key
from .directions import SETS, directions, nearest_count, preferred
from .origins import OriginFinder
from .pyramid import EDGE, FINEST, LEVELS

#: Automatic radius: this share of the longest side, but at least so many voxels.
RADIUS, RADIUS_VOXELS = 0.06, 8.0


class LightMap:
    """Sums of the light of some directions, over the packed texels.

    Attributes
    ----------
    texture
        Linear RGB and weight; light and weight alone where nothing shines by itself.
    key : tuple
        What it depends on.
    units, weights : ndarray
        All directions in their order, shape (K, 3), and what each counts for, shape (K,), with mean 1.
    done, slab : int
        Directions that all texels have, and slabs (of `EDGE` layers) that have one more.
    """

    def __init__(
        self,
        device: Device,
        key: tuple[Hashable, ...],
        blocks: Blocks,
        colored: bool,
        units: np.ndarray,
        weights: np.ndarray,
    ) -> None:
        self.key = key
        size = blocks.packing.size
        self.colored, self.units, self.weights = colored, units, weights
        self.done, self.slab = 0, 0
        channels = 4 if colored else 2
        self.size = int(np.prod(size)) * channels * 4
        with device.checked(f"{self.size >> 20} MiB for the light of packed blocks", "smaller volume"):
            self.texture = device.ctx.texture3d(size, channels, dtype="f4")
        self.texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        if not colored:
            self.texture.swizzle = "RRRG"

    @property
    def complete(self) -> bool:
        """Whether there is nothing left to gather."""
        return self.done >= len(self.units)

    @property
    def share(self) -> float:
        """How much of all that is to be gathered is there, 0 to 1."""
        return (self.done + self.slab / self.slabs) / len(self.units)

    @property
    def slabs(self) -> int:
        """Slabs of a pass."""
        return int(self.texture.size[2]) // EDGE

    def mean(self) -> np.ndarray:
        """Download the mean so far; shape (z, y, x, channels), NaN where there is nothing yet."""
        x, y, z = self.texture.size
        sums = np.frombuffer(self.texture.read(), dtype=np.float32).reshape(z, y, x, -1)
        reached = np.arange(z) < (z if self.done else self.slab * EDGE)
        weights = np.where(reached[:, None, None, None], sums[..., -1:], np.nan)
        return np.asarray(sums[..., :-1] / np.where(weights > 0, weights, np.nan))

    def release(self) -> None:
        """Free the texture."""
        self.texture.release()


class Gatherer:
    """Adds directions to light maps; keeps its programs."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._finder = OriginFinder(device)
        self._programs = Variants(device, "techniques/local_occlusion/gather.frag.glsl")

    def light_map(self, frame: Frame, material: Material, blocks: Blocks) -> LightMap:
        """Return the map of a frame, as far as it has been gathered."""
        units, weights = rays(frame)
        colored = gathers_emission(frame, material)
        key: tuple[Hashable, ...] = (
            *blocks_key(frame), *reach(frame), frame.params.samples, frame.params.gamma,
            frame.params.ends, colored, np.round(units, 9).tobytes(), np.round(weights, 9).tobytes(),
        )  # fmt: skip
        store = frame.device.store
        return store.get(
            ("local light", *key),
            lambda: LightMap(self.device, key, blocks, colored, units, weights),
            lambda m: m.size,
        )

    def gather(
        self, frame: Frame, material: Material, blocks: Blocks, light: LightMap, least: int, seconds: float
    ) -> Iterator[float]:
        """Add directions, one slab at least, yielding the share done of all after each slab.

        Parameters
        ----------
        least : int
            Directions that there have to be in any case.
        seconds : float
            Time after which it is enough for now.
        """
        origins = self._finder.origins(frame, blocks)
        target = LayerTarget(self.device, layers=1, size=light.texture.size[:2])
        began = time.perf_counter()
        try:
            for _ in self._finder.find(frame, material, blocks, origins, target):
                yield light.share
            program = self._prepare(frame, material, blocks, light)
            program.bind(u_origins=origins.texture)
            while not light.complete:
                self._add_slab(frame, program, target, light)
                yield light.share
                if light.done >= least and time.perf_counter() - began >= seconds:
                    break
        finally:
            target.release()

    def _add_slab(self, frame: Frame, program: Program, target: LayerTarget, light: LightMap) -> None:
        """Add the next direction to the next slab; whole or not at all."""
        ray = frame.volume.texture_from_world[:3, :3] @ light.units[light.done]
        program.set(u_ray=tuple(ray.tolist()), u_weight=float(light.weights[light.done]))
        ctx = self.device.ctx
        if light.done:  # the first direction replaces whatever was there
            ctx.enable(moderngl.BLEND)
            ctx.blend_func = moderngl.ONE, moderngl.ONE
        try:
            for layer in range(light.slab * EDGE, (light.slab + 1) * EDGE):
                target.use(light.texture, layer)
                program.set(u_layer=layer)
                program.draw()
        finally:
            ctx.disable(moderngl.BLEND)
        light.slab += 1
        if light.slab == light.slabs:
            light.slab, light.done = 0, light.done + 1
        self.device.wait()

    def _prepare(self, frame: Frame, material: Material, blocks: Blocks, light: LightMap) -> Program:
        program = self._programs.get((("COLORED", int(light.colored)), *material_defines(material)))
        bind_material(program, material, frame)
        blocks.bind(program, frame)
        radius, offset = reach(frame)
        transfer, volume = frame.transfer, frame.volume
        program.set(
            u_radius=radius, u_offset=offset, u_samples=float(frame.params.samples),
            u_steps=[steps(frame.params.samples, level) for level in range(LEVELS)], u_gamma=frame.params.gamma,
            u_ends=frame.params.ends,
            u_unit_distance=transfer.unit_distance or volume.unit_distance,
        )  # fmt: skip
        return program

    def release(self) -> None:
        """Free the programs."""
        self._programs.release()
        self._finder.release()


@functools.cache
def steps(samples: int, level: int) -> tuple[float, float]:
    """Return how many steps a ray takes in blocks of a level, and the growth g that makes them as long as the ray.

    The first is as long as in the finest blocks: 1 + g + g^2 + ... over the steps is `samples`.
    """
    number = max(2, round(samples * 2 / (1 + (1 << (FINEST - level)))))
    low, high = 1.0, float(samples)
    for _ in range(48):
        growth = (low + high) / 2
        low, high = (low, growth) if sum(growth**k for k in range(number)) > samples else (growth, high)
    return float(number), low


def reach(frame: Frame) -> tuple[float, float]:
    """Return the length of the rays and where they begin, mm; never less than a voxel between them."""
    volume, params = frame.volume, frame.params
    voxel = volume.unit_distance
    offset = params.offset * voxel
    longest = float(np.max(np.asarray(volume.dims) * volume.spacing))
    radius = params.radius if params.radius is not None else max(RADIUS * longest, RADIUS_VOXELS * voxel)
    return max(float(radius), offset + voxel), offset


def rays(frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """Return directions and weights: around everywhere, or the one way to the first lamp."""
    count, share = nearest_count(frame.params.directions), frame.params.preference
    lights = frame.scene.active_lights
    towards = lights[0].towards(frame.camera.basis(), frame.volume.center) if lights else None
    if count not in SETS and towards is not None:
        return np.asarray(towards)[None], np.ones(1)
    units, weights = directions(max(count, min(SETS)))
    if share == 0 or towards is None:
        return units, weights
    return units, preferred(units, weights, np.asarray(towards), share)


def gathers_emission(frame: Frame, material: Material) -> bool:
    """Tell whether what shines lights its surroundings."""
    return material.tables.emits and frame.params.emission in ("both", "gathering")
