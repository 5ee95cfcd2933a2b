"""Presets of two dimensions: what a one-dimensional one shows, but only where values change steeply.

Homogeneous tissue, however thick, hides nothing then: what is behind it is seen between its boundaries. How
steep a boundary is depends on scanner and spacing; the volume's own gradients tell it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..joint_histogram import sampled
from ..region import Region
from ..region_edit import whole_curve
from ..volume import Volume
from .preset import Preset
from .values import Levels

#: Voxels from which the gradients are judged.
_VOXELS = 60_000
#: Fewer tell nothing.
_ENOUGH = 200
#: Soft tissue from its own zero on, Hounsfield units.
_SOFT = (-150.0, 200.0)


def glass_skin(skin_and_bone: Preset, volume: Volume, zero: float) -> tuple[Preset, ...]:
    """Return bone in clear skin, for Hounsfield units; nothing where there is no soft tissue.

    Three quarters of the soft tissue are noise and fibres, whose gradients are left out; four times those are a
    boundary's.
    """
    values, gradients = _sampled(volume)
    soft = gradients[(values > zero + _SOFT[0]) & (values < zero + _SOFT[1])]
    if len(soft) < _ENOUGH:
        return ()
    inside = float(np.percentile(soft, 75))
    return _steep(
        skin_and_bone, volume, inside, 4 * inside, "Glass skin",
        "Bone through skin as clear as glass: only boundaries are seen (a 2D function)",
    )  # fmt: skip


def boundaries(glass: Preset, volume: Volume, parts: Levels) -> tuple[Preset, ...]:
    """Return the boundaries of and in a subject whose values mean nothing by themselves; nothing if it has none."""
    values, gradients = _sampled(volume)
    subject = gradients[values > parts.surface]
    if len(subject) < _ENOUGH:
        return ()
    low, high = (float(p) for p in np.percentile(subject, (50, 90)))
    return _steep(
        glass, volume, low, high, "Boundaries",
        "Inner walls through outer ones: only where values change steeply (a 2D function)",
    )  # fmt: skip


def _sampled(volume: Volume) -> tuple[np.ndarray, np.ndarray]:
    values, gradients = zip(*sampled(volume, _VOXELS), strict=True)
    return np.concatenate(values), np.concatenate(gradients)


def _steep(
    base: Preset, volume: Volume, low: float, high: float, name: str, description: str
) -> tuple[Preset, ...]:
    """Return a preset with a curve that begins at one gradient and is whole from another on."""
    if not 0 < low < high:
        return ()
    whole = whole_curve(volume)
    top = max(whole.gradient[1], 1.5 * high)
    # A soft edge is a share of half the height.
    curve: Region = replace(whole, gradient=(low, top), feather=min(1.0, 2 * (high - low) / (top - low)))
    transfer = replace(base.transfer, regions=(curve,), name=name)
    return (Preset(name, transfer, description, base.modality),)
