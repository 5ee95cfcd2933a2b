"""How many fetches a second a device reaches when it does nothing else: what a technique can be measured by."""

from __future__ import annotations

import time
from typing import Any

import moderngl
import numpy as np

from sfumato.gpu import Target
from sfumato.gpu.program import FULLSCREEN_VERTEX
from sfumato.renderer import Renderer

#: Fetches of each pixel, and pixels along a side of the picture.
FETCHES, SIDE = 64, 512
#: A trial lasts at least this long; the best of so many counts.
TRIAL_SECONDS, TRIALS = 0.05, 4

_SHADER = """#version 330 core
uniform {sampler} u_from;
out vec4 o_color;
void main() {{
    vec2 at = gl_FragCoord.xy / {side}.0;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < {fetches}; ++k) {{
        float along = (float(k) + 0.5) / {fetches}.0;
        sum += vec4({fetch});
    }}
    o_color = sum;
}}
"""
_LINEAR_3D = "textureLod(u_from, vec3(at, along), 0.0)"
#: Kind of fetch: sampler, GLSL, edge of the texture, its dimensions, components and type; as the techniques use them.
KINDS: dict[str, tuple[str, str, int, int, int, str]] = {
    "2D linear": ("sampler2D", "textureLod(u_from, at + 0.1 * along, 0.0)", 256, 2, 4, "nu2"),
    "3D linear R8": ("sampler3D", _LINEAR_3D, 128, 3, 1, "f1"),
    "3D linear R16": ("sampler3D", _LINEAR_3D, 128, 3, 1, "nu2"),
    "3D nearest": ("usampler3D", "texelFetch(u_from, ivec3(vec3(at, along) * 16.0), 0)", 16, 3, 1, "u1"),
    "1D table": ("sampler2D", "texelFetch(u_from, ivec2(fract(at.x + along) * 4096.0, 0), 0)", 4096, 1, 4, "f4"),
}  # fmt: skip
_BYTES = {"f1": np.uint8, "u1": np.uint8, "nu2": np.uint16, "f4": np.float32}


def fetch_ceilings(renderer: Renderer, clock: str) -> dict[str, float]:
    """Return fetches a second, by the processor time of all threads or by wall time, of each kind.

    Parameters
    ----------
    clock : str
        ``cpu`` or ``wall``.
    """
    renderer.device.make_current()
    return {kind: _ceiling(renderer, clock, *values) for kind, values in KINDS.items()}


def _ceiling(
    renderer: Renderer, clock: str, sampler: str, fetch: str, edge: int, dims: int, components: int, kind: str
) -> float:
    device = renderer.device
    texture = _texture(device.ctx, edge, dims, components, kind)
    text = _SHADER.format(sampler=sampler, fetch=fetch, side=SIDE, fetches=FETCHES)
    program = device.ctx.program(vertex_shader=FULLSCREEN_VERTEX, fragment_shader=text)
    array, target = device.ctx.vertex_array(program, []), Target(device, (SIDE, SIDE))
    texture.use(0)
    target.fbo.use()
    ask = time.process_time if clock == "cpu" else time.perf_counter
    best = 0.0
    for trial in range(TRIALS + 1):
        frames, wall, began = 0, time.perf_counter(), ask()
        while time.perf_counter() - wall < TRIAL_SECONDS:
            device.draw_triangles(array, 0, 3)
            device.wait()
            frames += 1
        if trial:  # the first one compiles
            best = max(best, frames * SIDE * SIDE * FETCHES / max(ask() - began, 1e-6))
    for thing in (array, program, target, texture):
        thing.release()
    return best


def _texture(ctx: Any, edge: int, dims: int, components: int, kind: str) -> Any:
    shape = {1: (edge, 1), 2: (edge, edge), 3: (edge, edge, edge)}[dims]
    data = np.zeros((*shape, components), dtype=_BYTES[kind])
    make = ctx.texture3d if dims == 3 else ctx.texture
    texture = make(shape, components, data, alignment=1, dtype=kind)
    nearest = kind == "u1"
    texture.filter = (moderngl.NEAREST,) * 2 if nearest else (moderngl.LINEAR,) * 2
    return texture
