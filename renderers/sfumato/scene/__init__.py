"""The scene: frozen data with no GL and no Qt, checked when made, JSON in and out.

`Scene` is the root of the tree; `Document` is its history. Everything is hashable and compared by
content, so that any part can be the key of a cache.
"""

from .camera import STANDARD_VIEWS, Basis, Bookmark, Camera
from .clip import MAX_CLIP_PLANES, ClipPlane, CropBox
from .document import Document
from .geometry import Geometry, Lines, Mesh, Roi, Seeds, Surface, Tracing
from .light import Light, nearest_possible_tilt, tilt_is_possible
from .params import Field, Param, fields_of
from .paths import parse_setting
from .region import Region
from .scene import MAX_LIGHTS, Scene, TechniqueParams
from .transfer import MAX_OPACITY, TransferFunction, TransferPoint
from .volume import Volume, VolumeInfo

__all__ = [
    "MAX_CLIP_PLANES",
    "MAX_LIGHTS",
    "MAX_OPACITY",
    "STANDARD_VIEWS",
    "Basis",
    "Bookmark",
    "Camera",
    "ClipPlane",
    "CropBox",
    "Document",
    "Field",
    "Geometry",
    "Light",
    "Lines",
    "Mesh",
    "Param",
    "Region",
    "Roi",
    "Scene",
    "Seeds",
    "Surface",
    "TechniqueParams",
    "Tracing",
    "TransferFunction",
    "TransferPoint",
    "Volume",
    "VolumeInfo",
    "fields_of",
    "nearest_possible_tilt",
    "parse_setting",
    "tilt_is_possible",
]
