"""Where the rays of packed texels begin: at the surface that is nearest, if one is near.

Light falls from one half to next to nothing within a voxel or two of a surface. Taken at the centres of texels, it
depends on how these happen to lie to the surface: coarse blocks would be lighter than fine ones, and fine ones striped
like wood. So a texel next to a surface gathers the light of the surface itself, which changes slowly along it, and
texels of any size agree.
"""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import numpy as np

from ...gpu import Device, LayerTarget, Variants
from ..frame import Frame
from ..marcher import Material, bind_material, material_defines
from .blocks import Blocks, blocks_key
from .pyramid import EDGE


class Origins:
    """Where the rays of each packed texel begin, and what its light counts for between texels.

    Attributes
    ----------
    texture
        Shift from the texel's centre in voxels (xyz), and weight, 0 to 1.
    slab : int
        Slabs (of `EDGE` layers) that are done.
    """

    def __init__(self, device: Device, blocks: Blocks) -> None:
        size = blocks.packing.size
        self.size, self.slab = int(np.prod(size)) * 8, 0
        with device.checked(f"{self.size >> 20} MiB for where rays begin", "smaller volume"):
            self.texture = device.ctx.texture3d(size, 4, dtype="f2")
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)

    @property
    def slabs(self) -> int:
        """Slabs of all texels."""
        return int(self.texture.size[2]) // EDGE

    def shifts(self) -> np.ndarray:
        """Download the shifts in voxels (x, y, z); shape (z, y, x, 3)."""
        x, y, z = self.texture.size
        held = np.frombuffer(self.texture.read(), dtype=np.float16).reshape(z, y, x, 4)
        return held[..., :3].astype(float)

    def release(self) -> None:
        """Free the texture."""
        self.texture.release()


class OriginFinder:
    """Finds origins, slab by slab; keeps its programs."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._programs = Variants(device, "techniques/local_occlusion/origins.frag.glsl")

    def origins(self, frame: Frame, blocks: Blocks) -> Origins:
        """Return the origins of a frame's texels, as far as they have been found."""
        return frame.device.store.get(
            ("origins of light", *blocks_key(frame)), lambda: Origins(self.device, blocks), lambda o: o.size
        )

    def find(
        self, frame: Frame, material: Material, blocks: Blocks, origins: Origins, target: LayerTarget
    ) -> Iterator[None]:
        """Find those that are missing, yielding after each slab."""
        if origins.slab == origins.slabs:
            return
        program = self._programs.get(material_defines(material))
        bind_material(program, material, frame)
        blocks.bind(program, frame)
        program.set(u_voxel_mm=frame.volume.min_spacing)
        while origins.slab < origins.slabs:
            for layer in range(origins.slab * EDGE, (origins.slab + 1) * EDGE):
                target.use(origins.texture, layer)
                program.set(u_layer=layer)
                program.draw()
            origins.slab += 1
            self.device.wait()
            yield

    def release(self) -> None:
        """Free the programs."""
        self._programs.release()
