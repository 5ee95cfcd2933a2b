"""The near field: where the ray caster itself looks, on the way from a sample to where it asks for its light.

A lamp's texture is as coarse as voxels or coarser, so near a surface it knows nothing of that surface: what
stands close to a sample is looked for by the ray caster. Two things decide where. A surface that faces the
viewer must be as bright however thin the slabs are into which its skin is cut; so the way begins with the
very slabs that the eye sees it in. And no step may leap over a skin, which is about a voxel thick.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .frame import Frame
from .light_volume import MAX_NEAR_TEXELS, NEAR_TEXELS, LightGrid

#: Numbers of samples that shaders are compiled for; the first suffices but for steep light and thin slabs.
SAMPLES = (4, 6)
#: Depth before a facing surface, in texels, at which light is asked for.
CLEAR_TEXELS = 1.45
#: Largest step of the way's begin, in voxels; slabs thinner than half of it are taken together.
MAX_STEP = 0.75


@dataclass(frozen=True)
class Ways:
    """The ways from a sample to where each lamp's light is asked for.

    Attributes
    ----------
    lengths : ndarray, shape (4,)
        mm.
    ends : ndarray, shape (4, samples)
        Shares of each way at which the volume is looked at; the last is 1.
    """

    lengths: np.ndarray
    ends: np.ndarray

    @property
    def samples(self) -> int:
        """Number of samples on each way."""
        return int(self.ends.shape[1])


def lay_ways(frame: Frame, tilts: Sequence[float], grids: Sequence[LightGrid]) -> Ways:
    """Lay out the ways to lamps at these tilts in degrees."""
    voxel, laid, lengths = frame.volume.min_spacing, [], np.ones(4)
    for k, (tilt, grid) in enumerate(zip(tilts, grids, strict=True)):
        secant, texel = 1 / abs(math.cos(math.radians(tilt))), grid.lattice.texel
        wanted = max(NEAR_TEXELS * texel, CLEAR_TEXELS * texel * secant)
        lengths[k] = min(wanted, MAX_NEAR_TEXELS * texel)
        laid.append(_ends(frame.step * secant, voxel, secant, float(lengths[k])))
    most = max((len(ends) for ends in laid), default=1)
    samples = next((n for n in SAMPLES if n >= most), SAMPLES[-1])
    ends = np.ones((4, samples))
    for row, own in zip(ends, laid, strict=False):
        row[: len(own)] = own[:samples]
    ends[:, -1] = 1.0
    return Ways(lengths, ends)


def _ends(slab: float, voxel: float, secant: float, length: float) -> list[float]:
    """Return shares of a way: even steps that meet the slabs' planes through a skin, then twice as far each time."""
    step = slab / math.ceil(slab / (MAX_STEP * voxel) - 1e-9)
    step *= max(1, math.floor(MAX_STEP / 1.7 * voxel / step))
    skin, at, ends = max(slab, voxel * secant), 0.0, list[float]()
    while at < length * (1 - 1e-6):
        at = at + step if at < skin * (1 - 1e-6) - step / 2 else max(2 * at, at + step)
        ends.append(min(1.0, at / length))
    return ends
