"""Figure 14: slices across the view, and slices half way to the lamp."""

from __future__ import annotations

from dataclasses import replace

from sfumato import Scene, TransferFunction
from sfumato_samples import load

from ..figure import Figure, panels
from ..setting import AMBIENT, TOP_LEFT, lit, look, still

#: Linear RGB.
POT, BARK, LEAF, YOUNG = (0.09, 0.19, 0.31), (0.33, 0.19, 0.11), (0.20, 0.36, 0.09), (0.30, 0.45, 0.14)


def figure_14() -> Figure:
    """View-aligned and half-angle slices with a lamp far to the side."""
    points = [(30, POT, 0.95), (55, POT, 0.0), (94, BARK, 0.0), (102, BARK, 0.55), (108, BARK, 0.55),
              (116, BARK, 0.0), (120, LEAF, 0.0), (160, LEAF, 0.9), (255, YOUNG, 0.95)]  # fmt: skip
    # Half-angle slicing knows no ambient light: a little emission does the same for both.
    glow = [(value, rgb, alpha, tuple(AMBIENT * c for c in rgb)) for value, rgb, alpha in points]
    transfer = TransferFunction.from_points(glow)
    volume = load("bonsai")
    light = replace(TOP_LEFT, tilt=66, aperture=9)
    tree = still(Scene(volume=volume, transfer=transfer, camera=look(volume.center, 148, turn=0, lift=6)))
    return Figure(
        14,
        "View-aligned and half-angle slices",
        "The lamp stands 66° to the side. Slices across the view (a) sample every surface alike; slices half "
        "way between eye and lamp (b) meet surfaces that face the viewer at a slant, and "
        "show themselves in the picture.",
        panels(
            (lit(tree, light, ambient=0.0), "multidirectional occlusion"),
            (tree.with_(technique="half-angle", lights=(light,)), "half-angle slicing"),
        ),
        (640, 560),
    )
