"""The blocks of a scene on the GPU: packed values, index and reverse index."""

from __future__ import annotations

import math
from collections.abc import Hashable

import moderngl
import numpy as np

from ...gpu import Device, Program
from ...gpu.volume_texture import normalised
from ..frame import Frame
from ..marcher import Material
from ..stack import clip_uniforms
from .levels import choose, errors, looks
from .packing import HIDDEN, NONE, Packing, pack, packed_voxels
from .pyramid import EDGE, Pyramid, build_pyramid

#: Width of the texture that holds the list of blocks.
LIST_WIDTH = 1024
#: Automatic data reduction of volumes of up to so many voxels; larger ones are reduced more.
REDUCTION, ORDINARY = 4.9, 4 << 20
#: Texels that there may be in any case.
FEW = 1 << 20
#: Part of a device's budget that packed values and light may take.
SHARE = 0.4
#: Part of it that the volume itself may take.
WHOLE_SHARE = 0.5
#: Bytes of a packed texel: its value, its light, and where its rays begin.
TEXEL_BYTES = 2 + 16 + 8


class Blocks:
    """A packed volume.

    Attributes
    ----------
    packing : Packing
        What is where.
    values, index, bricks, list : texture
        Packed values; index and reverse index, see ``blocks.glsl`` and ``gather.frag.glsl``.
    """

    def __init__(self, device: Device, packing: Packing, voxels: np.ndarray) -> None:
        self.packing = packing
        ctx = device.ctx
        rows = -(-max(1, len(packing.blocks)) // LIST_WIDTH)
        listed = np.zeros((rows * LIST_WIDTH, 4), dtype=np.uint16)
        listed[: len(packing.blocks)] = packing.blocks
        x, y, z = packing.size
        with device.checked(f"{voxels.nbytes >> 20} MiB for packed blocks", "smaller volume"):
            self.values = ctx.texture3d((x, y, z), 1, voxels, alignment=1, dtype=_DTYPE[voxels.itemsize])
            self.index = ctx.texture3d(packing.grid, 4, packing.index, dtype="u2")
            self.bricks = ctx.texture3d((x // EDGE, y // EDGE, z // EDGE), 2, packing.bricks, dtype="u4")
            self.list = ctx.texture((LIST_WIDTH, rows), 4, listed, dtype="u2")
        self.values.filter = (moderngl.LINEAR, moderngl.LINEAR)
        for texture in (self.index, self.bricks, self.list):
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.size = voxels.nbytes + packing.index.nbytes + packing.bricks.nbytes + listed.nbytes

    def bind(self, program: Program, frame: Frame) -> None:
        """Set what ``blocks.glsl`` needs."""
        program.bind(u_index=self.index, u_bricks=self.bricks, u_list=self.list, u_packed=self.values)
        program.set(
            u_blocks_per_unit=tuple((np.asarray(frame.volume.dims) / EDGE).tolist()),
            u_packed_texel=tuple((1 / np.asarray(self.packing.size)).tolist()),
        )

    def release(self) -> None:
        """Free the textures."""
        for texture in (self.values, self.index, self.bricks, self.list):
            texture.release()


_DTYPE = {1: "f1", 2: "nu2"}


def blocks_key(frame: Frame) -> tuple[Hashable, ...]:
    """Return what the blocks of a frame depend on."""
    scene, params = frame.scene, frame.params
    whole = is_whole(frame)
    cuts = scene.clip, scene.crop, scene.has_solid_cuts
    return frame.volume.key, frame.transfer, *cuts, params.reduction, params.coarsest, whole


def is_whole(frame: Frame) -> bool:
    """Tell whether the volume itself can be on the device; if not, its blocks are all there is of it."""
    data, device = frame.volume.data, frame.device
    wanted = data.size * (1 if data.dtype == np.uint8 else 2)
    return wanted <= WHOLE_SHARE * device.store.budget and max(frame.volume.dims) <= device.max_texture_3d


def prepare_blocks(frame: Frame, material: Material) -> Blocks:
    """Return the blocks of a frame on the GPU, packing them if they are not there yet."""
    store, volume = frame.device.store, frame.volume
    pyramid = store.get(
        ("pyramid", volume.key), lambda: build_pyramid(normalised(volume)[0]), lambda p: p.size
    )

    def make() -> Blocks:
        packing = lay_out(frame, material, pyramid)
        return Blocks(frame.device, packing, packed_voxels(pyramid, packing))

    return store.get(("blocks", *blocks_key(frame)), make, lambda b: b.size)


def lay_out(frame: Frame, material: Material, pyramid: Pyramid) -> Packing:
    """Choose the blocks' levels by their significance and lay them out."""
    shown = shown_blocks(frame, pyramid, material.tables.visible)
    # Of what is empty one texel is kept where the volume has no other form.
    levels = np.full(pyramid.grid, NONE if is_whole(frame) else HIDDEN, dtype=np.uint8)
    wanted = np.flatnonzero(shown)
    voxels = pyramid.levels[-1].size
    wished = voxels / frame.params.reduction if frame.params.reduction else automatic_texels(voxels)
    texels = min(wished, SHARE * frame.device.store.budget / TEXEL_BYTES)
    error = errors(pyramid, wanted, looks(frame.transfer, material.volume.domain))
    levels.ravel()[wanted] = choose(error, texels, frame.params.coarsest)
    return pack(levels, min(2048, frame.device.max_texture_3d))


def automatic_texels(voxels: int) -> float:
    """Return how many texels stand for a volume of so many voxels, unless the user says so."""
    return max(float(FEW), voxels / REDUCTION / math.pow(max(1.0, voxels / ORDINARY), 2 / 3))


def shown_blocks(frame: Frame, pyramid: Pyramid, visible: np.ndarray) -> np.ndarray:
    """Tell which blocks have anything visible in them that is not cut away; shape (bz, by, bx)."""
    count = np.concatenate([[0], np.cumsum(visible)])
    least, most = pyramid.extremes * (len(visible) - 1)
    # One entry of margin on either side: tables are interpolated.
    first = np.clip(np.floor(least).astype(np.int64) - 1, 0, len(visible) - 1)
    last = np.clip(np.ceil(most).astype(np.int64) + 1, 0, len(visible) - 1)
    shown = (count[last + 1] - count[first] > 0).reshape(pyramid.grid)
    edge = EDGE / np.asarray(frame.volume.dims)
    low = np.stack(np.meshgrid(*map(np.arange, shown.shape), indexing="ij")[::-1], axis=-1) * edge
    crop = frame.scene.crop
    kept = ((low < crop.high) & (low + edge > crop.low)).all(axis=-1)
    cut = clip_uniforms(frame.scene, frame.volume)
    for plane in np.asarray(cut["u_clip"])[: cut["u_clips"]]:
        # A block is cut away where even its farthest corner is.
        kept &= (low + edge * (plane[:3] > 0)) @ plane[:3] + plane[3] >= 0
    return np.asarray(shown & kept)
