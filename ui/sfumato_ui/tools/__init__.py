"""The tools of the picture: exactly one is active, and shows its own handles alone.

- `handles`: what a handle is, how it is hit, drawn, focused.
- `view`: from world to picture and back.
- `light`: every lamp on a hemisphere before the picture.
- `shadow`: what casts a shadow and where it falls; the lamp is solved for.
- `clip`: the crop box's faces (`crop`) and the clip planes (`planes`).
- `pick`: which material is seen at a place.

The Orbit tool has no handles; `viewport` turns the camera itself.
"""

from .clip import ClipTool
from .handles import HandleTool
from .light import LightTool
from .pick import PickTool
from .shadow import ShadowTool
from .shadow_bar import ShadowBar
from .view import PictureView

__all__ = ["ClipTool", "HandleTool", "LightTool", "PickTool", "PictureView", "ShadowBar", "ShadowTool"]
