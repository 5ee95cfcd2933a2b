"""The only place that calls moderngl.

GPU objects are made, sized and freed here: `Device` (context, functions that moderngl lacks, fences),
`Target` (a floating-point picture), `Program` (GLSL from files, includes, errors that name our lines) and
`Store` (what is kept for scenes to come, by content key, within a byte budget).
"""

from .device import Device
from .program import Program, ShaderSource
from .store import Store
from .target import LayerTarget, Target

__all__ = ["Device", "LayerTarget", "Program", "ShaderSource", "Store", "Target"]
