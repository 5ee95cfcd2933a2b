"""Sfumato's render core: light for volumes. No Qt anywhere below; this is what scripts import.

How the house is built::

    scene/        frozen data: volume, transfer function, camera, lights; checks and JSON   (numpy only)
    io/           readers; everything untrusted enters here
    geometry/     tracts, streamlines and surfaces: readers, tracing, tubes (the only place that imports VTK)
    gpu/          the only place that calls moderngl: device, textures, targets, programs
    shaders/lib/  GLSL by concept, included by name
    techniques/   one folder a technique; `marcher` (the one ray caster) and `sweep` beside them
    slicing/      plane slices through a volume, with window and level
    reference/    slow, clear float64 versions that tests believe
    renderer.py   `Renderer`: a scene and a size in, a picture out, in pieces that can be cancelled

``app -> ui -> core``, never back. A frame's path: `Document` tells of a new scene; a worker thread hands it
to its `Renderer`; the technique draws in bounded pieces, yielding after each; frames with different jitter
are accumulated in linear light; tone mapping and sRGB come last, once.

Examples
--------
>>> import sfumato
>>> picture = sfumato.render(sfumato.Scene(volume=sfumato.load("head.nii.gz")), size=(512, 512))  # doctest: +SKIP
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .errors import GpuError, LoadError, SceneError, SfumatoError
from .scene import (
    Bookmark,
    Camera,
    ClipPlane,
    CropBox,
    Document,
    Geometry,
    Light,
    Lines,
    Mesh,
    Region,
    Roi,
    Scene,
    Seeds,
    Surface,
    Tracing,
    TransferFunction,
    TransferPoint,
    Volume,
    VolumeInfo,
)

if TYPE_CHECKING:
    from .export.terms import render_terms
    from .geometry import load_geometry, trace
    from .io import load
    from .renderer import Quality, Renderer, render

__version__ = "0.1.0"

__all__ = [
    "Bookmark",
    "Camera",
    "ClipPlane",
    "CropBox",
    "Document",
    "Geometry",
    "GpuError",
    "Light",
    "Lines",
    "LoadError",
    "Mesh",
    "Quality",
    "Region",
    "Renderer",
    "Roi",
    "Scene",
    "SceneError",
    "Seeds",
    "SfumatoError",
    "Surface",
    "Tracing",
    "TransferFunction",
    "TransferPoint",
    "Volume",
    "VolumeInfo",
    "load",
    "load_geometry",
    "render",
    "render_terms",
    "trace",
]

#: Names that bring GL or readers along; imported when first used, so that ``import sfumato`` stays quick.
_LAZY = {
    "load": ".io",
    "load_geometry": ".geometry",
    "trace": ".geometry",
    "render": ".renderer",
    "render_terms": ".export.terms",
    "Renderer": ".renderer",
    "Quality": ".renderer",
}


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        import importlib

        return getattr(importlib.import_module(_LAZY[name], __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
