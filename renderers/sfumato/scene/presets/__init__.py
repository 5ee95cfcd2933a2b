"""Transfer function presets, and what the first picture of a volume looks like.

CT in Hounsfield units has presets in Hounsfield units (`hounsfield`), also where a reader could not tell
that it is CT; everything else has presets relative to its own histogram (`relative`). `boundaries` shows
of some of them only where values change steeply. `view` places the camera before what is visible, `table` cuts
the scanner's table away.
"""

from __future__ import annotations

from ...errors import SceneError
from ..transfer import TransferFunction
from ..volume import Volume
from .boundaries import boundaries, glass_skin
from .hounsfield import hounsfield_presets
from .media import MEDIA, Medium, filled, media_presets
from .preset import Preset
from .relative import mr_presets, plain_presets, ultrasound_presets
from .table import suggest_clip
from .values import hounsfield_zero, is_slab, levels, remembered, thinned
from .view import suggest_view

__all__ = [
    "MEDIA",
    "Medium",
    "Preset",
    "filled",
    "preset",
    "presets_for",
    "suggest_clip",
    "suggest_transfer",
    "suggest_view",
]


#: A subject that fills less than this share of its volume is a tree of vessels.
SPARSE = 0.025


@remembered
def presets_for(volume: Volume) -> tuple[Preset, ...]:
    """Return all presets that suit a volume, the best first; last the best one in smoke, fog and wax."""
    clear = _in_clear_air(volume)
    return (*clear, *media_presets(clear[0], volume))


def _in_clear_air(volume: Volume) -> tuple[Preset, ...]:
    zero = hounsfield_zero(volume)
    if zero is not None:
        presets = hounsfield_presets(zero)
        through = next(p for p in presets if p.name == "Skin and bone")
        return _by_content((*presets, *glass_skin(through, volume, zero)), volume, zero)
    parts = levels(volume)
    plain = plain_presets(parts)
    own = {"MR": mr_presets, "US": ultrasound_presets}.get(_modality(volume))
    if own is not None:
        return (*own(parts), *plain)
    if float((thinned(volume) > parts.surface).mean()) < SPARSE:
        plain = tuple(sorted(plain, key=lambda p: p.name != "Solid red"))
    # In MR they show no more than Glass does: its tissues have no steeper edges than its noise.
    steep = boundaries(next(p for p in plain if p.name == "Translucent"), volume, parts)
    return (*plain, *steep, *mr_presets(parts), *ultrasound_presets(parts))


def _modality(volume: Volume) -> str:
    """Return the modality; where it is not told, what lies in a patient and is no CT is taken for MR."""
    told = volume.info.modality.upper()
    return told or ("MR" if volume.info.orientation_known else "")


def _by_content(presets: tuple[Preset, ...], volume: Volume, zero: float) -> tuple[Preset, ...]:
    """Put first what there is enough of: bone, soft tissue, skin; of a few slices the cut tissue."""
    values = thinned(volume)
    solid = max(1, int((values > zero - 200).sum()))
    bone, soft = (float((values > zero + hu).sum()) / solid for hu in (250, 0))
    first = "Bone"
    if soft > 0.2 and (bone < 0.01 or is_slab(volume)):
        first = "Muscle"
    elif bone < 0.01:
        first = "Skin"
    return tuple(sorted(presets, key=lambda p: p.name != first))


def preset(name: str, volume: Volume) -> Preset:
    """Return a preset by its name, upper or lower case.

    Raises
    ------
    SceneError
        If there is no such preset for this volume; the message lists the names.
    """
    for candidate in presets_for(volume):
        if candidate.name.lower() == name.strip().lower():
            return candidate
    raise SceneError(
        "transfer", name, "presets for this volume: " + ", ".join(p.name for p in presets_for(volume))
    )


def suggest_transfer(volume: Volume) -> TransferFunction:
    """Return a transfer function that suits a volume's modality and values."""
    return presets_for(volume)[0].transfer
