"""Whether the first picture of a volume is good: what can be measured of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from sfumato import Scene, render
from sfumato.colorimetry import LUMINANCE

#: Allowed share of the picture's shorter side that the subject spans.
SPAN = (0.60, 0.90)
#: Allowed median of the foreground's sRGB brightness, of 255.
MEDIAN = (80.0, 180.0)
#: Largest allowed share of clipped foreground.
CLIPPED = 0.01
#: Least share of the foreground that shadow takes below `DARK` of its unlit brightness.
SHADOWED = 0.05
DARK = 0.7


@dataclass(frozen=True)
class Figures:
    """What was measured of a picture.

    Attributes
    ----------
    span : float
        Larger side of the subject's box over the picture's shorter side.
    median : float
        Median sRGB brightness of the foreground (alpha > 0.5), of 255.
    clipped : float
        Share of the foreground with a channel at its limit.
    shadowed : float
        Share of the foreground below 0.7 of its unlit brightness.
    """

    span: float
    median: float
    clipped: float
    shadowed: float

    @property
    def complaints(self) -> tuple[str, ...]:
        """What is not as it should be, a few words each."""
        found = []
        if not SPAN[0] <= self.span <= SPAN[1]:
            found.append(f"spans {self.span:.0%}, not {SPAN[0]:.0%} to {SPAN[1]:.0%}")
        if not MEDIAN[0] <= self.median <= MEDIAN[1]:
            found.append(f"median {self.median:.0f}, not {MEDIAN[0]:.0f} to {MEDIAN[1]:.0f}")
        if not self.clipped < CLIPPED:
            found.append(f"{self.clipped:.1%} clipped")
        if not self.shadowed >= SHADOWED:
            found.append(f"only {self.shadowed:.1%} in shadow")
        return tuple(found)

    @property
    def verdict(self) -> str:
        """``good``, or what is wrong."""
        return "; ".join(self.complaints) or "good"


def look_at(scene: Scene, size: tuple[int, int] = (384, 384)) -> tuple[np.ndarray, Figures]:
    """Draw a scene and measure the picture.

    Returns
    -------
    ndarray, Figures
        The picture as linear float32, premultiplied, without background, shape (height, width, 4); and
        what was measured.
    """
    scene = scene.with_(background=(0.0, 0.0, 0.0, 0.0))
    lit = render(scene, size, linear=True)
    unlit = render(scene.with_(technique="raycast"), size, linear=True)
    return lit, measure(lit, unlit, scene.exposure)


def measure(lit: np.ndarray, unlit: np.ndarray, exposure: float = 0.0) -> Figures:
    """Measure a picture.

    Parameters
    ----------
    lit, unlit : ndarray, shape (height, width, 4)
        Linear, premultiplied, with nothing behind the subject.
    exposure : float
        In stops.
    """
    subject = lit[..., 3] > 0.5
    if not subject.any():
        return Figures(0.0, 0.0, 0.0, 0.0)
    straight = lit[subject, :3] / lit[subject, 3:] * np.float32(2.0**exposure)
    level = straight @ LUMINANCE
    full = unlit[subject, :3] / np.maximum(unlit[subject, 3:], 1e-6) @ LUMINANCE * np.float32(2.0**exposure)
    return Figures(
        span=_span(lit[..., 3] > 0.25),
        median=255 * float(srgb(np.median(level))),
        clipped=float((srgb(straight).max(axis=-1) >= 254.5 / 255).mean()),
        shadowed=float((level < DARK * full).mean()),
    )


def _span(mask: np.ndarray) -> float:
    """Return the larger side of the box around all but specks, over the picture's shorter side."""
    labels, count = ndimage.label(mask)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    kept = (sizes >= 0.01 * sizes.max())[labels] & mask if count else mask
    rows, columns = np.flatnonzero(kept.any(axis=1)), np.flatnonzero(kept.any(axis=0))
    if not len(rows):
        return 0.0
    longer = max(int(np.ptp(rows)), int(np.ptp(columns))) + 1
    return longer / float(min(mask.shape))


def srgb(linear: np.ndarray) -> np.ndarray:
    """Encode linear light, clipped to 0..1, as sRGB 0..1."""
    light = np.clip(linear, 0.0, 1.0)
    return np.asarray(np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055))
