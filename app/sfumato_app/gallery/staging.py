"""What the gallery's subjects stand before: a cloth, so that there is something for their shadows to fall on."""

from __future__ import annotations

from functools import cache

import numpy as np

from sfumato import Volume, VolumeInfo
from sfumato_samples import load

#: Values of air and of cloth: air lies between cloth and tissue, so no edge of cloth looks like skin.
AIR, CLOTH = -1000, -5000
#: Linear RGB: a surgeon's drape, which flatters skin and bone.
DRAPE = (0.16, 0.27, 0.30)
#: The cloth's part of a transfer function; its edge lies half way, where its surface has no steps.
CLOTH_POINTS: tuple[tuple[float, tuple[float, float, float], float], ...] = (
    (CLOTH, DRAPE, 0.95),
    (-3400, DRAPE, 0.95),
    (-2600, DRAPE, 0.0),
)


@cache
def before_cloth(name: str, gap: float, margin: float, fold: float = 1.5) -> Volume:
    """Return a CT sample before a cloth with soft folds.

    Parameters
    ----------
    name : str
        A sample in Hounsfield units.
    gap : float
        Distance from the back of the sample's box to the cloth in mm; negative: into the box.
    margin : float
        How far the cloth reaches beyond the sample on all four sides, in mm.
    fold : float
        Height of the folds in mm.
    """
    subject = load(name)
    step = subject.spacing[0]
    around, behind = round(margin / step), round((gap + 6 * fold + 4) / step)
    values = np.pad(
        subject.data,
        ((around, around), (0, max(0, behind)), (around, around)),
        constant_values=AIR,
    )
    surface = (subject.data.shape[1] * step + gap + 3 * fold) - _folds(values.shape, step, fold)
    depth = ((np.arange(values.shape[1]) + 0.5) * step)[None, :, None] - surface[:, None, :]
    # Five voxels of edge: wide enough for gradients without contour lines.
    share = np.clip(0.5 + depth / (5 * step), 0, 1)
    values = np.where(share > 0, (AIR + share * (CLOTH - AIR)).astype(values.dtype), values)
    assert subject.origin is not None
    origin = tuple(o - k * step for o, k in zip(subject.origin, (around, 0, around), strict=True))
    info = VolumeInfo(modality="CT", orientation_known=True, name=f"{subject.info.name} before a cloth")
    return Volume(values, spacing=subject.spacing, origin=origin, info=info)  # type: ignore[arg-type]


def _folds(shape: tuple[int, ...], step: float, height: float) -> np.ndarray:
    """Return the cloth's relief in mm, shape (z, x): a few slanting waves that bend and fade."""
    z, x = np.ogrid[: shape[0], : shape[2]]
    u, v = x * step / 70.0, z * step / 70.0
    bent = u + 0.35 * v + 0.10 * np.sin(2.1 * v + 0.7) + 0.05 * np.sin(5.0 * u - 1.7 * v)
    broad = np.sin(2.3 * bent + 0.4) * (0.75 + 0.25 * np.sin(1.3 * v))
    fine = np.sin(6.1 * bent + 1.1 * v) * (0.5 + 0.5 * np.sin(1.9 * u - 1.4 * v + 0.5))
    return np.asarray(height * (broad + 0.35 * fine))
