"""The README's picture: one hand, three ways to light it."""

from __future__ import annotations

from PIL import Image

from sfumato import Scene, TransferFunction
from sfumato_samples import load

from .figure import Panel, panels
from .setting import headlamp, lit, look, still
from .sheet import SHEET, draw_panel
from .staging import CLOTH_POINTS, before_cloth

#: Of the whole picture, and of the gaps between its panels, in pixels.
SIZE, GAP = (1200, 675), 6
SKIN, FLESH, BONE = (0.58, 0.34, 0.24), (0.44, 0.15, 0.09), (0.62, 0.56, 0.43)


def hero_panels() -> tuple[Panel, ...]:
    """Return the same view unlit, lit from the eye and lit from the top left."""
    transfer = TransferFunction.from_points(
        [*CLOTH_POINTS, (-420, SKIN, 0.0), (-300, SKIN, 0.10), (-150, SKIN, 0.10), (-60, SKIN, 0.012),
         (100, FLESH, 0.02), (200, FLESH, 0.10), (320, BONE, 0.6), (480, BONE, 0.93), (1500, (0.68, 0.63, 0.52), 0.95)]
    )  # fmt: skip
    camera = look(load("hand").center, 246)
    scene = still(Scene(volume=before_cloth("hand", 2, 44, 6.0), transfer=transfer, camera=camera))
    return panels(
        (scene.with_(technique="raycast"), "unlit"),
        (headlamp(scene), "lit from the eye"),
        (lit(scene).with_(technique="cone"), "lit from the top left"),
    )


def draw_hero(scale: float = 1.0, frames: int | None = None) -> Image.Image:
    """Draw the README's picture: the panels side by side, parted by thin white lines."""
    width, height = (max(24, round(side * scale)) for side in SIZE)
    gap = max(1, round(GAP * scale))
    row = hero_panels()
    side = (width - gap * (len(row) - 1)) // len(row)
    sheet = Image.new("RGB", (len(row) * side + gap * (len(row) - 1), height), SHEET)
    for number, panel in enumerate(row):
        sheet.paste(draw_panel(panel, (side, height), frames), (number * (side + gap), 0))
    return sheet
