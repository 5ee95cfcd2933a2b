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
RED: Palette = ((0.43, 0.075, 0.045), (0.46, 0.11, 0.07), (0.52, 0.25, 0.175))


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


def _surface_preset(
    levels: Levels, palette: Palette, at: float, name: str, text: str, modality: str, softness: float = 0.2
) -> Preset:
    return Preset(name, surface(levels, palette, at, name, softness=softness), text, modality)


def mr_presets(levels: Levels) -> tuple[Preset, ...]:
    """Return the presets for magnetic resonance."""
    bright = (levels.inner + levels.top) / 2
    fluid = "What is brighter than most tissue: fat, fluid or white matter, by the sequence"
    return (
        _surface_preset(
            levels, TISSUE, levels.surface, "Surface", "The surface of head, brain or body", "MR"
        ),
        _surface_preset(levels, TISSUE, levels.inner, "Bright tissue", fluid, "MR"),
        _surface_preset(
            levels, RED, bright, "Bright vessels", "The brightest parts, as in angiography", "MR"
        ),
        Preset("Glass", translucent(levels, TISSUE, "Glass"), "Bright parts in a translucent hull", "MR"),
    )


def ultrasound_presets(levels: Levels) -> tuple[Preset, ...]:
    """Return the presets for ultrasound."""
    return (
        _surface_preset(
            levels, AMBER, levels.surface, "Echo", "All that echoes, with a soft surface", "US", 0.5
        ),
        _surface_preset(levels, AMBER, levels.inner, "Strong echo", "Strong echoes only", "US", 0.4),
        Preset("Haze", translucent(levels, AMBER, "Haze"), "Strong echoes within a haze of weak ones", "US"),
    )


def plain_presets(levels: Levels) -> tuple[Preset, ...]:
    """Return the presets for values of unknown meaning."""
    solid = "The surface of all that stands out from the background"
    return (
        _surface_preset(levels, CLAY, levels.surface, "Solid", solid, ""),
        _surface_preset(levels, CLAY, levels.inner, "Solid inside", "The surface of the brighter parts", ""),
        _surface_preset(levels, RED, levels.surface, "Solid red", solid + ", in the colour of blood", ""),
        Preset(
            "Translucent", translucent(levels, CLAY, "Translucent"), "Bright parts in a translucent hull", ""
        ),
    )
