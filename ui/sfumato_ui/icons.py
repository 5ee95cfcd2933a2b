"""Icons from qtawesome's Phosphor font, which comes with the package and needs no network."""

from __future__ import annotations

import qtawesome
from qtpy.QtGui import QIcon

from .theme import Theme

_GLYPHS = {
    "open": "ph.folder-open",
    "save": "ph.floppy-disk",
    "undo": "ph.arrow-counter-clockwise",
    "redo": "ph.arrow-clockwise",
    "picture": "ph.image",
    "unlit": "ph.lightbulb-filament",
    "orbit": "ph.cube",
    "light": "ph.sun",
    "shadow": "ph.circle-half-tilt",
    "highlight": "ph.sparkle",
    "fit": "ph.corners-out",
    "clip": "ph.crop",
    "pick": "ph.eyedropper",
    "flip": "ph.arrows-left-right",
    "add": "ph.plus",
    "duplicate": "ph.copy",
    "over": "ph.arrow-up",
    "under": "ph.arrow-down",
    "remove": "ph.trash",
    "rename": "ph.pencil-simple",
    "mute": "ph.eye-slash",
    "shown": "ph.eye",
    "solo": "ph.number-circle-one",
    "close": "ph.x",
    "vtk": "ph.columns",
    "slices": "ph.rows",
    "lamp": "ph.lamp",
    "enlarge": "ph.arrows-out-simple",
    "reduce": "ph.arrows-in-simple",
    "history": "ph.clock-counter-clockwise",
    "compare": "ph.square-half",
    "undock": "ph.arrow-square-out",
    "error": "ph.warning",
    "info": "ph.info",
    "reset": "ph.arrow-u-up-left",
    "unfold": "ph.caret-down",
    "fold": "ph.caret-up",
}


def icon(name: str, theme: Theme, color: str = "") -> QIcon:
    """Return an icon in the theme's text colour, in the colour of checked buttons while checked."""
    base = color or theme.text
    made: QIcon = qtawesome.icon(
        _GLYPHS[name], color=base, color_on=color or theme.on_accent, color_disabled=theme.border
    )
    return made
