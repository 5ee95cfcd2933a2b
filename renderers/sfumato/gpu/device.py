"""A graphics device: one OpenGL 3.3 context that belongs to one thread."""

from __future__ import annotations

import ctypes
import sys
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import moderngl

from ..errors import GpuError
from .store import Store

GL_FRAMEBUFFER = 0x8D40
GL_COLOR_ATTACHMENT0 = 0x8CE0
GL_COLOR = 0x1800
GL_UNSIGNED_INT = 0x1405
GL_SYNC_GPU_COMMANDS_COMPLETE = 0x9117
GL_SYNC_FLUSH_COMMANDS_BIT = 0x0001
GL_TIMEOUT_EXPIRED = 0x911B
GL_WAIT_FAILED = 0x911D
GL_CONTEXT_LOST = 0x0507

#: Waiting for the GPU is cut into pieces, so that a lost context cannot hold a thread for ever.
FENCE_SECONDS = 2.0
MAX_FENCE_WAITS = 60
#: A lost context reports errors without end.
MAX_OLD_ERRORS = 16
_SOFTWARE = ("llvmpipe", "softpipe", "swiftshader", "swr")


def is_software(device: str) -> bool:
    """Tell by its name whether a graphics device is a program that runs on the CPU."""
    return any(name in device.lower() for name in _SOFTWARE)


class Device:
    """An off-screen OpenGL context and what it can do.

    Must be used on the thread that made it. Objects are collected by `collect` alone: with moderngl's
    automatic mode, an object that is dropped on another thread frees a same-numbered one here.

    Raises
    ------
    GpuError
        If there is no OpenGL 3.3.
    """

    def __init__(self) -> None:
        self.ctx = _create_context()
        self.ctx.gc_mode = "context_gc"
        self._thread = threading.get_ident()
        self._closed = False
        self.store = Store()
        #: Variants of shaders by identity, those asked for last at the end: where each is kept (`Variants`).
        self.recent_variants: OrderedDict[int, tuple[dict[Any, Any], Any]] = OrderedDict()
        info = self.ctx.info
        self.name = str(info["GL_RENDERER"])
        self.version = str(info["GL_VERSION"])
        self.is_software = is_software(self.name)
        self.max_texture_3d = int(info["GL_MAX_3D_TEXTURE_SIZE"])
        self.max_texture_2d = int(info["GL_MAX_TEXTURE_SIZE"])
        self.max_layers = int(info["GL_MAX_ARRAY_TEXTURE_LAYERS"])
        u32, i32, u64, ptr = ctypes.c_uint, ctypes.c_int, ctypes.c_uint64, ctypes.c_void_p
        self._attach_whole = self._function("glFramebufferTexture", None, u32, u32, u32, i32)
        self._attach_layer = self._function("glFramebufferTextureLayer", None, u32, u32, u32, i32, i32)
        self._fence_sync = self._function("glFenceSync", ptr, u32, u32)
        self._client_wait = self._function("glClientWaitSync", u32, ptr, u32, u64)
        self._delete_sync = self._function("glDeleteSync", None, ptr)
        self._get_error = self._function("glGetError", u32)
        self._clear_buffer = self._function("glClearBufferfv", None, u32, i32, ptr)
        self._draw_arrays = self._function("glDrawArrays", None, u32, i32, i32)
        self._draw_elements = self._function("glDrawElements", None, u32, i32, u32, ptr)

    def _function(self, name: str, result: Any, *arguments: Any) -> Callable[..., Any]:
        # moderngl has no public loader; this attribute is the one place where we rely on a private one.
        address = self.ctx.mglo._context.load_opengl_function(name)
        if not address:
            raise GpuError(f"OpenGL function {name}", f"{self.ctx.info['GL_RENDERER']} does not have it")
        return ctypes.CFUNCTYPE(result, *arguments)(address)

    def make_current(self) -> None:
        """Make this the thread's current context.

        Raises
        ------
        GpuError
            On another thread than the one that made the device.
        """
        if threading.get_ident() != self._thread:
            raise GpuError("a device was used on another thread than its own", "make one Renderer per thread")
        self.ctx.__enter__()  # type: ignore[no-untyped-call]

    def attach_layer(self, attachment: int, texture: Any, layer: int) -> None:
        """Attach one layer of an array or 3D texture to the bound framebuffer (moderngl cannot)."""
        self._attach_layer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + attachment, texture.glo, 0, layer)

    def attach_layers(self, attachment: int, texture: Any) -> None:
        """Attach all layers of a texture to the bound framebuffer; a geometry shader chooses among them."""
        self._attach_whole(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + attachment, texture.glo, 0)

    def clear(self, fbo: Any, *values: float) -> None:
        """Fill a framebuffer with a value, all of it.

        By itself moderngl fills no more than the scissor of the framebuffer that was used last.
        """
        used = self.ctx.fbo
        fbo.use()
        fbo.clear(*values)
        if used is not None and not isinstance(used.mglo, moderngl.InvalidObject):
            used.use()

    def clear_attachment(self, attachment: int, value: float) -> None:
        """Fill one colour attachment of the bound framebuffer with a value (moderngl clears them all)."""
        self._clear_buffer(GL_COLOR, attachment, (ctypes.c_float * 4)(value, value, value, value))

    def draw_triangles(self, array: Any, first: int, count: int) -> None:
        """Draw a range of a vertex array without holding Python's lock: a driver may compile here, for seconds."""
        array.render(moderngl.TRIANGLES, vertices=0)  # binds program and array
        self._draw_arrays(moderngl.TRIANGLES, first, count)

    def draw_points(self, array: Any, first: int, count: int) -> None:
        """Draw a range of a vertex array's vertices as points, as `draw_triangles` does."""
        array.render(moderngl.POINTS, vertices=0)
        self._draw_arrays(moderngl.POINTS, first, count)

    def draw_indexed(self, array: Any, first: int, count: int) -> None:
        """Draw a range of a vertex array's indices (32 bit) as triangles, as `draw_triangles` does."""
        array.render(moderngl.TRIANGLES, vertices=0)
        self._draw_elements(moderngl.TRIANGLES, count, GL_UNSIGNED_INT, 4 * first)

    def wait(self) -> None:
        """Wait until all that was asked of the GPU is done, without holding Python's global lock.

        Raises
        ------
        GpuError
            If the GPU does not answer: the context is lost, or it ran out of memory.
        """
        fence = self._fence_sync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)
        if not fence:
            raise GpuError(
                "the graphics context was lost",
                "restart the program; the scene can be saved first",
                "new renderer",
            )
        try:
            for _ in range(MAX_FENCE_WAITS):
                answer = self._client_wait(fence, GL_SYNC_FLUSH_COMMANDS_BIT, int(FENCE_SECONDS * 1e9))
                if answer == GL_WAIT_FAILED:
                    raise GpuError(
                        "the graphics driver stopped answering",
                        "try a smaller picture, or restart the program",
                        "new renderer",
                    )
                if answer != GL_TIMEOUT_EXPIRED:
                    return
            raise GpuError(
                "the graphics driver did not finish a pass in two minutes",
                "try a smaller picture",
                "smaller picture",
            )
        finally:
            self._delete_sync(fence)

    @contextmanager
    def checked(self, doing: str, remedy: str = "smaller picture") -> Iterator[None]:
        """Raise a `GpuError` if OpenGL reports an error within the block, naming what was being done.

        Parameters
        ----------
        doing : str
            What is asked of the device, for the message.
        remedy : str
            What would help if memory is short, as in `GpuError`.
        """
        for _ in range(MAX_OLD_ERRORS):  # moderngl leaves one behind when it makes a framebuffer
            if not self._get_error():
                break
        try:
            yield
        except Exception as error:  # moderngl raises its own bare Error
            raise GpuError(doing, f"{error} on {self.name}", remedy) from None
        code = self._get_error()
        if code:
            name = {
                0x0505: "out of GPU memory",
                0x0506: "incomplete framebuffer",
                0x0507: "context lost",
            }.get(code, f"OpenGL error 0x{code:04x}")
            lost = code == GL_CONTEXT_LOST
            raise GpuError(
                doing, f"{name} on {self.name}; use a {remedy}", "new renderer" if lost else remedy
            )

    def collect(self) -> None:
        """Free GPU objects that nothing refers to any more."""
        while self.ctx.objects:  # moderngl's own loop trips over objects that were released by hand
            thing = self.ctx.objects.popleft()
            if hasattr(thing, "release"):
                thing.release()

    @property
    def usable(self) -> bool:
        """Whether the device is open and this is its thread."""
        return not self._closed and threading.get_ident() == self._thread

    def close(self) -> None:
        """Free everything."""
        self._closed = True
        self.store.clear()
        self.collect()
        self.ctx.release()


def _create_context() -> moderngl.Context:
    backends: list[dict[str, Any]] = [{"backend": "egl"}, {}] if sys.platform.startswith("linux") else [{}]
    reasons = []
    for backend in backends:
        try:
            return moderngl.create_context(standalone=True, require=330, **backend)
        except Exception as error:  # moderngl raises bare Exceptions
            reasons.append(str(error))
    raise GpuError("an OpenGL 3.3 context could not be made", "; ".join(reasons) or "no driver")
