"""The volume with the light that reaches each voxel beside its value, for light that rests.

A software renderer's look-up in a texture of four channels takes hardly longer than in one of one channel; so, once it
has the light beside the value, light costs it next to nothing. It is made when the same light is drawn again.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Hashable
from typing import Any

from ...gpu import LAYERED, Device, Program, Variants
from ..frame import Frame
from ..light_cache import LightCache
from ..marcher import Material, bind_material
from .field import draw_layers, new_texture

BYTES_A_VOXEL = 8


def greatest_light(frame: Frame) -> float:
    """Return what light, linear RGB, cannot exceed anywhere: that of a point which nothing shades."""
    lamps = sum(max(light.color) * light.intensity for light in frame.scene.active_lights)
    return float(max(frame.params.ambient + lamps, 1e-6))


class Baker:
    """Makes and keeps such volumes.

    Attributes
    ----------
    filled : int
        How many were made so far.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self._programs = Variants(device, "techniques/extinction/baked.frag.glsl", *LAYERED)
        self._kept = LightCache(
            lambda size: new_texture(device, size, 4, "nu2", linear=True),
            store=device.store,
            bytes_per_texel=BYTES_A_VOXEL,
        )
        self._seen: Hashable = None
        self.filled = 0

    def pays(self, frame: Frame, cell_mm: float, key: Hashable) -> bool:
        """Tell whether a frame's light is that of the frame before, no finer than voxels, and its volume small enough.

        On a GPU it is not worth its memory: look-ups wait for memory there.

        Parameters
        ----------
        cell_mm : float
            Edge of the light cache's cells.
        """
        seen, self._seen = self._seen, key
        if self._kept.find(key) is not None:
            return True
        needed = BYTES_A_VOXEL * frame.volume.data.size
        fits = needed <= self._kept.budget and cell_mm >= frame.volume.unit_distance
        return seen == key and self.device.is_software and fits

    def volume(
        self, frame: Frame, material: Material, key: Hashable, lights: int, bind: Callable[[Program], None]
    ) -> Generator[float, None, Any]:
        """Return the texture (value, light over `greatest_light`), filling it if need be; yields the share done.

        Parameters
        ----------
        bind : callable
            Lets a program read the light cache.
        """

        def fill(texture: Any) -> Generator[float, None, None]:
            program = self._programs.get((("LIGHTS", lights),))
            bind_material(program, material, frame)
            bind(program)
            program.set(u_light_scale=greatest_light(frame))
            yield from draw_layers(self.device, program, texture)
            self.filled += 1

        return (yield from self._kept.swept(key, frame.volume.dims, fill))

    def clear(self) -> None:
        """Free what is kept."""
        self._kept.clear()
        self._seen = None

    def release(self) -> None:
        """Free the GPU objects."""
        self._programs.release()
        self._kept.release()
