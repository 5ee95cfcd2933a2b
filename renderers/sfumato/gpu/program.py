"""GLSL from files: includes by name, defines for true variants, errors that name our file and line."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import GpuError
from .device import Device

PACKAGE = Path(__file__).resolve().parent.parent
LIBRARY = PACKAGE / "shaders" / "lib"
_INCLUDE = re.compile(r'^\s*#include\s+"([\w.]+)"\s*$')

#: A triangle that covers the viewport.
FULLSCREEN_VERTEX = """#version 330 core
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    gl_Position = vec4(corner, 0.0, 1.0);
}
"""


@dataclass(frozen=True)
class ShaderSource:
    """A shader file (relative to the package) and the defines of one variant."""

    file: str
    defines: tuple[tuple[str, int], ...] = ()

    def text(self) -> tuple[str, list[str]]:
        """Return the expanded text and the list of files that its ``#line`` numbers refer to."""
        files: list[str] = []
        body = _expand(PACKAGE / self.file, files, set())
        defines = "".join(f"#define {name} {value}\n" for name, value in self.defines)
        return f"#version 330 core\n{defines}{body}", files


def _expand(path: Path, files: list[str], done: set[Path]) -> str:
    if path in done:
        return ""
    done.add(path)
    index = len(files)
    files.append(str(path.relative_to(PACKAGE)))
    lines = [f"#line 1 {index}"]
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = _INCLUDE.match(line)
        if match:
            lines += [_expand(LIBRARY / f"{match[1]}.glsl", files, done), f"#line {number + 1} {index}"]
        else:
            lines.append(line)
    return "\n".join(lines) + "\n"


class Program:
    """A linked program whose uniforms are set by name; names that the compiler dropped are ignored."""

    def __init__(
        self,
        device: Device,
        fragment: ShaderSource,
        vertex: str = FULLSCREEN_VERTEX,
        geometry: str | None = None,
    ) -> None:
        self.device = device
        text, files = fragment.text()
        try:
            self._program = device.ctx.program(
                vertex_shader=vertex, fragment_shader=text, geometry_shader=geometry
            )
        except Exception as error:  # moderngl raises its own bare Error
            raise GpuError(
                f"shader {fragment.file} does not compile", _name_lines(str(error), files), "other technique"
            ) from None
        self._array = device.ctx.vertex_array(self._program, [])
        self._mesh: Any = None
        self._uniforms: dict[str, Any] = {name: self._program[name] for name in self._program}
        self._units: dict[str, int] = {}
        self._textures: dict[str, Any] = {}
        for name, member in self._uniforms.items():
            if _is_sampler(member):
                self._units[name] = len(self._units)
                member.value = self._units[name]

    def set(self, **values: Any) -> None:
        """Set uniforms; arrays may be longer than the compiler's."""
        for name, value in values.items():
            member = self._uniforms.get(name)
            if member is None:
                continue
            if isinstance(value, np.ndarray):
                kind = "i4" if value.dtype.kind in "iu" else "f4"
                member.write(value.astype(kind).tobytes()[: _byte_size(member)])
            else:
                member.value = value

    def bind(self, **textures: Any) -> None:
        """Bind textures to samplers by name; they stay, whatever other programs bind meanwhile."""
        self._textures.update({name: texture for name, texture in textures.items() if name in self._units})

    def _take_units(self) -> None:
        # All programs share the texture units, each from the first on.
        for name, texture in self._textures.items():
            texture.use(self._units[name])

    def draw(self) -> None:
        """Draw the covering triangle."""
        self._take_units()
        self.device.draw_triangles(self._array, 0, 3)

    def draw_layers(self, first: int, count: int) -> None:
        """Draw the covering triangle into each of some layers, with a program of `LAYERED`."""
        self._take_units()
        self.device.draw_triangles(self._array, 3 * first, 3 * count)

    def draw_rects(self, count: int) -> None:
        """Draw rectangles, six vertices each, placed by the vertex shader (instances are slow in software)."""
        self._take_units()
        self.device.draw_triangles(self._array, 0, 6 * count)

    def load_mesh(self, buffer: Any, attribute: str) -> None:
        """Take triangles from a buffer of float32 (x, y, z), which the vertex shader gets as an attribute."""
        if self._mesh is not None:
            self._mesh.release()
        self._mesh = self.device.ctx.vertex_array(self._program, [(buffer, "3f", attribute)])

    def draw_mesh(self, first: int, count: int) -> None:
        """Draw a range of the vertices of `load_mesh` as triangles."""
        self._take_units()
        self.device.draw_triangles(self._mesh, first, count)

    def draw_buffers(
        self, vertices: Any, layout: str, names: tuple[str, ...], indices: Any, first: int, count: int
    ) -> None:
        """Draw a range of indexed triangles, or of points where there are no indices.

        Parameters
        ----------
        vertices : buffer
            Interleaved attributes.
        layout : str
            Their formats, as in moderngl: ``"3f4 4f2"``.
        names : tuple of str
            What the vertex shader calls them.
        indices : buffer or None
            Unsigned, 32 bit.
        """
        self._take_units()
        array = self.device.ctx.vertex_array(
            self._program, [(vertices, layout, *names)], indices, index_element_size=4
        )
        try:
            (self.device.draw_points if indices is None else self.device.draw_indexed)(array, first, count)
        finally:
            array.release()

    def release(self) -> None:
        """Free the GPU objects."""
        if self._mesh is not None:
            self._mesh.release()
        self._array.release()
        self._program.release()


#: Vertex and geometry shader of programs whose `Program.draw_layers` covers layers of a target.
LAYERED = ("shaders/layers.vert.glsl", "shaders/layers.geom.glsl")

#: Variants that a device keeps: a software renderer takes 3 to 5 MB for each, and there are hundreds.
VARIANTS_KEPT = 96


class Variants:
    """Programs of one fragment shader by their defines, each compiled when first asked for.

    A device keeps those that were asked for last, whatever their shader. One that goes is freed once nobody holds it
    any more: a picture that is being drawn may.

    Parameters
    ----------
    fragment, vertex, geometry : str
        Shader files, relative to the package; without a vertex shader the programs cover the viewport.
    """

    def __init__(self, device: Device, fragment: str, vertex: str = "", geometry: str = "") -> None:
        self.device = device
        self._fragment, self._vertex, self._geometry = fragment, vertex, geometry
        self._programs: dict[tuple[tuple[str, int], ...], Program] = {}

    def get(self, defines: tuple[tuple[str, int], ...]) -> Program:
        """Return the program of a set of defines."""
        if defines not in self._programs:
            vertex, geometry = (
                (PACKAGE / file).read_text(encoding="utf-8") if file else other
                for file, other in ((self._vertex, FULLSCREEN_VERTEX), (self._geometry, None))
            )
            assert vertex is not None
            fragment = ShaderSource(self._fragment, defines)
            self._programs[defines] = Program(self.device, fragment, vertex, geometry)
        program = self._programs[defines]
        recent = self.device.recent_variants
        recent[id(program)] = (self._programs, defines)
        recent.move_to_end(id(program))
        while len(recent) > VARIANTS_KEPT:
            programs, oldest = recent.popitem(last=False)[1]
            del programs[oldest]
        return program

    def release(self) -> None:
        """Free the programs."""
        for program in self._programs.values():
            self.device.recent_variants.pop(id(program), None)
            program.release()
        self._programs.clear()


def _byte_size(member: Any) -> int:
    return int(member.dimension) * int(member.array_length) * 4


#: GL_SAMPLER_2D, _3D, 2D_ARRAY and their integer forms.
_SAMPLERS = {0x8B5E, 0x8B5F, 0x8DC1, 0x8DCA, 0x8DCB, 0x8DCF, 0x8DD2, 0x8DD3, 0x8DD7}


def _is_sampler(member: Any) -> bool:
    return getattr(member, "gl_type", None) in _SAMPLERS


def _name_lines(message: str, files: list[str]) -> str:
    """Replace a compiler's ``file-number:line`` by our file's name."""

    def named(match: re.Match[str]) -> str:
        number = int(match[1])
        return f"{files[number]}:{match[2]}" if number < len(files) else match[0]

    flat = re.sub(r"\b(\d+)[:(](\d+)\)?", named, message)
    return " ".join(flat.split())[:600]
