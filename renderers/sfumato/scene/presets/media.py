"""Media that fill the empty space around a subject: smoke, fog, wax (Schlegel2011, Fig. 9); linear RGB.

In them light can be seen on its way: shafts between what casts shadows, a glow around lamps that stand inside.
They are transfer functions and nothing else; how far light spreads on its way is the technique's cone angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..transfer import TransferFunction
from ..volume import Volume
from .preset import Preset


@dataclass(frozen=True)
class Medium:
    """What fills the space.

    Attributes
    ----------
    name, description : str
        For people.
    color : (float, float, float)
        Linear RGB.
    depth : float
        Optical depth along the volume's longest side.
    """

    name: str
    description: str
    color: tuple[float, float, float]
    depth: float


MEDIA = (
    Medium(
        "Smoke", "The subject in thin smoke, in which lamps draw shafts of light", (0.55, 0.56, 0.60), 0.5
    ),
    Medium("Fog", "The subject in thick fog, which swallows what is far", (0.74, 0.78, 0.82), 1.6),
    Medium("Wax", "The subject cast in a block of translucent wax", (0.78, 0.60, 0.36), 5.0),
)


def filled(transfer: TransferFunction, medium: Medium, volume: Volume) -> TransferFunction:
    """Return a function in which whatever was fainter than a medium is that medium.

    Parameters
    ----------
    transfer : TransferFunction
        By points; one by regions has no values of its own for empty space and is returned as it is.
    volume : Volume
        Whose longest side the medium's depth refers to.
    """
    if transfer.regions:
        return transfer
    longest = max(n * s for n, s in zip(volume.dims, volume.spacing, strict=True))
    unit = transfer.unit_distance or volume.unit_distance
    faint = -math.expm1(-medium.depth / longest * unit)
    points = tuple(
        replace(point, opacity=faint, color=medium.color) if point.opacity < faint else point
        for point in transfer.points
    )
    return replace(transfer, points=points, name=medium.name)


def media_presets(base: Preset, volume: Volume) -> tuple[Preset, ...]:
    """Return the media around what a preset shows."""
    return tuple(
        Preset(m.name, filled(base.transfer, m, volume), m.description, base.modality) for m in MEDIA
    )
