"""How many texture fetches a frame makes, counted by its own shaders.

A renderer of its own draws the frame once more with the same shaders, in which every ``textureLod`` and
``texelFetch`` also adds one to a counter of its kind; each fragment adds its counts to a buffer at its end.
So what is counted is what the shaders ask for: skipped space, early ends and tiles that are not drawn cost
nothing, and neither do lanes that a processor carries along in vain.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from sfumato.renderer import Renderer

#: What is told apart, and the ceiling (`ceilings.KINDS`) that each is measured by. Unfiltered 2D fetches are
#: those of transfer function tables, and of the sweep's state in `multidirectional`.
KINDS = {
    "2D linear": "2D linear",
    "3D linear": "3D linear R8",
    "3D nearest": "3D nearest",
    "unfiltered": "1D table",
}
#: Rows of counters, so that no fragment waits for all others and no counter overflows.
_ROWS = 64

_COUNTERS = """
layout(std430, binding = 0) buffer Fetches { uint fetches[]; };
uint spent[4] = uint[4](0u, 0u, 0u, 0u);
vec4 counted_lod(sampler2D s, vec2 p, float l) { ++spent[0]; return textureLod(s, p, l); }
vec4 counted_lod(sampler2DArray s, vec3 p, float l) { ++spent[0]; return textureLod(s, p, l); }
vec4 counted_lod(sampler3D s, vec3 p, float l) { ++spent[1]; return textureLod(s, p, l); }
uvec4 counted_fetch(usampler3D s, ivec3 p, int l) { ++spent[2]; return texelFetch(s, p, l); }
vec4 counted_fetch(sampler2D s, ivec2 p, int l) { ++spent[3]; return texelFetch(s, p, l); }
"""
_MAIN = """
void main() {
    drawn();
    int row = (int(gl_FragCoord.y) % %d) * 4;
    for (int k = 0; k < 4; ++k) if (spent[k] > 0u) atomicAdd(fetches[row + k], spent[k]);
}
""".replace("%d", str(_ROWS))


def counting(fragment: str) -> str:
    """Return a fragment shader that counts its fetches besides."""
    head, body = fragment.split("\n", 1)
    assert head.startswith("#version 330")
    body = re.sub(r"\btextureLod\b", "counted_lod", body)
    body = re.sub(r"\btexelFetch\b", "counted_fetch", body)
    body = re.sub(r"\bvoid main\(\)", "void drawn()", body)
    return f"#version 430 core\n{_COUNTERS}{body}{_MAIN}"


class _CountingContext:
    """A moderngl context whose programs count."""

    def __init__(self, ctx: Any) -> None:
        self._ctx = ctx

    def __getattr__(self, name: str) -> Any:
        return getattr(self._ctx, name)

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "_ctx":
            object.__setattr__(self, name, value)
        else:
            setattr(self._ctx, name, value)

    def program(self, *, fragment_shader: str, **others: str | None) -> Any:
        return self._ctx.program(fragment_shader=counting(fragment_shader), **others)


class FetchCounter:
    """A renderer whose fetches are counted; ``renderer`` is None where OpenGL is older than 4.3."""

    def __init__(self) -> None:
        self.renderer: Renderer | None = Renderer()
        device = self.renderer.device
        if device.ctx.version_code < 430:
            self.renderer.close()
            self.renderer = None
            return
        self._buffer = device.ctx.buffer(reserve=_ROWS * len(KINDS) * 4)
        device.ctx = _CountingContext(device.ctx)  # type: ignore[assignment]

    def begin(self) -> None:
        """Count from zero."""
        assert self.renderer is not None
        self.renderer.device.make_current()
        self._buffer.clear()
        self._buffer.bind_to_storage_buffer(0)

    def counts(self) -> dict[str, int]:
        """Return the fetches since `begin`, by kind."""
        assert self.renderer is not None
        self.renderer.device.make_current()
        self.renderer.device.wait()
        table = np.frombuffer(self._buffer.read(), dtype=np.uint32).reshape(_ROWS, len(KINDS))
        return dict(zip(KINDS, map(int, table.sum(axis=0, dtype=np.int64)), strict=True))

    def close(self) -> None:
        """Free everything."""
        if self.renderer is not None:
            self.renderer.device.make_current()
            self._buffer.release()
            self.renderer.close()


def seconds_at_ceiling(counts: dict[str, int], ceilings: dict[str, float]) -> float:
    """Return the seconds that these fetches alone would take at their ceilings."""
    return sum(count / ceilings[KINDS[kind]] for kind, count in counts.items())
