"""Presets relative to a volume's own values: MR, ultrasound, 8-bit and simulated data; linear RGB."""

from __future__ import annotations

from ..transfer import TransferFunction
from .preset import Preset
from .values import Levels

RGB = tuple[float, float, float]
#: Surface, middle and brightest part of the subject.
Palette = tuple[RGB, RGB, RGB]
TISSUE: Palette = ((0.46, 0.27, 0.185), (0.51, 0.37, 0.275), (0.58, 0.50, 0.41))
CLAY: Palette = ((0.42, 0.26, 0.145), (0.52, 0.41, 0.27), (0.62, 0.58, 0.50))
AMBER: Palette = ((0.44, 0.21, 0.08), (0.52, 0.31, 0.13), (0.62, 0.47, 0.28))
RED: Palette = ((0.52, 0.09, 0.055), (0.56, 0.13, 0.08), (0.62, 0.30, 0.21))


def surface(
    levels: Levels, palette: Palette, at: float, name: str, *, softness: float = 0.2, opacity: float = 0.95
) -> TransferFunction:
    """Return a function that is opaque above a value.

    Parameters
    ----------
    at : float
        The value where the material begins; the ramp is centred there.
    softness : float
        Half the ramp's width as a fraction of the way from the background: wide enough that a boundary
        of two voxels holds it without steps.
    """
    half = softness * max(at - levels.background, 1e-3 * (levels.top - levels.background))
    inner = max(levels.inner, at + 2 * half)
    top = max(levels.top, inner + half)
    low, middle, high = palette
    return TransferFunction.from_points(
        [
            (at - half, low, 0.0),
            (at + half, low, 0.15 * opacity),
            (inner, middle, 0.7 * opacity),
            (top, high, opacity),
        ],
        name=name,
    )


def translucent(levels: Levels, palette: Palette, name: str) -> TransferFunction:
    """Return a function with a thin hull around solid inner parts."""
    at, inner, top = (
        levels.surface,
        levels.inner,
        max(levels.top, levels.inner + 1e-3 * (levels.top - levels.background)),
    )
    half = 0.2 * max(at - levels.background, 1e-3 * (levels.top - levels.background))
    low, middle, high = palette
    band = min(at + 2 * half, inner)
    return TransferFunction.from_points(
        [
            (at - half, low, 0.0),
            (at, low, 0.06),
            (band, low, 0.01),
            (inner, middle, 0.1),
            ((inner + top) / 2, high, 0.9),
            (top, high, 0.95),
        ],
        name=name,
    )


def mr_presets(levels: Levels) -> tuple[Preset, ...]:
    """Return the presets for magnetic resonance."""
    return (
        Preset("Surface", surface(levels, TISSUE, levels.surface, "Surface"), "The outer surface of head, brain or body", "MR"),
        Preset("Bright tissue", surface(levels, TISSUE, levels.inner, "Bright tissue"), "What is brighter than most tissue: fat, fluid or white matter, by the sequence", "MR"),
        Preset("Vessels", surface(levels, RED, (levels.inner + levels.top) / 2, "Vessels"), "The brightest parts, as in angiography", "MR"),
        Preset("Glass", translucent(levels, TISSUE, "Glass"), "Bright parts in a translucent hull", "MR"),
    )  # fmt: skip


def ultrasound_presets(levels: Levels) -> tuple[Preset, ...]:
    """Return the presets for ultrasound."""
    return (
        Preset(
            "Echo",
            surface(levels, AMBER, levels.surface, "Echo", softness=0.5),
            "Everything that echoes, with a soft surface",
            "US",
        ),
        Preset(
            "Strong echo",
            surface(levels, AMBER, levels.inner, "Strong echo", softness=0.4),
            "Strong echoes only",
            "US",
        ),
        Preset("Haze", translucent(levels, AMBER, "Haze"), "Strong echoes within a haze of weak ones", "US"),
    )


def plain_presets(levels: Levels) -> tuple[Preset, ...]:
    """Return the presets for values of unknown meaning."""
    return (
        Preset("Solid", surface(levels, CLAY, levels.surface, "Solid"), "The surface of all that stands out from the background", ""),
        Preset("Solid inner parts", surface(levels, CLAY, levels.inner, "Solid inner parts"), "The surface of the brighter parts", ""),
        Preset("Solid red", surface(levels, RED, levels.surface, "Solid red"), "The same surface in the colour of blood", ""),
        Preset("Translucent", translucent(levels, CLAY, "Translucent"), "Bright parts in a translucent hull", ""),
    )  # fmt: skip
