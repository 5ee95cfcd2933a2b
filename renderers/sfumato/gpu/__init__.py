"""The only place that calls moderngl.

GPU objects are made, sized and freed here: `Device` (context, functions that moderngl lacks, fences),
`Target` (a floating-point picture), `Program` (GLSL from files, includes, errors that name our lines) and
`Variants` of one, `Store` (what is kept for scenes to come, by content key, within a byte budget) and
`gpu_objects` (what is there, and its bytes).
"""

from .device import Device, is_software
from .memory import GpuObject, gpu_objects
from .program import LAYERED, Program, ShaderSource, Variants
from .store import Store
from .target import LayerTarget, Target

__all__ = [
    "LAYERED",
    "Device",
    "GpuObject",
    "LayerTarget",
    "Program",
    "ShaderSource",
    "Store",
    "Target",
    "Variants",
    "gpu_objects",
    "is_software",
]
